// SPDX-License-Identifier: BSD-3-Clause
#include "exports/page_scan.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "exports/bytes.h"
#include "exports/foxglove.h"
#include "exports/page_row.h"

namespace lidar_obstacles::apps {
namespace {

/// Numbers that look drawn at random, the same in every run.
std::uint32_t scrambled(std::uint32_t n) {
    n = (n ^ n >> 16U) * 0x7feb352dU;
    n = (n ^ n >> 15U) * 0x846ca68bU;
    return n ^ n >> 16U;
}

bool fits(const Eigen::Vector3f& p) { return p.cwiseAbs().maxCoeff() < 32767 * kPageStep; }

std::int16_t steps(float metres) { return static_cast<std::int16_t>(std::lround(metres / kPageStep)); }

/// Returns in the order in which neighbours are near each other.
std::vector<std::int32_t> alongRings(const PointCloud& cloud) {
    std::vector<std::int32_t> order;
    order.reserve(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (fits(cloud.xyz[i])) order.push_back(static_cast<std::int32_t>(i));
    if (cloud.view.empty() || cloud.ring.size() != cloud.size()) return order;
    std::stable_sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
        const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
        return std::pair(cloud.ring[i], cloud.view.column_of[i]) < std::pair(cloud.ring[j], cloud.view.column_of[j]);
    });
    return order;
}

bool isBackground(ReturnKind kind) {
    return kind == ReturnKind::None || kind == ReturnKind::Ground || kind == ReturnKind::Structure;
}

/// How many returns of the background were in its cube before, in the order given by chance.
std::uint32_t placeInCube(std::unordered_map<std::uint64_t, std::uint32_t>& cubes, const PagePoint& p) {
    constexpr int kCube = 15;  // steps: .3 m
    std::uint64_t key = 0;
    for (const int place : {p.x, p.y, p.z}) key = key << 16U | static_cast<std::uint16_t>((place + 32768) / kCube);
    return cubes[key]++;
}

void rank(std::vector<PagePoint>& points) {
    std::vector<std::uint32_t> order(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
    std::sort(order.begin(), order.end(), [](std::uint32_t a, std::uint32_t b) { return scrambled(a) < scrambled(b); });
    std::unordered_map<std::uint64_t, std::uint32_t> cubes;
    std::vector<std::uint32_t> level(points.size(), 0);
    for (const std::uint32_t i : order)
        if (isBackground(points[i].kind)) level[i] = 1 + placeInCube(cubes, points[i]);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return level[a] < level[b]; });
    for (std::size_t k = 0; k < order.size(); ++k) points[order[k]].rank = static_cast<std::uint32_t>(k);
}

/// The returns with a rank below `count`, in their order.
std::vector<PagePoint> firstByRank(const std::vector<PagePoint>& points, std::size_t count) {
    std::vector<PagePoint> kept;
    kept.reserve(std::min(count, points.size()));
    for (const PagePoint& p : points)
        if (p.rank < count) kept.push_back(p);
    return kept;
}

/// Runs of equal cells: floats x, y (lower-left corner), z of the ground, cell size; u16 columns, rows; then per run a
/// byte state and u16 length.
std::string gridRuns(const ScanOutput& scan) {
    const KnownCells cells = knownCells(scan.found.detection.grid);
    std::string bytes;
    for (const double number :
         {cells.origin.x(), cells.origin.y(), scan.found.detection.ground.heightAt(0.0, 0.0), cells.resolution})
        putFloat(bytes, static_cast<float>(number));
    putInteger(bytes, static_cast<std::uint16_t>(cells.columns));
    putInteger(bytes, static_cast<std::uint16_t>(cells.rows));
    for (std::size_t at = 0; at < cells.states.size();) {
        std::size_t end = at;
        while (end < cells.states.size() && end - at < 65535 && cells.states[end] == cells.states[at]) ++end;
        bytes += cells.states[at];
        putInteger(bytes, static_cast<std::uint16_t>(end - at));
        at = end;
    }
    return bytes;
}

void putText(std::string& bytes, const std::string& text) {
    putInteger(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += text;
}

/// Low bytes of the differences, then their high bytes.
void putDifferences(std::string& bytes, const std::vector<PagePoint>& points, std::int16_t PagePoint::* axis) {
    for (const unsigned shift : {0U, 8U}) {
        int before = 0;
        for (const PagePoint& p : points) {
            bytes += static_cast<char>(static_cast<std::uint16_t>(p.*axis - before) >> shift & 0xFFU);
            before = p.*axis;
        }
    }
}

}  // namespace

PageScan pageScan(const ScanOutput& scan, std::size_t max_points) {
    const PointCloud& cloud = scan.found.cloud;
    const ReturnLabels labels = labelReturns(scan.found);
    PageScan page;
    page.points.reserve(cloud.size());
    for (const std::int32_t index : alongRings(cloud)) {
        const auto i = static_cast<std::size_t>(index);
        const Eigen::Vector3f& p = cloud.xyz[i];
        page.points.push_back({steps(p.x()), steps(p.y()), steps(p.z()), labels.kind[i], 0});
    }
    rank(page.points);
    page.points = firstByRank(page.points, max_points);
    page.structure = pageStructure(scan);
    page.grid = gridRuns(scan);
    page.row = pageRow(scan);
    return page;
}

std::string deflated(const std::string& bytes) {
    std::string small(compressBound(bytes.size()), '\0');
    uLongf size = small.size();
    if (compress2(reinterpret_cast<Bytef*>(small.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                  bytes.size(), Z_DEFAULT_COMPRESSION) != Z_OK)
        throw std::bad_alloc();
    small.resize(size);
    return base64(small);
}

std::string packed(const PageScan& scan, std::size_t max_points) {
    const std::vector<PagePoint> points = firstByRank(scan.points, max_points);
    std::string bytes;
    putText(bytes, scan.structure);
    putText(bytes, scan.grid);
    putInteger(bytes, static_cast<std::uint32_t>(points.size()));
    for (const PagePoint& p : points) putInteger(bytes, static_cast<std::uint8_t>(p.kind));
    for (const auto axis : {&PagePoint::x, &PagePoint::y, &PagePoint::z}) putDifferences(bytes, points, axis);
    return deflated(bytes);
}

std::string toBytes(const PageScan& scan) {
    std::string bytes;
    for (const std::string& text : {scan.structure, scan.grid, scan.row}) putText(bytes, text);
    const std::size_t size = scan.points.size() * sizeof(PagePoint);
    const std::size_t at = bytes.size();
    bytes.resize(at + size);
    if (size > 0) std::memcpy(bytes.data() + at, scan.points.data(), size);
    return bytes;
}

PageScan pageScanOf(const std::string& bytes) {
    PageScan scan;
    std::size_t at = 0;
    for (std::string* text : {&scan.structure, &scan.grid, &scan.row}) {
        std::uint32_t size = 0;
        for (std::size_t k = 4; k > 0; --k) size = size << 8U | static_cast<std::uint8_t>(bytes[at + k - 1]);
        *text = bytes.substr(at + 4, size);
        at += 4 + size;
    }
    scan.points.resize((bytes.size() - at) / sizeof(PagePoint));
    if (!scan.points.empty())
        std::memcpy(scan.points.data(), bytes.data() + at, scan.points.size() * sizeof(PagePoint));
    return scan;
}

}  // namespace lidar_obstacles::apps

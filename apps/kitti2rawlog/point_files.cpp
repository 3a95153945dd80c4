// SPDX-License-Identifier: BSD-3-Clause
#include "point_files.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "ring_recovery.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

/// The floats of a file, `per_point` for each point. Written by little-endian machines for such.
std::vector<float> readFloats(const fs::path& file, std::size_t per_point) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error(file.string() + ": cannot read: " + std::strerror(errno));
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (bytes.size() % (per_point * sizeof(float)) != 0) {
        throw std::runtime_error(file.string() + ": " + std::to_string(bytes.size()) +
                                 " bytes are no whole number of points of " + std::to_string(per_point) + " floats");
    }
    std::vector<float> values(bytes.size() / sizeof(float));
    if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

bool isReturn(const float* p) {
    return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]) &&
           (p[0] != 0.F || p[1] != 0.F || p[2] != 0.F);
}

/// Whether higher ring numbers look lower: the sign of the covariance of ring and elevation.
bool ringsCountFromTop(const Frame& frame) {
    double mean_ring = 0.0;
    double mean_elevation = 0.0;
    double sum_of_products = 0.0;
    const auto n = static_cast<double>(frame.points.size());
    for (std::size_t k = 0; k < frame.points.size(); ++k) {
        const Eigen::Vector3f& p = frame.points[k];
        const double elevation = std::atan2(p.z(), p.head<2>().norm());
        mean_ring += frame.ring[k] / n;
        mean_elevation += elevation / n;
        sum_of_products += frame.ring[k] * elevation;
    }
    return sum_of_products - n * mean_ring * mean_elevation < 0.0;
}

}  // namespace

void readKittiPoints(const fs::path& file, int planes, Frame& frame) {
    const std::vector<float> values = readFloats(file, 4);
    for (std::size_t k = 0; k + 3 < values.size(); k += 4) {
        if (!isReturn(&values[k])) continue;
        frame.points.emplace_back(values[k], values[k + 1], values[k + 2]);
        frame.intensity.push_back(values[k + 3]);
    }
    try {
        frame.ring = recoverRings(frame.points, planes);
    } catch (const std::runtime_error& e) {
        throw std::runtime_error(file.string() + ": " + e.what());
    }
}

void readNuScenesPoints(const fs::path& file, int planes, Frame& frame) {
    const std::vector<float> values = readFloats(file, 5);
    for (std::size_t k = 0; k + 4 < values.size(); k += 5) {
        if (!isReturn(&values[k])) continue;
        const float ring = values[k + 4];
        if (!(ring >= 0.F) || ring >= static_cast<float>(planes) || ring != std::floor(ring))
            throw std::runtime_error(file.string() + ": point " + std::to_string(k / 5) + ": ring " +
                                     std::to_string(ring) + " is not one of 0 .. " + std::to_string(planes - 1));
        frame.points.emplace_back(values[k], values[k + 1], values[k + 2]);
        frame.intensity.push_back(values[k + 3] / 255.F);
        frame.ring.push_back(static_cast<std::uint16_t>(ring));
    }
    if (!ringsCountFromTop(frame)) return;
    for (std::uint16_t& r : frame.ring) r = static_cast<std::uint16_t>(planes - 1 - r);
}

}  // namespace lidar_obstacles::apps

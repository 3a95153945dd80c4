// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/labels.h"

#include <cstring>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <utility>

#include "lidar_obstacles/simulation/truth.h"

namespace lidar_obstacles::simulation {
namespace {

constexpr const char* kMagic = "LOLABELS";
constexpr std::size_t kMagicBytes = 8, kHeaderBytes = kMagicBytes + 4, kScanBytes = 16, kReturnBytes = 3;
constexpr std::uint32_t kVersion = 1;

void put(std::string& bytes, std::uint64_t value, int count) {
    for (int k = 0; k < count; ++k) bytes += static_cast<char>((value >> (8 * k)) & 0xffU);
}

std::uint64_t get(const std::string& bytes, std::size_t at, int count) {
    std::uint64_t value = 0;
    for (int k = 0; k < count; ++k)
        value |= static_cast<std::uint64_t>(static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(k)]))
                 << (8 * k);
    return value;
}

}  // namespace

ScanLabels labelsOf(const LidarScan& scan, std::size_t scan_index) {
    ScanLabels labels{scan_index, kEpoch + scan.turn.start(), {}};
    labels.returns.reserve(scan.returns.size());
    for (const LidarReturn& r : scan.returns) {
        if (std::abs(r.id) > std::numeric_limits<std::int16_t>::max())
            throw std::invalid_argument("labels: " + std::to_string(r.id) + " is too large for an id");
        labels.returns.push_back({static_cast<std::int16_t>(r.id), r.kind});
    }
    return labels;
}

std::string labelsHeader() {
    std::string bytes = kMagic;
    put(bytes, kVersion, 4);
    return bytes;
}

std::string labelsRecord(const ScanLabels& labels) {
    std::string bytes;
    bytes.reserve(kScanBytes + kReturnBytes * labels.returns.size());
    put(bytes, labels.scan_index, 4);
    put(bytes, labels.returns.size(), 4);
    std::uint64_t timestamp = 0;
    static_assert(sizeof timestamp == sizeof labels.timestamp);
    std::memcpy(&timestamp, &labels.timestamp, sizeof timestamp);
    put(bytes, timestamp, 8);
    for (const ReturnLabel& r : labels.returns) {
        put(bytes, static_cast<std::uint16_t>(r.id), 2);
        put(bytes, static_cast<std::uint8_t>(r.kind), 1);
    }
    return bytes;
}

LabelsReader::LabelsReader(std::string file) : file_(std::move(file)), in_(file_, std::ios::binary) {
    std::error_code error;
    left_ = std::filesystem::file_size(file_, error);
    if (!in_ || error) throw std::runtime_error(file_ + ": cannot read");
    std::string header(kHeaderBytes, '\0');
    if (left_ < kHeaderBytes || !read(header) || header.compare(0, kMagicBytes, kMagic) != 0)
        throw std::runtime_error(file_ + ": no file of labels (it does not begin with " + kMagic + ")");
    if (get(header, kMagicBytes, 4) != kVersion)
        throw std::runtime_error(file_ + ": labels of version " + std::to_string(get(header, kMagicBytes, 4)) +
                                 "; known is " + std::to_string(kVersion));
}

void LabelsReader::fail(const std::string& reason) const {
    throw std::runtime_error(file_ + ": scan " + std::to_string(scans_) + ": " + reason);
}

bool LabelsReader::read(std::string& bytes) {
    if (left_ == 0 && !bytes.empty()) return false;
    if (left_ < bytes.size()) fail("the file ends within it");
    if (!in_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()))) fail("cannot read");
    left_ -= bytes.size();
    return true;
}

std::optional<ScanLabels> LabelsReader::next() {
    std::string bytes(kScanBytes, '\0');
    if (!read(bytes)) return std::nullopt;
    ScanLabels labels;
    labels.scan_index = get(bytes, 0, 4);
    const std::uint64_t count = get(bytes, 4, 4), timestamp = get(bytes, 8, 8);
    std::memcpy(&labels.timestamp, &timestamp, sizeof timestamp);
    if (count * kReturnBytes > left_) fail("the file ends within it");
    bytes.resize(count * kReturnBytes);
    if (count > 0) read(bytes);
    labels.returns.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t kind = get(bytes, kReturnBytes * i + 2, 1);
        if (kind >= allKinds().size()) fail("return " + std::to_string(i) + ": no kind " + std::to_string(kind));
        const auto id = static_cast<std::int16_t>(static_cast<std::uint16_t>(get(bytes, kReturnBytes * i, 2)));
        labels.returns[i] = {id, static_cast<ObjectKind>(kind)};
    }
    ++scans_;
    return labels;
}

}  // namespace lidar_obstacles::simulation

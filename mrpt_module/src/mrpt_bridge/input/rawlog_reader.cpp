// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/rawlog_reader.h"

#include <mrpt/core/exceptions.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "mrpt_bridge/input/external_clouds.h"
#include "mrpt_bridge/input/gz_error.h"
#include "mrpt_bridge/input/lidar_names.h"
#include "mrpt_bridge/input/reason_of.h"

namespace lidar_obstacles {

/// MRPT archive over zlib, which reads plain files as well and, unlike MRPT's own stream, tells where in the
/// compressed file it stands and whether the compressed stream is whole.
class RawlogReader::GzArchive : public mrpt::serialization::CArchive {
  public:
    GzArchive(const std::string& path, std::uint64_t start) {
        std::error_code ec;
        if (std::filesystem::is_directory(path, ec)) throw std::runtime_error("cannot open " + path + ": a directory");
        errno = 0;
        file_ = gzopen(path.c_str(), "rb");
        if (!file_) throw std::runtime_error("cannot open " + path + ": " + std::strerror(errno ? errno : ENOMEM));
        gzbuffer(file_, 1U << 17U);
        const auto size = std::filesystem::file_size(path, ec);
        size_ = ec ? 0.0 : static_cast<double>(size);
        // isCompressed() looks at the file: only then zlib knows that it may seek instead of reading up to there
        if (start == 0 || (!isCompressed() && gzseek(file_, static_cast<z_off_t>(start), SEEK_SET) >= 0)) return;
        gzclose(file_);
        throw std::runtime_error("cannot read " + path + " from byte " + std::to_string(start) + " on");
    }
    ~GzArchive() override { gzclose(file_); }
    GzArchive(const GzArchive&) = delete;
    GzArchive& operator=(const GzArchive&) = delete;

    bool isCompressed() const { return gzdirect(file_) == 0; }
    std::uint64_t position() const { return static_cast<std::uint64_t>(gztell(file_)); }

    double progress() const {
        return size_ > 0.0 ? std::clamp(static_cast<double>(gzoffset(file_)) / size_, 0.0, 1.0) : 1.0;
    }

    /// Why the compressed stream is broken; empty if it is not.
    std::string streamError() const { return gzErrorOf(file_); }

  protected:
    std::size_t read(void* data, std::size_t size) override {
        auto* to = static_cast<char*>(data);
        std::size_t done = 0;
        while (done < size) {
            const auto part = static_cast<unsigned>(std::min<std::size_t>(size - done, 1U << 30U));
            const int got = gzread(file_, to + done, part);
            if (got <= 0) break;
            done += static_cast<std::size_t>(got);
        }
        return done;
    }
    std::size_t write(const void*, std::size_t) override { throw std::logic_error("the archive is for reading"); }

  private:
    gzFile file_ = nullptr;
    double size_ = 0.0;  ///< of the file as it lies on disk [byte]
};

RawlogReader::RawlogReader(const std::string& path, std::uint64_t start, bool with_clouds)
    : path_(path), archive_(std::make_unique<GzArchive>(path, start)), names_(std::make_unique<LidarNames>()) {
    if (with_clouds) clouds_ = std::make_unique<ExternalClouds>(path);
}

RawlogReader::~RawlogReader() = default;

std::optional<SourceItem> RawlogReader::next() {
    while (pending_.empty() && status_ == SourceStatus::Open) {
        if (!readObject()) return std::nullopt;
    }
    if (pending_.empty()) return std::nullopt;
    SourceItem item = std::move(pending_.front());
    pending_.pop_front();
    return item;
}

bool RawlogReader::isCompressed() const { return archive_->isCompressed(); }

bool RawlogReader::readObject() {
    object_begin_ = archive_->position();
    mrpt::serialization::CSerializable::Ptr object;
    try {
        object = archive_->ReadObject();
    } catch (const mrpt::serialization::CExceptionEOF&) {
        const std::string broken = archive_->streamError();
        broken.empty() ? void(status_ = SourceStatus::End) : fail(broken);
        return false;
    } catch (const std::exception& e) {  // also bad_alloc, from a length that cannot be right
        const std::string broken = archive_->streamError();
        fail(broken.empty() ? reasonOf(e) : broken);
        return false;
    }
    const std::size_t number = objects_++;
    if (auto observation = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)) {
        add(observation, number);
    } else if (auto action = std::dynamic_pointer_cast<mrpt::obs::CActionCollection>(object)) {
        SourceItem item;
        item.action = action;
        item.object = number;
        pending_.push_back(std::move(item));
    } else if (auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) {
        for (const auto& part : *frame)
            if (part) add(part, number);
    } else {
        ++passed_over_;
    }
    return true;
}

void RawlogReader::add(const mrpt::obs::CObservation::Ptr& observation, std::size_t number) {
    SourceItem item;
    item.observation = observation;
    item.object = number;
    if (isLidarScan(*observation)) item.lidar = names_->nameOf(*observation);
    const std::string reason = clouds_ ? clouds_->load(*observation) : "";
    item.is_gap = !reason.empty();
    if (item.is_gap && gaps_++ == 0) first_gap_ = reason;
    pending_.push_back(std::move(item));
}

void RawlogReader::fail(const std::string& reason) {
    status_ = SourceStatus::Damaged;
    message_ = path_ + ": object " + std::to_string(objects_) + " cannot be read: " + reason;
}

std::string RawlogReader::remarks() const {
    std::string text;
    if (passed_over_ != 0)
        text = std::to_string(passed_over_) + " objects that are neither observation nor action passed over";
    if (gaps_ != 0)
        text += (text.empty() ? "" : "; ") + std::to_string(gaps_) +
                " scans left out whose points cannot be read, the first: " + first_gap_;
    return text;
}

double RawlogReader::progress() const { return status_ == SourceStatus::End ? 1.0 : archive_->progress(); }

}  // namespace lidar_obstacles

// SPDX-License-Identifier: BSD-3-Clause
#include "scan_store.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/input_choice.h"
#include "common/message_of.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/rawlog_reader.h"

namespace lidar_obstacles::apps {

ScanStore::ScanStore(const std::string& path, const ScanSelection& selection)
    : path_(path),
      selection_(selection),
      files_(path),
      source_(openScanSource(path, selection.options)),
      label_(selection.label) {
    const auto* rawlog = dynamic_cast<const RawlogReader*>(source_.get());
    if (!rawlog || rawlog->isCompressed()) spool_ = std::make_unique<ScanSpool>();
    thread_ = std::thread(&ScanStore::readThrough, this);
}

ScanStore::~ScanStore() {
    stop_ = true;
    thread_.join();
}

void ScanStore::readThrough() {
    try {
        while (const auto item = source_->next()) {
            if (stop_ || !add(*item)) break;
            progress_ = source_->progress();
        }
        finish();
    } catch (const std::exception& e) {
        report(messageOf(e), false);
    }
    progress_ = 1.0;
    {
        const std::lock_guard lock(mutex_);
        complete_ = true;
    }
    grown_.notify_all();
}

/// False if no later item can be of interest.
bool ScanStore::add(const SourceItem& item) {
    part_ = object_ == item.object ? part_ + 1 : 0;
    object_ = item.object;
    if (!item.observation) return true;
    if (const auto* image = dynamic_cast<const mrpt::obs::CObservationImage*>(item.observation.get()))
        appendImage(*image);
    if (!isLidarScan(*item.observation)) return true;
    const std::string& label = item.lidar;
    if (selection_.label && label != *selection_.label) return true;
    if (!label_) label_ = label;
    if (label != *label_) {
        report(path_ + ": several lidars ('" + *label_ + "', '" + label + "' ...), choose one with --sensor-label",
               true);
        return false;
    }
    const std::size_t number = seen_++;
    if (number > selection_.to) return false;
    if (!item.is_gap && number >= selection_.from && (number - selection_.from) % selection_.every == 0) append(item);
    return true;
}

/// Where it will be read again.
ScanSpool::Place ScanStore::placeOf(const mrpt::obs::CObservation& observation) {
    if (spool_) return spool_->append(observation);
    return {static_cast<const RawlogReader&>(*source_).objectBegin(), part_};
}

void ScanStore::append(const SourceItem& item) {
    const Entry entry{mrpt::Clock::toDouble(item.observation->timestamp), seen_ - 1, placeOf(*item.observation)};
    {
        const std::lock_guard lock(mutex_);
        entries_.push_back(entry);
    }
    grown_.notify_all();
}

void ScanStore::appendImage(const mrpt::obs::CObservationImage& image) {
    const ImageEntry entry{mrpt::Clock::toDouble(image.timestamp), placeOf(image)};
    const std::lock_guard lock(mutex_);
    auto& images = images_[image.sensorLabel];
    if (images.empty()) cameras_.push_back(image.sensorLabel);
    images.push_back(entry);
}

void ScanStore::finish() {
    if (source_->status() == SourceStatus::Damaged) return report(source_->message(), false);
    if (size() > 0 || !problem().empty() || stop_) return;
    if (seen_ > 0) return report(path_ + ": --from, --to and --every leave none of its scans", true);
    if (selection_.label) return report(path_ + ": no lidar '" + *selection_.label + "' in it", true);
    report(noScansIn(path_, *source_), false);
}

void ScanStore::report(const std::string& problem, bool usage) {
    const std::lock_guard lock(mutex_);
    problem_ = problem;
    usage_ = usage;
}

std::size_t ScanStore::size() const {
    const std::lock_guard lock(mutex_);
    return entries_.size();
}

std::string ScanStore::problem() const {
    const std::lock_guard lock(mutex_);
    return problem_;
}

bool ScanStore::waitFor(std::size_t index) const {
    std::unique_lock lock(mutex_);
    grown_.wait(lock, [&] { return index < entries_.size() || complete_; });
    return index < entries_.size();
}

ScanStore::Entry ScanStore::entry(std::size_t index) const {
    const std::lock_guard lock(mutex_);
    return entries_.at(index);
}

std::size_t ScanStore::scanIndex(std::size_t index) const { return entry(index).scan_index; }

double ScanStore::time(std::size_t index) const { return entry(index).time; }

std::size_t ScanStore::atScanIndex(std::size_t scan_index) const {
    const std::lock_guard lock(mutex_);
    const auto at = std::lower_bound(entries_.begin(), entries_.end(), scan_index,
                                     [](const Entry& e, std::size_t wanted) { return e.scan_index < wanted; });
    const auto index = static_cast<std::size_t>(at - entries_.begin());
    return std::min(index, entries_.empty() ? 0 : entries_.size() - 1);
}

std::size_t ScanStore::atTime(double time) const {
    const std::lock_guard lock(mutex_);
    const auto after = std::upper_bound(entries_.begin(), entries_.end(), time,
                                        [](double wanted, const Entry& e) { return wanted < e.time; });
    return after == entries_.begin() ? 0 : static_cast<std::size_t>(after - entries_.begin()) - 1;
}

mrpt::obs::CObservation::Ptr ScanStore::read(std::size_t index) const {
    const Entry e = entry(index);
    const auto scan = readAt(e.place);
    if (!scan || !isLidarScan(*scan))
        throw std::runtime_error(path_ + ": scan " + std::to_string(e.scan_index) + " has changed on disk");
    if (selection_.sensor_pose) placeSensor(*scan, *selection_.sensor_pose, selection_.points_in_vehicle);
    return scan;
}

/// Null if nothing is there.
mrpt::obs::CObservation::Ptr ScanStore::readAt(const ScanSpool::Place& place) const {
    if (spool_) return spool_->read(place);
    RawlogReader reader(path_, place.begin);
    std::optional<SourceItem> item = reader.next();
    for (std::uint64_t k = 0; item && k < place.size; ++k) item = reader.next();
    return item ? item->observation : nullptr;
}

std::vector<std::string> ScanStore::cameras() const {
    const std::lock_guard lock(mutex_);
    return cameras_;
}

std::optional<std::size_t> ScanStore::imageBeside(const std::string& camera, std::size_t index) const {
    constexpr double kFarthest = 0.25;  // [s]
    const double scan = time(index);
    const std::lock_guard lock(mutex_);
    const auto images = images_.find(camera);
    if (images == images_.end()) return std::nullopt;
    const auto away = [&](const ImageEntry& e) { return std::abs(e.time - scan); };
    const auto nearest = std::min_element(images->second.begin(), images->second.end(),
                                          [&](const auto& a, const auto& b) { return away(a) < away(b); });
    if (away(*nearest) > kFarthest) return std::nullopt;
    return static_cast<std::size_t>(nearest - images->second.begin());
}

CameraImage ScanStore::readImage(const std::string& camera, std::size_t number) const {
    ScanSpool::Place place;
    {
        const std::lock_guard lock(mutex_);
        place = images_.at(camera).at(number).place;
    }
    CameraImage none;
    none.label = camera;
    try {
        const auto image = std::dynamic_pointer_cast<mrpt::obs::CObservationImage>(readAt(place));
        if (image) return cameraImageOf(*image, files_);
        none.problem = path_ + ": the image has changed on disk";
    } catch (const std::exception& e) {
        none.problem = messageOf(e);
    }
    return none;
}

}  // namespace lidar_obstacles::apps

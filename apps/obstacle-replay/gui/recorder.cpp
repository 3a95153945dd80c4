// SPDX-License-Identifier: BSD-3-Clause
#include "recorder.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

#include "common/numbered_files.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

constexpr double kUsualRate = 10.0;  // where a single scan does not tell [1/s]

bool isVideo(const ViewOptions& options) { return fs::path(options.record).extension() == ".mp4"; }

}  // namespace

Recorder::Recorder(const Recording& recording)
    : recording_(recording),
      truth_(recording.options.truth.empty() ? TruthByScan{} : readTruthByScan(recording.options.truth)),
      renderer_(recording.options.width, recording.options.height),
      overlay_(layers_.scene()) {
    layers_.setVisible(recording.options.layers);
    layers_.setPointColor(recording.options.color);
    layers_.setViewDistance(recording.view.distance);
    if (isVideo(recording.options)) return;
    std::error_code error;
    fs::create_directories(recording.options.record, error);
    if (!fs::is_directory(recording.options.record))
        throw std::runtime_error(recording.options.record + ": cannot make the folder");
    removeNumbered(recording.options.record, {{"frame_", ".png"}});
}

void Recorder::add(std::size_t scan_index, const SequenceResult& found, const ObstacleDetector& detector,
                   const ZoneMonitor* zones) {
    auto scan = std::make_shared<ShownScan>();
    scan->scan_index = scan_index;
    scan->take(found, detector, recording_.params);
    if (zones != nullptr) scan->zones = outlinesOf(*zones, found, detector.trajectory());
    tails_.add(found, detector.trajectory());
    scan->tails = tails_.tails();
    const auto truth = truth_.find(scan_index);
    if (truth != truth_.end()) scan->truth = truth->second;
    if (first_time_ == 0.0) first_time_ = scan->cloud.timestamp;
    const mrpt::img::CImage picture = draw(scan);
    if (isVideo(recording_.options)) return write(picture, scan->cloud.timestamp);
    char name[32];
    std::snprintf(name, sizeof name, "frame_%06zu.png", scan_index);
    const fs::path file = fs::path(recording_.options.record) / name;
    if (!picture.saveToFile(file.string())) throw std::runtime_error(file.string() + ": cannot write");
}

mrpt::img::CImage Recorder::draw(const std::shared_ptr<ShownScan>& scan) {
    OverlayTexts texts;
    char line[64];
    std::snprintf(line, sizeof line, "\nscan %zu, %.2f s\n", scan->scan_index, scan->cloud.timestamp - first_time_);
    texts.state = fs::path(recording_.input).filename().string() + line + countsText(*scan);
    texts.times = timesText(*scan);
    texts.layers = layersText(recording_.options.layers, recording_.options.color);
    overlay_.write(texts);
    layers_.setScan(scan);
    CameraView view = recording_.view;
    view.target.z() = scan->result.ground.heightAt(view.target.x(), view.target.y());
    return renderer_.render(*layers_.scene(), view);
}

void Recorder::write(const mrpt::img::CImage& picture, double time) {
    if (!video_ && !waiting_) {
        waiting_ = picture.makeDeepCopy();
        return;
    }
    if (!video_) openVideo(1.0 / std::clamp(time - first_time_, 1.0 / 60.0, 1.0));
    video_->append(picture);
}

void Recorder::openVideo(double frames_per_second) {
    const ViewOptions& o = recording_.options;
    video_ = std::make_unique<VideoFile>(o.record, std::to_string(o.width) + "x" + std::to_string(o.height),
                                         frames_per_second);
    video_->append(*waiting_);
    waiting_.reset();
}

void Recorder::finish() {
    if (waiting_) openVideo(kUsualRate);
    if (video_) video_->close();
}

}  // namespace lidar_obstacles::apps

// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/annotated_rawlog.h"

#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CText.h>

#include <utility>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/results.h"

namespace lidar_obstacles {

using mrpt::obs::CObservationComment;

mrpt::obs::CObservation3DScene::Ptr toSceneObservation(const PointCloud& cloud, const DetectionResult& result,
                                                       const std::string& scan_label, const SceneOptions& options) {
    auto observation = mrpt::obs::CObservation3DScene::Create();
    observation->timestamp = mrpt::Clock::fromDouble(cloud.timestamp);
    observation->sensorLabel = scan_label.empty() ? "obstacles" : scan_label + "_obstacles";
    observation->scene = toScene(cloud, result, options);
    if (const auto grid = observation->scene->getByName("grid")) observation->scene->removeObject(grid);
    auto label = mrpt::opengl::CText::Create(observation->sensorLabel);
    label->setFont("sans", 14);
    label->setLocation(0.0, 0.0, result.ground.heightAt(0.0, 0.0));
    label->setName("sensor_label");
    observation->scene->insert(label);
    return observation;
}

AnnotatedRawlog::AnnotatedRawlog(std::filesystem::path file, std::string comment)
    : writer_(std::move(file)), comment_(std::move(comment)) {}

AnnotatedRawlog::~AnnotatedRawlog() = default;

void AnnotatedRawlog::copy(const SourceItem& item) {
    if (object_ && *object_ != item.object) writePending();
    object_ = item.object;
    if (item.observation) time_ = item.observation->timestamp;
    if (item.action) {
        writeComment("");
        has_actions_ = true;
        writer_.append(*item.action);
    } else if (const auto comment = std::dynamic_pointer_cast<CObservationComment>(item.observation)) {
        writeComment(comment->text);
    } else if (item.observation) {
        writeComment("");
        append(item.observation);
        for (const auto& scan : item.beside) append(scan);
        if (isLidarScan(*item.observation)) scan_label_ = item.observation->sensorLabel;
        ++copied_;
    }
}

void AnnotatedRawlog::append(const mrpt::obs::CObservation::Ptr& observation) { pending_.push_back(observation); }

void AnnotatedRawlog::annotate(const PointCloud& cloud, const DetectionResult& result, const SceneOptions& options) {
    append(toSceneObservation(cloud, result, scan_label_, options));
    append(toResultsObservation({cloud.timestamp, scan_label_, result.obstacles}));
}

void AnnotatedRawlog::writeComment(const std::string& of_recording) {
    if (has_comment_ && of_recording.empty()) return;
    CObservationComment comment;
    comment.text = comment_;
    comment.timestamp = time_;
    if (!of_recording.empty()) comment.text += "\n\nComment of the recording:\n" + of_recording;
    writer_.append(comment);
    has_comment_ = true;
}

void AnnotatedRawlog::writePending() {
    if (copied_ > 1 || (has_actions_ && copied_ > 0)) {  // a sensory frame
        mrpt::obs::CSensoryFrame frame;
        for (const auto& observation : pending_) frame.insert(observation);
        writer_.append(frame);
    } else {
        for (const auto& observation : pending_) writer_.append(*observation);
    }
    pending_.clear();
    copied_ = 0;
}

void AnnotatedRawlog::close() {
    writePending();
    writeComment("");
    writer_.close();
}

std::optional<SourceItem> CopyingSource::next() {
    auto item = source_.next();
    if (item) to_.copy(*item);
    return item;
}

}  // namespace lidar_obstacles

// SPDX-License-Identifier: BSD-3-Clause
#include "pictures.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/CText.h>
#include <mrpt/poses/CPose3D.h>
#include <mrpt/system/string_utils.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>
#include <map>
#include <optional>

#include "common/interrupt.h"
#include "detector.h"
#include "explain.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles::apps {
namespace {

using evaluation::ObjectRecord;
using evaluation::SetResult;
using evaluation::WorstScan;

constexpr int kWidth = 960;
constexpr int kHeight = 600;
const mrpt::img::TColor kTruthColor(60, 255, 60);

std::string base64Jpeg(const mrpt::img::CImage& picture) {
    mrpt::io::CMemoryStream stream;
    picture.saveToStreamAsJPEG(stream, 85);
    std::vector<std::uint8_t> bytes(stream.getTotalBytesCount());
    std::memcpy(bytes.data(), stream.getRawBufferData(), bytes.size());
    std::string text;
    mrpt::system::encodeBase64(bytes, text);
    text.erase(std::remove_if(text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }), text.end());
    return text;
}

void addTruth(mrpt::opengl::COpenGLScene& scene, const ObjectRecord& record, bool worst) {
    const OrientedBox& b = record.object.box;
    const mrpt::math::TPoint3D half(b.size.x() / 2, b.size.y() / 2, b.size.z() / 2);
    auto box = mrpt::opengl::CBox::Create(mrpt::math::TPoint3D(-half.x, -half.y, -half.z), half, true);
    box->setBoxBorderColor(kTruthColor);
    box->setLineWidth(worst ? 5.F : record.counted ? 2.F : 1.F);
    box->setPose(mrpt::poses::CPose3D(b.center.x(), b.center.y(), b.center.z(), b.yaw, 0, 0));
    scene.insert(box);
    if (!worst) return;
    auto label = mrpt::opengl::CText::Create("truth: " + record.object.type + ' ' + record.object.object_id);
    label->setFont("sans", 20);
    label->setColor_u8(kTruthColor);
    label->setLocation(b.center.x(), b.center.y(), b.center.z() + half.z + 1.2);
    scene.insert(label);
}

/// A detection as an obstacle, with the returns of the cloud in its box.
Obstacle obstacleOf(const evaluation::Detection& d, const PointCloud& cloud) {
    Obstacle o;
    std::from_chars(d.id.data(), d.id.data() + d.id.size(), o.id);  // 0 where it is no number
    o.box = d.box;
    o.heading_valid = d.heading_valid;
    o.cls = evaluation::classOf(d.group);
    o.num_points = d.num_points;
    o.points = returnsIn(o.box, cloud);
    return o;
}

/// What the detector made of the scan, with the boxes that were judged in the place of its own: these are tracks, and
/// those of one scan alone.
void takeJudged(std::vector<Obstacle> judged, DetectionResult& result) {
    const auto isRoadUser = [](const Obstacle& o) { return o.cls != ObstacleClass::Structure; };
    auto& obstacles = result.obstacles;
    obstacles.erase(std::remove_if(obstacles.begin(), obstacles.end(), isRoadUser), obstacles.end());
    std::move(judged.begin(), judged.end(), std::back_inserter(obstacles));
}

CameraView overviewOf(const GroundModel& ground) {
    CameraView view;
    view.target.z() = ground.heightAt(view.target.x(), view.target.y());
    return view;
}

/// From the vehicle's side and above, near enough to see the object's returns.
CameraView closeUpOf(const OrientedBox& box) {
    CameraView view;
    view.target = box.center;
    view.distance = 13.0;
    view.azimuth_deg = std::atan2(-box.center.y(), -box.center.x()) * 180.0 / M_PI;
    view.elevation_deg = 48.0;
    return view;
}

class Painter {
  public:
    Painter(const std::vector<SetResult>& results, const EvaluateOptions& options, const DetectorParams& params)
        : results_(results), options_(options), params_(params), renderer_(kWidth, kHeight) {}

    ScanPictures draw(const WorstScan& scan, const SourceItem& item) {
        const PointCloud cloud = cloudOf(item, params_);
        const SetResult& judged = results_[scan.set];
        const OrientedBox& worst = scan.worst->object.box;
        ScanPictures pictures;
        const bool is_ours = options_.sets[scan.set].detections.empty();
        DetectionResult result = is_ours ? detectScan(cloud, params_) : DetectionResult{};
        if (is_ours)
            pictures.remarks = explainReturns(worst, cloud, result);  // what this scan alone gave
        else
            result.candidates = returnsIn(worst, cloud);
        takeJudged(judgedObstacles(judged, scan.scan_index, cloud), result);
        SceneOptions scene_options;
        scene_options.rejected = true;
        scene_options.own_body = OwnBody(params_.region.own_body);
        scene_options.region = params_.region;
        const auto scene = toScene(cloud, result, scene_options);
        for (const ObjectRecord& r : judged.records) {
            if (r.timestamp == scan.timestamp) addTruth(*scene, r, &r == scan.worst);
        }
        pictures.overview = base64Jpeg(renderer_.render(*scene, overviewOf(result.ground)));
        pictures.close_up = base64Jpeg(renderer_.render(*scene, closeUpOf(worst)));
        return pictures;
    }

  private:
    const std::vector<SetResult>& results_;
    const EvaluateOptions& options_;
    const DetectorParams& params_;
    SceneRenderer renderer_;
};

}  // namespace

std::vector<Obstacle> judgedObstacles(const SetResult& result, int scan_index, const PointCloud& cloud) {
    std::vector<Obstacle> obstacles;
    for (const ObjectRecord& r : result.records) {
        if (r.object.scan_index == scan_index && r.detection) obstacles.push_back(obstacleOf(*r.detection, cloud));
    }
    for (const auto& u : result.unmatched) {
        if (u.scan_index == scan_index) obstacles.push_back(obstacleOf(u.detection, cloud));
    }
    return obstacles;
}

std::vector<ScanPictures> drawScans(const std::vector<WorstScan>& scans, const std::vector<SetResult>& results,
                                    const EvaluateOptions& options, const DetectorParams& params) {
    std::vector<ScanPictures> pictures(scans.size());
    std::optional<Painter> painter;  // made with the first picture: rendering may not be there, and not be needed
    for (std::size_t s = 0; s < options.sets.size(); ++s) {
        std::map<int, std::size_t> wanted;  // scan_index -> place in `pictures`
        for (std::size_t k = 0; k < scans.size(); ++k) {
            if (scans[k].set == s) wanted[scans[k].scan_index] = k;
        }
        if (wanted.empty() || options.sets[s].rawlog.empty()) continue;
        if (!painter) painter.emplace(results, options, params);
        forEachScan({options.sets[s].rawlog, options.choice}, [&](std::size_t index, const SourceItem& item, double) {
            if (isInterrupted()) return false;
            const auto it = wanted.find(static_cast<int>(index));
            if (it != wanted.end()) pictures[it->second] = painter->draw(scans[it->second], item);
            return static_cast<int>(index) < wanted.rbegin()->first;
        });
    }
    return pictures;
}

}  // namespace lidar_obstacles::apps

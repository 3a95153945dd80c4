// SPDX-License-Identifier: BSD-3-Clause
#include "outputs.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string_view>

#include "common/merges_csv.h"
#include "common/number_text.h"
#include "common/numbered_files.h"
#include "common/text_file.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "lidar_obstacles/mrpt_bridge/filter_scene.h"
#include "lidar_obstacles/mrpt_bridge/maps.h"
#include "lidar_obstacles/mrpt_bridge/zone_scene.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOwnBodyFile = "own_body.txt";
constexpr const char* kMergesFile = "merges.csv";

/// @throws UsageError if a file to write is the input.
void requireOther(const std::string& option, const fs::path& file, const fs::path& input) {
    std::error_code ignored;
    if (fs::equivalent(file, input, ignored)) throw UsageError(option + ": is the input");
}

/// Whether the own body is told by this file, which an earlier run has learnt.
bool readsOwnBody(const Options& options, const fs::path& file) {
    constexpr std::string_view kFrom = "region.own_body=@";
    std::error_code ignored;
    return std::any_of(options.set.begin(), options.set.end(), [&](const std::string& word) {
        return word.rfind(kFrom, 0) == 0 && fs::equivalent(word.substr(kFrom.size()), file, ignored);
    });
}

void require(bool written, const fs::path& file) {
    if (!written) throw std::runtime_error(file.string() + ": cannot write");
}

}  // namespace

Outputs::Outputs(const Options& options, const DetectorParams& params)
    : scenes_(options.scenes),
      grids_(options.grids),
      pictures_(options.pictures),
      view_(options.view),
      folder_(options.output),
      low_(params.low.enabled) {
    scene_options_.explain = options.explain;
    scene_options_.own_body = OwnBody(params.region.own_body);
    scene_options_.region = params.region;
    std::error_code error;
    fs::create_directories(folder_, error);
    if (error || !fs::is_directory(folder_)) {
        throw std::runtime_error(folder_.string() + ": cannot make the output folder" +
                                 (error ? ": " + error.message() : ": there is a file of that name"));
    }
    if (!options.report.empty()) {
        requireOther("--report " + options.report, options.report, options.input);
        page_ = std::make_unique<ReplayPage>(options.report);
        input_ = options.input;
    }
    if (pictures_.every > 0) renderer_.emplace(options.show.picture_width, options.show.picture_height);
    removeNumbered(folder_, {{"scene_", ".3Dscene"}, {"grid_", ".png"}, {"grid_", ".yaml"}, {"picture_", ".png"}});
    ExportFormats formats = options.formats;
    formats.replace = fs::exists(folder_ / "summary.json", error);
    for (const char* name : {"summary.json", "summary.json.part", kMergesFile}) fs::remove(folder_ / name, error);
    if (!readsOwnBody(options, folder_ / kOwnBodyFile)) fs::remove(folder_ / kOwnBodyFile, error);
    formats.zones = !options.zones.empty();
    formats.low = formats.csv && params.low.enabled;
    formats.poses = matchesScans(params.ego) && usesPoses(params, options.choice.joins());
    exports_.emplace(folder_, formats,
                     std::map<std::string, std::string>{{"program", "obstacle-replay " LIDAR_OBSTACLES_VERSION},
                                                        {"input", options.input},
                                                        {"parameters", dumpParams(params)}});
    if (options.explain) merges_.emplace(folder_ / kMergesFile).append(mergesHeader());
}

std::unique_ptr<ScanSource> Outputs::annotate(std::unique_ptr<ScanSource> source, const Options& options,
                                              const DetectorParams& params) {
    if (options.annotate.empty()) return source;
    requireOther("--annotate " + options.annotate, options.annotate, options.input);
    annotated_.emplace(options.annotate,
                       "# obstacle-replay " LIDAR_OBSTACLES_VERSION " on " + options.input + "\n" + dumpParams(params));
    return std::make_unique<CopyingSource>(std::move(source), *annotated_);
}

void Outputs::startRecording(const Options& options, const DetectorParams& params) {
    ViewOptions show = options.show;
    if (!options.zones.empty()) show.layers.set(static_cast<std::size_t>(Layer::Zones));  // as in the window
    recorder_ = std::make_unique<Recorder>(Recording{options.input, show, options.view, params});
}

void Outputs::add(std::size_t processed, std::size_t scan_index, const Watched& scan,
                  const ObstacleDetector& detector) {
    const SequenceResult& found = scan.found;
    const PointCloud& cloud = found.cloud;
    const DetectionResult& result = found.detection;
    ++scans_;
    const Trajectory& trajectory = detector.trajectory();
    const std::optional<Eigen::Isometry3d> pose =
        trajectory.rotationOnly() ? std::nullopt : trajectory.at(cloud.timestamp).T_world_vehicle;
    const ScanOutput output{scan_index, found, pose};
    exports_->add(output, {&scan.health, scan.zones, low_ ? &result.low : nullptr});
    if (page_) page_->add(output);
    if (merges_) merges_->append(mergesRows(cloud.timestamp, scan_index, cloud, result));
    if (found.match) {
        frames_ += found.match->restarted;
        if (pose) exports_->addPose(cloud.timestamp, scan_index, *pose, frames_);
    }
    if (annotated_) annotated_->annotate(cloud, result, scene_options_);
    if (recorder_) recorder_->add(scan_index, found, detector, scan.zones);
    if (grids_.has(processed)) writeGrid(scan_index, result.grid);
    if (scenes_.has(processed) || pictures_.has(processed)) draw(processed, scan_index, scan, detector);
}

void Outputs::draw(std::size_t processed, std::size_t scan_index, const Watched& scan,
                   const ObstacleDetector& detector) {
    const SequenceResult& found = scan.found;
    const auto scene = toScene(found.cloud, found.detection, scene_options_);
    if (found.filtered) addFilter(*scene, found, detector);
    if (scan.zones != nullptr) addZones(*scene, found, detector.trajectory(), *scan.zones);
    if (scenes_.has(processed)) {
        const fs::path file = fileOf("scene", scan_index, ".3Dscene");
        require(scene->saveToFile(file.string()), file);
    }
    if (pictures_.has(processed)) {
        CameraView view = view_;
        view.target.z() = found.detection.ground.heightAt(view.target.x(), view.target.y());
        const fs::path file = fileOf("picture", scan_index, ".png");
        require(renderer_->render(*scene, view).saveToFile(file.string()), file);
    }
}

std::string Outputs::writeOwnBody(const OwnBody& body, const std::string& comment) {
    std::string text = "# " + comment + "\n";
    for (const OwnPart& part : body.parts()) text += toText(OwnBody(std::vector<OwnPart>{part})) + "\n";
    const fs::path file = folder_ / kOwnBodyFile;
    writeTextFile(file, text);
    return file.string();
}

void Outputs::discard() {
    exports_->discard();
    if (merges_) merges_->discard();
}

void Outputs::finish(const std::string& summary, const std::string& note) {
    exports_->close();
    if (merges_) merges_->close();
    if (annotated_) annotated_->close();
    if (recorder_) recorder_->finish();
    if (page_) page_->finish({"obstacle-replay " LIDAR_OBSTACLES_VERSION, input_, note});
    writeTextFile(folder_ / "summary.json", summary);
}

fs::path Outputs::fileOf(const char* kind, std::size_t scan_index, const char* extension) const {
    char number[32];
    std::snprintf(number, sizeof number, "_%06zu", scan_index);
    return folder_ / (std::string(kind) + number + extension);
}

void Outputs::writeGrid(std::size_t scan_index, const OccupancyGrid& grid) const {
    if (grid.empty()) return;
    const fs::path picture = fileOf("grid", scan_index, ".png");
    require(toOccupancyGridMap(grid).saveAsBitmapFile(picture.string()), picture);
    const OccupancyThresholds thresholds;
    writeTextFile(fileOf("grid", scan_index, ".yaml"),
                  "image: " + picture.filename().string() + "\nresolution: " + shortestText(grid.resolution) +
                      "\norigin: [" + shortestText(grid.origin.x()) + ", " + shortestText(grid.origin.y()) +
                      ", 0]\nnegate: 0\noccupied_thresh: " + shortestText(thresholds.occupied) +
                      "\nfree_thresh: " + shortestText(thresholds.free) + "\n");
}

}  // namespace lidar_obstacles::apps

// SPDX-License-Identifier: BSD-3-Clause
// nuScenes: tables of tokens (Caesar et al. 2020, and the schema page of the development kit).
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <unordered_map>

#include "point_files.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kPlanes = 32;
constexpr const char* kChannel = "LIDAR_TOP";
constexpr const char* kCamera = "CAM_FRONT";
constexpr double kImageGap = 0.1;  ///< between a sweep and the image beside it, at most [s]

/// A table: its rows by their tokens.
class Table {
  public:
    Table(const fs::path& folder, const std::string& name) : file_(folder / (name + ".json")) {
        std::ifstream in(file_);
        if (!in) throw std::runtime_error(file_.string() + ": cannot read");
        try {
            rows_ = json::parse(in);
            for (const json& row : rows_) by_token_[row.at("token").get<std::string>()] = &row;
        } catch (const json::exception& e) {
            throw std::runtime_error(file_.string() + ": " + e.what());
        }
    }
    Table(const Table&) = delete;
    Table& operator=(const Table&) = delete;

    const json& rows() const { return rows_; }
    /// @throws std::runtime_error naming the file if there is no such row.
    const json& at(const std::string& token) const {
        const auto it = by_token_.find(token);
        if (it == by_token_.end()) throw std::runtime_error(file_.string() + ": no row with token '" + token + "'");
        return *it->second;
    }

  private:
    fs::path file_;
    json rows_;
    std::unordered_map<std::string, const json*> by_token_;
};

/// A row's translation and rotation (quaternion w, x, y, z).
Eigen::Isometry3d poseOf(const json& row) {
    const json& t = row.at("translation");
    const json& q = row.at("rotation");
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() =
        Eigen::Quaterniond(q.at(0).get<double>(), q.at(1).get<double>(), q.at(2).get<double>(), q.at(3).get<double>())
            .normalized()
            .toRotationMatrix();
    T.translation() = Eigen::Vector3d(t.at(0).get<double>(), t.at(1).get<double>(), t.at(2).get<double>());
    return T;
}

/// "vehicle.bus.rigid" -> "bus", "human.pedestrian.adult" -> "pedestrian"; what moves differently or not: "misc".
std::string typeOf(const std::string& category) {
    const auto begins = [&](const char* text) { return category.rfind(text, 0) == 0; };
    for (const char* type : {"car", "truck", "bus", "trailer", "motorcycle", "bicycle"}) {
        if (begins((std::string("vehicle.") + type).c_str())) return type;
    }
    if (begins("vehicle.")) return "misc_vehicle";  // construction, emergency
    for (const char* not_on_foot :
         {"human.pedestrian.personal_mobility", "human.pedestrian.stroller", "human.pedestrian.wheelchair"}) {
        if (begins(not_on_foot)) return "misc";
    }
    return begins("human.") ? "pedestrian" : "misc";
}

/// Visibility 4 (80 .. 100 %) .. 1 (0 .. 40 %) as KITTI's level.
int occlusionOf(const std::string& visibility) { return visibility == "4" ? 0 : visibility == "1" ? 2 : 1; }

/// A sweep of the lidar.
struct Sweep {
    double timestamp = 0.0;
    fs::path file;
    Eigen::Isometry3d T_vehicle_sensor;
    Eigen::Isometry3d T_world_vehicle;
    std::string labelled_sample;  ///< "" for sweeps between keyframes
};

struct Scene {
    std::vector<Sweep> sweeps;
    std::unordered_map<std::string, std::vector<LabelledObject>> objects;  ///< of each sample, world frame
    std::vector<FrameImage> images;                                        ///< rising in time; where they are asked for
};

fs::path tablesIn(const fs::path& folder) {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.is_directory() && entry.path().filename().string().rfind("v1.0-", 0) == 0)
            found.push_back(entry.path());
    }
    if (found.empty()) throw std::runtime_error(folder.string() + ": no folder v1.0-*");
    return *std::min_element(found.begin(), found.end());
}

/// Token of the scene of this name; the only one if no name is given.
std::string sceneToken(const Table& scenes, const std::string& name, const fs::path& folder) {
    std::string names;
    for (const json& row : scenes.rows()) {
        if (row.at("name") == name || (name.empty() && scenes.rows().size() == 1)) return row.at("token");
        names += (names.empty() ? "" : ", ") + row.at("name").get<std::string>();
    }
    throw std::runtime_error(folder.string() + ": which scene? --sequence NAME, one of: " + names);
}

FrameImage imageOf(const fs::path& folder, const json& row, const json& calibration) {
    const json& K = calibration.at("camera_intrinsic");
    FrameImage image{folder / row.at("filename").get<std::string>(), kCamera, row.at("timestamp").get<double>() * 1e-6};
    image.fx = K.at(0).at(0);
    image.fy = K.at(1).at(1);
    image.cx = K.at(0).at(2);
    image.cy = K.at(1).at(2);
    image.T_vehicle_camera = poseOf(calibration);
    return image;
}

/// The image that is nearest in time to a sweep, if its file is there.
std::optional<FrameImage> imageBeside(const Scene& scene, double time) {
    const auto after = std::lower_bound(scene.images.begin(), scene.images.end(), time,
                                        [](const FrameImage& image, double t) { return image.timestamp < t; });
    const FrameImage* nearest = nullptr;
    for (auto it = after == scene.images.begin() ? after : after - 1; it != scene.images.end() && it <= after; ++it)
        if (!nearest || std::abs(it->timestamp - time) < std::abs(nearest->timestamp - time)) nearest = &*it;
    std::error_code ec;
    if (!nearest || std::abs(nearest->timestamp - time) > kImageGap || !fs::is_regular_file(nearest->file, ec))
        return std::nullopt;
    return *nearest;
}

void readSweeps(const fs::path& folder, const fs::path& tables, const std::string& scene_token, Scene& scene) {
    const Table samples(tables, "sample");
    const Table sensors(tables, "sensor");
    const Table calibrations(tables, "calibrated_sensor");
    const Table poses(tables, "ego_pose");
    const Table data(tables, "sample_data");
    for (const json& row : data.rows()) {
        if (samples.at(row.at("sample_token")).at("scene_token") != scene_token) continue;
        const json& calibration = calibrations.at(row.at("calibrated_sensor_token"));
        const json& channel = sensors.at(calibration.at("sensor_token")).at("channel");
        if (channel == kCamera) scene.images.push_back(imageOf(folder, row, calibration));
        if (channel != kChannel) continue;
        Sweep sweep;
        sweep.timestamp = row.at("timestamp").get<double>() * 1e-6;
        sweep.file = folder / row.at("filename").get<std::string>();
        sweep.T_vehicle_sensor = poseOf(calibration);
        sweep.T_world_vehicle = poseOf(poses.at(row.at("ego_pose_token")));
        if (row.at("is_key_frame").get<bool>()) sweep.labelled_sample = row.at("sample_token");
        scene.sweeps.push_back(std::move(sweep));
    }
    std::sort(scene.sweeps.begin(), scene.sweeps.end(),
              [](const Sweep& a, const Sweep& b) { return a.timestamp < b.timestamp; });
    std::sort(scene.images.begin(), scene.images.end(),
              [](const FrameImage& a, const FrameImage& b) { return a.timestamp < b.timestamp; });
    if (scene.sweeps.empty()) throw std::runtime_error(tables.string() + ": the scene has no " + kChannel + " sweeps");
}

/// Labels of the scene's keyframes. Their boxes stay in the world frame.
void readAnnotations(const fs::path& tables, Scene& scene) {
    const Table instances(tables, "instance");
    const Table categories(tables, "category");
    const Table annotations(tables, "sample_annotation");
    for (const Sweep& sweep : scene.sweeps) {
        if (!sweep.labelled_sample.empty()) scene.objects[sweep.labelled_sample];
    }
    for (const json& row : annotations.rows()) {
        const auto it = scene.objects.find(row.at("sample_token"));
        if (it == scene.objects.end()) continue;
        const json& instance = instances.at(row.at("instance_token"));
        LabelledObject object;
        object.id = row.at("instance_token");
        object.type = typeOf(categories.at(instance.at("category_token")).at("name"));
        const Eigen::Isometry3d T_world_box = poseOf(row);
        const json& size = row.at("size");  // width, length, height
        object.box.center = T_world_box.translation();
        object.box.size = {size.at(1).get<double>(), size.at(0).get<double>(), size.at(2).get<double>()};
        const Eigen::Vector3d along = T_world_box.linear().col(0);
        object.box.yaw = std::atan2(along.y(), along.x());
        object.occluded = occlusionOf(row.value("visibility_token", "4"));
        it->second.push_back(std::move(object));
    }
}

LabelledObject inVehicleFrame(LabelledObject object, const Eigen::Isometry3d& T_world_vehicle) {
    const Eigen::Vector3d along =
        T_world_vehicle.linear().transpose() * Eigen::Vector3d(std::cos(object.box.yaw), std::sin(object.box.yaw), 0.0);
    object.box.center = T_world_vehicle.inverse() * object.box.center;
    object.box.yaw = normalizeAngle(std::atan2(along.y(), along.x()));
    return object;
}

}  // namespace

Sequence openNuScenes(const SequenceOptions& options) {
    const fs::path folder = options.folder;
    const fs::path tables = tablesIn(folder);
    const auto scene = std::make_shared<Scene>();
    try {
        const Table scenes(tables, "scene");
        readSweeps(folder, tables, sceneToken(scenes, options.sequence, folder), *scene);
        readAnnotations(tables, *scene);
    } catch (const json::exception& e) {  // a column that is missing or of another kind
        throw std::runtime_error(tables.string() + ": " + e.what());
    }
    const auto load = [=](std::size_t k) {
        const Sweep& sweep = scene->sweeps.at(k);
        Frame frame;
        frame.timestamp = sweep.timestamp;
        frame.T_vehicle_sensor = sweep.T_vehicle_sensor;
        frame.T_world_vehicle = sweep.T_world_vehicle;
        readNuScenesPoints(sweep.file, kPlanes, frame);
        if (options.images) frame.image = imageBeside(*scene, sweep.timestamp);
        const auto it = scene->objects.find(sweep.labelled_sample);
        if (it == scene->objects.end()) return frame;
        for (const LabelledObject& o : it->second) frame.objects.push_back(inVehicleFrame(o, sweep.T_world_vehicle));
        return frame;
    };
    return {scene->sweeps.size(), kPlanes, load};
}

}  // namespace lidar_obstacles::apps

// SPDX-License-Identifier: BSD-3-Clause
// KITTI object and tracking: which file is where.
#include <memory>

#include "kitti_files.h"
#include "oxts_poses.h"
#include "point_files.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

/// Everything of a tracking sequence but its points.
struct Tracking {
    std::vector<fs::path> scans;
    std::map<std::size_t, std::vector<LabelledObject>> objects;
    std::vector<std::optional<Eigen::Isometry3d>> poses;  ///< by the scan's number
};

std::map<std::size_t, std::vector<LabelledObject>> readTrackingLabels(const fs::path& file,
                                                                      const Eigen::Isometry3d& T_vehicle_camera) {
    std::map<std::size_t, std::vector<LabelledObject>> objects;
    for (const Words& words : wordsOf(file)) {
        auto object = objectOfLabel(words, 2, T_vehicle_camera);
        if (!object) continue;
        object->id = words.text(1);
        if (words.integer(0) < 0) words.fail("a frame's number is not negative");
        objects[static_cast<std::size_t>(words.integer(0))].push_back(std::move(*object));
    }
    return objects;
}

/// Row n of the file is scan n; none where the row is empty.
std::vector<std::optional<Eigen::Isometry3d>> readTrackingPoses(const fs::path& file,
                                                                const Eigen::Isometry3d& T_imu_vehicle) {
    std::vector<std::optional<Eigen::Isometry3d>> all;
    std::optional<OxtsPoses> poses;
    for (const Words& row : rowsOf(file)) {
        all.emplace_back();
        if (row.size() == 0) continue;
        if (!poses) poses.emplace(row, T_imu_vehicle);
        all.back() = poses->vehicle(row);
    }
    if (!poses) throw std::runtime_error(file.string() + ": empty");
    return all;
}

}  // namespace

Sequence openKittiObject(const SequenceOptions& options) {
    const fs::path folder = options.folder;
    const auto scans = std::make_shared<std::vector<fs::path>>(scansIn(folder / "velodyne"));
    if (options.images) requireImages(folder / "image_2");
    const auto load = [=](std::size_t k) {
        const fs::path& scan = scans->at(k);
        Frame frame;
        frame.timestamp = options.start_time + kKittiPeriod * static_cast<double>(k);
        frame.T_vehicle_sensor = vehicleVelo(options);
        readKittiPoints(scan, kKittiPlanes, frame);
        const std::string name = scan.stem().string() + ".txt";
        if (options.images) {
            const Eigen::Isometry3d T_velo_rect0 = readCameraCalibration(folder / "calib" / name).T_velo_camera;
            frame.image = readColourCamera(folder / "calib" / name, frame.T_vehicle_sensor * T_velo_rect0)
                              .image(folder / "image_2" / scan.stem().concat(".png"), frame.timestamp);
        }
        if (!fs::exists(folder / "label_2" / name)) return frame;
        const Eigen::Isometry3d T_vehicle_camera =
            frame.T_vehicle_sensor * readCameraCalibration(folder / "calib" / name).T_velo_camera;
        int line = 0;
        for (const Words& words : wordsOf(folder / "label_2" / name)) {
            auto object = objectOfLabel(words, 0, T_vehicle_camera);
            const std::string id = scan.stem().string() + '_' + std::to_string(line++);
            if (!object) continue;
            object->id = id;
            frame.objects.push_back(std::move(*object));
        }
        return frame;
    };
    return {scans->size(), kKittiPlanes, load};
}

Sequence openKittiTracking(const SequenceOptions& options) {
    if (options.sequence.empty()) throw std::runtime_error(options.folder + ": which sequence? (--sequence 0000)");
    const fs::path folder = options.folder;
    const std::string file = options.sequence + ".txt";
    const KittiCalibration calibration = readCameraCalibration(folder / "calib" / file);
    const auto all = std::make_shared<Tracking>();
    all->scans = scansIn(folder / "velodyne" / options.sequence);
    if (fs::exists(folder / "label_02" / file))
        all->objects = readTrackingLabels(folder / "label_02" / file, vehicleVelo(options) * calibration.T_velo_camera);
    if (fs::exists(folder / "oxts" / file)) {
        all->poses =
            readTrackingPoses(folder / "oxts" / file, (vehicleVelo(options) * calibration.T_velo_imu).inverse());
    }
    std::optional<KittiCamera> camera;
    const fs::path images = folder / "image_02" / options.sequence;
    if (options.images) {
        requireImages(images);
        camera = readColourCamera(folder / "calib" / file, vehicleVelo(options) * calibration.T_velo_camera);
    }
    const auto load = [=](std::size_t k) {
        const std::size_t number = numberOf(all->scans.at(k));  // some sequences lack scans
        Frame frame;
        frame.timestamp = options.start_time + kKittiPeriod * static_cast<double>(number);
        frame.T_vehicle_sensor = vehicleVelo(options);
        readKittiPoints(all->scans[k], kKittiPlanes, frame);
        if (number < all->poses.size()) frame.T_world_vehicle = all->poses[number];
        if (camera) frame.image = camera->image(images / all->scans[k].stem().concat(".png"), frame.timestamp);
        const auto it = all->objects.find(number);
        if (it != all->objects.end()) frame.objects = it->second;
        return frame;
    };
    return {all->scans.size(), kKittiPlanes, load, missingOf(all->scans)};
}

}  // namespace lidar_obstacles::apps

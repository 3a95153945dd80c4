// The three layouts of KITTI: which file is where.
#include <memory>

#include "kitti_files.h"
#include "point_files.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kPlanes = 64;
constexpr double kPeriod = 0.1;  // [s]

Eigen::Isometry3d vehicleVelo(const SequenceOptions& options) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation().z() = options.sensor_height;
    return T;
}

std::vector<fs::path> scansIn(const fs::path& folder) {
    std::vector<fs::path> scans = filesIn(folder, ".bin");
    if (scans.empty()) throw std::runtime_error(folder.string() + ": no .bin files in it");
    return scans;
}

/// Number in a file's name: 000042.bin is 42. @throws std::runtime_error for another name.
std::size_t numberOf(const fs::path& file) {
    const std::string stem = file.stem().string();
    if (stem.empty() || stem.size() > 15 || stem.find_first_not_of("0123456789") != std::string::npos)
        throw std::runtime_error(file.string() + ": a scan's name is its number");
    return static_cast<std::size_t>(std::stoull(stem));
}

/// Poses of the vehicle from rows of oxts; the world's origin is where the first one is.
class OxtsPoses {
  public:
    OxtsPoses(const Words& first, const Eigen::Isometry3d& T_imu_vehicle)
        : latitude_deg_(first.number(0)),
          T_imu_vehicle_(T_imu_vehicle),
          origin_((poseOfOxts(first, latitude_deg_) * T_imu_vehicle).translation()) {}

    Eigen::Isometry3d vehicle(const Words& row) const {
        Eigen::Isometry3d T = poseOfOxts(row, latitude_deg_) * T_imu_vehicle_;
        T.translation() -= origin_;
        return T;
    }

  private:
    double latitude_deg_;
    Eigen::Isometry3d T_imu_vehicle_;
    Eigen::Vector3d origin_;
};

/// Everything of a tracking sequence but its points.
struct Tracking {
    std::vector<fs::path> scans;
    std::map<std::size_t, std::vector<LabelledObject>> objects;
    std::vector<Eigen::Isometry3d> poses;
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

/// Everything of a raw drive but its points.
struct Drive {
    std::vector<fs::path> scans;
    std::vector<double> times;  ///< by the scan's number
    std::map<std::size_t, std::vector<LabelledObject>> objects;
    std::optional<OxtsPoses> poses;
    fs::path oxts;
};

Words oxtsRow(const fs::path& file) {
    const std::vector<Words> rows = wordsOf(file);
    if (rows.empty()) throw std::runtime_error(file.string() + ": empty");
    return rows.front();
}

std::vector<double> readTimes(const fs::path& file) {
    std::vector<double> times;
    std::size_t line = 0;
    for (const std::string& text : linesOf(file)) {
        ++line;
        try {
            if (!text.empty()) times.push_back(secondsOf(text));
        } catch (const std::runtime_error& e) {
            throw std::runtime_error(file.string() + ':' + std::to_string(line) + ": " + e.what());
        }
    }
    return times;
}

fs::path oxtsFile(const Drive& drive, const fs::path& scan) { return drive.oxts / (scan.stem().string() + ".txt"); }

Drive readDrive(const SequenceOptions& options) {
    const fs::path folder = options.folder;
    Drive drive;
    drive.scans = scansIn(folder / "velodyne_points" / "data");
    drive.times = readTimes(folder / "velodyne_points" / "timestamps.txt");
    const fs::path tracklets = folder / "tracklet_labels.xml";
    if (fs::exists(tracklets)) drive.objects = readTracklets(tracklets, vehicleVelo(options));
    drive.oxts = folder / "oxts" / "data";
    if (!fs::exists(drive.oxts)) return drive;
    const fs::path day = fs::absolute(folder / ".").parent_path().parent_path();
    const Eigen::Isometry3d T_imu_velo = readImuToVelo(day / "calib_imu_to_velo.txt").inverse();
    drive.poses.emplace(oxtsRow(oxtsFile(drive, drive.scans.front())), T_imu_velo * vehicleVelo(options).inverse());
    return drive;
}

}  // namespace

Sequence openKittiObject(const SequenceOptions& options) {
    const fs::path folder = options.folder;
    const auto scans = std::make_shared<std::vector<fs::path>>(scansIn(folder / "velodyne"));
    const auto load = [=](std::size_t k) {
        const fs::path& scan = scans->at(k);
        Frame frame;
        frame.timestamp = options.start_time + kPeriod * static_cast<double>(k);
        frame.T_vehicle_sensor = vehicleVelo(options);
        readKittiPoints(scan, kPlanes, frame);
        const std::string name = scan.stem().string() + ".txt";
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
    return {scans->size(), kPlanes, load};
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
        const std::vector<Words> rows = wordsOf(folder / "oxts" / file);
        if (rows.empty()) throw std::runtime_error((folder / "oxts" / file).string() + ": empty");
        const OxtsPoses poses(rows.front(), (vehicleVelo(options) * calibration.T_velo_imu).inverse());
        for (const Words& row : rows) all->poses.push_back(poses.vehicle(row));
    }
    const auto load = [=](std::size_t k) {
        const std::size_t number = numberOf(all->scans.at(k));  // some sequences lack scans
        Frame frame;
        frame.timestamp = options.start_time + kPeriod * static_cast<double>(number);
        frame.T_vehicle_sensor = vehicleVelo(options);
        readKittiPoints(all->scans[k], kPlanes, frame);
        if (number < all->poses.size()) frame.T_world_vehicle = all->poses[number];
        const auto it = all->objects.find(number);
        if (it != all->objects.end()) frame.objects = it->second;
        return frame;
    };
    return {all->scans.size(), kPlanes, load};
}

Sequence openKittiRaw(const SequenceOptions& options) {
    const auto drive = std::make_shared<Drive>(readDrive(options));
    const auto load = [=](std::size_t k) {
        const fs::path& scan = drive->scans.at(k);
        const std::size_t number = numberOf(scan);
        Frame frame;
        if (number >= drive->times.size())
            throw std::runtime_error(scan.string() + ": timestamps.txt has " + std::to_string(drive->times.size()) +
                                     " lines only");
        frame.timestamp = drive->times[number];
        frame.T_vehicle_sensor = vehicleVelo(options);
        readKittiPoints(scan, kPlanes, frame);
        if (drive->poses) frame.T_world_vehicle = drive->poses->vehicle(oxtsRow(oxtsFile(*drive, scan)));
        const auto it = drive->objects.find(number);
        if (it != drive->objects.end()) frame.objects = it->second;
        return frame;
    };
    return {drive->scans.size(), kPlanes, load};
}

}  // namespace lidar_obstacles::apps

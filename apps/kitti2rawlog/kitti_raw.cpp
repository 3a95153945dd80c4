// SPDX-License-Identifier: BSD-3-Clause
// KITTI raw: which file is where, and which row belongs to which scan.
#include <algorithm>
#include <cmath>
#include <memory>

#include "kitti_files.h"
#include "oxts_poses.h"
#include "point_files.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

/// Times by the number of the line, which is that of the scan: a line without one stands for a scan that is missing.
using Times = std::vector<std::optional<double>>;

/// Everything of a raw drive but its points.
struct Drive {
    std::vector<fs::path> scans;
    fs::path times_file;
    Times times;
    std::map<std::size_t, std::vector<LabelledObject>> objects;
    std::optional<OxtsPoses> poses;
    fs::path oxts;                      ///< folder of the poses
    Times oxts_times;                   ///< empty if the drive does not tell them
    std::optional<KittiCamera> camera;  ///< where images are asked for
    fs::path images;                    ///< folder of them
    Times image_times;                  ///< empty if the drive does not tell them
};

Times readTimes(const fs::path& file) {
    Times times;
    for (const std::string& text : linesOf(file)) {
        times.emplace_back();
        const std::size_t begin = text.find_first_not_of(" \t");
        if (begin == std::string::npos) continue;
        try {
            times.back() = secondsOf(text.substr(begin));
        } catch (const std::runtime_error& e) {
            throw std::runtime_error(file.string() + ':' + std::to_string(times.size()) + ": " + e.what());
        }
    }
    return times;
}

/// The times by the numbers of the scans also where lines of scans that are missing were taken out: as many lines as
/// there are scans, and scans of higher numbers than that, are lines in the order of the scans.
Times byNumber(Times times, const std::vector<fs::path>& scans) {
    const bool is_short = !scans.empty() && times.size() == scans.size() && numberOf(scans.back()) >= times.size();
    if (!is_short || !std::all_of(times.begin(), times.end(), [](const auto& time) { return time.has_value(); }))
        return times;
    Times spread(numberOf(scans.back()) + 1);
    for (std::size_t k = 0; k < scans.size(); ++k) spread[numberOf(scans[k])] = times[k];
    return spread;
}

double timeOf(const Drive& drive, const fs::path& scan) {
    const std::size_t number = numberOf(scan);
    if (number >= drive.times.size())
        throw std::runtime_error(scan.string() + ": no time for it: " + drive.times_file.string() + " has " +
                                 std::to_string(drive.times.size()) + " lines only");
    if (!drive.times[number])
        throw std::runtime_error(drive.times_file.string() + ':' + std::to_string(number + 1) + ": no time for " +
                                 scan.string());
    return *drive.times[number];
}

/// Number of the row of oxts that belongs to a scan: the scan's own, unless that was measured at another time (drives
/// that are not synchronised count scans and poses apart). Nothing if none is near.
std::optional<std::size_t> oxtsNumber(const Drive& drive, std::size_t number, double time) {
    const Times& times = drive.oxts_times;
    const auto apart = [&](std::size_t k) { return times[k] ? std::abs(*times[k] - time) : 1e300; };
    if (times.empty() || (number < times.size() && apart(number) <= kKittiPeriod)) return number;
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < times.size(); ++k) nearest = apart(k) < apart(nearest) ? k : nearest;
    return apart(nearest) <= kKittiPeriod ? std::optional(nearest) : std::nullopt;
}

/// The row of oxts that belongs to a scan; nothing where the drive lacks it.
std::optional<Words> oxtsRow(const Drive& drive, const fs::path& scan) {
    const auto number = oxtsNumber(drive, numberOf(scan), timeOf(drive, scan));
    if (!number) return std::nullopt;
    const std::string digits = std::to_string(*number);
    const std::size_t width = scan.stem().string().size();
    const fs::path file =
        drive.oxts / (std::string(width > digits.size() ? width - digits.size() : 0, '0') + digits + ".txt");
    if (!fs::exists(file)) return std::nullopt;
    const std::vector<Words> rows = wordsOf(file);
    return rows.empty() ? std::nullopt : std::optional(rows.front());
}

void readPoses(const SequenceOptions& options, Drive& drive) {
    const fs::path folder = options.folder;
    drive.oxts = folder / "oxts" / "data";
    if (!fs::exists(drive.oxts)) return;
    const fs::path times = folder / "oxts" / "timestamps.txt";
    if (fs::exists(times)) drive.oxts_times = readTimes(times);
    const fs::path day = fs::absolute(folder / ".").parent_path().parent_path();
    const Eigen::Isometry3d T_imu_velo = readImuToVelo(day / "calib_imu_to_velo.txt").inverse();
    for (const fs::path& scan : drive.scans) {
        const auto first = oxtsRow(drive, scan);
        if (!first) continue;
        drive.poses.emplace(*first, T_imu_velo * vehicleVelo(options).inverse());
        return;
    }
    throw std::runtime_error(drive.oxts.string() + ": no pose of any scan in it");
}

void findImages(const SequenceOptions& options, Drive& drive) {
    const fs::path folder = options.folder;
    drive.images = folder / "image_02" / "data";
    requireImages(drive.images);
    const fs::path day = fs::absolute(folder / ".").parent_path().parent_path();
    drive.camera = readColourCamera(day / "calib_cam_to_cam.txt", vehicleVelo(options) * readRawCamera(day));
    const fs::path times = folder / "image_02" / "timestamps.txt";
    if (fs::exists(times)) drive.image_times = readTimes(times);
}

/// Images are called as the scans are. Without a time of its own it has that of the scan.
std::optional<FrameImage> imageOf(const Drive& drive, const fs::path& scan) {
    if (!drive.camera) return std::nullopt;
    const std::size_t number = numberOf(scan);
    const bool has_time = number < drive.image_times.size() && drive.image_times[number];
    return drive.camera->image(drive.images / scan.stem().concat(".png"),
                               has_time ? *drive.image_times[number] : timeOf(drive, scan));
}

Drive readDrive(const SequenceOptions& options) {
    const fs::path folder = options.folder;
    Drive drive;
    drive.scans = scansIn(folder / "velodyne_points" / "data");
    drive.times_file = folder / "velodyne_points" / "timestamps.txt";
    drive.times = byNumber(readTimes(drive.times_file), drive.scans);
    const fs::path tracklets = folder / "tracklet_labels.xml";
    if (fs::exists(tracklets)) drive.objects = readTracklets(tracklets, vehicleVelo(options));
    readPoses(options, drive);
    if (options.images) findImages(options, drive);
    return drive;
}

}  // namespace

Sequence openKittiRaw(const SequenceOptions& options) {
    const auto drive = std::make_shared<Drive>(readDrive(options));
    const auto load = [=](std::size_t k) {
        const fs::path& scan = drive->scans.at(k);
        Frame frame;
        frame.timestamp = timeOf(*drive, scan);
        frame.T_vehicle_sensor = vehicleVelo(options);
        readKittiPoints(scan, kKittiPlanes, frame);
        const auto row = drive->poses ? oxtsRow(*drive, scan) : std::nullopt;
        if (row) frame.T_world_vehicle = drive->poses->vehicle(*row);
        const auto it = drive->objects.find(numberOf(scan));
        if (it != drive->objects.end()) frame.objects = it->second;
        frame.image = imageOf(*drive, scan);
        return frame;
    };
    return {drive->scans.size(), kKittiPlanes, load, missingOf(drive->scans)};
}

}  // namespace lidar_obstacles::apps

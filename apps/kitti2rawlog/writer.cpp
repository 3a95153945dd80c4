// SPDX-License-Identifier: BSD-3-Clause
#include "writer.h"

#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CObservationVelodyneScan.h>
#include <mrpt/poses/CPose3D.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "common/number_text.h"
#include "common/text_file.h"
#include "lidar_obstacles/evaluation/box_overlap.h"
#include "lidar_obstacles/mrpt_bridge/rawlog_writer.h"
#include "mrpt_bridge/input/point_fields.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

mrpt::poses::CPose3D poseOf(const Eigen::Isometry3d& T) {
    return mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(Eigen::Matrix4d(T.matrix())));
}

/// Which returns lie on the object.
std::size_t returnsOn(const OrientedBox& box, const Frame& frame) {
    constexpr double kMargin = 0.1;  // [m]
    const Eigen::Isometry3d T_box_vehicle =
        (Eigen::Translation3d(box.center) * Eigen::AngleAxisd(box.yaw, Eigen::Vector3d::UnitZ())).inverse();
    const Eigen::Isometry3d T_box_sensor = T_box_vehicle * frame.T_vehicle_sensor;
    const Eigen::Vector3d half = 0.5 * box.size;
    std::size_t count = 0;
    for (const Eigen::Vector3f& p : frame.points) {
        const Eigen::Vector3d q = T_box_sensor * p.cast<double>();
        if (std::abs(q.x()) < half.x() + kMargin && std::abs(q.y()) < half.y() + kMargin &&
            q.z() < half.z() + kMargin && q.z() > -half.z() + kMargin)
            ++count;
    }
    return count;
}

/// The frame with every k-th plane, renumbered (`sensor.planes`).
Frame decimated(const Frame& frame, int step) {
    Frame kept = frame;
    kept.points.clear();
    kept.intensity.clear();
    kept.ring.clear();
    const int first = (step - 1) / 2;
    for (std::size_t k = 0; k < frame.points.size(); ++k) {
        const int above = frame.ring[k] - first;
        if (above < 0 || above % step != 0) continue;
        kept.points.push_back(frame.points[k]);
        kept.intensity.push_back(frame.intensity[k]);
        kept.ring.push_back(static_cast<std::uint16_t>(above / step));
    }
    return kept;
}

std::uint8_t byteOf(float intensity) {
    return static_cast<std::uint8_t>(std::lround(255.F * std::clamp(intensity, 0.F, 1.F)));
}

mrpt::obs::CObservation::Ptr velodyneScan(const Frame& frame) {
    auto scan = mrpt::obs::CObservationVelodyneScan::Create();
    scan->sensorPose = poseOf(frame.T_vehicle_sensor);
    scan->minRange = 0.0;  // what is too near is for the user's parameters to say
    scan->maxRange = 200.0;
    auto& cloud = scan->point_cloud;
    for (std::size_t k = 0; k < frame.points.size(); ++k) {
        cloud.x.push_back(frame.points[k].x());
        cloud.y.push_back(frame.points[k].y());
        cloud.z.push_back(frame.points[k].z());
        cloud.intensity.push_back(byteOf(frame.intensity[k]));
        cloud.laser_id.push_back(static_cast<std::int16_t>(frame.ring[k]));
    }
    return scan;
}

mrpt::obs::CObservation::Ptr pointCloudScan(const Frame& frame) {
    auto scan = mrpt::obs::CObservationPointCloud::Create();
    scan->sensorPose = poseOf(frame.T_vehicle_sensor);
    auto map = makeIntensityMap(frame.points.size());
    for (std::size_t k = 0; k < frame.points.size(); ++k) {
        map->setPointFast(k, frame.points[k].x(), frame.points[k].y(), frame.points[k].z());
        setIntensity(*map, k, frame.intensity[k]);
    }
    scan->pointcloud = map;
    return scan;
}

/// An observation whose image is in a file of its own. @param name  of that file, in MRPT's folder for them.
mrpt::obs::CObservationImage imageObservation(const FrameImage& image, const std::string& name) {
    mrpt::img::CImage pixels;
    if (!pixels.loadFromFile(image.file.string())) throw std::runtime_error(image.file.string() + ": no image in it");
    mrpt::obs::CObservationImage observation;
    observation.cameraParams.ncols = static_cast<std::uint32_t>(pixels.getWidth());
    observation.cameraParams.nrows = static_cast<std::uint32_t>(pixels.getHeight());
    observation.cameraPose = poseOf(image.T_vehicle_camera);
    observation.cameraParams.setIntrinsicParamsFromValues(image.fx, image.fy, image.cx, image.cy);
    observation.image.setExternalStorage(name);
    return observation;
}

constexpr const char* kTruthHeader =
    "timestamp,scan_index,object_id,type,x,y,z,length,width,height,yaw,vx,vy,num_points,range_nearest,visible_faces,"
    "occluded,num_points_all\n";

std::string truthRow(const Frame& frame, std::size_t index, const LabelledObject& o, std::size_t all_returns) {
    std::string row = fixedText(frame.timestamp, 6) + ',' + std::to_string(index) + ',' + o.id + ',' + o.type;
    for (int k = 0; k < 3; ++k) row += ',' + fixedText(o.box.center[k], 4);
    for (int k = 0; k < 3; ++k) row += ',' + fixedText(o.box.size[k], 3);
    return row + ',' + fixedText(o.box.yaw, 5) + ",0,0," + std::to_string(returnsOn(o.box, frame)) + ',' +
           fixedText(evaluation::nearestFaceDistance(o.box), 3) + ",-," + std::to_string(o.occluded) + ',' +
           std::to_string(all_returns) + '\n';
}

std::string egoRow(double timestamp, std::size_t index, const mrpt::poses::CPose3D& pose) {
    return std::to_string(index) + ',' + fixedText(timestamp, 6) + ',' + fixedText(pose.x(), 4) + ',' +
           fixedText(pose.y(), 4) + ',' + fixedText(pose.z(), 4) + ',' + fixedText(pose.roll(), 6) + ',' +
           fixedText(pose.pitch(), 6) + ',' + fixedText(pose.yaw(), 6) + '\n';
}

}  // namespace

struct SequenceWriter::Files {
    WriterOptions options;
    int step = 1;  ///< every step-th plane is kept
    std::size_t scans = 0;
    RawlogWriter rawlog;
    std::string truth, ego;        ///< rows of the scans that are in the rawlog
    fs::path image;                ///< the one that was written last
    std::vector<fs::path> copies;  ///< of images, in the folder beside the rawlog
    bool finished = false;

    Files(WriterOptions o, int step_) : options(std::move(o)), step(step_), rawlog(options.prefix + ".rawlog") {}
    void writeImage(const FrameImage& image);
    void write(mrpt::obs::CObservation& observation, double timestamp, const char* label) {
        observation.timestamp = mrpt::Clock::fromDouble(timestamp);
        observation.sensorLabel = label;
        rawlog.append(observation);
    }
};

/// Copies the file as it is: nothing is compressed once more. The same image of two scans is written once.
void SequenceWriter::Files::writeImage(const FrameImage& frame) {
    if (frame.file == image) return;
    image = frame.file;
    const fs::path folder = options.prefix + "_Images";
    const std::string number = std::to_string(copies.size());
    const std::string name = frame.camera + '_' + std::string(number.size() < 6 ? 6 - number.size() : 0, '0') + number +
                             frame.file.extension().string();
    auto observation = imageObservation(frame, name);
    std::error_code error;
    fs::create_directories(folder, error);
    if (!error) fs::copy_file(frame.file, folder / name, fs::copy_options::overwrite_existing, error);
    if (error)
        throw std::runtime_error(frame.file.string() + ": cannot copy to " + (folder / name).string() + ": " +
                                 error.message());
    copies.push_back(folder / name);
    write(observation, frame.timestamp, frame.camera.c_str());
}

SequenceWriter::SequenceWriter(const WriterOptions& options, int sensor_planes) {
    const int planes = options.planes > 0 ? options.planes : sensor_planes;
    if (sensor_planes % planes != 0) {
        throw std::invalid_argument("--planes " + std::to_string(planes) + " does not divide the sensor's " +
                                    std::to_string(sensor_planes));
    }
    const fs::path folder = fs::path(options.prefix).parent_path();
    std::error_code error;
    if (!folder.empty()) fs::create_directories(folder, error);
    if (error) throw std::runtime_error(folder.string() + ": cannot make the folder: " + error.message());
    files_ = std::make_unique<Files>(options, sensor_planes / planes);
}

SequenceWriter::~SequenceWriter() {
    if (files_->finished) return;
    std::error_code ignored;
    for (const fs::path& copy : files_->copies) fs::remove(copy, ignored);
}

void SequenceWriter::add(const Frame& frame) {
    const Frame kept = files_->step > 1 ? decimated(frame, files_->step) : frame;
    if (frame.image) files_->writeImage(*frame.image);  // first: one that cannot be read leaves nothing of its scan
    mrpt::obs::CObservationRobotPose pose;
    if (frame.T_world_vehicle) {
        pose.pose.mean = poseOf(*frame.T_world_vehicle);
        files_->write(pose, frame.timestamp, "ego_rtk");
    }
    const auto scan = files_->options.scan_class == ScanClass::Velodyne ? velodyneScan(kept) : pointCloudScan(kept);
    files_->write(*scan, frame.timestamp, "velodyne");
    if (frame.T_world_vehicle) files_->ego += egoRow(frame.timestamp, files_->scans, pose.pose.mean);
    for (const LabelledObject& o : frame.objects)
        files_->truth += truthRow(kept, files_->scans, o, returnsOn(o.box, frame));
    ++files_->scans;
}

void SequenceWriter::finish() {
    const std::string& prefix = files_->options.prefix;
    TextFile truth(prefix + "_gt.csv");
    std::optional<TextFile> ego;
    try {  // a full disk shows here, before a file of an earlier run is gone
        truth.append(kTruthHeader + files_->truth);
        if (!files_->ego.empty())
            ego.emplace(prefix + "_ego.csv").append("scan_index,timestamp,x,y,z,roll,pitch,yaw\n" + files_->ego);
        files_->rawlog.close();
    } catch (const std::exception&) {
        truth.discard();
        if (ego) ego->discard();
        throw;
    }
    files_->finished = true;
    truth.close();
    std::error_code ignored;
    fs::remove(prefix + "_ego.csv", ignored);  // of an earlier run
    if (ego) ego->close();
}

}  // namespace lidar_obstacles::apps

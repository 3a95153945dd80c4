// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/ego_motion.h"

#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CActionRobotMovement3D.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <cmath>
#include <stdexcept>

#include "lidar_obstacles/types.h"
#include "mrpt_bridge/input/gps_fix.h"

namespace lidar_obstacles {
namespace {

using namespace mrpt::obs;

double secondsOf(const mrpt::Clock::time_point& stamp) { return mrpt::Clock::toDouble(stamp); }

/// The movement of an action, if it holds one.
std::optional<mrpt::poses::CPose3D> incrementOf(const CActionCollection& action) {
    if (const auto move = action.getActionByClass<CActionRobotMovement3D>()) {
        return move->estimationMethod == CActionRobotMovement3D::emOdometry ? move->rawOdometryIncrementReading
                                                                            : move->poseChange.mean;
    }
    const auto move = action.getActionByClass<CActionRobotMovement2D>();
    if (!move) return std::nullopt;
    const bool odometry = move->estimationMethod == CActionRobotMovement2D::emOdometry;
    return mrpt::poses::CPose3D(odometry ? move->rawOdometryIncrementReading : move->poseChange->getMeanVal());
}

bool tellsRates(const CObservationIMU& imu) {
    return imu.dataIsPresent[IMU_WX] && imu.dataIsPresent[IMU_WY] && imu.dataIsPresent[IMU_WZ];
}

/// What an observation can be made a source of.
EgoKind kindOf(const CObservation& observation) {
    if (dynamic_cast<const CObservationRobotPose*>(&observation)) return EgoKind::Pose;
    if (dynamic_cast<const CObservationOdometry*>(&observation)) return EgoKind::Odometry;
    if (const auto* imu = dynamic_cast<const CObservationIMU*>(&observation))
        return tellsRates(*imu) ? EgoKind::Imu : EgoKind::None;
    if (const auto* gps = dynamic_cast<const CObservationGPS*>(&observation))
        return readGps(*gps).heading ? EgoKind::Gps : EgoKind::None;
    return EgoKind::None;
}

std::string listOf(const std::map<EgoSource, std::size_t>& sources) {
    std::string list;
    for (const auto& [source, count] : sources)
        list += (list.empty() ? "'" : ", '") + source.label + "' (" + toString(source.kind) + ")";
    return list.empty() ? "no source of poses" : list;
}

}  // namespace

StampedPose toStampedPose(double time, const mrpt::poses::CPose3D& pose) {
    StampedPose stamped;
    stamped.time = time;
    stamped.position = {pose.x(), pose.y(), pose.z()};
    stamped.orientation = Eigen::AngleAxisd(pose.yaw(), Eigen::Vector3d::UnitZ()) *
                          Eigen::AngleAxisd(pose.pitch(), Eigen::Vector3d::UnitY()) *
                          Eigen::AngleAxisd(pose.roll(), Eigen::Vector3d::UnitX());
    return stamped;
}

const char* toString(EgoKind kind) {
    switch (kind) {
        case EgoKind::Pose:
            return "pose";
        case EgoKind::Odometry:
            return "odometry";
        case EgoKind::Actions:
            return "actions";
        case EgoKind::Gps:
            return "gps";
        case EgoKind::Imu:
            return "imu";
        case EgoKind::Matching:
            return "matching";
        case EgoKind::None:
            break;
    }
    return "none";
}

std::map<EgoSource, std::size_t> egoSources(const std::string& path, std::size_t max_objects) {
    std::map<EgoSource, std::size_t> sources;
    InputOptions without_clouds;
    without_clouds.with_clouds = false;
    const auto source = openScanSource(path, without_clouds);
    while (const auto item = source->next()) {
        if (item->object >= max_objects) break;
        if (item->action && incrementOf(*item->action)) ++sources[{EgoKind::Actions, "actions"}];
        const EgoKind kind = item->observation ? kindOf(*item->observation) : EgoKind::None;
        if (kind != EgoKind::None) ++sources[{kind, item->observation->sensorLabel}];
    }
    return sources;
}

EgoSource chooseEgoSource(const std::string& path, const std::string& source) {
    if (source == "none") return {};
    if (source == "matching") return {EgoKind::Matching, source};
    const bool any = source == "auto";
    const auto sources = egoSources(path, any ? 400 : 4000);
    EgoSource best;
    std::size_t most = 0;
    for (const auto& [found, count] : sources) {  // better kinds come first
        if (any ? best.kind != EgoKind::None && (found.kind != best.kind || count <= most) : found.label != source)
            continue;
        best = found;
        most = count;
        if (!any) break;
    }
    if (!any && best.kind == EgoKind::None)
        throw std::invalid_argument("[ego] source = " + source + ": " + path + " has " + listOf(sources));
    return best;
}

std::optional<StampedPose> EgoMotion::poseOf(const SourceItem& item) {
    if (!isRead(source_.kind)) return std::nullopt;
    if (source_.kind == EgoKind::Actions) return fromActions(item);
    if (!item.observation || item.observation->sensorLabel != source_.label) return std::nullopt;
    const CObservation& observation = *item.observation;
    const double time = secondsOf(observation.timestamp);
    if (source_.kind == EgoKind::Gps) return fromGps(observation);
    if (source_.kind == EgoKind::Imu) return fromImu(observation);
    if (const auto* pose = dynamic_cast<const CObservationRobotPose*>(&observation))
        return toStampedPose(time, pose->pose.mean);
    if (const auto* odometry = dynamic_cast<const CObservationOdometry*>(&observation))
        return toStampedPose(time, mrpt::poses::CPose3D(odometry->odometry));
    return std::nullopt;
}

std::optional<StampedPose> EgoMotion::fromActions(const SourceItem& item) {
    if (item.action) {
        const auto step = incrementOf(*item.action);
        if (!step) return std::nullopt;
        const StampedPose move = toStampedPose(0.0, *step);
        sum_.position += sum_.orientation * move.position;
        sum_.orientation = (sum_.orientation * move.orientation).normalized();
        const auto stamp = item.action->get(0)->timestamp;
        waits_for_time_ = stamp == INVALID_TIMESTAMP;
        if (waits_for_time_) return std::nullopt;
        sum_.time = secondsOf(stamp);
        return sum_;
    }
    if (!waits_for_time_ || !item.observation || item.observation->timestamp == INVALID_TIMESTAMP) return std::nullopt;
    waits_for_time_ = false;
    sum_.time = secondsOf(item.observation->timestamp);
    return sum_;
}

std::optional<StampedPose> EgoMotion::fromGps(const CObservation& observation) {
    const auto* gps = dynamic_cast<const CObservationGPS*>(&observation);
    if (!gps) return std::nullopt;
    constexpr double kOldest = 0.5;  // a heading serves positions of the next half second
    const GpsFix fix = readGps(*gps);
    const double time = secondsOf(gps->timestamp);
    if (fix.height) altitude_ = *fix.height;
    if (fix.heading) {
        yaw_ = normalizeAngle(M_PI / 2.0 - *fix.heading);
        yaw_time_ = time;
    } else if (fix.stands && std::abs(time - yaw_time_) <= kOldest) {
        yaw_time_ = time;  // what stands does not turn
    }
    if (!fix.latitude_longitude || !(std::abs(time - yaw_time_) <= kOldest)) return std::nullopt;
    const Eigen::Vector3d place(fix.latitude_longitude->x(), fix.latitude_longitude->y(), altitude_);
    if (!geodetic_origin_) geodetic_origin_ = place;
    mrpt::poses::CPose3D T_world_vehicle(0, 0, 0, yaw_, fix.pitch, fix.roll);
    StampedPose pose = toStampedPose(time, T_world_vehicle);
    const mrpt::poses::CPose3D& antenna = gps->sensorPose;
    pose.position = eastNorthUp(place, *geodetic_origin_) -
                    pose.orientation * Eigen::Vector3d(antenna.x(), antenna.y(), antenna.z());
    return pose;
}

std::optional<StampedPose> EgoMotion::fromImu(const CObservation& observation) {
    const auto* imu = dynamic_cast<const CObservationIMU*>(&observation);
    if (!imu || !tellsRates(*imu)) return std::nullopt;
    const double time = secondsOf(imu->timestamp);
    constexpr double kLongest = 1.0;  // of a step that a rate can tell; farther back, the clock was set [s]
    const double since = begun_ ? time - sum_.time : 0.0;
    const double seconds = std::abs(since) > kLongest ? 0.0 : since;
    if (seconds < 0.0) return std::nullopt;  // came late: the sum has gone on without it
    const Eigen::Quaterniond R_vehicle_sensor = toStampedPose(0.0, imu->sensorPose).orientation;
    const Eigen::Vector3d rate =
        R_vehicle_sensor *
        Eigen::Vector3d(imu->rawMeasurements[IMU_WX], imu->rawMeasurements[IMU_WY], imu->rawMeasurements[IMU_WZ]);
    const double angle = rate.norm() * seconds;
    if (angle > 0.0) sum_.orientation = sum_.orientation * Eigen::AngleAxisd(angle, rate.normalized());
    sum_.orientation.normalize();
    sum_.time = time;
    sum_.rotation_only = true;
    begun_ = true;
    return sum_;
}

}  // namespace lidar_obstacles

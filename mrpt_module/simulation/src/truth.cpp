// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/truth.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles::simulation {
namespace {

/// A row of comma-separated values; the same text whatever the locale.
class Row {
  public:
    Row& text(const std::string& word) {
        text_ += (text_.empty() ? "" : ",") + word;
        return *this;
    }
    Row& number(double value, int decimals) {
        char buffer[400];  // the largest double has 309 digits
        const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr;
        return text({buffer, end});
    }
    Row& integer(long value) { return text(std::to_string(value)); }
    Row& time(double t) { return number(kEpoch + t, 6); }
    std::string line() const { return text_ + "\n"; }

  private:
    std::string text_;
};

/// Middle of an object's box and its yaw as the vehicle sees it at time t.
struct RelativePose {
    Eigen::Vector3d center;
    double yaw;
};

RelativePose relativePose(const TurnPoses& poses, const PoseTrack& object, double height, double t) {
    const Eigen::Isometry3d T_vehicle_object = toIsometry(poses.ego.at(t)).inverse() * toIsometry(object.at(t));
    const Eigen::Vector3d ahead = T_vehicle_object.linear().col(0);
    return {T_vehicle_object * Eigen::Vector3d(0.0, 0.0, 0.5 * height), std::atan2(ahead.y(), ahead.x())};
}

/// Velocity in the world over 40 ms, and the rate of the yaw.
struct Velocity {
    Eigen::Vector3d linear;
    double yaw_rate;
};

Velocity velocityOf(const PoseTrack& poses, double t) {
    constexpr double kHalf = 0.02;
    const Pose6 before = poses.at(t - kHalf), after = poses.at(t + kHalf);
    return {(after.position - before.position) / (2.0 * kHalf), (after.yaw - before.yaw) / (2.0 * kHalf)};
}

/// What the returns of an object say.
struct Returns {
    int count = 0;
    int first_firings = 0;  ///< of them those of the first of the two firings of a block
    double time_sum = 0.0;
    std::array<int, 5> faces{};  ///< front, back, left, right, top
};

int faceOf(const Eigen::Vector3f& n) {
    if (std::abs(n.z()) >= std::max(std::abs(n.x()), std::abs(n.y()))) return 4;
    if (std::abs(n.x()) >= std::abs(n.y())) return n.x() > 0.0f ? 0 : 1;
    return n.y() > 0.0f ? 2 : 3;
}

std::vector<Returns> returnsByObject(const LidarScan& scan) {
    std::vector<Returns> all(scan.sights.size());
    for (const LidarReturn& r : scan.returns) {
        if (r.object < 0) continue;
        Returns& mine = all[static_cast<std::size_t>(r.object)];
        ++mine.count;
        if (r.firing % 2 == 0) ++mine.first_firings;
        mine.time_sum += r.time;
        ++mine.faces[static_cast<std::size_t>(faceOf(r.normal))];
    }
    return all;
}

/// Letters of the faces with at least a twentieth of the returns; "-" without returns.
std::string visibleFaces(const Returns& returns) {
    std::string letters;
    for (std::size_t k = 0; k < returns.faces.size(); ++k)
        if (returns.faces[k] > 0 && 20 * returns.faces[k] >= returns.count) letters += "FBLRT"[k];
    return letters.empty() ? "-" : letters;
}

/// Share of the object that something else hides; 1 if no shot would meet it.
double occlusion(const Sight& sight) {
    if (sight.alone <= 0) return 1.0;
    return std::clamp(1.0 - static_cast<double>(sight.first) / sight.alone, 0.0, 1.0);
}

double nearestRange(const RelativePose& pose, const Eigen::Vector3d& size) {
    const Eigen::Vector2d local = Eigen::Rotation2Dd(-pose.yaw) * pose.center.head<2>();
    return (local.cwiseAbs() - 0.5 * size.head<2>()).cwiseMax(0.0).norm();
}

void addPose(Row& row, const RelativePose& pose) {
    for (int k = 0; k < 3; ++k) row.number(pose.center[k], 4);
    row.number(normalizeAngle(pose.yaw), 5);
}

struct RowInput {
    const TurnPoses& poses;
    const LidarScan& scan;
    const Returns& returns;
    const Sight& sight;
};

void addVelocities(Row& row, const RowInput& in, const PoseTrack& track) {
    const double t = in.scan.turn.start();
    const Eigen::Matrix3d to_vehicle = toIsometry(in.poses.ego.at(t)).linear().transpose();
    const Velocity own = velocityOf(track, t), ego = velocityOf(in.poses.ego, t);
    const Eigen::Vector3d relative = to_vehicle * (own.linear - ego.linear);
    row.number(relative.x(), 3).number(relative.y(), 3).number(own.yaw_rate, 4);
}

std::string truthRow(const WorldObject& object, const PoseTrack& track, const RowInput& in, std::size_t scan_index) {
    const Turn& turn = in.scan.turn;
    const Eigen::Vector3d& size = object.model->size;
    const double seen = in.returns.count > 0 ? turn.start() + in.returns.time_sum / in.returns.count : turn.middle();
    const auto pose = [&](double t) { return relativePose(in.poses, track, size.z(), t); };
    const Eigen::Vector3d velocity =
        toIsometry(in.poses.ego.at(turn.start())).linear().transpose() * velocityOf(track, turn.start()).linear;
    Row row;
    row.time(turn.start()).integer(static_cast<long>(scan_index)).integer(object.id).text(nameOf(object.model->kind));
    const RelativePose now = pose(turn.start());
    for (int k = 0; k < 3; ++k) row.number(now.center[k], 4);
    for (int k = 0; k < 3; ++k) row.number(size[k], 3);
    row.number(normalizeAngle(now.yaw), 5).number(velocity.x(), 3).number(velocity.y(), 3);
    row.integer(in.returns.count).number(nearestRange(now, size), 3).text(visibleFaces(in.returns));
    row.number(occlusion(in.sight), 3).integer(in.returns.first_firings);
    row.time(turn.middle());
    addPose(row, pose(turn.middle()));
    row.time(seen);
    addPose(row, pose(seen));
    addVelocities(row, in, track);
    const Pose6 world = track.at(turn.start());
    for (int k = 0; k < 3; ++k) row.number(world.position[k], 3);
    row.number(normalizeAngle(world.yaw), 5);
    return row.line();
}

void addWorldPose(Row& row, const Pose6& pose) {
    for (int k = 0; k < 3; ++k) row.number(pose.position[k], 4);
    row.number(pose.roll, 6).number(pose.pitch, 6).number(normalizeAngle(pose.yaw), 6);
}

}  // namespace

std::string truthHeader() {
    return "timestamp,scan_index,object_id,type,x,y,z,length,width,height,yaw,vx,vy,num_points,range_nearest,"
           "visible_faces,occluded,num_points_mrpt,t_mid,x_mid,y_mid,z_mid,yaw_mid,t_obs,x_obs,y_obs,z_obs,yaw_obs,"
           "vrel_x,vrel_y,yaw_rate,x_w,y_w,z_w,yaw_w\n";
}

std::string truthRows(const World& world, const TurnPoses& poses, const LidarScan& scan, std::size_t scan_index) {
    const std::vector<Returns> returns = returnsByObject(scan);
    std::string rows;
    for (std::size_t i = 0; i < world.objects.size(); ++i)
        if (poses.objects[i])
            rows +=
                truthRow(world.objects[i], *poses.objects[i], {poses, scan, returns[i], scan.sights[i]}, scan_index);
    return rows;
}

std::string egoHeader() {
    return "scan_index,timestamp,x,y,z,roll,pitch,yaw,t_mid,x_mid,y_mid,z_mid,roll_mid,pitch_mid,yaw_mid,speed,"
           "num_returns\n";
}

std::string egoRow(const TurnPoses& poses, const LidarScan& scan, std::size_t scan_index) {
    const Turn& turn = scan.turn;
    Row row;
    row.integer(static_cast<long>(scan_index)).time(turn.start());
    addWorldPose(row, poses.ego.at(turn.start()));
    row.time(turn.middle());
    addWorldPose(row, poses.ego.at(turn.middle()));
    row.number(velocityOf(poses.ego, turn.start()).linear.norm(), 3);
    return row.integer(static_cast<long>(scan.returns.size())).line();
}

std::string staticTable(const World& world) {
    std::string table = "type,x,y,z,length,width,height,yaw\n";
    for (const StaticBox& box : world.boxes) {
        Row row;
        row.text(box.type);
        for (int k = 0; k < 3; ++k) row.number(box.center[k], 3);
        for (int k = 0; k < 3; ++k) row.number(box.size[k], 3);
        table += row.number(normalizeAngle(box.yaw), 5).line();
    }
    return table;
}

}  // namespace lidar_obstacles::simulation

// SPDX-License-Identifier: BSD-3-Clause
#include "look.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "common/message_of.h"
#include "common/run_app.h"
#include "lidar_obstacles/mrpt_bridge/joined_lidars.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"

namespace lidar_obstacles::apps {
namespace {

/// One pass over the scans.
class Pass {
  public:
    Pass(const Options& options, const DetectorParams& params, const mrpt::poses::CPose3D& turned)
        : options_(options), params_(params), turned_(turned), check_(params) {}

    Look run(ScanSource& source) {
        while (taken_ < options_.scans) {
            auto item = source.next();
            if (!item) break;
            if (isWanted(*item) && seen_++ >= options_.from && !item->is_gap) take(*item, source.objects());
            if (!look_.damage.empty()) break;
        }
        if (source.status() == SourceStatus::Damaged) look_.damage = source.message();
        if (taken_ == 0) refuse(source);
        look_.remarks = source.remarks();
        look_.report = check_.report();
        return std::move(look_);
    }

  private:
    bool isWanted(const SourceItem& item) {
        if (!item.observation || !isLidarScan(*item.observation)) return false;
        if (const auto& wanted = options_.choice.sensor_label) return item.lidar == *wanted;
        if (seen_ == 0) look_.lidar = item.lidar;
        if (item.lidar == look_.lidar) return true;
        throw UsageError(options_.input + ": several lidars, choose one with --sensor-label: " +
                         listLidars(options_.input, options_.choice.options));
    }

    void take(const SourceItem& item, std::size_t objects) {
        mrpt::poses::CPose3D pose;
        item.observation->getSensorPose(pose);
        if (taken_ == 0) {
            look_.lidar = item.lidar;
            look_.sensor_pose = pose + turned_;
        }
        placeSensor(*item.observation, pose + turned_, options_.choice.points_in_vehicle);
        try {
            check_.add(toPointCloud(item, params_.sensor));
            ++taken_;
        } catch (const std::invalid_argument&) {
            throw;  // parameters that do not fit the sensor
        } catch (const std::exception& e) {
            look_.damage = options_.input + ": object " + std::to_string(objects - 1) + ": " + messageOf(e);
        }
    }

    [[noreturn]] void refuse(const ScanSource& source) const {
        if (!look_.damage.empty()) throw std::runtime_error(look_.damage);
        if (seen_ > 0) throw UsageError(options_.input + ": --from leaves none of its scans");
        if (const auto& wanted = options_.choice.sensor_label)
            throw UsageError(options_.input + ": no lidar '" + *wanted +
                             "'; there are: " + listLidars(options_.input, options_.choice.options));
        throw std::runtime_error(noScansIn(options_.input, source));
    }

    const Options& options_;
    const DetectorParams& params_;
    const mrpt::poses::CPose3D& turned_;
    SetupCheck check_;
    Look look_;
    int seen_ = 0;   ///< scans of the lidar
    int taken_ = 0;  ///< looked at
};

}  // namespace

Look lookAt(const Options& options, const DetectorParams& params, const mrpt::poses::CPose3D& turned) {
    const auto source = openInput(options.input, options.choice);
    return Pass(options, params, turned).run(*source);
}

std::string levelPose(const Look& look) {
    constexpr double kDegrees = 180.0 / M_PI;
    const Eigen::Quaterniond level = Eigen::Quaterniond::FromTwoVectors(look.report.up, Eigen::Vector3d::UnitZ());
    const Eigen::Matrix3d rotation = level.toRotationMatrix() * look.sensor_pose.getRotationMatrix().asEigen();
    mrpt::math::CMatrixDouble33 matrix;
    matrix.asEigen() = rotation;
    const mrpt::poses::CPose3D pose(matrix, mrpt::math::CVectorFixedDouble<3>());
    const auto tenths = [](double rad) { return std::round(rad * kDegrees * 10.0) / 10.0 + 0.0; };  // no "-0.0"
    char words[160];
    std::snprintf(words, sizeof words, "%.2f,%.2f,%.2f,%.1f,%.1f,%.1f", look.sensor_pose.x(), look.sensor_pose.y(),
                  look.report.height.value_or(0.0), tenths(pose.yaw()), tenths(pose.pitch()), tenths(pose.roll()));
    return words;
}

}  // namespace lidar_obstacles::apps

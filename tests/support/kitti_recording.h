// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Small recordings in KITTI's layouts, and kitti2rawlog run on them.
#pragma once

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/truth.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "support/shell.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::test {

namespace fs = std::filesystem;
inline constexpr double kHeight = 1.73;  ///< of KITTI's sensor

using Points = std::vector<std::vector<float>>;

/// A turn as KITTI stores it: planes from the top, each from straight ahead counter-clockwise; all at 10 m, plane k
/// (0 = lowest) with reflectance k / 100. `columns` points a plane between the two azimuths.
inline Points turn(int top, int bottom, int columns, double from_deg = 0.0, double to_deg = 360.0) {
    Points points;
    for (int plane = top; plane >= bottom; --plane) {
        for (int c = 0; c < columns; ++c) {
            const double azimuth = (from_deg + (to_deg - from_deg) * (c + 0.5) / columns) * M_PI / 180.0;
            const double elevation = (-25.0 + 0.4 * plane) * M_PI / 180.0;
            points.push_back({static_cast<float>(10.0 * std::cos(elevation) * std::cos(azimuth)),
                              static_cast<float>(10.0 * std::cos(elevation) * std::sin(azimuth)),
                              static_cast<float>(10.0 * std::sin(elevation)), static_cast<float>(plane) / 100.F});
        }
    }
    return points;
}

struct Outcome {
    int code = -1;
    std::string err;
};

/// What stands in a converted rawlog.
struct Contents {
    std::vector<PointCloud> clouds;
    std::vector<mrpt::obs::CObservationRobotPose::Ptr> poses;
    std::vector<mrpt::obs::CObservation::Ptr> scans;
};

class Kitti2Rawlog : public ::testing::Test {
  protected:
    std::string path(const std::string& name) const { return folder_.file(name); }

    void write(const std::string& name, const std::string& text) const {
        fs::create_directories(fs::path(path(name)).parent_path());
        writeFile(path(name), text);
    }
    void writePoints(const std::string& name, const Points& points) const {
        std::string bytes;
        for (const auto& p : points) {
            const std::size_t size = p.size() * sizeof(float);
            bytes.resize(bytes.size() + size);
            std::memcpy(bytes.data() + bytes.size() - size, p.data(), size);
        }
        write(name, bytes);
    }

    Outcome run(const std::string& arguments, const std::string& input = "in", const std::string& before = "") const {
        const std::string command = before + " '" KITTI2RAWLOG "' '" + path(input) + "' --output '" + path("out") +
                                    "' " + arguments + " >'" + path("stdout") + "' 2>'" + path("stderr") + "'";
        return {shell(command), readFile(path("stderr"))};
    }

    Contents contents(const SensorParams& params = {}) const {
        Contents c;
        const auto source = openScanSource(path("out.rawlog"));
        while (const auto item = source->next()) {
            const auto pose = std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(item->observation);
            if (pose) c.poses.push_back(pose);
            if (!isLidarScan(*item->observation)) continue;
            c.scans.push_back(item->observation);
            c.clouds.push_back(*toPointCloud(*item->observation, params));
        }
        EXPECT_EQ(source->status(), SourceStatus::End) << source->message();
        return c;
    }
    std::vector<evaluation::TruthObject> truth() const {
        return evaluation::readTruth(path("out_gt.csv"), evaluation::TruthPose::Observed);
    }

    /// Camera axes (x right, y down, z ahead) seen from the velodyne, 0.27 m ahead of it and 0.08 m below.
    static std::string calibration() {
        return "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nR0_rect: 1 0 0 0 1 0 0 0 1\n"
               "Tr_velo_to_cam: 0 -1 0 0 0 0 -1 -0.08 1 0 0 -0.27\n"
               "Tr_imu_to_velo: 1 0 0 -0.8 0 1 0 0.3 0 0 1 -0.8\n\n";
    }

  private:
    TempFolder folder_;
};

}  // namespace lidar_obstacles::test

// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// MRPT's reactive navigation on the obstacles of this library: a small robot crosses a simulated car park.
///
///     scan -> toPointCloud -> detect -> toPointsMap -> senseObstacles -> CReactiveNavigationSystem -> wheels
#include <mrpt/config/CConfigFile.h>
#include <mrpt/kinematics/CVehicleSimul_DiffDriven.h>
#include <mrpt/nav/reactive/CReactiveNavigationSystem.h>
#include <mrpt/nav/reactive/CRobot2NavInterfaceForSimulator.h>
#include <mrpt/version.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include "lidar_obstacles/mrpt_bridge/navigation.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/pipelines.h"
#include "simulated_lidar.h"

namespace {

using namespace lidar_obstacles;

struct Options {
    std::string scenario = LIDAR_OBSTACLES_EXAMPLE "car_park.yaml";
    std::string config = LIDAR_OBSTACLES_EXAMPLE "navigation.ini";
    std::string trace;  ///< CSV of the way; empty: none
    double goal_x = 42.0, goal_y = 0.0;
    double time = 180.0;  ///< it gives up then [s]
};

/// The robot as the navigator sees it; wheels and clock are MRPT's simulation.
class Robot : public mrpt::nav::CRobot2NavInterfaceForSimulator_DiffDriven {
  public:
    using CRobot2NavInterfaceForSimulator_DiffDriven::CRobot2NavInterfaceForSimulator_DiffDriven;

    bool senseObstacles(mrpt::maps::CSimplePointsMap& obstacles, mrpt::system::TTimeStamp& timestamp) override {
        obstacles = obstacles_;
        timestamp = mrpt::Clock::now();
        return true;
    }
    void setObstacles(const mrpt::maps::CSimplePointsMap& obstacles) { obstacles_ = obstacles; }

  private:
    mrpt::maps::CSimplePointsMap obstacles_;
};

/// MRPT's navigator without its table of times at the end.
class Navigator : public mrpt::nav::CReactiveNavigationSystem {
  public:
    explicit Navigator(Robot& robot) : CReactiveNavigationSystem(robot, false) { m_timlog_delays.disable(); }
};

/// Where the robot went, and how near it came.
class Journal {
  public:
    explicit Journal(const std::string& trace) {
        if (!trace.empty()) trace_.open(trace);
        if (trace_.is_open()) trace_ << "time,x,y,yaw,clearance,points\n";
    }

    void note(const mrpt::kinematics::CVehicleSimul_DiffDriven& robot, const std::vector<OrientedBox>& boxes,
              std::size_t points) {
        const mrpt::math::TPose2D& pose = robot.getCurrentGTPose();
        const OrientedBox self{{pose.x, pose.y, 0.3}, {0.9, 0.6, 0.6}, pose.phi};
        double now = std::numeric_limits<double>::infinity();
        for (const OrientedBox& box : boxes) now = std::min(now, examples::clearance(self, box));
        nearest_ = std::min(nearest_, now);
        if (has_last_) way_ += std::hypot(pose.x - last_.x, pose.y - last_.y);
        last_ = pose;
        has_last_ = true;
        if (trace_.is_open())
            trace_ << robot.getTime() << ',' << pose.x << ',' << pose.y << ',' << pose.phi << ',' << now << ','
                   << points << '\n';
    }

    double nearest() const { return nearest_; }
    double way() const { return way_; }

  private:
    std::ofstream trace_;
    double nearest_ = std::numeric_limits<double>::infinity();
    double way_ = 0.0;
    mrpt::math::TPose2D last_;
    bool has_last_ = false;
};

/// Folder for the tables that MRPT makes of its trajectories, removed with the object.
class TableFolder {
  public:
    TableFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "navigation_XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~TableFolder() { std::filesystem::remove_all(path_); }
    TableFolder(const TableFolder&) = delete;
    TableFolder& operator=(const TableFolder&) = delete;
    const std::string& path() const { return path_; }

  private:
    std::string path_;
};

/// Since MRPT 2.14.3 CHolonomicFullEval has an eighth factor and wants a weight for it; no phase of the file uses it.
[[maybe_unused]] void addEighthFactor(mrpt::config::CConfigFile& config) {
    const std::string section = "CHolonomicFullEval";
    for (const std::string& key : {std::string("factorWeights"), std::string("factorNormalizeOrNot")}) {
        const std::string list = config.read_string(section, key, "");
        if (std::count(list.begin(), list.end(), ',') != 6) continue;  // a list that was written for it
        config.write(section, key, list.substr(0, list.rfind(']')) + ", 0]");
    }
}

void prepare(mrpt::nav::CReactiveNavigationSystem& navigator, const Options& options, const TableFolder& tables) {
    mrpt::config::CConfigFile config(options.config);
    config.discardSavingChanges();
    if constexpr (MRPT_VERSION >= 0x20e03) addEighthFactor(config);
    navigator.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    navigator.loadConfigFile(config);
    navigator.params_abstract_ptg_navigator.ptg_cache_files_directory = tables.path();
    navigator.initialize();
    mrpt::nav::CAbstractNavigator::TNavigationParams go;
    go.target.target_coords = {options.goal_x, options.goal_y, 0.0};
    go.target.targetAllowedDistance = 0.5F;
    navigator.navigate(&go);
}

int run(const Options& options) {
    const DetectorParams params;
    mrpt::kinematics::CVehicleSimul_DiffDriven wheels;
    Robot robot(wheels);
    robot.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    examples::SimulatedLidar lidar(simulation::loadScenario(options.scenario), wheels);
    const TableFolder tables;
    Navigator navigator(robot);
    prepare(navigator, options, tables);

    Journal journal(options.trace);
    while (wheels.getTime() < options.time) {
        const PointCloud cloud = toPointCloud(*lidar.turn(), params.sensor);
        const auto obstacles = toPointsMap(cloud, detect(cloud, params));
        robot.setObstacles(obstacles);
        navigator.navigationStep();
        journal.note(wheels, lidar.boxesAt(wheels.getTime()), obstacles.size());
        if (navigator.getCurrentState() != mrpt::nav::CAbstractNavigator::NAVIGATING) break;
    }
    const mrpt::math::TPose2D& end = wheels.getCurrentGTPose();
    const bool reached = std::hypot(end.x - options.goal_x, end.y - options.goal_y) < 1.0;
    const bool hit = journal.nearest() <= 0.0;
    std::printf("%s after %.1f s and %.1f m, at x = %.1f, y = %.1f; %s %.2f m\n", reached ? "goal reached" : "stopped",
                wheels.getTime(), journal.way(), end.x, end.y,
                hit ? "HIT something; nearest" : "nothing was hit; nearest", journal.nearest());
    return reached && !hit ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Drives a simulated robot through a car park with MRPT's reactive navigation.", "example-navigation");
    app.add_option("--scenario", options.scenario, "the world")->type_name("FILE.yaml")->capture_default_str();
    app.add_option("--config", options.config, "of the navigation")->type_name("FILE.ini")->capture_default_str();
    app.add_option("--goal-x", options.goal_x, "[m]")->capture_default_str();
    app.add_option("--goal-y", options.goal_y, "[m]")->capture_default_str();
    app.add_option("--time", options.time, "gives up after this time [s]")->capture_default_str();
    app.add_option("--trace", options.trace, "writes the way of the robot")->type_name("FILE.csv");
    CLI11_PARSE(app, argc, argv);
    try {
        return run(options);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "example-navigation: error: %s\n", e.what());
        return 1;
    }
}

// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The command line of obstacle-evaluate.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/input_choice.h"
#include "common/run_app.h"
#include "lidar_obstacles/evaluation/bootstrap.h"
#include "lidar_obstacles/evaluation/evaluate.h"

namespace lidar_obstacles::apps {

/// The files of one recording; "" where there is none.
struct SetFiles {
    std::string name;  ///< unique among the sets, fit for a file name
    std::string rawlog;
    std::string truth;
    std::string detections;  ///< obstacles.csv to be judged; "": the detector runs on the rawlog
    std::string statics;
    std::string ego;
};

/// One way to run the detector, e.g. "8_plane" with sensor.planes=8.
struct Variant {
    std::string name;
    std::vector<std::string> set;  ///< section.key=value
};

struct EvaluateOptions {
    std::vector<SetFiles> sets;
    std::vector<Variant> variants;  ///< at least one; a plain evaluation has one without a name
    bool monza = false;             ///< the paper's experiment: figures of the target over time, table of its errors
    std::string config;             ///< "": the built-in defaults
    std::vector<std::string> set;   ///< section.key=value, for all variants
    InputChoice choice;
    std::string output = "output/evaluation";
    evaluation::TruthPose pose = evaluation::TruthPose::Observed;
    std::string points_column = "num_points";
    evaluation::EvaluationOptions evaluation;
    evaluation::BootstrapOptions bootstrap;
    int jobs = 1;
    int worst = 10;      ///< scans that are drawn
    bool report = true;  ///< report.html
    bool plots = true;   ///< ... with plots, which gnuplot draws
};

/// Reads the command line; nullopt if it asked for --help or --version, which are printed then.
/// @throws UsageError
std::optional<EvaluateOptions> parseEvaluateOptions(int argc, char** argv);

}  // namespace lidar_obstacles::apps

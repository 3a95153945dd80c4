// SPDX-License-Identifier: BSD-3-Clause
#include "outputs.h"

#include <filesystem>
#include <stdexcept>

namespace lidar_obstacles::apps {
namespace {

constexpr double kEgoPeriod = 0.05;  ///< of the vehicle's own sensors [s]

/// The prefix, its folder made.
std::string prepared(const std::string& prefix) {
    const std::filesystem::path folder = std::filesystem::path(prefix).parent_path();
    if (folder.empty()) return prefix;
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error || !std::filesystem::is_directory(folder))
        throw std::runtime_error(folder.string() + ": cannot make the output folder" +
                                 (error ? ": " + error.message() : ": there is a file of that name"));
    return prefix;
}

}  // namespace

Outputs::Outputs(const Options& options, const simulation::World& world)
    : options_(options),
      world_(world),
      odometry_(world, options.run.from, options.run.seed),
      told_(options.run.from),
      rawlog_(prepared(options.output) + ".rawlog"),
      truth_(options.output + "_gt.csv"),
      ego_(options.output + "_ego.csv"),
      statics_(options.output + "_static.csv"),
      labels_(options.output + "_labels.bin") {
    truth_.append(simulation::truthHeader());
    ego_.append(simulation::egoHeader());
    statics_.append(simulation::staticTable(world));
    labels_.append(simulation::labelsHeader());
}

Outputs::~Outputs() {
    if (finished_) return;
    for (TextFile* file : {&truth_, &ego_, &statics_, &labels_}) file->discard();
}

void Outputs::addEgoSensors(double until) {
    for (double time : simulation::ticks(told_, until, kEgoPeriod)) {
        rawlog_.append(*simulation::rtkPose(world_, time, options_.run.seed));
        if (options_.odometry) rawlog_.append(*odometry_.at(time));
    }
    told_ = std::max(told_, until);
}

void Outputs::add(const simulation::RecordedScan& scan) {
    addEgoSensors(scan.time);
    rawlog_.append(*scan.observation);
    for (const auto& beside : scan.beside) rawlog_.append(*beside);
    truth_.append(scan.truth_rows);
    ego_.append(scan.ego_row);
    labels_.append(simulation::labelsRecord(scan.labels));
}

void Outputs::finish(double end) {
    addEgoSensors(end);
    rawlog_.close();
    truth_.close();
    ego_.close();
    statics_.close();
    labels_.close();
    finished_ = true;
}

}  // namespace lidar_obstacles::apps

// SPDX-License-Identifier: BSD-3-Clause
#include "support/small_worlds.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "lidar_obstacles/simulation/truth.h"

namespace lidar_obstacles::simulation::test {
namespace {

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
    return parts;
}

}  // namespace

std::string scenarioText(const SmallWorld& world) {
    return "duration: 10\n"
           "track: {width: 20, segments: [{straight: 400}]}\n"
           "terrain: {reach: 120, cell: 5}\n"
           "sensor: {pose: {z: 1.9}, range_noise: 0" +
           world.sensor + "}\nego: {path: " + world.ego + "}\n" + world.lists;
}

World worldOf(const SmallWorld& world) { return buildWorld(parseScenario(scenarioText(world), "test")); }

LidarScan scanOf(const World& world, std::size_t index, std::uint64_t seed) {
    const Turn turn = turnNumber(index, world.scenario.sensor.rate);
    return castScan(world, turn, posesDuring(world, turn), seed);
}

std::string truthOf(const World& world, std::size_t index) {
    const Turn turn = turnNumber(index, world.scenario.sensor.rate);
    const TurnPoses poses = posesDuring(world, turn);
    return truthHeader() + truthRows(world, poses, castScan(world, turn, poses, 1), index);
}

std::string csvValue(const std::string& csv, std::size_t row, const std::string& name) {
    const std::vector<std::string> lines = split(csv, '\n');
    const std::vector<std::string> header = split(lines.at(0), ',');
    const auto column = std::find(header.begin(), header.end(), name);
    if (column == header.end()) throw std::runtime_error("no column " + name);
    return split(lines.at(row + 1), ',').at(static_cast<std::size_t>(column - header.begin()));
}

double csvNumber(const std::string& csv, std::size_t row, const std::string& name) {
    return std::stod(csvValue(csv, row, name));
}

}  // namespace lidar_obstacles::simulation::test

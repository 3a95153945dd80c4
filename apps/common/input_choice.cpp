// SPDX-License-Identifier: BSD-3-Clause
#include "common/input_choice.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "common/number_text.h"
#include "common/run_app.h"
#include "lidar_obstacles/mrpt_bridge/ipv4_address.h"
#include "lidar_obstacles/mrpt_bridge/joined_lidars.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"

namespace lidar_obstacles::apps {
namespace {

/// The items of another source, with the sensors at other places.
class PlacedSource : public ScanSourceFilter {
  public:
    PlacedSource(std::unique_ptr<ScanSource> source, const InputChoice& choice)
        : ScanSourceFilter(*source), owned_(std::move(source)), choice_(choice) {}

    std::optional<SourceItem> next() override {
        auto item = source_.next();
        if (!item || !item->observation || !isLidarScan(*item->observation)) return item;
        if (const auto T_vehicle_sensor = choice_.poseOf(item->lidar))
            placeSensor(*item->observation, *T_vehicle_sensor, choice_.points_in_vehicle);
        return item;
    }

  private:
    std::unique_ptr<ScanSource> owned_;
    const InputChoice choice_;
};

std::uint32_t readAddress(const std::string& words) {
    try {
        return parseAddress(words);
    } catch (const std::invalid_argument& e) {
        throw UsageError(std::string("--source ") + e.what());
    }
}

/// "[LABEL=]X,Y,Z,YAW,PITCH,ROLL".
void addPose(const std::string& words, InputChoice& choice) {
    const auto end = words.rfind('=');
    const std::string label = end == std::string::npos ? "" : trimmed(words.substr(0, end));
    const std::string numbers = end == std::string::npos ? words : words.substr(end + 1);
    if (choice.sensor_poses.count(label) != 0)
        throw UsageError("--sensor-pose " + words + ": there is a pose of that sensor already");
    choice.sensor_poses[label] = readPose("--sensor-pose", numbers);
}

/// The lidars that the options name.
std::vector<std::string> namesSaid(const InputChoice& choice) {
    std::vector<std::string> names;
    if (choice.joins()) names = JoinedLidars::namesIn(*choice.sensor_label);
    for (const auto& [label, T_vehicle_sensor] : choice.sensor_poses)
        if (!label.empty()) names.push_back(label);
    return names;
}

/// @throws UsageError if a lidar that is joined or gets a place is not in the input, or several get the same place.
void requireLidars(const std::string& input, const InputChoice& choice) {
    constexpr std::size_t kSoon = 2000;  // objects within which each should have come
    if (choice.joins() && choice.sensor_poses.count("") != 0)
        throw UsageError("--sensor-pose: several lidars are not at one place: write LABEL=X,Y,Z,YAW,PITCH,ROLL");
    const std::vector<std::string> names = namesSaid(choice);
    if (names.empty()) return;
    const auto soon = lidarLabels(input, kSoon, choice.options);
    for (const std::string& name : names) {
        if (soon.count(name) != 0) continue;
        const std::string there = listLidars(input, choice.options);
        if (there.find("'" + name + "' (") == std::string::npos)
            throw UsageError(input + ": no lidar '" + name + "'" +
                             (choice.sensor_poses.count(name) != 0 ? ", which --sensor-pose names" : "") +
                             "; there are: " + there);
    }
}

}  // namespace

mrpt::poses::CPose3D readPose(const std::string& option, const std::string& words, double farthest) {
    constexpr double kTurn = 360.0;
    const std::vector<double> numbers = readNumbers(words);
    if (numbers.size() != 6)
        throw UsageError(option + ' ' + words + ": must be X,Y,Z,YAW,PITCH,ROLL (metres, degrees)");
    const auto is_beyond = [](double limit) { return [limit](double number) { return std::abs(number) > limit; }; };
    if (std::any_of(numbers.begin(), numbers.begin() + 3, is_beyond(farthest)))
        throw UsageError(option + ' ' + words + ": X, Y and Z must be within " + fixedText(farthest, 0) + " m");
    if (std::any_of(numbers.begin() + 3, numbers.end(), is_beyond(kTurn)))
        throw UsageError(option + ' ' + words + ": YAW, PITCH and ROLL must be within 360 degrees");
    const double rad = M_PI / 180.0;
    return {numbers[0], numbers[1], numbers[2], numbers[3] * rad, numbers[4] * rad, numbers[5] * rad};
}

void addInputChoice(CLI::App& app, InputChoice& choice) {
    app.add_option("--sensor-label", choice.sensor_label,
                   "the lidar to use, where the input has several; or several with commas, or all: their scans\n"
                   "are joined, at the times of the first")
        ->type_name("LABEL[,..]|all");
    app.add_option_function<std::vector<std::string>>(
           "--sensor-pose",
           [&choice](const std::vector<std::string>& all) {
               for (const std::string& words : all) addPose(words, choice);
           },
           "the sensor on the vehicle [m, deg]; without, what the input says (captures: the identity);\n"
           "of several lidars once for each")
        ->type_name("[LABEL=]X,Y,Z,YAW,PITCH,ROLL")
        ->allow_extra_args(false);
    app.add_flag("--points-in-vehicle", choice.points_in_vehicle,
                 "the points of clouds are in the vehicle's frame already: --sensor-pose only says where their rays\n"
                 "start");
    app.add_option("--port", choice.options.port, "of a capture: only packets to this UDP port; without, to any")
        ->type_name("N")
        ->check(CLI::Range(1, 65535));
    app.add_option_function<std::string>(
           "--source", [&choice](const std::string& words) { choice.options.sender = readAddress(words); },
           "of a capture: only packets of this address")
        ->type_name("ADDRESS");
    app.add_option("--sensor-model", choice.options.sensor_model,
                   "of a capture: the model, where the packets name it wrongly or not at all")
        ->type_name("MODEL")
        ->check(CLI::IsMember(sensorModels()));
}

bool InputChoice::joins() const { return sensor_label && JoinedLidars::joins(*sensor_label); }

std::optional<mrpt::poses::CPose3D> InputChoice::poseOf(const std::string& lidar) const {
    const auto own = sensor_poses.find(lidar);
    if (own != sensor_poses.end()) return own->second;
    const auto common = sensor_poses.find("");
    const bool is_used = !sensor_label || lidar == *sensor_label;
    return common != sensor_poses.end() && is_used ? std::optional(common->second) : std::nullopt;
}

void placeSensor(mrpt::obs::CObservation& scan, const mrpt::poses::CPose3D& T_vehicle_sensor, bool points_in_vehicle) {
    scan.setSensorPose(T_vehicle_sensor);
    if (!points_in_vehicle) return;
    const auto* cloud = dynamic_cast<const mrpt::obs::CObservationPointCloud*>(&scan);
    if (cloud && cloud->pointcloud) cloud->pointcloud->changeCoordinatesReference(-T_vehicle_sensor);
}

std::unique_ptr<ScanSource> openInput(const std::string& input, const InputChoice& choice) {
    if (choice.points_in_vehicle && choice.sensor_poses.empty())
        throw UsageError("--points-in-vehicle needs --sensor-pose: where do their rays start?");
    requireLidars(input, choice);
    auto source = openScanSource(input, choice.options);
    if (!choice.sensor_poses.empty()) source = std::make_unique<PlacedSource>(std::move(source), choice);
    if (choice.joins()) source = std::make_unique<JoinedLidars>(std::move(source), *choice.sensor_label);
    return source;
}

std::string listLidars(const std::string& input, const InputOptions& options) {
    constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
    std::string list;
    for (const auto& [label, scans] : lidarLabels(input, kAll, options))
        list += (list.empty() ? "'" : ", '") + label + "' (" + std::to_string(scans) + " scans)";
    return list.empty() ? "none" : list;
}

std::string noScansIn(const std::string& input, const ScanSource& source) {
    const std::string remarks = source.remarks();
    return input + ": no lidar scans in it" + (remarks.empty() ? "" : ": " + remarks);
}

}  // namespace lidar_obstacles::apps

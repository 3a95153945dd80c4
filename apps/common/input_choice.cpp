#include "common/input_choice.h"

#include <arpa/inet.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <utility>

#include "common/number_text.h"
#include "common/run_app.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"

namespace lidar_obstacles::apps {
namespace {

/// The items of another source, with the sensor of one lidar at another place.
class PlacedSource : public ScanSourceFilter {
  public:
    PlacedSource(std::unique_ptr<ScanSource> source, const InputChoice& choice)
        : ScanSourceFilter(*source),
          owned_(std::move(source)),
          label_(choice.sensor_label),
          T_vehicle_sensor_(*choice.sensor_pose) {}

    std::optional<SourceItem> next() override {
        auto item = source_.next();
        if (item && item->observation && isLidarScan(*item->observation) && (!label_ || item->lidar == *label_))
            item->observation->setSensorPose(T_vehicle_sensor_);
        return item;
    }

  private:
    std::unique_ptr<ScanSource> owned_;
    std::optional<std::string> label_;
    mrpt::poses::CPose3D T_vehicle_sensor_;
};

std::uint32_t readAddress(const std::string& words) {
    in_addr address{};
    if (inet_pton(AF_INET, words.c_str(), &address) != 1)
        throw UsageError("--source " + words + ": must be an IPv4 address such as 192.168.1.201");
    return ntohl(address.s_addr);
}

}  // namespace

mrpt::poses::CPose3D readPose(const std::string& option, const std::string& words) {
    const std::vector<double> numbers = readNumbers(words);
    if (numbers.size() != 6)
        throw UsageError(option + ' ' + words + ": must be X,Y,Z,YAW,PITCH,ROLL (metres, degrees)");
    const double rad = M_PI / 180.0;
    return {numbers[0], numbers[1], numbers[2], numbers[3] * rad, numbers[4] * rad, numbers[5] * rad};
}

void addInputChoice(CLI::App& app, InputChoice& choice) {
    app.add_option("--sensor-label", choice.sensor_label, "the lidar to use, where the input has several")
        ->type_name("LABEL");
    app.add_option_function<std::string>(
           "--sensor-pose",
           [&choice](const std::string& words) { choice.sensor_pose = readPose("--sensor-pose", words); },
           "the sensor on the vehicle [m, deg]; without, what the input says (captures: the identity)")
        ->type_name("X,Y,Z,YAW,PITCH,ROLL");
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

std::unique_ptr<ScanSource> openInput(const std::string& input, const InputChoice& choice) {
    auto source = openScanSource(input, choice.options);
    if (!choice.sensor_pose) return source;
    return std::make_unique<PlacedSource>(std::move(source), choice);
}

std::string noScansIn(const std::string& input, const ScanSource& source) {
    const std::string remarks = source.remarks();
    return input + ": no lidar scans in it" + (remarks.empty() ? "" : ": " + remarks);
}

}  // namespace lidar_obstacles::apps

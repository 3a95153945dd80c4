// SPDX-License-Identifier: BSD-3-Clause
#include "beside.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "lidar_obstacles/live/udp_source.h"

namespace lidar_obstacles::apps {
namespace {

double timeOf(const live::LiveScan& scan) { return mrpt::Clock::toDouble(scan.observation->timestamp); }

std::unique_ptr<live::UdpSource> sourceAt(const live::Endpoint& place) {
    try {
        return std::make_unique<live::UdpSource>(place);
    } catch (const std::runtime_error& e) {
        throw std::runtime_error(std::string("--beside: ") + e.what());
    }
}

}  // namespace

SensorsBeside::SensorsBeside(const Options& options) {
    for (const SensorBeside& beside : options.beside) {
        live::ScannerOptions o;
        o.stream = options.stream;
        o.stream.sender.reset();
        o.stream.sensor_pose = beside.pose;
        o.queue = static_cast<std::size_t>(options.queue);
        auto source = sourceAt(beside.listen);
        const std::string place = toString(source->endpoint());
        sensors_.push_back({place, std::make_unique<live::LiveScanner>(std::move(source), o), {}});
    }
}

std::vector<live::LiveScan> SensorsBeside::at(double time) {
    std::vector<live::LiveScan> scans;
    for (Sensor& sensor : sensors_) {
        while (auto scan = sensor.scanner->next(0.0)) sensor.last.push_back(std::move(*scan));
        if (sensor.last.size() > 2) sensor.last.erase(sensor.last.begin(), sensor.last.end() - 2);
        const auto nearest = std::min_element(
            sensor.last.begin(), sensor.last.end(),
            [&](const auto& a, const auto& b) { return std::abs(timeOf(a) - time) < std::abs(timeOf(b) - time); });
        if (nearest != sensor.last.end() && std::abs(timeOf(*nearest) - time) <= kApart)
            scans.push_back(*nearest);
        else
            ++missing_;
    }
    return scans;
}

void SensorsBeside::stop() {
    for (Sensor& sensor : sensors_) sensor.scanner->stop();
}

std::vector<std::string> SensorsBeside::takeReports() {
    std::vector<std::string> reports;
    for (Sensor& sensor : sensors_)
        for (const std::string& text : sensor.scanner->takeReports()) reports.push_back(sensor.place + ": " + text);
    return reports;
}

}  // namespace lidar_obstacles::apps

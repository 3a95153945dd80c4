// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/testing/scenes.h"

#include <locale>
#include <sstream>
#include <stdexcept>

namespace lidar_obstacles::testing {
namespace {

constexpr double kVehicle = 60.0;  ///< where it is at the end, along the track [m]

/// As YAML has it, whatever the locale of the program.
std::string text(double value) {
    std::ostringstream out;
    out.imbue(std::locale::classic());
    out << value;
    return out.str();
}

/// The place that is (x, y) in the vehicle frame at the end.
std::string at(double x, double y) { return "s: " + text(kVehicle + x) + ", d: " + text(y); }

/// From one place to the other within the second.
std::string path(double x_from, double y_from, double x_to, double y_to) {
    return "path: [{t: 0, " + at(x_from, y_from) + "}, {t: 1, " + at(x_to, y_to) + "}]";
}

/// A number in [low, high]; not one, it is an error of the caller.
double inRange(const char* what, double value, double low, double high) {
    if (value >= low && value <= high) return value;
    throw std::invalid_argument(std::string(what) + " must be " + text(low) + " to " + text(high) + ", is " +
                                text(value));
}

/// The road and the vehicle, with lines of YAML that say what else is there.
std::string scene(const std::string& objects, const std::string& clutter, double speed = 0.0) {
    return "duration: 1\n"
           "track: {width: 14, segments: [{straight: 200}]}\n"
           "sensor: {pose: {z: 1.8}}\n"
           "ego: {" +
           path(-speed, 0.0, 0.0, 0.0) + "}\n" + (objects.empty() ? "" : "objects:\n" + objects) +
           (clutter.empty() ? "" : "clutter:\n" + clutter);
}

}  // namespace

std::string emptyRoad() { return scene("", ""); }

std::string carAhead(double x) {
    return scene("  - {model: sedan, " + at(inRange("carAhead: x", x, 5.0, 50.0), 0.0) + "}\n", "");
}

std::string personBesideWall(double gap) {
    const double y = -5.0 + inRange("personBesideWall: gap", gap, 0.3, 3.0);
    return scene("  - {model: standing_pedestrian, " + at(10.0, y) + ", yaw: 90}\n",
                 "  - {type: wall, from: " + text(kVehicle) + ", to: " + text(kVehicle + 30.0) +
                     ", d: -5.15, width: 0.3, height: 2.5}\n");
}

std::string parkedCars() {
    std::string cars;
    for (const double x : {6.0, 12.0, 18.0, 24.0}) cars += "  - {model: sedan, " + at(x, -4.0) + "}\n";
    return scene(cars, "");
}

std::string streetCorner() {
    std::string houses;
    for (const double side : {-1.0, 1.0})
        for (const double x : {6.0, 35.0})
            houses += "  - {type: building, " + at(x, side * 11.0) + ", length: 18, width: 8, height: 7}\n";
    return scene("  - {model: sedan, " + at(20.0, -3.0) + ", yaw: 90}\n" + "  - {model: standing_pedestrian, " +
                     at(15.0, -4.0) + ", yaw: 90}\n",
                 houses);
}

std::string personCrossing() { return scene("  - {model: pedestrian, " + path(12.0, -0.75, 12.0, 0.75) + "}\n", ""); }

std::string vanAhead(double speed) {
    inRange("vanAhead: speed", speed, 0.0, 20.0);
    return scene("  - {model: van, " + path(15.0 - speed, 0.0, 15.0, 0.0) + "}\n", "", 8.0);
}

}  // namespace lidar_obstacles::testing

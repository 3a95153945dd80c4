// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/params.h"

#include <sstream>
#include <stdexcept>
#include <type_traits>

#include "lidar_obstacles/own_body.h"
#include "lidar_obstacles/params_list.h"
#include "lidar_obstacles/searched_place.h"

namespace lidar_obstacles {
namespace {

/// @param read  throws std::invalid_argument if the text of that key of the region is not right.
template <class Read>
void validateText(const char* key, const std::string& text, Read read) {
    try {
        read(text);
    } catch (const std::invalid_argument& e) {
        throw std::invalid_argument(std::string("[region] ") + key + " = " + text + ": " + e.what());
    }
}

}  // namespace

void validate(const DetectorParams& params) {
    forEachParam(params, [](const ParamInfo& info, const auto& value) {
        using Value = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<Value, int> || std::is_same_v<Value, double>) {
            if (value >= info.min && value <= info.max) return;  // false for NaN
            std::ostringstream text;
            text << "[" << info.section << "] " << info.key << " = " << value << " is outside " << info.min << " .. "
                 << info.max << (info.unit[0] != '\0' ? " " : "") << info.unit;
            throw std::invalid_argument(text.str());
        }
    });
    validateText("own_body", params.region.own_body, [](const std::string& text) { OwnBody{text}; });
    validateText("outline", params.region.outline, [](const std::string& text) { searchedOutline(text); });
    validateText("excluded", params.region.excluded, [](const std::string& text) { ExcludedPlaces{text}; });
}

DetectorParams barePaper(DetectorParams params) {
    params.pipeline.bare_paper = true;
    params.ground.standing_runs = false;
    params.clustering.closing = 0.2;
    params.clustering.closing_per_metre = 0.02;
    params.clustering.link_columns = 0;
    params.plane_fit.method = BoxMethod::Plane;
    params.hull_fit.refine = false;
    params.box.completion = Completion::None;
    GateParams& gates = params.gates;
    gates.min_points_vehicle = gates.min_points_pedestrian = gates.min_points_cyclist = 0;
    gates.max_length_vehicle = gates.max_length_pedestrian = gates.max_length_cyclist = 0.0;
    gates.min_probability = 0.0;
    return params;
}

}  // namespace lidar_obstacles

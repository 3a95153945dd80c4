/// @file
/// The one list of all parameters. Loading a config file, writing one, the check for unknown keys, range checks
/// and the README's table walk it, so that a parameter is named in two places only: its struct and here.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "lidar_obstacles/params.h"

namespace lidar_obstacles {

struct ParamInfo {
    const char* section;
    const char* key;
    const char* unit;    ///< "" where the value has none
    const char* source;  ///< section of the paper, or "" where it is ours
    const char* text;    ///< one line
    double min;          ///< smallest allowed value (numbers only)
    double max;          ///< largest allowed value (numbers only)
};

/// The words of an enumeration as they stand in a config file: `choices(FreeSpace{})`.
inline constexpr std::array<std::pair<std::string_view, FreeSpace>, 2> choices(FreeSpace) {
    return {{{"ground", FreeSpace::Ground}, {"rays", FreeSpace::Rays}}};
}

/// Calls `visit(ParamInfo, value&)` for every parameter in the order of config.ini. A value is a bool, an int, a
/// double or an enumeration with `choices()`. `Params` is DetectorParams, const or not.
template <class Params, class Visitor>
void forEachParam(Params& p, Visitor&& visit) {
    visit(ParamInfo{"sensor", "planes", "", "Sec. V", "keep this many planes (decimation); 0: all", 0, 128}, p.sensor.planes);
    visit(ParamInfo{"sensor", "rings", "", "", "planes of the sensor; 0: from the observation", 0, 128}, p.sensor.rings);
    visit(ParamInfo{"sensor", "min_range", "m", "", "nearer returns are dropped", 0, 10}, p.sensor.min_range);
    visit(ParamInfo{"sensor", "max_range", "m", "", "farther returns are dropped", 1, 300}, p.sensor.max_range);

    visit(ParamInfo{"grid", "free", "", "Sec. III.A", "ground | rays: what makes a cell free", 0, 0}, p.grid.free);
}

}  // namespace lidar_obstacles

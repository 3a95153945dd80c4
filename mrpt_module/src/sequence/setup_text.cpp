// SPDX-License-Identifier: BSD-3-Clause
// The words of a SetupReport, and what follows from it.
#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "lidar_obstacles/setup_check.h"

namespace lidar_obstacles {
namespace {

constexpr double kDegrees = 180.0 / M_PI;
constexpr double kMuch = 0.002;  // share of the returns; less are stray ones

std::string words(const char* format, ...) {
    char buffer[200];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(buffer, sizeof buffer, format, arguments);
    va_end(arguments);
    return buffer;
}

std::string sensorLine(const SetupReport& r) {
    if (!r.height) return "sensor: no ground in any scan, so neither height nor tilt are known";
    return words("sensor: %.2f m above the ground, tilted by %.1f deg against it", *r.height, r.tilt * kDegrees);
}

std::string ringsLine(const SetupReport& r) {
    std::string line = r.rings == 0 ? "rings: none named, boxes are less exact" : words("rings: %d", r.rings);
    line += words(", elevations from %.1f to %.1f deg", r.lowest * kDegrees, r.highest * kDegrees);
    for (const int ring : r.silent_rings) line += words(", ring %d is silent", ring);
    return line;
}

std::string rateLine(const SetupReport& r) {
    std::string line = r.rate > 0.0 ? words("rate: %.1f scans/s", r.rate) : std::string("rate: not known");
    if (r.gaps > 0) line += words(", %zu gaps", r.gaps);
    if (r.steps_back > 0) line += words(", %zu scans are not later than the one before", r.steps_back);
    return line;
}

std::string seamLine(const SetupReport& r) {
    if (!r.point_times) return "seam: not known, returns have no times";
    std::string line = r.turn_begins ? words("seam: turns begin at %.0f deg", *r.turn_begins * kDegrees)
                                     : std::string("seam: turns begin at different azimuths");
    return line + (r.torn > 0 ? words(", a surface is torn apart there in %zu of them", r.torn) : std::string());
}

std::string bodyLine(const SetupReport& r) {
    std::string line = words("own body: %.1f %% of the returns are in region.own_body", 100.0 * r.own_share);
    if (!r.own_body.empty()) return line + words(", and %zu more parts stay in place", r.own_body.parts().size());
    if (r.moved) return line + ", nothing else stays in place";
    if (r.near_share > kMuch) line += words(", %.1f %% more are within 1 m of the sensor", 100.0 * r.near_share);
    return line + "; the vehicle hardly moves, or the scans are fewer than 20: more is not known";
}

}  // namespace

std::vector<std::string> toLines(const SetupReport& r) {
    if (r.scans == 0) return {};
    return {
        words("scans: %zu, %.0f returns each, from %.0f deg around", r.scans, r.returns, r.view * kDegrees),
        sensorLine(r),
        words("ground: in %zu of %zu scans, %.0f %% of the returns", r.with_ground, r.scans, 100.0 * r.ground_share),
        ringsLine(r),
        rateLine(r),
        seamLine(r),
        bodyLine(r)};
}

std::vector<std::string> settingsFor(const SetupReport& r, const DetectorParams& params) {
    std::vector<std::string> lines;
    if (r.height && r.tilt * kDegrees > params.ground.max_slope_deg - 3.0)
        lines.push_back(words("ground.max_slope_deg = %.0f   # if the tilt is the road's, not the mount's",
                              std::min(30.0, std::ceil(r.tilt * kDegrees) + 4.0)));
    if (!r.own_body.empty()) {
        std::vector<OwnPart> parts = OwnBody(params.region.own_body).parts();
        parts.insert(parts.end(), r.own_body.parts().begin(), r.own_body.parts().end());
        lines.push_back("region.own_body = " + toText(OwnBody(parts)) + "   # stays in place while the vehicle moves");
    }
    if (r.torn > 0 && !params.deskew.mend_seam)
        lines.push_back("deskew.mend_seam = true   # surfaces are torn apart at the seam");
    return lines;
}

}  // namespace lidar_obstacles

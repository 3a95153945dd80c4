// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/searched_place.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "scan/place_text.h"

namespace lidar_obstacles {
namespace {

/// The sector of "(from, to)" behind its name. @throws std::invalid_argument
Sector sectorOf(const std::string& inside) {
    std::vector<double> numbers;
    for (std::size_t at = inside.find_first_not_of(kBlanks); at != std::string::npos;) {
        const std::size_t end = std::min(inside.find_first_of(kBlanks, at), inside.size());
        double number = 0.0;
        const auto [stop, error] = std::from_chars(inside.data() + at, inside.data() + end, number);
        if (error != std::errc() || stop != inside.data() + end || !(std::abs(number) <= 360.0))
            throw std::invalid_argument("'" + inside.substr(at, end - at) + "' is no azimuth of -360 .. 360 deg");
        numbers.push_back(number);
        at = inside.find_first_not_of(kBlanks, end);
    }
    if (numbers.size() != 2) throw std::invalid_argument("a sector has 2 numbers (azimuth from, to) [deg]");
    if (std::fmod(numbers[1] - numbers[0], 360.0) == 0.0)
        throw std::invalid_argument("'from' and 'to' of a sector must be two directions");
    return {numbers[0], numbers[1]};
}

/// Takes the sectors out of a text. @throws std::invalid_argument
std::vector<Sector> takeSectors(std::string& text) {
    std::vector<Sector> sectors;
    for (std::size_t at = text.find("sector"); at != std::string::npos; at = text.find("sector")) {
        const std::size_t open = text.find_first_not_of(kBlanks, at + 6), close = text.find(')', at);
        if (open == std::string::npos || text[open] != '(' || close == std::string::npos)
            throw std::invalid_argument("a sector is written as sector(from, to)");
        sectors.push_back(sectorOf(text.substr(open + 1, close - open - 1)));
        text.replace(at, close + 1 - at, " ");
    }
    return sectors;
}

Eigen::Vector2d directionOf(double azimuth_deg) {
    const double azimuth = azimuth_deg * M_PI / 180.0;
    return {std::cos(azimuth), std::sin(azimuth)};
}

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

ExcludedPlaces::ExcludedPlaces(const std::string& text) {
    std::string rest = text;
    sectors = takeSectors(rest);
    if (!sectors.empty() && rest.find_first_not_of(kBlanks) == std::string::npos) return;
    try {
        parts = OwnBody(rest);
    } catch (const std::invalid_argument& e) {
        throw std::invalid_argument(std::string(e.what()) + "; expected none, or box(..), polygon(..) and sector(..)");
    }
}

std::string toText(const ExcludedPlaces& places) {
    std::string text = places.parts.empty() && !places.sectors.empty() ? "" : toText(places.parts);
    for (const Sector& s : places.sectors)
        text += (text.empty() ? "sector(" : " sector(") + numberText(s.from_deg) + ", " + numberText(s.to_deg) + ")";
    return text;
}

OwnBody searchedOutline(const std::string& text) {
    try {
        return OwnBody(text);
    } catch (const std::invalid_argument& e) {
        throw std::invalid_argument(std::string(e.what()) + "; expected none, or polygon(..) and box(..)");
    }
}

SearchedPlace::SearchedPlace(const RegionParams& params)
    : front_(static_cast<float>(params.front)),
      rear_(static_cast<float>(-params.rear)),
      side_(static_cast<float>(params.lateral)),
      outline_(searchedOutline(params.outline)) {
    const ExcludedPlaces excluded(params.excluded);
    excluded_ = excluded.parts;
    for (const Sector& s : excluded.sectors) {
        const double turn = std::fmod(s.to_deg - s.from_deg + 720.0, 360.0);
        wedges_.push_back({directionOf(s.from_deg), directionOf(s.to_deg), turn > 180.0});
    }
    whole_ = outline_.empty() && excluded_.empty() && wedges_.empty();
}

bool SearchedPlace::Wedge::holds(const Eigen::Vector2d& p) const {
    const bool behind_from = cross(from, p) >= 0.0, before_to = cross(p, to) > 0.0;
    return wide ? behind_from || before_to : behind_from && before_to;
}

bool SearchedPlace::holdsCut(const Eigen::Vector3f& p) const {
    if (!(outline_.empty() || outline_.holds(p)) || excluded_.holds(p)) return false;
    const Eigen::Vector2d from_above = p.head<2>().cast<double>();
    return std::none_of(wedges_.begin(), wedges_.end(), [&](const Wedge& w) { return w.holds(from_above); });
}

PlaceOfObstacles::PlaceOfObstacles(const RegionParams& params) : searched_(params), own_(params.own_body) {}

}  // namespace lidar_obstacles

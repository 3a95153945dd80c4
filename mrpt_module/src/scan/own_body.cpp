// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/own_body.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "scan/place_text.h"

namespace lidar_obstacles {
namespace {

std::string_view withoutBlanks(std::string_view text) {
    const auto first = text.find_first_not_of(kBlanks);
    return first == std::string_view::npos ? std::string_view{} : text.substr(first);
}

/// Numbers between blanks and commas. @throws std::invalid_argument
std::vector<double> numbersIn(std::string_view text) {
    std::vector<double> numbers;
    for (text = withoutBlanks(text); !text.empty(); text = withoutBlanks(text)) {
        const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
        double number = 0.0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
        if (error != std::errc() || end != word.data() + word.size() || !(std::abs(number) <= 1000.0))
            throw std::invalid_argument("'" + std::string(word) + "' is no number of metres");
        numbers.push_back(number);
        text.remove_prefix(word.size());
    }
    return numbers;
}

OwnPart boxOf(const std::vector<double>& n) {
    if (n.size() != 4 && n.size() != 6)
        throw std::invalid_argument("a box has 4 numbers (x from, to, y from, to) or 6 (z from, to as well)");
    for (std::size_t k = 0; k < n.size(); k += 2)
        if (!(n[k] < n[k + 1])) throw std::invalid_argument("each 'from' of a box must be below its 'to'");
    OwnPart part;
    part.is_box = true;
    part.outline = {{n[0], n[2]}, {n[1], n[2]}, {n[1], n[3]}, {n[0], n[3]}};
    if (n.size() == 6) part.z_min = n[4], part.z_max = n[5];
    return part;
}

OwnPart polygonOf(const std::vector<double>& n) {
    if (n.size() < 6 || n.size() % 2 != 0)
        throw std::invalid_argument("a polygon has two numbers (x y) for each of at least three corners");
    OwnPart part;
    for (std::size_t k = 0; k < n.size(); k += 2) part.outline.emplace_back(n[k], n[k + 1]);
    return part;
}

/// Takes the next part off the text. @throws std::invalid_argument
OwnPart takePart(std::string_view& text) {
    const auto open = text.find('(');
    const auto close = text.find(')');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open)
        throw std::invalid_argument("must be none, or box(..) and polygon(..)");
    std::string_view name = text.substr(0, open);
    name = name.substr(0, name.find_last_not_of(kBlanks) + 1);
    const std::vector<double> numbers = numbersIn(text.substr(open + 1, close - open - 1));
    text = withoutBlanks(text.substr(close + 1));
    if (name == "box") return boxOf(numbers);
    if (name == "polygon") return polygonOf(numbers);
    throw std::invalid_argument("'" + std::string(name) + "' is neither box nor polygon");
}

std::vector<OwnPart> partsOf(const std::string& text) {
    std::string_view rest = withoutBlanks(text);
    std::vector<OwnPart> parts;
    if (rest.substr(0, rest.find_last_not_of(kBlanks) + 1) == "none") return parts;
    if (rest.empty()) throw std::invalid_argument("must be none, or box(..) and polygon(..)");
    while (!rest.empty()) parts.push_back(takePart(rest));
    return parts;
}

/// Even-odd rule: how often a ray from the point to -x crosses the outline.
bool isInside(const std::vector<Eigen::Vector2d>& outline, const Eigen::Vector2d& p) {
    bool inside = false;
    for (std::size_t k = 0, last = outline.size() - 1; k < outline.size(); last = k++) {
        const Eigen::Vector2d& a = outline[k];
        const Eigen::Vector2d& b = outline[last];
        if ((a.y() > p.y()) == (b.y() > p.y())) continue;
        if (p.x() >= a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) inside = !inside;
    }
    return inside;
}

std::string partText(const OwnPart& part) {
    std::string text;
    if (part.is_box) {
        const Eigen::Vector2d &low = part.outline[0], &high = part.outline[2];
        text = "box(" + numberText(low.x()) + ", " + numberText(high.x()) + ", " + numberText(low.y()) + ", " +
               numberText(high.y());
        if (std::isfinite(part.z_min)) text += ", " + numberText(part.z_min) + ", " + numberText(part.z_max);
        return text + ")";
    }
    for (const Eigen::Vector2d& p : part.outline)
        text += (text.empty() ? "polygon(" : ", ") + numberText(p.x()) + " " + numberText(p.y());
    return text + ")";
}

}  // namespace

OwnBody::OwnBody(const std::string& text) : OwnBody(partsOf(text)) {}

OwnBody::OwnBody(std::vector<OwnPart> parts) : parts_(std::move(parts)) {
    for (const OwnPart& part : parts_) {
        bounds_.push_back(boundsOf(part));
        if (bounds_.size() == 1) all_ = bounds_.front();
        all_.low = all_.low.cwiseMin(bounds_.back().low);
        all_.high = all_.high.cwiseMax(bounds_.back().high);
    }
}

OwnBody::Bounds OwnBody::boundsOf(const OwnPart& part) {
    Eigen::Vector2d low = part.outline.front(), high = low;
    for (const Eigen::Vector2d& p : part.outline) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    return {{static_cast<float>(low.x()), static_cast<float>(low.y()), static_cast<float>(part.z_min)},
            {static_cast<float>(high.x()), static_cast<float>(high.y()), static_cast<float>(part.z_max)}};
}

bool OwnBody::inAPart(const Eigen::Vector3f& p) const {
    for (std::size_t k = 0; k < parts_.size(); ++k)
        if (bounds_[k].hold(p) && (parts_[k].is_box || isInside(parts_[k].outline, p.head<2>().cast<double>())))
            return true;
    return false;
}

std::string toText(const OwnBody& body) {
    std::string text;
    for (const OwnPart& part : body.parts()) text += (text.empty() ? "" : " ") + partText(part);
    return text.empty() ? "none" : text;
}

}  // namespace lidar_obstacles

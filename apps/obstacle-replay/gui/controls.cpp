// SPDX-License-Identifier: BSD-3-Clause
#include "controls.h"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <iterator>
#include <stdexcept>

#include "common/message_of.h"

namespace lidar_obstacles::apps {

namespace {

/// Keys that need a recording.
bool needsPlayer(int code) {
    static constexpr int kKeys[] = {' ', kRight, kLeft, kPageDown, kPageUp, kHome, kEnd, 'j', kUp, kDown,  'l',
                                    '1', '2',    '[',   ']',       '/',     'y',   '9',  kF2, kF3, kDelete};
    return std::find(std::begin(kKeys), std::end(kKeys), code) != std::end(kKeys);
}

}  // namespace

const char* toString(CameraMode camera) {
    switch (camera) {
        case CameraMode::Top:
            return "top";
        case CameraMode::Free:
            return "free";
        case CameraMode::Follow:
            break;
    }
    return "follow";
}

/// A key and what it does; a key without a text is told with the one before it.
struct Controls::Binding {
    int code;
    const char* keys;
    const char* text;
    std::function<void(Controls&, const KeyPress&, double)> act;
};

// NOLINTNEXTLINE(readability-function-size): one list, a line or two for each key
const std::vector<Controls::Binding>& Controls::bindings() {
    using C = Controls;
    using K = KeyPress;
    const auto layer = [](Layer l) { return [l](C& c, const K&, double) { c.toggle(l); }; };
    const auto camera = [](CameraMode m) { return [m](C& c, const K&, double) { c.view_.camera = m; }; };
    const auto step = [](int n) { return [n](C& c, const K&, double) { c.player_->step(n); }; };
    const auto zoom = [](int n) { return [n](C& c, const K&, double) { c.view_.zoom += n; }; };
    const auto vertical = [](int n) { return [n](C& c, const K&, double now) { c.upOrDown(n, now); }; };
    const auto change = [](int n, bool coarse) {
        return [n, coarse](C& c, const K&, double) { c.changeParam(n, coarse); };
    };
    const auto asks = [](Question q) { return [q](C& c, const K&, double) { c.ask(q); }; };
    static const std::vector<Binding> kBindings = {
        {' ', "space", "play, pause",
         [](C& c, const K&, double now) { c.player_->playing() ? c.player_->pause() : c.player_->play(now); }},
        {kRight, "right, left", "next, previous scan", step(1)},
        {kLeft, "", "", step(-1)},
        {kPageDown, "page down, up", "ten scans on, back", step(10)},
        {kPageUp, "", "", step(-10)},
        {kHome, "home, end", "first, last scan", [](C& c, const K&, double) { c.player_->first(); }},
        {kEnd, "", "", [](C& c, const K&, double) { c.player_->last(); }},
        {'j', "j", "jump to a scan (120) or time (12.5s, 1:05)", asks(Question::Jump)},
        {kUp, "up, down", "faster, slower", vertical(1)},
        {kDown, "", "", vertical(-1)},
        {']', "], [", "next, previous mark of the timeline", [](C& c, const K&, double) { ++c.view_.marks; }},
        {'[', "", "", [](C& c, const K&, double) { --c.view_.marks; }},
        {'/', "/", "a range to play: from here; to here; all again", [](C& c, const K&, double) { c.markRange(); }},
        {'l', "l", "loop", [](C& c, const K&, double) { c.player_->setLoop(!c.player_->loop()); }},
        {'i', "i, o", "zoom in, out (or mouse wheel)", zoom(-1)},
        {'o', "", "", zoom(1)},
        {'f', "f", "camera follows the vehicle", camera(CameraMode::Follow)},
        {'t', "t", "camera from the top", camera(CameraMode::Top)},
        {'v', "v", "camera free (or drag with the mouse)", camera(CameraMode::Free)},
        {'r', "r", "raw returns", layer(Layer::Raw)},
        {'c', "c", "their colour: height, intensity, ring", [](C& c, const K&, double) { c.nextColor(); }},
        {'g', "g", "ground", layer(Layer::Ground)},
        {'a', "a", "candidates: above the ground", layer(Layer::Candidates)},
        {'z', "z", "returns that the 3D filter took out", layer(Layer::Filtered)},
        {'k', "k", "voxels of the 3D filter", layer(Layer::Voxels)},
        {'m', "m", "occupancy grid map", layer(Layer::Grid)},
        {'n', "n", "cells after morphology", layer(Layer::Morphology)},
        {'u', "u", "clusters", layer(Layer::Clusters)},
        {'x', "x", "rejected clusters: reason measured/limit", layer(Layer::Rejected)},
        {'e', "e", "evidence: plane, hull, line", layer(Layer::Fit)},
        {'b', "b", "boxes and headings", layer(Layer::Boxes)},
        {'3', "3", "tails and speeds of tracks", layer(Layer::Tracks)},
        {'4', "4", "table of obstacles and tracks", [](C& c, const K&, double) { c.view_.tracks = !c.view_.tracks; }},
        {'5', "5", "merges that were weighed: taken, refused", layer(Layer::Merges)},
        {'6', "6", "zones (--zones)", layer(Layer::Zones)},
        {'7', "7", "the region that is searched", layer(Layer::Region)},
        {'8', "8", "legend", [](C& c, const K&, double) { c.view_.legend = !c.view_.legend; }},
        {'9', "9", "image of the next camera, or none", [](C& c, const K&, double) { ++c.view_.images; }},
        {'d', "d", "descriptions of the boxes", layer(Layer::Labels)},
        {'y', "y", "ground truth (--truth)", layer(Layer::Truth)},
        {'0', "0", "all layers on, as before", [](C& c, const K&, double) { c.toggleAll(); }},
        {'1', "1, 2", "dual return: last, strongest on or off",
         [](C& c, const K&, double) { c.toggleDual(&DualReturns::last); }},
        {'2', "", "", [](C& c, const K&, double) { c.toggleDual(&DualReturns::strongest); }},
        {'p', "p", "parameters: up, down choose", [](C& c, const K&, double) { c.view_.panel = !c.view_.panel; }},
        {'+', "+, -", "... change", change(1, false)},
        {'=', "", "", change(1, false)},
        {'-', "", "", change(-1, false)},
        {'.', "., comma", "... change by ten steps", change(1, true)},
        {',', "", "", change(-1, true)},
        {kEnter, "enter", "... type a value", asks(Question::Value)},
        {kBackspace, "backspace", "... back to the default",
         [](C& c, const K&, double) { c.setParams(c.panel_.reset(c.params_.params())); }},
        {'w', "w", "write the parameters as config.ini", asks(Question::SaveAs)},
        {kF2, "F2", "own body, region, zones: edit with the mouse",
         [](C& c, const K&, double) { c.view_.outlines = !c.view_.outlines; }},
        {kDelete, "delete", "... the corner that was touched last",
         [](C& c, const K&, double) { ++c.view_.deletions; }},
        {kF3, "F3", "write the zones as a file", asks(Question::SaveZonesAs)},
        {kF6, "F6", "light or dark", [](C& c, const K&, double) { c.nextTheme(); }},
        {kF7, "F7, F8", "smaller, larger texts", [](C& c, const K&, double) { c.scaleTexts(-1); }},
        {kF8, "", "", [](C& c, const K&, double) { c.scaleTexts(1); }},
        {'s', "s", "screenshot", [](C& c, const K&, double) { ++c.view_.screenshots; }},
        {'h', "h", "help", [](C& c, const K&, double) { c.view_.help = !c.view_.help; }},
        {'q', "q, esc", "quit", [](C& c, const K&, double) { c.view_.quit = true; }},
        {kEscape, "", "", [](C& c, const K&, double) { c.view_.quit = true; }},
    };
    return kBindings;
}

std::vector<KeyHelp> keyTable(bool plays) {
    std::vector<KeyHelp> table;
    for (const auto& b : Controls::bindings())
        if (*b.text != '\0' && (plays || !needsPlayer(b.code))) table.push_back({b.keys, b.text});
    return table;
}

Controls::Controls(Player& player, const LayerSet& layers, PointColor color)
    : Controls(static_cast<ParamsInUse&>(player), layers, color) {
    player_ = &player;
}

Controls::Controls(ParamsInUse& params, const LayerSet& layers, PointColor color) : params_(params), player_(nullptr) {
    view_.layers = layers;
    view_.color = color;
}

void Controls::press(const KeyPress& key, double now) {
    view_.message.clear();
    const bool chooses = view_.panel && (key.code == kUp || key.code == kDown);
    try {
        if (question_ != Question::None) return type(key);
        for (const Binding& b : bindings())
            if (b.code == key.code && (player_ || chooses || !needsPlayer(key.code))) return b.act(*this, key, now);
    } catch (const std::exception& e) {  // what was typed, a combination of parameters, a file that cannot be written
        view_.message = messageOf(e);
    }
}

void Controls::cameraMoved() { view_.camera = CameraMode::Free; }

void Controls::toggle(Layer layer) { view_.layers.flip(static_cast<std::size_t>(layer)); }

void Controls::toggleAll() {
    if (view_.layers.all()) {
        view_.layers = layers_before_all_;
    } else {
        layers_before_all_ = view_.layers;
        view_.layers.set();
    }
}

void Controls::nextColor() {
    view_.color = static_cast<PointColor>((static_cast<int>(view_.color) + 1) % 3);
    view_.layers.set(static_cast<std::size_t>(Layer::Raw));
}

void Controls::nextTheme() { view_.look.theme = view_.look.theme == Theme::Dark ? Theme::Light : Theme::Dark; }

void Controls::scaleTexts(int direction) {
    view_.look = view_.look.scaled(direction);
    char text[32];
    std::snprintf(text, sizeof text, "texts x%g", static_cast<double>(view_.look.text_scale));
    view_.message = text;
}

void Controls::upOrDown(int direction, double now) {
    if (view_.panel) return panel_.choose(-direction);
    direction > 0 ? player_->faster(now) : player_->slower(now);
}

void Controls::changeParam(int direction, bool coarse) {
    if (view_.panel) setParams(panel_.changed(params_.params(), direction, coarse));
}

void Controls::setParams(const DetectorParams& params) {
    if (view_.panel) params_.setParams(params);
}

void Controls::toggleDual(bool DualReturns::* which) {
    DualReturns dual = player_->setup().dual;
    dual.*which = !(dual.*which);
    player_->setDualReturns(dual);
    view_.message = std::string("dual return: last ") + (dual.last ? "on" : "off") + ", strongest " +
                    (dual.strongest ? "on" : "off");
}

/// The first time the range begins here, the second time it ends here, the third time all is played again.
void Controls::markRange() {
    const std::size_t here = player_->aim();
    if (player_->range()) {
        player_->setRange(std::nullopt);
        view_.message = "all scans are played";
    } else if (!range_from_) {
        range_from_ = here;
        view_.message = "the range begins here; / at a later scan ends it";
    } else {
        const std::size_t from = *range_from_;
        range_from_.reset();
        player_->setRange(std::pair(from, here));
        view_.message = "only this range is played; l loops, / plays all again";
    }
}

}  // namespace lidar_obstacles::apps

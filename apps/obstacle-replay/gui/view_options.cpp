// SPDX-License-Identifier: BSD-3-Clause
#include "view_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <sstream>

namespace lidar_obstacles::apps {
namespace {

std::string layerNames() {
    std::string names;
    for (std::size_t k = 0; k < kLayers; ++k) names += (k ? ", " : "") + std::string(toString(static_cast<Layer>(k)));
    return names;
}

LayerSet readLayers(const std::string& list) {
    if (list == "all") return LayerSet().set();
    LayerSet layers;
    std::istringstream in(list);
    for (std::string name; std::getline(in, name, ',');) {
        const auto layer = layerOf(name);
        if (!layer) throw UsageError("--layers: '" + name + "' is none of " + layerNames());
        layers.set(static_cast<std::size_t>(*layer));
    }
    return layers;
}

PointColor readColor(const std::string& word) {
    for (const PointColor c : {PointColor::Height, PointColor::Intensity, PointColor::Ring})
        if (word == toString(c)) return c;
    throw UsageError("--color " + word + ": must be height, intensity or ring");
}

/// "800x600"; both even, as videos want them.
void readSize(const std::string& text, int& width, int& height) {
    const char* end = text.data() + text.size();
    const auto [cross, first] = std::from_chars(text.data(), end, width);
    const auto [stop, second] = cross == end ? std::from_chars_result{end, std::errc::invalid_argument}
                                             : std::from_chars(cross + 1, end, height);
    const bool good = first == std::errc() && second == std::errc() && *cross == 'x' && stop == end;
    if (!good || width < 64 || height < 64 || width > 7680 || height > 4320 || width % 2 != 0 || height % 2 != 0)
        throw UsageError("--size " + text + ": must be WIDTHxHEIGHT, even numbers from 64x64 to 7680x4320");
}

}  // namespace

const char* toString(Theme theme) { return theme == Theme::Light ? "light" : "dark"; }

Look Look::scaled(int direction) const {
    Look other = *this;
    other.text_scale = std::clamp(text_scale + kStep * static_cast<float>(direction), kSmallest, kLargest);
    return other;
}

void addLookOptions(CLI::App& app, Look& look) {
    app.add_option_function<std::string>(
           "--theme", [&look](const std::string& word) { look.theme = word == "light" ? Theme::Light : Theme::Dark; },
           "of the window: dark or light (F6)")
        ->check(CLI::IsMember({"dark", "light"}))
        ->default_str("dark");
    app.add_option("--text-scale", look.text_scale, "size of the window's texts, 0.5 to 3 (F7, F8)")
        ->check(CLI::Range(Look::kSmallest, Look::kLargest))
        ->capture_default_str();
}

void addViewOptions(CLI::App& app, ViewOptions& o) {
    app.add_flag("--gui", o.gui, "show the scans in a window instead of writing results; h lists the keys");
    app.add_option("--record", o.record, "draw the run, too, into DIR/frame_NNNNNN.png or a video; needs no display")
        ->type_name("DIR|FILE.mp4");
    app.add_option("--truth", o.truth, "labelled objects to draw (*_gt.csv)")->type_name("FILE");
    app.add_option("--truth-fov", o.truth_fov_deg,
                   "angle ahead that is labelled [deg]: beyond it no box is marked as a phantom (KITTI: 80)")
        ->type_name("DEG")
        ->check(CLI::Range(1.0, 360.0))
        ->capture_default_str();
    app.add_option("--layers", o.layer_list, "what window and video show at first: all, or some of " + layerNames())
        ->type_name("LIST");
    app.add_option("--color", o.color_word, "colour of the layer raw: height, intensity or ring")->type_name("WORD");
    app.add_option("--size", o.size_text,
                   "of window, video and pictures [pixels]; without it 800x600, and 1280x800 of --pictures")
        ->type_name("WxH");
    addLookOptions(app, o.look);
    app.add_option("--gui-log", o.log, "write what the window shows as JSON lines, for tests")->type_name("FILE");
}

void finishViewOptions(ViewOptions& o) {
    if (!o.layer_list.empty())
        o.layers = readLayers(o.layer_list);
    else if (!o.truth.empty())
        o.layers.set(static_cast<std::size_t>(Layer::Truth));
    o.color = readColor(o.color_word);
    if (!o.size_text.empty()) {
        readSize(o.size_text, o.width, o.height);
        o.picture_width = o.width;
        o.picture_height = o.height;
    }
    const std::string extension = std::filesystem::path(o.record).extension();
    for (const char* other : {".avi", ".mkv", ".mov", ".webm", ".gif", ".m4v"})
        if (extension == other) throw UsageError("--record " + o.record + ": videos are written as .mp4");
    if (o.gui && !o.record.empty()) throw UsageError("--gui and --record: one of the two");
}

}  // namespace lidar_obstacles::apps

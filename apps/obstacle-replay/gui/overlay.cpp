// SPDX-License-Identifier: BSD-3-Clause
#include "overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <vector>

#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles::apps {
namespace {

constexpr const char* kFont = "6x13";
constexpr int kColumn = 6;  // width of its characters [pixels] ...
constexpr int kLine = 13;   // ... and height
constexpr mrpt::img::TColor kInk(224, 230, 240);
constexpr mrpt::img::TColor kPaper(5, 5, 8);
constexpr int kMargin = 4;  // around texts [pixels]

template <class... Values>
std::string format(const char* pattern, Values... values) {
    char buffer[256];
    std::snprintf(buffer, sizeof buffer, pattern, values...);
    return buffer;
}

std::string playText(const Player& player) {
    std::string text = player.playing() ? "playing" : "paused";
    text += player.speed() > 100 ? ", as fast as it goes" : format(", x%g", player.speed());
    if (player.loop()) text += ", loop";
    if (player.seeking()) text += ", waiting for the scan or its poses";
    if (!player.store().complete()) text += format(", reading %.0f %%", 100.0 * player.store().progress());
    return text;
}

std::string posesText(const PoseIndex& poses, bool provisional) {
    if (poses.source().kind == EgoKind::None) return poses.complete() ? "no poses" : "looking for poses";
    std::string text = "poses of '" + poses.source().label + "' (" + toString(poses.source().kind) + ")";
    if (!poses.complete()) text += provisional ? ", reading, not yet up to this scan" : ", reading";
    if (poses.refused() > 0) text += format(", %zu refused", poses.refused());
    return text;
}

std::string stateText(const Player& player, const std::string& file) {
    const auto scan = player.shown();
    if (!scan) return file + "\nreading ...";
    const ScanStore& store = player.store();
    std::string text = file + "\n" +
                       format("scan %zu of %zu to %zu, %.2f s, ", scan->scan_index, store.scanIndex(0),
                              store.scanIndex(store.size() - 1), player.elapsed()) +
                       recordingTime(scan->cloud.timestamp) + "\n" + playText(player) + "\n";
    text += scan->error.empty() ? countsText(*scan) : scan->error;
    if (const PoseIndex* poses = player.poses()) text += "\n" + posesText(*poses, player.provisional());
    const std::string problem = store.problem();
    return problem.empty() ? text : text + "\n" + problem;
}

std::string trackRow(const Obstacle& o) {
    const TrackState& t = *o.track;
    const float p = probabilityOf(o);
    const std::string speed = t.velocity ? format("%.1f", t.moving ? t.velocity->norm() : 0.0) : "-";
    return format("%5d %-10s %5.1f %5s %6.1f %4s %s", o.id, toString(o.cls), distanceTo(o.box), speed.c_str(), t.age,
                  p > 0.F ? format("%.2f", static_cast<double>(p)).c_str() : "-",
                  !t.seen       ? "hidden"
                  : t.age > 0.0 ? ""
                                : "new");
}

int heightOf(const std::string& text) {
    return 2 * kMargin + kLine * (1 + static_cast<int>(std::count(text.begin(), text.end(), '\n')));
}

int widthOf(const std::string& text) {
    std::size_t longest = 0;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        longest = std::max(longest, end - at);
        at = end + 1;
    }
    return 2 * kMargin + kColumn * static_cast<int>(longest);
}

}  // namespace

std::string recordingTime(double timestamp) {
    const auto seconds = static_cast<std::time_t>(std::floor(timestamp));
    std::tm utc{};
    gmtime_r(&seconds, &utc);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &utc);
    return text + format(".%03d UTC", static_cast<int>(1e3 * (timestamp - std::floor(timestamp))));
}

std::string countsText(const ShownScan& scan) {
    const DetectionResult& r = scan.result;
    const auto ground = std::count(r.ground.is_ground.begin(), r.ground.is_ground.end(), 1);
    std::string text = format("%zu returns, %td ground (%s), %zu candidates, %zu cells\n", scan.cloud.size(), ground,
                              toString(r.ground.evidence), r.candidates.size(), r.grid.occupied.size());
    std::map<std::string, int> classes;
    for (const Obstacle& o : r.obstacles) ++classes[toString(o.cls)];
    text += format("%zu obstacles", r.obstacles.size());
    const char* separator = ": ";
    for (const auto& [name, count] : classes) {
        text += separator + std::to_string(count) + " " + name;
        separator = ", ";
    }
    text += format("; %zu rejected", r.clusters.rejected.size());
    return scan.used.empty() ? text : text + "\n" + scan.used;
}

std::string timesText(const ShownScan& scan) {
    std::string text;
    if (scan.decode_ms > 0.0) text = format("%-10s %6.2f ms\n", "decode", scan.decode_ms);
    for (const StageTime& t : scan.result.timing) text += format("%-10s %6.2f ms\n", t.stage, t.ms);
    return text + format("%-10s %6.2f ms", "total", totalMs(scan));
}

std::string tracksText(const ShownScan& scan, std::size_t rows) {
    std::vector<const Obstacle*> tracks;
    for (const Obstacle& o : scan.result.obstacles)
        if (o.track) tracks.push_back(&o);
    std::stable_sort(tracks.begin(), tracks.end(),
                     [](const Obstacle* a, const Obstacle* b) { return distanceTo(a->box) < distanceTo(b->box); });
    std::string text = format("%5s %-10s %5s %5s %6s %4s", "track", "class", "m", "m/s", "age s", "p");
    for (std::size_t k = 0; k < std::min(rows, tracks.size()); ++k) text += "\n" + trackRow(*tracks[k]);
    if (tracks.empty()) text += "\nno tracks";
    return tracks.size() > rows ? text + format("\n      and %zu more", tracks.size() - rows) : text;
}

std::string layersText(const LayerSet& layers, PointColor color) {
    std::string text;
    for (std::size_t k = 0; k < kLayers; ++k) {
        if (!layers[k]) continue;
        const auto layer = static_cast<Layer>(k);
        text += (text.empty() ? "" : " ") + std::string(toString(layer));
        if (layer == Layer::Raw) text += std::string("(") + toString(color) + ")";
    }
    return text.empty() ? "no layers" : text;
}

std::string helpText(bool plays) {
    std::string text;
    for (const KeyHelp& k : keyTable(plays))
        text += format("%s%-15s %s", text.empty() ? "" : "\n", k.keys.c_str(), k.text.c_str());
    return text;
}

OverlayTexts overlayTexts(const Player& player, const Controls& controls, const std::string& file) {
    const ViewState& view = controls.view();
    OverlayTexts texts;
    texts.state = stateText(player, file);
    if (player.shown()) texts.times = timesText(*player.shown());
    texts.layers = std::string("camera ") + toString(view.camera) + ", h: help\n" + layersText(view.layers, view.color);
    texts.bottom = view.prompt.empty() ? view.message : view.prompt;
    if (view.help) texts.middle = helpText();
    return texts;
}

/// Each text is a picture in a viewport of its own: letters drawn one by one cost more than the rest of the scene.
Overlay::Overlay(const mrpt::opengl::COpenGLScene::Ptr& scene) {
    for (const char* name : {"hud_state", "hud_times", "hud_middle", "hud_layers", "hud_bottom", "hud_tracks"}) {
        blocks_[name].view = scene->createViewport(name);
        paint("", blocks_[name]);
    }
}

void Overlay::write(const OverlayTexts& texts) {
    const int below = heightOf(texts.state) + 2 * kMargin;
    put("hud_state", {kMargin, -kMargin}, texts.state);
    put("hud_times", {-kMargin, -kMargin}, texts.times);
    put("hud_middle", {kMargin, -below}, texts.middle);
    put("hud_layers", {kMargin, kMargin}, texts.layers);
    put("hud_tracks", {-kMargin, kMargin}, texts.tracks);
    put("hud_bottom", {kMargin, 2 * kMargin + heightOf(texts.layers)}, texts.bottom);
}

/// Makes a text a block of its own, at a place that counts from the right and from the top where negative.
void Overlay::put(const std::string& name, const std::array<int, 2>& at, const std::string& text) {
    Block& block = blocks_.at(name);
    if (block.text == text && block.at == at) return;
    block.text = text;
    block.at = at;
    paint(text, block);
}

void Overlay::paint(const std::string& text, Block& block) {
    const int width = text.empty() ? 2 : widthOf(text);
    const int height = text.empty() ? 2 : heightOf(text);
    mrpt::img::CImage picture(static_cast<unsigned>(width), static_cast<unsigned>(height), mrpt::img::CH_RGB);
    picture.filledRectangle(0, 0, width - 1, height - 1, kPaper);
    picture.selectTextFont(kFont);
    int y = kMargin;
    for (std::size_t at = 0; at < text.size(); y += kLine) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        picture.textOut(kMargin, y, text.substr(at, end - at), kInk);
        at = end + 1;
    }
    block.view->setImageView(std::move(picture));
    const auto& at = block.at;
    block.view->setViewportPosition(at[0] < 0 ? at[0] - width : at[0], at[1] < 0 ? at[1] - height : at[1], width,
                                    height);
}

}  // namespace lidar_obstacles::apps

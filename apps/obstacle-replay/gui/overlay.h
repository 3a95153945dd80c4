// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The words on the screen.
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include <array>
#include <map>
#include <string>

#include "controls.h"
#include "player.h"

namespace lidar_obstacles::apps {

/// What stands where; empty texts are not drawn. Lines end with '\n'.
struct OverlayTexts {
    std::string state;   ///< top left: file, scan, counts
    std::string times;   ///< top right: milliseconds per stage
    std::string layers;  ///< bottom left: what is shown
    std::string bottom;  ///< above it: a question, or the last message
    std::string middle;  ///< left: help
    std::string tracks;  ///< bottom right: table of tracks
};

/// "2016-01-21 08:18:02.345 UTC". @param timestamp  seconds since the epoch.
std::string recordingTime(double timestamp);
/// The counts of one scan: returns by stage, cells, obstacles by class, rejected clusters.
std::string countsText(const ShownScan& scan);
/// Milliseconds per stage, a line each; decoding only where it was timed.
std::string timesText(const ShownScan& scan);
/// A line per track, the nearest first: id, class, distance, speed, age, probability; "-": not known.
/// @param rows  at most so many; a last line says how many more there are.
std::string tracksText(const ShownScan& scan, std::size_t rows);
std::string layersText(const LayerSet& layers, PointColor color);
/// @param plays  with the keys that need a recording.
std::string helpText(bool plays = true);

/// @param file  name of what is played.
OverlayTexts overlayTexts(const Player& player, const Controls& controls, const std::string& file);

/// Writes the texts over a scene; those that have not changed are left alone.
class Overlay {
  public:
    /// Adds what it needs to the scene.
    explicit Overlay(const mrpt::opengl::COpenGLScene::Ptr& scene);
    void write(const OverlayTexts& texts);

  private:
    struct Block {
        mrpt::opengl::COpenGLViewport::Ptr view;
        std::string text;
        std::array<int, 2> at{1, 1};
    };
    static void paint(const std::string& text, Block& block);
    void put(const std::string& name, const std::array<int, 2>& at, const std::string& text);

    std::map<std::string, Block> blocks_;
};

}  // namespace lidar_obstacles::apps

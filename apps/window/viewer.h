// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the windows of obstacle-replay and obstacle-live share: the scene, its labels and legend, the chosen obstacle,
/// the table.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "explain.h"
#include "history.h"
#include "image_texture.h"
#include "label_layout.h"
#include "outline_editor.h"
#include "screen.h"
#include "window_layout.h"

namespace lidar_obstacles::apps {

/// Texts over the scene; empty ones are not drawn.
struct SceneTexts {
    std::string state;   ///< top left
    std::string times;   ///< top right, where there is room
    std::string layers;  ///< bottom left
    std::string bottom;  ///< above it: a question, or the last message
    std::string help;    ///< left
};

/// What a frame shows beside the scan.
struct ViewerFrame {
    const ViewState& view;
    SceneTexts texts;
    std::function<const std::vector<HistoryPoint>&(const Obstacle&)> history;
    std::function<void()> parameters = nullptr;                 ///< fills a panel; null: there is none
    std::function<void(const ScreenRect&)> timeline = nullptr;  ///< draws a panel of that place; null: there is none
    std::shared_ptr<const CameraImage> image = nullptr;         ///< of the scan; null: none is shown
    const OutlineEditor* outlines = nullptr;                    ///< null: none are edited
};

/// A column of the table that it is sorted by.
enum class TableColumn : std::uint8_t { Id, Class, Distance, Speed, Age, Probability, Returns, Count };
/// The obstacles' places in that order; what is not known comes last.
std::vector<std::size_t> sortedBy(const std::vector<Obstacle>& obstacles, TableColumn column, bool ascending);

class Viewer {
  public:
    Viewer(const std::string& title, int width, int height);

    Screen& screen() { return screen_; }
    const Screen& screen() const { return screen_; }
    const SceneLayers& layers() const { return layers_; }
    void setScan(const std::shared_ptr<const LayerData>& scan);
    /// Draws everything; clicks in the scene and the table choose obstacles.
    void draw(const ViewerFrame& frame);

    /// The number of the chosen obstacle; none if nothing is chosen.
    const std::optional<int>& chosen() const { return chosen_; }
    void choose(std::optional<int> id) { chosen_ = id; }
    /// The chosen obstacle of the scan that is shown; null if it is not in it.
    const Obstacle* chosenObstacle() const;
    /// The ground as it was drawn last, for what the mouse does. Valid until the next draw() or setScan().
    GroundView ground(const Projection& projection) const { return {projection, groundModel()}; }
    Projection projection() const { return Projection(screen_.camera(), drawn_.layout.scene); }
    /// True once after the table has moved the camera.
    bool tookCamera();

    /// What was drawn last, for tests.
    struct Drawn {
        WindowLayout layout;
        std::vector<PlacedLabel> labels;
        std::vector<std::string> legend;                   ///< its lines; empty while it is hidden
        std::vector<int> rows;                             ///< of the table: numbers of the obstacles
        std::vector<Eigen::Vector2f> row_at;               ///< and where they are [pixels]
        std::map<std::string, Eigen::Vector2f> header_at;  ///< titles of its columns
        std::vector<Line> numbers;                         ///< of the chosen obstacle
        std::vector<std::string> reasons;
        std::vector<Line> features;                          ///< empty while their list is folded
        Eigen::Vector2f features_at{0.F, 0.F};               ///< the title that folds it [pixels]
        std::size_t history = 0;                             ///< scans in its plots
        std::vector<std::string> plots;                      ///< their names
        ScreenRect image;                                    ///< where the camera's image itself is; no height: nowhere
        std::vector<std::vector<Eigen::Vector2f>> outlines;  ///< corners of those that are edited [pixels]
        std::map<int, Eigen::Vector2f> in_image;  ///< middles of the boxes with edges in it, by number [pixels]
    };
    const Drawn& drawn() const { return drawn_; }

  private:
    const GroundModel& groundModel() const;
    void takeClicks();
    bool timesShown(const SceneTexts& texts) const;
    void drawLabels(const ViewerFrame& frame);
    void drawChosen() const;
    void drawOutlines(const OutlineEditor& editor);
    void drawTexts(const ViewerFrame& frame) const;
    void drawImage(const ViewerFrame& frame);
    void drawBoxesInImage(const ViewerFrame& frame);
    void drawSide(const ViewerFrame& frame);
    void drawDetails(const ViewerFrame& frame);
    void drawFeatures(const Obstacle& obstacle);
    void drawTable();
    void drawRow(const Obstacle& obstacle);
    void centreOn(const Obstacle& obstacle);

    Screen screen_;
    SceneLayers layers_;
    ImageTexture texture_;
    std::shared_ptr<const LayerData> scan_;
    std::optional<int> chosen_;
    std::string chosen_name_;
    TableColumn sorted_by_ = TableColumn::Distance;
    bool ascending_ = true;
    bool took_camera_ = false;
    std::shared_ptr<const LayerData> measured_;  ///< scan that `features_` are of
    std::optional<int> measured_id_;
    std::vector<Line> features_;
    Drawn drawn_;
};

/// Calls ImGui::Begin for a panel that stays in its place; ImGui::End is for the caller.
/// @param flags  more of ImGuiWindowFlags.
void beginPanel(const char* name, const ScreenRect& at, int flags = 0);
/// The place of the legend, at the lower right of the scene.
ScreenRect legendRect(const ScreenRect& scene, const LayerSet& layers);
/// The colour of a class, as Dear ImGui packs them.
std::uint32_t classColor(ObstacleClass cls);
/// A legend of what the colours of the visible layers mean. @return its lines.
std::vector<std::string> drawLegend(const ScreenRect& scene, const LayerSet& layers);
/// Plots of speed, distance, size and class probabilities over time; nothing without points. @return their names.
std::vector<std::string> drawPlots(const std::vector<HistoryPoint>& points, double now);

}  // namespace lidar_obstacles::apps

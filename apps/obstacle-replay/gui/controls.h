// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Keys -> what is shown: the state of the window, without a window.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/scene_layers.h"
#include "look.h"
#include "param_panel.h"
#include "player.h"

namespace lidar_obstacles::apps {

/// Keys that are no characters.
enum Key : int {
    kEnter = 13,
    kEscape = 27,
    kBackspace = 8,
    kLeft = 1000,
    kRight,
    kUp,
    kDown,
    kHome,
    kEnd,
    kPageUp,
    kPageDown,
    kDelete,
    kF2,
    kF3,
    kF6,
    kF7,
    kF8
};

struct KeyPress {
    int code = 0;  ///< a Key, or a character in lower case
    bool shift = false;
};

enum class CameraMode : std::uint8_t {
    Follow,  ///< from behind the vehicle; set anew with every scan
    Top,     ///< from straight above, forward is up
    Free     ///< where the mouse put it
};
/// "follow", "top" or "free".
const char* toString(CameraMode camera);

/// What the window shows beside the scan.
struct ViewState {
    LayerSet layers;
    PointColor color = PointColor::Height;
    CameraMode camera = CameraMode::Follow;
    Look look;
    bool help = false;
    bool panel = false;
    bool tracks = false;  ///< the table of obstacles and tracks
    bool legend = true;
    bool outlines = false;  ///< own body, region and zones are edited with the mouse
    std::string prompt;     ///< a question and what has been typed; empty if nothing is asked
    std::string message;    ///< of the last key; empty if it had none
    int zoom = 0;           ///< steps since the start, up: away
    int marks = 0;          ///< marks further since the start
    int images = 0;         ///< cameras further since the start
    int screenshots = 0;    ///< asked for since the start
    int deletions = 0;      ///< of corners, asked for since the start
    bool quit = false;
};

/// A key of the help: what stands on it and what it does.
struct KeyHelp {
    std::string keys;
    std::string text;
};
/// All keys, in the order of the help. @param plays  with those that need a recording.
std::vector<KeyHelp> keyTable(bool plays = true);

/// Turns keys into changes of the player and of the view.
class Controls {
  public:
    Controls(Player& player, const LayerSet& layers, PointColor color);
    /// Without a recording: the keys of playing do nothing.
    Controls(ParamsInUse& params, const LayerSet& layers, PointColor color);

    /// @param now  the player's clock [s].
    void press(const KeyPress& key, double now);
    /// The mouse has moved the camera.
    void cameraMoved();
    void setLook(const Look& look) { view_.look = look; }
    /// The file that zones came from: the one that is offered for saving them.
    void setZonesFile(const std::string& file) { zones_file_ = file; }
    /// Puts a line on the screen.
    void say(const std::string& message) { view_.message = message; }

    const ViewState& view() const { return view_; }
    const ParamPanel& panel() const { return panel_; }
    ParamPanel& panel() { return panel_; }

  private:
    enum class Question : std::uint8_t { None, Jump, Value, SaveAs, SaveZonesAs, Overwrite };
    struct Binding;
    static const std::vector<Binding>& bindings();
    friend std::vector<KeyHelp> keyTable(bool plays);

    void ask(Question question);
    void type(const KeyPress& key);
    void answer();
    void toggle(Layer layer);
    void toggleAll();
    void nextColor();
    void nextTheme();
    void scaleTexts(int direction);
    void upOrDown(int direction, double now);
    void changeParam(int direction, bool coarse);
    void setParams(const DetectorParams& params);
    void toggleDual(bool DualReturns::* which);
    std::string questionText() const;
    void saveUnlessThere(Question what, const std::string& file);
    void save(Question what, const std::string& file);
    void markRange();

    ParamsInUse& params_;
    Player* player_;  ///< null: nothing is played
    ViewState view_;
    ParamPanel panel_;
    LayerSet layers_before_all_;
    std::optional<std::size_t> range_from_;  ///< a range begins here and has no end yet
    Question question_ = Question::None;
    std::string typed_;
    Question saved_ = Question::None;  ///< what a file that is there already would be overwritten with
    std::string file_;                 ///< that file
    std::string zones_file_ = "zones.yaml";
};

}  // namespace lidar_obstacles::apps

// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What became of each obstacle over the scans, and the scans worth a look.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/health.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

/// An obstacle in one scan.
struct HistoryPoint {
    double time = 0.0;           ///< of the scan [s since the epoch]
    Eigen::Vector2f center;      ///< vehicle frame [m]
    float distance = 0;          ///< from the vehicle's origin to the nearest point of the box [m]
    Eigen::Vector3f size;        ///< of the box: length, width, height [m]
    std::optional<float> speed;  ///< over ground [m/s]; none where it is not known
    ClassProbabilities classes{};
    std::size_t scan = 0;  ///< place of the scan in what was recorded
};

enum class MarkKind : std::uint8_t { NewTrack, LostTrack, GroundLost, LateScan, Phantom, Fault, SlowScan };
/// "new track", "lost track", "ground lost", "late scan", "phantom", "sensor fault" or "slow scan".
const char* toString(MarkKind kind);

/// A scan worth a look.
struct Mark {
    std::size_t scan = 0;  ///< its place
    MarkKind kind = MarkKind::NewTrack;
    std::string text;  ///< "vehicle 12 is new"
};

/// What is known of a scan beside what was found in it.
struct ScanNotes {
    std::vector<int> phantoms = {};  ///< numbers of obstacles where the truth has nothing: marked where each begins
    HealthReport health = {};        ///< of the sensor after it: each fault is marked where it is first reported
    double took = 0.0;  ///< to process it [s]; where this begins to be longer than from scan to scan, that is marked
};

/// Scans one after the other. Structure has no history. A track counts as new with the first scan in which it is sure
/// (of an age above zero), and as lost with the last one that has it; all tracks of the first scan are there from the
/// start. Memory: some 75 bytes per road user and scan, unless only the last `seconds` are kept.
class History {
  public:
    /// @param seconds  how much is kept; 0: all.
    explicit History(double seconds = 0.0) : seconds_(seconds) {}

    void add(const DetectionResult& result, double time, const ScanNotes& notes = {});
    void clear() { *this = History(seconds_); }
    std::size_t scans() const { return scans_; }

    /// The obstacle of that number, oldest first; empty for an unknown one.
    const std::vector<HistoryPoint>& of(int id) const;
    /// The number of the obstacle that is within half a metre of a place in a scan; nothing if there is none.
    std::optional<int> at(std::size_t scan, const Eigen::Vector2d& center) const;
    /// Rising.
    const std::vector<Mark>& marks() const { return marks_; }

  private:
    void note(MarkKind kind, std::size_t scan, const std::string& text);
    void noteTime(double time, double took);
    void noteFaults(const HealthReport& health);
    void noteTracks(const DetectionResult& result);
    void notePhantoms(const DetectionResult& result, const std::vector<int>& phantoms);
    void forget(double before);

    struct Followed {
        std::size_t last = 0;  ///< scan that had it
        std::string name;
        bool told = false;  ///< that it is new
    };
    double seconds_;
    std::size_t scans_ = 0;
    bool had_ground_ = false;
    double last_time_ = 0.0;
    double usual_gap_ = 0.0;  ///< between scans [s]; 0: not known
    std::map<int, std::vector<HistoryPoint>> points_;
    std::vector<std::vector<int>> ids_;  ///< by scan, where all is kept
    std::map<int, Followed> followed_;
    std::vector<int> phantoms_;  ///< of the last scan
    HealthReport health_;        ///< after it
    bool was_slow_ = false;
    std::vector<Mark> marks_;
};

/// The next place with marks after (+1) or before (-1) a scan; nothing if there is none.
std::optional<std::size_t> nextMark(const std::vector<Mark>& marks, std::size_t scan, int direction);

}  // namespace lidar_obstacles::apps

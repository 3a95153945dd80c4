// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is shown of a file, and how it moves on: no window, no keys.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "params_in_use.h"
#include "pose_index.h"
#include "scan_store.h"
#include "sequence.h"
#include "shown_scan.h"

namespace lidar_obstacles::apps {

/// Plays the scans of a store. Times are seconds of any clock that runs evenly, given by the caller. A few processed
/// scans are kept, so that stepping to and fro costs nothing; a change of parameters drops them and processes the scan
/// that is shown again. Poses are read by a thread of their own from when the parameters first use them. No call waits
/// for them: a scan is shown when those that belong to it are known, but the first one, and the one that is shown when
/// parameters change, at once, and again when they are.
class Player : public ParamsInUse {
  public:
    /// Speeds that faster() and slower() choose from.
    static constexpr std::array<double, 9> kSpeeds = {0.1, 0.25, 0.5, 1, 2, 4, 8, 16, 1000};

    /// @param store  must outlive the player.
    /// @throws std::invalid_argument if the parameters do not fit each other or name poses that the file has not,
    ///     std::runtime_error if their map cannot be read.
    Player(const ScanStore& store, const DetectorSetup& setup, TruthByScan truth);

    /// Moves on: to the next scan if it is due, to where a seek led as soon as the index is that far.
    /// @return true if another scan (or the same with other parameters) is shown than after the last call.
    bool tick(double now);

    void play(double now);
    void pause() { playing_ = false; }
    bool playing() const { return playing_; }
    void setLoop(bool loop) { loop_ = loop; }
    bool loop() const { return loop_; }
    void faster(double now) { setSpeed(speed_at_ + 1, now); }
    void slower(double now) { setSpeed(speed_at_ - 1, now); }
    /// Scans per scan of the recording; the largest means: as fast as they can be shown.
    double speed() const { return kSpeeds[static_cast<std::size_t>(speed_at_)]; }

    /// Plays these places of the index only, and loops over them; none: all. @throws std::invalid_argument if the first
    /// one is not before the last.
    void setRange(std::optional<std::pair<std::size_t, std::size_t>> range);
    const std::optional<std::pair<std::size_t, std::size_t>>& range() const { return range_; }
    /// Seeks, in places of the index; pauses. What lies behind the end means the last scan.
    void step(std::ptrdiff_t scans);
    void first() { seek(0); }
    void goTo(std::size_t index) { seek(index); }
    void last();
    /// "120": scan number 120; "12.5s" or "1:05": that much after the first scan.
    /// @throws std::invalid_argument if it is neither.
    void jump(const std::string& where);

    /// The scan that is shown; null before the first one.
    std::shared_ptr<const ShownScan> shown() const { return shown_; }
    /// The labelled objects of the scan at a place of the index; null where there are none.
    const std::vector<TruthBox>* truthAt(std::size_t index) const;
    /// True while it is shown without all poses that belong to it.
    bool provisional() const { return provisional_; }
    /// Its place in the index.
    std::size_t position() const { return position_; }
    /// The place that a step or a jump to a place is about to show; else position().
    std::size_t aim() const;
    /// True while a seek waits for the index, or for the poses of the scan.
    bool seeking() const { return wanted_.has_value(); }
    const ScanStore& store() const { return store_; }
    /// Seconds from the first scan to the shown one.
    double elapsed() const;

    /// A sequence of its own with the same parameters and poses.
    std::unique_ptr<Sequence> anotherSequence() const { return sequenceFor(setup(), poses_); }
    /// Rises when parameters change, or poses that came late: what was found before is not what is found now.
    std::size_t generation() const { return generation_; }
    const DetectorSetup& setup() const { return sequence_->setup(); }
    const DetectorParams& params() const override { return setup().params; }
    /// Where the poses come from; null where none are used or known.
    const PoseIndex* poses() const { return usesPoses(setup().params) && poses_ ? poses_->index.get() : nullptr; }
    /// Shows the scan with other parameters.
    /// @throws as the constructor, and if they do not fit the sensor; all stays as it was then.
    void setParams(const DetectorParams& params) override { change({params, setup().dual, setup().zones}); }
    /// Shows the scan with other zones, too. @throws std::invalid_argument as validate() of zones
    void setOutlines(const DetectorParams& params, const ZoneSet& zones) { change({params, setup().dual, zones}); }
    void setDualReturns(const DualReturns& dual) { change({setup().params, dual, setup().zones}); }

  private:
    enum class Target : std::uint8_t { Place, Scan, Time, Last };
    struct Wanted {
        Target target;
        double value;
    };

    void seek(std::size_t index) { want({Target::Place, static_cast<double>(index)}); }
    void want(const Wanted& wanted);
    std::optional<std::size_t> found(const Wanted& wanted) const;
    void advance(double now);
    void show(std::size_t index);
    void keep(std::size_t index, std::shared_ptr<const ShownScan> scan);
    void change(const DetectorSetup& setup);
    void setSpeed(int at, double now);
    void settle();
    std::shared_ptr<const ShownScan> process(std::size_t index, Sequence& sequence) const;

    struct Poses {
        std::string source;                      ///< as [ego] source names it
        std::shared_ptr<const PoseIndex> index;  ///< null: the file has none
    };
    std::optional<Poses> posesFor(const DetectorParams& params) const;
    std::unique_ptr<Sequence> sequenceFor(const DetectorSetup& setup, const std::optional<Poses>& poses) const;

    const ScanStore& store_;
    std::optional<Poses> poses_;  ///< set when they were first used
    std::unique_ptr<Sequence> sequence_;
    bool settled_ = false;  ///< the shown scan was processed with all poses
    bool provisional_ = false;
    TruthByScan truth_;
    std::deque<std::pair<std::size_t, std::shared_ptr<const ShownScan>>> kept_;  ///< the one used last in front
    std::shared_ptr<const ShownScan> shown_;
    std::shared_ptr<const ShownScan> told_;  ///< that tick() told of
    std::size_t position_ = 0;
    std::optional<Wanted> wanted_;
    std::size_t generation_ = 1;
    std::optional<std::pair<std::size_t, std::size_t>> range_;
    bool playing_ = false;
    bool loop_ = false;
    int speed_at_ = 3;
    double shown_at_ = 0.0;  ///< when the shown scan was due
};

}  // namespace lidar_obstacles::apps

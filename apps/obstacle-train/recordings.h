// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Recordings of the user's own, with truth, as further examples beside the simulated ones.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "box_labels.h"
#include "common/lidar_scans.h"
#include "lidar_obstacles/params.h"
#include "samples.h"

namespace lidar_obstacles::apps {

/// How recordings are read.
struct RecordingOptions {
    InputChoice choice;       ///< which lidar of each
    int every = 5;            ///< of the labelled scans every so many are used
    double view_deg = 360.0;  ///< the truth has all objects within this angle, half of it to the left and right of x
};

/// A scan of a recording, and the boxes in it.
struct BoxedScan {
    std::size_t number = 0;  ///< of the scan in the recording
    std::vector<LabelledBox> boxes;
};

/// How many objects of a class the boxes tell of.
struct ObjectCount {
    std::size_t objects = 0;
    std::size_t boxes = 0;  ///< with returns, in the scans that are used
};

/// A recording whose scans are labelled by boxes.
struct Recording {
    LidarInput input;
    std::string truth;  ///< file
    LabelledView view;
    std::vector<BoxedScan> scans;        ///< those that are used, in the order of the recording; five or more
    std::size_t scans_in_file = 0;       ///< of the lidar
    std::size_t scans_labelled = 0;      ///< of them
    std::size_t truth_without_scan = 0;  ///< scans that the truth has and the recording has not
    std::array<ObjectCount, 5> counts;   ///< by ObstacleClass
    std::string rawlog_md5, truth_md5;   ///< of the files' bytes, as md5sum prints them
    std::string remarks;                 ///< what was left out of the recording, in one line
};

/// Reads the truth (columns as evaluation::readTruth; poses of the instant when the laser saw the object) and the
/// recording, and finds the scans of the one in the other by their timestamps, to 0.04 s. Scans without an object are
/// labelled where PREFIX_ego.csv beside PREFIX_gt.csv names them. Nothing is labelled beyond the farthest box.
/// @throws CsvError naming file and line, also for a type of object that is not known; std::runtime_error if a file
///     cannot be read, the truth is of other stamps, or fewer than five scans remain.
Recording openRecording(const std::string& rawlog, const std::string& truth, const RecordingOptions& options,
                        const DetectorParams& params);

/// What a scan of a recording serves for: the first two fifths of the scans to learn to group, the next two to learn
/// the verdict, the last one, kept back, to calibrate and to judge.
enum class Serves : std::uint8_t { Grouping, Verdict, Judging };

/// Measures the scans that serve for something, each with 16, 8 and 4 of its rings where the sensor has them, else with
/// all. @throws as openRecording.
std::vector<ScanSamples> samplesOfRecording(const Recording& recording, Serves what, const DetectorParams& params);

/// Table of a model's card: what was added. Empty without recordings.
std::string recordingsTable(const std::vector<Recording>& recordings);

}  // namespace lidar_obstacles::apps

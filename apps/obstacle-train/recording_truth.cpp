// SPDX-License-Identifier: BSD-3-Clause
#include "recording_truth.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>

#include "lidar_obstacles/evaluation/csv_table.h"
#include "lidar_obstacles/evaluation/truth.h"

namespace lidar_obstacles::apps {
namespace {

constexpr double kSameScan = 0.04;  // between the stamps of truth and recording [s], as in evaluations

/// @throws CsvError at the first line whose type has no meaning.
void checkTypes(const std::string& file) {
    evaluation::CsvReader csv(file, {"type"});
    while (csv.next()) {
        const std::string type = csv.lowerText("type");
        if (labelledTypeOf(type).known) continue;
        std::string kinds;
        for (const ObjectKind kind : allKinds())
            if (kind != ObjectKind::Ground && kind != ObjectKind::Noise) kinds += std::string(nameOf(kind)) + ", ";
        csv.fail("type: '" + type + "' is no kind of object; expected one of " + kinds +
                 "or ignore for what is to be left open");
    }
}

/// Numbers of objects by their names, 1, 2 ... in the order of the file.
std::int16_t numberOf(const std::string& file, const std::string& object_id, std::map<std::string, int>& numbers) {
    const int number = numbers.emplace(object_id, static_cast<int>(numbers.size()) + 1).first->second;
    if (number > std::numeric_limits<std::int16_t>::max())
        throw std::runtime_error(file + ": more than 32767 objects; split the recording");
    return static_cast<std::int16_t>(number);
}

/// PREFIX_ego.csv of PREFIX_gt.csv; empty if there is none.
std::string egoFileOf(const std::string& truth) {
    constexpr std::string_view kEnd = "_gt.csv";
    if (truth.size() < kEnd.size() || truth.compare(truth.size() - kEnd.size(), kEnd.size(), kEnd) != 0) return {};
    std::string ego = truth.substr(0, truth.size() - kEnd.size()) + "_ego.csv";
    return std::filesystem::exists(ego) ? ego : std::string();
}

}  // namespace

RecordingTruth readRecordingTruth(const std::string& file) {
    checkTypes(file);
    RecordingTruth truth;
    std::map<std::string, int> numbers;
    for (const evaluation::TruthObject& o : evaluation::readTruth(file, evaluation::TruthPose::Observed)) {
        std::vector<LabelledBox>& boxes = truth.scans[o.timestamp];
        if (!o.box.center.allFinite() || !std::isfinite(o.box.yaw)) continue;  // without a return it may have no pose
        boxes.push_back({o.box, o.num_points, numberOf(file, o.object_id, numbers), labelledTypeOf(o.type).kind});
        truth.reach = std::max(truth.reach, o.box.center.head<2>().norm() + 0.5 * o.box.size.head<2>().norm());
    }
    const std::string ego = egoFileOf(file);
    if (!ego.empty())
        for (const evaluation::EgoPose& pose : evaluation::readEgoPoses(ego))
            if (scanAt(truth, pose.timestamp) == truth.scans.end()) truth.scans[pose.timestamp];
    if (truth.reach == 0.0) throw std::runtime_error(file + ": no box in it");
    return truth;
}

std::map<double, std::vector<LabelledBox>>::const_iterator scanAt(const RecordingTruth& truth, double time) {
    auto at = truth.scans.lower_bound(time);
    if (at != truth.scans.begin()) {
        const auto before = std::prev(at);
        if (at == truth.scans.end() || time - before->first < at->first - time) at = before;
    }
    return at != truth.scans.end() && std::abs(at->first - time) <= kSameScan ? at : truth.scans.end();
}

}  // namespace lidar_obstacles::apps

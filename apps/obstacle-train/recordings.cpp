// SPDX-License-Identifier: BSD-3-Clause
#include "recordings.h"

#include <mrpt/system/md5.h>

#include <algorithm>
#include <boost/interprocess/file_mapping.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "recording_truth.h"

namespace lidar_obstacles::apps {
namespace {

std::string md5Of(const std::string& file) {
    namespace ipc = boost::interprocess;
    if (std::filesystem::file_size(file) == 0) return mrpt::system::md5(std::string());
    const ipc::file_mapping mapping(file.c_str(), ipc::read_only);
    const ipc::mapped_region bytes(mapping, ipc::read_only);
    return mrpt::system::md5(static_cast<const unsigned char*>(bytes.get_address()), bytes.get_size());
}

std::string secondsText(double time) {
    char text[40];
    std::snprintf(text, sizeof text, "%.3f", time);
    return text;
}

/// The first and last scan of a recording [s].
struct Span {
    double first = std::numeric_limits<double>::infinity();
    double last = -std::numeric_limits<double>::infinity();
};

/// All scans that the truth labels; counts the others.
std::vector<BoxedScan> labelledScans(const RecordingTruth& truth, const DetectorParams& params, Recording& r) {
    std::vector<BoxedScan> scans;
    std::set<double> found;
    Span span;
    r.remarks = forEachScan(r.input, [&](std::size_t number, const SourceItem& item, double) {
        const double time = namedCloudOf(r.input, number, item, params).timestamp;
        span = {std::min(span.first, time), std::max(span.last, time)};
        ++r.scans_in_file;
        const auto at = scanAt(truth, time);
        if (at != truth.scans.end() && found.insert(at->first).second) scans.push_back({number, at->second});
        return true;
    });
    r.scans_labelled = scans.size();
    r.truth_without_scan = truth.scans.size() - found.size();
    if (scans.empty())
        throw std::runtime_error(r.truth + ": truth of other stamps: its scans are from " +
                                 secondsText(truth.scans.begin()->first) + " to " +
                                 secondsText(truth.scans.rbegin()->first) + " s, those of " + r.input.rawlog +
                                 " from " + secondsText(span.first) + " to " + secondsText(span.last) + " s");
    return scans;
}

void countObjects(Recording& r) {
    std::array<std::set<std::int16_t>, 5> ids;
    for (const BoxedScan& scan : r.scans)
        for (const LabelledBox& box : scan.boxes) {
            if (!box.kind || box.returns == 0) continue;
            const auto cls = static_cast<std::size_t>(classOf(*box.kind));
            ids[cls].insert(box.id);
            ++r.counts[cls].boxes;
        }
    for (std::size_t c = 0; c < ids.size(); ++c) r.counts[c].objects = ids[c].size();
}

Serves purposeOf(std::size_t place, std::size_t scans) {
    const std::size_t fifth = 5 * place / scans;
    return fifth < 2 ? Serves::Grouping : fifth < 4 ? Serves::Verdict : Serves::Judging;
}

/// Numbers of rings to measure a scan with; 0: all it has.
std::vector<int> ringsOf(const PointCloud& full) {
    std::vector<int> rings;
    for (const int n : {16, 8, 4})
        if (full.view.rings > 0 && full.view.rings % n == 0) rings.push_back(n);
    if (rings.empty()) rings.push_back(0);
    return rings;
}

/// Of a scan, by each number of rings.
std::vector<ScanSamples> samplesOf(const Recording& r, const SourceItem& item, const BoxedScan& scan,
                                   DetectorParams params) {
    params.sensor.planes = 0;
    const std::vector<int> numbers = ringsOf(namedCloudOf(r.input, scan.number, item, params));
    std::vector<ScanSamples> samples;
    samples.reserve(numbers.size());
    for (const int rings : numbers) {
        params.sensor.planes = rings;
        const PointCloud cloud = namedCloudOf(r.input, scan.number, item, params);
        samples.push_back(samplesOfScan(cloud, labelsByBoxes(cloud, scan.boxes, r.view), params));
    }
    return samples;
}

}  // namespace

Recording openRecording(const std::string& rawlog, const std::string& truth_file, const RecordingOptions& options,
                        const DetectorParams& params) {
    const RecordingTruth truth = readRecordingTruth(truth_file);
    Recording r;
    r.input = {rawlog, options.choice};
    r.truth = truth_file;
    r.view = {options.view_deg / 2.0 * M_PI / 180.0, truth.reach};
    const std::vector<BoxedScan> labelled = labelledScans(truth, params, r);
    for (std::size_t k = 0; k < labelled.size(); k += static_cast<std::size_t>(options.every))
        r.scans.push_back(labelled[k]);
    if (r.scans.size() < 5)
        throw std::runtime_error(rawlog + ": " + std::to_string(r.scans.size()) +
                                 " scans to use (labelled: " + std::to_string(labelled.size()) +
                                 ", every: " + std::to_string(options.every) + "); 5 or more are needed");
    countObjects(r);
    r.rawlog_md5 = md5Of(rawlog);
    r.truth_md5 = md5Of(truth_file);
    return r;
}

std::vector<ScanSamples> samplesOfRecording(const Recording& r, Serves what, const DetectorParams& params) {
    std::vector<ScanSamples> all;
    std::size_t next = 0;
    forEachScan(r.input, [&](std::size_t number, const SourceItem& item, double) {
        if (number != r.scans[next].number) return true;
        if (purposeOf(next, r.scans.size()) == what)
            for (ScanSamples& samples : samplesOf(r, item, r.scans[next], params)) all.push_back(std::move(samples));
        return ++next < r.scans.size();
    });
    return all;
}

std::string recordingsTable(const std::vector<Recording>& recordings) {
    if (recordings.empty()) return {};
    std::string text = "| recording, MD5 | truth, MD5 | scans used / labelled / all |";
    constexpr std::array kClasses{ObstacleClass::Vehicle, ObstacleClass::Pedestrian, ObstacleClass::Cyclist,
                                  ObstacleClass::Structure, ObstacleClass::Unknown};
    for (const ObstacleClass c : kClasses) text += std::string(" ") + toString(c) + " |";
    text += "\n|---|---|---|---|---|---|---|---|\n";
    const auto name = [](const std::string& file) { return std::filesystem::path(file).filename().string(); };
    for (const Recording& r : recordings) {
        text += "| " + name(r.input.rawlog) + " " + r.rawlog_md5 + " | " + name(r.truth) + " " + r.truth_md5 + " | " +
                std::to_string(r.scans.size()) + " / " + std::to_string(r.scans_labelled) + " / " +
                std::to_string(r.scans_in_file) + " |";
        for (const ObstacleClass c : kClasses) {
            const ObjectCount& n = r.counts[static_cast<std::size_t>(c)];
            text += " " + std::to_string(n.objects) + " (" + std::to_string(n.boxes) + ") |";
        }
        text += '\n';
    }
    return text;
}

}  // namespace lidar_obstacles::apps

// SPDX-License-Identifier: BSD-3-Clause
#include "card.h"

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <stdexcept>

namespace lidar_obstacles::apps {
namespace {

constexpr std::array<ObstacleClass, 5> kClasses = {ObstacleClass::Vehicle, ObstacleClass::Pedestrian,
                                                   ObstacleClass::Cyclist, ObstacleClass::Structure,
                                                   ObstacleClass::Unknown};

template <class... Args>
std::string format(const char* pattern, Args... args) {
    char text[400];
    std::snprintf(text, sizeof text, pattern, args...);
    return text;
}

/// What the classes told are in truth.
std::string tableOf(const Judgement& j) {
    std::string text = format("Groups chosen in %zu scans; rows: class told, columns: truth.\n\n| |", j.scans);
    for (std::size_t k = 0; k < kCategories; ++k) text += format(" %s |", toString(static_cast<Category>(k)));
    text += " calibration error |\n|---|";
    for (std::size_t k = 0; k <= kCategories; ++k) text += "---|";
    text += '\n';
    for (const ObstacleClass c : kClasses) {
        text += format("| %s |", toString(c));
        for (const int n : j.confusion[static_cast<std::size_t>(c)]) text += format(" %d |", n);
        text += format(" %.3f |\n", j.calibration_error[static_cast<std::size_t>(c)]);
    }
    text += format(
        "\nOf %d vehicles of 15 returns or more %d had a hypothesis that is whole, and %d were found so; of %d people "
        "%d and %d.\n",
        j.vehicles[0], j.vehicles[1], j.vehicles[2], j.people[0], j.people[1], j.people[2]);
    return text;
}

/// What was added to the simulated scenes.
std::string additionsText(const std::vector<Recording>& recordings) {
    if (recordings.empty()) return {};
    return "Added to them: recordings with boxes as truth. Numbers of objects, in brackets of their boxes with returns "
           "in\nthe scans used. The first two fifths of these scans taught to group, the next two to judge, the last "
           "was "
           "kept back.\n\n" +
           recordingsTable(recordings) + "\n";
}

/// Of the training, UTC; SOURCE_DATE_EPOCH, if set, is now: the same bytes on another day.
std::string today() {
    const char* set = std::getenv("SOURCE_DATE_EPOCH");
    char* end = nullptr;
    const std::time_t now = set != nullptr ? std::strtoll(set, &end, 10) : std::time(nullptr);
    if (set != nullptr && (end == set || *end != '\0'))
        throw std::runtime_error(std::string("SOURCE_DATE_EPOCH is no number of seconds: ") + set);
    std::tm utc{};
    gmtime_r(&now, &utc);
    char text[20];
    std::strftime(text, sizeof text, "%Y-%m-%d", &utc);
    return text;
}

}  // namespace

std::string cardText(const Training& t, const Judgements& judgements) {
    const char* only = t.recordings.empty() ? "nothing recorded, no shipped scenario" : "no shipped scenario";
    std::string text = "# Recognizer\n\nMade by `obstacle-train`";
    text += " on " + today();
    text += format(
        " from %d random scenes of the simulator (seeds %llu to %llu): %s.\n"
        "Two of three sensors are VLP-16s, the others have the lasers of a Puck Hi-Res or some of an HDL-32's or "
        "HDL-64's.\n",
        t.scenes, static_cast<unsigned long long>(t.seed),
        static_cast<unsigned long long>(t.seed + static_cast<unsigned long long>(t.scenes) - 1), only);
    text += format(
        "%d rounds of boosted trees for each of %zu categories, depth %d, rate %g, twice: to form groups, from %zu\n"
        "groups of returns, and to judge what was chosen among what stands about it, from %zu in as many other "
        "scenes.\n"
        "Every fifth set of scenes was kept back; they calibrate the probabilities and give these figures.\n\n",
        t.boosting.rounds, kCategories, t.boosting.depth, t.boosting.rate, t.groups, t.verdicts);
    if (!t.boosting.left_out.empty()) text += "Without the features";
    for (const Feature k : t.boosting.left_out)
        text += std::string(" `") + featureInfos()[static_cast<std::size_t>(k)].name + "`";
    if (!t.boosting.left_out.empty()) text += ".\n\n";
    if (t.noise) text += format("Noise of the ranges: %g m in all scenes.\n\n", *t.noise);
    if (!t.set.empty()) text += "Detector:";
    for (const std::string& assignment : t.set) text += " `" + assignment + "`";
    if (!t.set.empty()) text += "\n\n";
    text += additionsText(t.recordings) + tableOf(judgements.all);
    if (!t.recordings.empty()) text += "\nThe recordings alone:\n\n" + tableOf(judgements.recorded);
    return text;
}

}  // namespace lidar_obstacles::apps

// SPDX-License-Identifier: BSD-3-Clause
#include "statistics.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/number_text.h"

namespace lidar_obstacles::apps {
namespace {

using Counts = live::StreamCounts;

constexpr std::pair<const char*, std::size_t Counts::*> kFaults[] = {
    {"lost", &Counts::lost},
    {"late", &Counts::late},
    {"duplicate", &Counts::duplicates},
    {"malformed", &Counts::malformed},
    {"foreign", &Counts::foreign},
    {"unclear", &Counts::unclear},
    {"outages", &Counts::outages},
    {"mode changes", &Counts::mode_changes},
    {"restarts", &Counts::restarts},
    {"of a turn that the end cut off", &Counts::unfinished},
};

nlohmann::ordered_json quantiles(const live::LatencyHistogram& times) {
    return {{"p50", times.quantile(0.50)},
            {"p95", times.quantile(0.95)},
            {"p99", times.quantile(0.99)},
            {"max", times.max()}};
}

}  // namespace

std::string summaryLine(const Statistics& s) {
    const Counts& c = s.counts.stream;
    std::string text = fixedText(s.seconds, 1) + " s: " + std::to_string(c.packets) + " packets, " +
                       std::to_string(s.detected) + " scans, " + std::to_string(s.obstacles) + " obstacles; latency " +
                       fixedText(s.latency.quantile(0.50), 2) + " / " + fixedText(s.latency.quantile(0.95), 2) + " / " +
                       fixedText(s.latency.quantile(0.99), 2) + " ms (p50 / p95 / p99)";
    if (s.tracking.count() > 0)
        text += ", of it tracks " + fixedText(s.tracking.quantile(0.50), 2) + " / " +
                fixedText(s.tracking.quantile(0.99), 2) + " ms (p50 / p99)";
    std::string faults;
    const auto add = [&faults](std::size_t n, const std::string& name) {
        if (n > 0) faults += (faults.empty() ? "; " : ", ") + std::to_string(n) + ' ' + name;
    };
    for (const auto& [name, member] : kFaults) add(c.*member, name);
    add(s.counts.overflows, "datagrams not fetched in time");
    add(s.counts.dropped, "scans dropped");
    add(s.undecodable, "scans that cannot be right");
    add(s.missing_beside, "scans of further sensors missing");
    add(s.record_dropped, "scans not recorded");
    add(s.poses_refused, "lines that are no pose");
    add(s.match_lost, "scans not matched");
    add(s.not_searched, "scans not searched");
    add(s.clients.cut_off, "clients cut off");
    add(s.clients.refused, "clients too many");
    add(s.clients.errors, "requests refused");
    return text + faults;
}

namespace {

/// What came from the network, packet by packet.
void addPackets(const live::StreamCounts& c, nlohmann::ordered_json& json) {
    json["datagrams"] = c.datagrams;
    json["packets"] = c.packets;
    json["scans"] = c.scans;
    json["lost"] = c.lost;
    json["late"] = c.late;
    json["duplicates"] = c.duplicates;
    json["malformed"] = c.malformed;
    json["foreign"] = c.foreign;
    json["unclear"] = c.unclear;
    json["outages"] = c.outages;
    json["mode_changes"] = c.mode_changes;
    json["restarts"] = c.restarts;
    json["unfinished"] = c.unfinished;
}

}  // namespace

std::string toJson(const Statistics& s) {
    nlohmann::ordered_json json;
    json["seconds"] = s.seconds;
    addPackets(s.counts.stream, json);
    json["detected"] = s.detected;
    json["obstacles"] = s.obstacles;
    json["overflows"] = s.counts.overflows;
    json["scans_dropped"] = s.counts.dropped;
    json["scans_undecodable"] = s.undecodable;
    json["scans_missing_beside"] = s.missing_beside;
    json["recorded"] = s.recording ? nlohmann::ordered_json(s.recorded) : nlohmann::ordered_json();
    json["record_dropped"] = s.record_dropped;
    json["scans_not_searched"] = s.not_searched;
    json["clients"] = s.clients.clients;
    json["clients_cut_off"] = s.clients.cut_off;
    json["clients_refused"] = s.clients.refused;
    json["requests"] = s.clients.requests;
    json["requests_refused"] = s.clients.errors;
    json["poses"] = s.poses;
    json["poses_of_clients"] = s.poses_of_clients;
    json["poses_refused"] = s.poses_refused;
    json["scans_matched"] = s.matched;
    json["scans_not_matched"] = s.match_lost;
    json["zones"] = s.watched.zonesJson();
    json["health"] = s.watched.healthJson();
    json["latency_ms"] = quantiles(s.latency);
    json["tracking_ms"] = s.tracking.count() > 0 ? quantiles(s.tracking) : nlohmann::ordered_json();
    return json.dump(2) + "\n";
}

}  // namespace lidar_obstacles::apps

// SPDX-License-Identifier: BSD-3-Clause
#include "manifest.h"

#include <mrpt/rtti/CObject.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>
#include <unordered_map>

#include "common/run_app.h"
#include "common/text_file.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "objects/builtin_model.h"

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "obstacle-fleet manifest 2";

/// One line, whatever bytes are in names.
std::string lineOf(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

Json toJson(const Settings& s) {
    return {{"format", kFormat}, {"version", s.version},       {"folder", s.folder},
            {"files", s.files},  {"options", s.input_options}, {"parameters", s.parameters}};
}

Json toJson(const Recording& r) {
    Json json = {{"name", r.name}};
    if (!r.error.empty()) {
        json["error"] = r.error;
        return json;
    }
    json["bytes"] = r.stamp.bytes;
    json["changed_ns"] = r.stamp.changed_ns;
    json["sha256"] = r.sha256;
    json["key"] = r.key;
    json["named"] = r.named;
    return json;
}

Settings settingsFrom(const Json& json) {
    if (json.at("format") != kFormat)
        throw std::runtime_error("is no manifest of this kind, or of an earlier one: make it anew, without --known");
    Settings s;
    s.version = json.at("version");
    s.folder = json.at("folder");
    s.files = json.at("files");
    s.input_options = json.at("options").get<std::vector<std::string>>();
    s.parameters = json.at("parameters");
    return s;
}

Recording recordingFrom(const Json& json, const Settings& settings) {
    Recording r;
    r.name = json.at("name");
    if (json.contains("error")) {
        r.error = json.at("error");
        return r;
    }
    r.stamp = {json.at("bytes"), json.at("changed_ns")};
    r.sha256 = json.at("sha256");
    r.key = json.at("key");
    r.named = json.at("named").get<std::vector<std::string>>();
    if (r.key != keyOf(settings, r.sha256)) throw std::runtime_error("its key is not that of its content and settings");
    return r;
}

bool isUtf8(const std::string& text) {
    try {
        return !Json(text).dump().empty();
    } catch (const nlohmann::json::type_error&) {
        return false;
    }
}

/// What is known of a place from earlier manifests.
using Known = std::unordered_map<std::string, const Recording*>;

/// Reads all of a recording. @throws std::runtime_error also if it changed meanwhile.
void readContent(const fs::path& path, Recording& r) {
    const Stamp alone = stampOf(path);
    r.named = filesNamedIn(path);
    if (!std::all_of(r.named.begin(), r.named.end(), isUtf8))
        throw std::runtime_error(path.string() + ": its clouds have names that are not UTF-8");
    r.stamp = stampOf(path, r.named);
    r.sha256 = contentOf(path, r.named);
    if (!(stampOf(path) == alone) || !(stampOf(path, r.named) == r.stamp))
        throw std::runtime_error(path.string() + ": changed while it was read");
}

Recording readRecording(const Settings& settings, const std::string& name, const Known& known) {
    Recording r;
    r.name = name;
    if (!isUtf8(name)) {
        r.error = "its name is not UTF-8";
        return r;
    }
    try {
        const fs::path path = pathOf(settings, name);
        const auto before = known.find(path.string());
        if (before != known.end() && stampOf(path, before->second->named) == before->second->stamp) {
            r = *before->second;
            r.name = name;
        } else {
            readContent(path, r);
        }
        r.key = keyOf(settings, r.sha256);
    } catch (const std::exception& e) {
        r.error = e.what();
    }
    return r;
}

}  // namespace

std::string keyOf(const Settings& settings, const std::string& sha256) {
    std::string text = sha256 + '\n' + settings.version + '\n' + settings.files + '\n';
    for (const std::string& word : settings.input_options) text += word + '\n';
    return sha256Of(text + settings.parameters);
}

std::string filesOf(const DetectorParams& params) {
    const std::string& model = params.recognizer.model;
    const std::string& map = params.octomap.map;
    const std::string model_digest = model == "built-in" ? sha256Of(builtinModel()) : sha256OfFile(model);
    return map == "none" || map.empty() ? model_digest : model_digest + ' ' + sha256OfFile(map);
}

Settings makeSettings(DetectorParams params, const std::vector<std::string>& input_options) {
    std::string& model = params.recognizer.model;
    if (model != "built-in") model = fs::absolute(model).lexically_normal().string();
    std::string& map = params.octomap.map;
    if (map != "none" && !map.empty()) map = fs::absolute(map).lexically_normal().string();
    Settings s;
    s.version = LIDAR_OBSTACLES_VERSION;
    s.folder = fs::current_path().string();
    s.parameters = dumpParams(params);
    s.input_options = input_options;
    s.files = filesOf(params);
    return s;
}

apps::InputChoice inputChoiceOf(const std::vector<std::string>& input_options) {
    apps::InputChoice choice;
    CLI::App app("", "obstacle-fleet");
    apps::addInputChoice(app, choice);
    std::vector<std::string> words(input_options.rbegin(), input_options.rend());  // as CLI11 wants them
    try {
        app.parse(words);
    } catch (const CLI::ParseError& e) {
        throw apps::UsageError(std::string("options of the input: ") + e.what());
    }
    return choice;
}

Manifest makeManifest(const Settings& settings, const std::vector<std::string>& names,
                      const std::vector<Manifest>& known, int threads) {
    Known places;
    for (const Manifest& manifest : known)
        for (const Recording& r : manifest.recordings)
            if (r.error.empty()) places[pathOf(manifest.settings, r.name).string()] = &r;
    Manifest manifest{settings, std::vector<Recording>(names.size())};
    mrpt::rtti::registerAllPendingClasses();  // here, or the threads below race for it
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t k = next++; k < names.size(); k = next++)
            manifest.recordings[k] = readRecording(settings, names[k], places);
    };
    std::vector<std::thread> others;
    others.reserve(static_cast<std::size_t>(threads));
    for (int t = 1; t < threads; ++t) others.emplace_back(work);
    work();
    for (std::thread& t : others) t.join();
    return manifest;
}

void writeManifest(const fs::path& file, const Manifest& manifest) {
    std::string text = lineOf(toJson(manifest.settings));
    for (const Recording& r : manifest.recordings) text += lineOf(toJson(r));
    apps::writeTextFile(file, text);  // in one piece: what ends within is no manifest
}

Manifest readManifest(const fs::path& file) {
    std::ifstream in(file);
    std::string line;
    std::size_t number = 0;
    Manifest manifest;
    if (!in || fs::is_directory(file)) throw std::runtime_error(file.string() + ": cannot read this manifest");
    while (std::getline(in, line)) {
        ++number;
        try {
            const Json json = Json::parse(line);
            if (number == 1)
                manifest.settings = settingsFrom(json);
            else
                manifest.recordings.push_back(recordingFrom(json, manifest.settings));
        } catch (const std::exception& e) {
            throw std::runtime_error(file.string() + ':' + std::to_string(number) +
                                     ": not what `obstacle-fleet manifest` writes: " + e.what());
        }
    }
    if (number == 0) throw std::runtime_error(file.string() + ": is empty, expected a manifest");
    return manifest;
}

Manifest readOwnManifest(const fs::path& file) {
    Manifest manifest = readManifest(file);
    if (manifest.settings.version != LIDAR_OBSTACLES_VERSION)
        throw std::runtime_error(file.string() + ": made by version " + manifest.settings.version +
                                 ", this is " LIDAR_OBSTACLES_VERSION ": make it anew, with --known " + file.string());
    return manifest;
}

fs::path pathOf(const Settings& settings, const std::string& name) {
    return (fs::path(settings.folder) / name).lexically_normal();  // an absolute name stays what it is
}

std::string withName(std::string message, const Settings& settings, const std::string& name) {
    const std::string path = pathOf(settings, name).string();
    for (auto at = message.find(path); at != std::string::npos; at = message.find(path, at + name.size()))
        message.replace(at, path.size(), name);
    return message;
}

}  // namespace lidar_obstacles::fleet

// SPDX-License-Identifier: BSD-3-Clause
#include "store.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/text_file.h"

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& what) {
    throw std::runtime_error(file.string() + ": " + what + ": " + std::strerror(errno != 0 ? errno : EIO));
}

void makeFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (!error && fs::is_directory(folder)) return;
    throw std::runtime_error(folder.string() + ": cannot make the folder" + (error ? ": " + error.message() : ""));
}

/// So that a power cut leaves no empty files under good names.
void sync(const fs::path& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) fail(file, "cannot open");
    const bool is_synced = fsync(descriptor) == 0 || errno == EINVAL;  // EINVAL: the file system does not know how
    close(descriptor);
    if (!is_synced) fail(file, "cannot write");
}

std::int64_t changedNs(const fs::path& file) {
    struct stat status{};
    if (stat(file.c_str(), &status) != 0) return -1;
    return std::int64_t{1000000000} * status.st_mtim.tv_sec + status.st_mtim.tv_nsec;
}

}  // namespace

const char* toString(Status status) {
    switch (status) {
        case Status::Done:
            return "done";
        case Status::Damaged:
            return "damaged";
        case Status::Failed:
            break;
    }
    return "failed";
}

Store::Store(fs::path folder) : folder_(std::move(folder)) {
    for (const char* name : {"results", "claims", "unfinished"}) makeFolder(folder_ / name);
    began_ns_ = now();
}

fs::path Store::resultOf(const std::string& key) const { return folder_ / "results" / key.substr(0, 2) / key; }

fs::path Store::claimsOf(const std::string& key) const {
    fs::path folder = folder_ / "claims" / key.substr(0, 2);
    makeFolder(folder);
    return folder;
}

bool Store::isDone(const std::string& key, bool retry_failed) const {
    const fs::path file = resultOf(key) / "result.json";
    const std::int64_t written_ns = changedNs(file);
    if (written_ns < 0) return false;
    if (written_ns >= began_ns_) return true;  // by another process just now: once is enough
    const Result result = read(key);
    return result.status == Status::Done || (!result.again && !retry_failed);
}

Result Store::read(const std::string& key) const {
    const fs::path file = resultOf(key) / "result.json";
    try {
        std::ifstream in(file);
        if (!in) throw std::runtime_error("cannot read it");
        const auto json = nlohmann::json::parse(in);
        const std::string status = json.at("status");
        Result result{Status::Failed, json.at("reason"), json.at("again")};
        if (status == "done") result.status = Status::Done;
        if (status == "damaged") result.status = Status::Damaged;
        return result;
    } catch (const std::exception& e) {
        throw std::runtime_error(file.string() + ": " + e.what() + "; remove its folder to do the work again");
    }
}

fs::path Store::begin(const std::string& key, const std::string& who) const {
    fs::path folder = folder_ / "unfinished" / (key + "." + who);
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    makeFolder(folder);
    return folder;
}

bool Store::publish(const fs::path& unfinished, const std::string& key, bool retry_failed) const {
    for (const auto& file : fs::directory_iterator(unfinished)) sync(file.path());
    sync(unfinished);
    const fs::path place = resultOf(key);
    makeFolder(place.parent_path());
    std::error_code ignored;
    if (fs::exists(place / "result.json", ignored) && !isDone(key, retry_failed)) {
        const fs::path old = unfinished.string() + ".old";
        fs::rename(place, old, ignored);
        fs::remove_all(old, ignored);
    }
    const bool is_new = std::rename(unfinished.c_str(), place.c_str()) == 0;
    if (!is_new && errno != ENOTEMPTY && errno != EEXIST) fail(place, "cannot give the results their place");
    for (const auto& file : fs::directory_iterator(folder_ / "unfinished"))  // ours, and what killed ones left
        if (file.path().filename().string().rfind(key + ".", 0) == 0) fs::remove_all(file.path(), ignored);
    sync(place.parent_path());
    return is_new;
}

std::int64_t Store::now() const {
    char name[300];
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    std::snprintf(name, sizeof name, ".now.%s.%d", host, static_cast<int>(getpid()));
    const fs::path file = folder_ / "unfinished" / name;
    std::ofstream(file) << '.';
    const std::int64_t time = changedNs(file);
    std::error_code ignored;
    fs::remove(file, ignored);
    if (time < 0) throw std::runtime_error(folder_.string() + ": cannot write into this folder");
    return time;
}

void writeFailure(const fs::path& folder, const Result& result) {
    const nlohmann::ordered_json json = {
        {"status", toString(Status::Failed)}, {"reason", result.reason}, {"again", result.again}};
    apps::writeTextFile(folder / "result.json",
                        json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace lidar_obstacles::fleet

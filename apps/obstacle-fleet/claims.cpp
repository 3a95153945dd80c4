// SPDX-License-Identifier: BSD-3-Clause
#include "claims.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "content.h"

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;

std::string textOf(const char* file) {
    std::ifstream in(file);
    std::string text;
    std::getline(in, text);
    return text;
}

/// Field 22 of /proc/PID/stat; the name of the program before it may hold anything but is in brackets. -1: no such
/// process.
std::int64_t startOf(std::int64_t process) {
    const std::string text = textOf(("/proc/" + std::to_string(process) + "/stat").c_str());
    auto at = text.rfind(')');
    for (int field = 2; field < 22 && at != std::string::npos; ++field) at = text.find(' ', at + 1);
    return at == std::string::npos ? -1 : std::strtoll(text.c_str() + at, nullptr, 10);
}

std::int64_t numberOf(const char* variable) {
    const char* text = std::getenv(variable);
    return text == nullptr ? 0 : std::strtoll(text, nullptr, 10);
}

/// The claims to a key, by their numbers, rising.
std::vector<unsigned long> claimsTo(const fs::path& folder, const std::string& key) {
    std::vector<unsigned long> numbers;
    for (const auto& file : fs::directory_iterator(folder)) {
        const std::string name = file.path().filename().string();
        unsigned long number = 0;
        const char* end = name.data() + name.size();
        if (name.rfind(key + ".", 0) != 0) continue;
        const auto read = std::from_chars(name.data() + key.size() + 1, end, number);
        if (read.ec == std::errc() && read.ptr == end) numbers.push_back(number);
    }
    std::sort(numbers.begin(), numbers.end());
    return numbers;
}

std::optional<Owner> ownerOf(const fs::path& claim) {
    try {
        std::ifstream in(claim);
        const auto json = nlohmann::json::parse(in);
        return Owner{json.at("machine"), json.at("process"), json.at("started"), json.at("job"), json.at("restarts")};
    } catch (const std::exception&) {
        return std::nullopt;  // gone, or of another program: it gives signs of life or it does not
    }
}

}  // namespace

std::string Owner::word() const {
    return sha256Of(machine).substr(0, 8) + "." + std::to_string(process) + "." + std::to_string(started);
}

Owner thisProcess() {
    Owner me;
    std::error_code ignored;
    const std::string space = fs::read_symlink("/proc/self/ns/pid", ignored).string();  // a container counts anew
    char host[256] = "";
    gethostname(host, sizeof host - 1);
    me.machine = std::string(host) + ' ' + textOf("/proc/sys/kernel/random/boot_id") + ' ' + space;
    me.process = getpid();
    me.started = startOf(me.process);
    const char* job = std::getenv("SLURM_JOB_ID");
    me.job = job == nullptr ? "" : std::string(job) + '.' + std::to_string(numberOf("SLURM_PROCID"));
    me.restarts = numberOf("SLURM_RESTART_COUNT");
    return me;
}

bool mayLive(const Owner& other, const Owner& me) {
    if (!me.job.empty() && other.job == me.job && other.restarts < me.restarts) return false;
    if (other.machine != me.machine) return true;
    return startOf(other.process) == other.started;
}

Claim::Claim(Claim&& other) noexcept : file_(std::move(other.file_)), stem_(std::move(other.stem_)) {
    other.file_.clear();
}

Claim::~Claim() {
    if (file_.empty()) return;
    try {  // rising: while a lower one goes, ours still holds
        const fs::path folder = stem_.parent_path();
        const std::string key = stem_.filename().string();
        if (!fs::exists(file_)) return;
        for (const unsigned long number : claimsTo(folder, key)) {
            const fs::path claim = folder / (key + "." + std::to_string(number));
            fs::remove(claim);
            if (claim == file_) return;
        }
    } catch (const std::exception&) {  // it gets stale
    }
}

void Claim::beat() const { utimensat(AT_FDCWD, file_.c_str(), nullptr, 0); }

bool Claim::holds() const {
    const std::vector<unsigned long> numbers = claimsTo(stem_.parent_path(), stem_.filename().string());
    return !numbers.empty() && file_ == stem_.string() + "." + std::to_string(numbers.back());
}

bool Claims::isStale(const fs::path& claim) const {
    const auto owner = ownerOf(claim);
    if (owner && !mayLive(*owner, owner_)) return true;
    struct stat status{};
    if (stat(claim.c_str(), &status) != 0) return false;  // released just now
    const double age =
        static_cast<double>(now_() - status.st_mtim.tv_nsec) * 1e-9 - static_cast<double>(status.st_mtim.tv_sec);
    return age > stale_;
}

/// A claim appears with all it says. @return nullopt if there is one of that name.
std::optional<fs::path> Claims::link(const fs::path& folder, const std::string& name) const {
    const nlohmann::json owner = {{"machine", owner_.machine},
                                  {"process", owner_.process},
                                  {"started", owner_.started},
                                  {"job", owner_.job},
                                  {"restarts", owner_.restarts}};
    const fs::path draft = folder / (".draft." + owner_.word());
    const fs::path claim = folder / name;
    std::ofstream out(draft, std::ios::trunc);
    out << owner.dump() << '\n';
    out.close();
    const bool is_written = static_cast<bool>(out);
    const bool is_linked = is_written && ::link(draft.c_str(), claim.c_str()) == 0;
    const int reason = errno;
    std::error_code ignored;
    fs::remove(draft, ignored);
    if (is_linked) return claim;
    if (is_written && reason == EEXIST) return std::nullopt;
    throw std::runtime_error(claim.string() + ": cannot claim this work: " + std::strerror(reason));
}

std::optional<Claim> Claims::take(const fs::path& folder, const std::string& key) const {
    const auto named = [&](unsigned long number) { return key + "." + std::to_string(number); };
    const std::vector<unsigned long> before = claimsTo(folder, key);
    if (!before.empty() && !isStale(folder / named(before.back()))) return std::nullopt;
    const unsigned long number = before.empty() ? 0 : before.back() + 1;
    const auto file = link(folder, named(number));
    if (!file) return std::nullopt;
    // What was listed may have changed before ours was there: of two that took it, neither may believe it is alone.
    for (const unsigned long other : claimsTo(folder, key)) {
        if (other == number || (other < number && isStale(folder / named(other)))) continue;
        std::error_code ignored;
        fs::remove(*file, ignored);
        return std::nullopt;
    }
    return std::optional<Claim>(std::in_place, *file, folder / key);
}

}  // namespace lidar_obstacles::fleet

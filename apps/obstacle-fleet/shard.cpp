// SPDX-License-Identifier: BSD-3-Clause
#include "shard.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <queue>
#include <tuple>
#include <unordered_set>
#include <utility>

#include "common/run_app.h"

namespace lidar_obstacles::fleet {
namespace {

using apps::UsageError;

std::optional<std::size_t> numberIn(const std::string& text) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

/// @throws UsageError naming the variable if it is not set or no number.
std::size_t numberOf(const Environment& environment, const char* name) {
    const char* text = environment(name);
    const auto number = numberIn(text == nullptr ? "" : text);
    if (!number)
        throw UsageError(std::string(name) + "=" + (text == nullptr ? "" : text) +
                         ": expected a whole number; or say the shard with --shard I/N");
    return *number;
}

Shard shardOfWords(const std::string& words) {
    const auto slash = words.find('/');
    const auto index = numberIn(words.substr(0, slash));
    const auto count = slash == std::string::npos ? std::nullopt : numberIn(words.substr(slash + 1));
    if (!index || !count || *index >= *count)
        throw UsageError("--shard " + words + ": must be I/N, part I of N, counted from 0: 0/4, 1/4, 2/4, 3/4");
    return {*index, *count, "--shard"};
}

Shard shardOfArray(const Environment& environment) {
    const auto id = numberOf(environment, "SLURM_ARRAY_TASK_ID");
    const auto count = numberOf(environment, "SLURM_ARRAY_TASK_COUNT");
    const auto least = numberOf(environment, "SLURM_ARRAY_TASK_MIN");
    const bool has_step = environment("SLURM_ARRAY_TASK_STEP") != nullptr;
    const auto step = has_step ? numberOf(environment, "SLURM_ARRAY_TASK_STEP") : 1;
    if (step == 0 || id < least || (id - least) % step != 0 || (id - least) / step >= count)
        throw UsageError("SLURM_ARRAY_TASK_ID=" + std::to_string(id) + ": is not one of " + std::to_string(count) +
                         " numbers from " + std::to_string(least) + " on in steps of " + std::to_string(step) +
                         ": give the whole array (--array=0-9), or say the shard with --shard I/N");
    return {(id - least) / step, count, "SLURM_ARRAY_TASK_ID"};
}

Shard shardOfRank(const Environment& environment, const char* rank, const char* size) {
    const Shard shard{numberOf(environment, rank), numberOf(environment, size), rank};
    if (shard.index >= shard.count)
        throw UsageError(std::string(rank) + "=" + std::to_string(shard.index) + ": must be below " + size + "=" +
                         std::to_string(shard.count));
    return shard;
}

}  // namespace

Shard chooseShard(const std::string& words, const Environment& environment) {
    if (!words.empty()) return shardOfWords(words);
    if (environment("SLURM_ARRAY_TASK_ID") != nullptr) return shardOfArray(environment);
    for (const auto& [rank, size] : {std::pair("OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"),
                                     std::pair("PMI_RANK", "PMI_SIZE"), std::pair("SLURM_PROCID", "SLURM_NTASKS")})
        if (environment(rank) != nullptr && environment(size) != nullptr) return shardOfRank(environment, rank, size);
    return {};
}

std::vector<std::size_t> worksOf(const Manifest& manifest, const Shard& shard) {
    const std::vector<Recording>& all = manifest.recordings;
    std::unordered_set<std::string> keys;
    std::vector<std::size_t> works;
    works.reserve(all.size());
    for (std::size_t k = 0; k < all.size(); ++k)
        if (all[k].error.empty() && keys.insert(all[k].key).second) works.push_back(k);
    std::sort(works.begin(), works.end(), [&](std::size_t a, std::size_t b) {
        return std::tie(all[b].stamp.bytes, all[a].key) < std::tie(all[a].stamp.bytes, all[b].key);
    });
    using Load = std::pair<std::uint64_t, std::size_t>;  // bytes, shard
    std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;
    for (std::size_t s = 0; s < shard.count; ++s) loads.emplace(0, s);
    std::vector<std::size_t> mine;
    mine.reserve(works.size() / shard.count + 1);
    for (const std::size_t k : works) {
        const auto [bytes, s] = loads.top();
        loads.pop();
        loads.emplace(bytes + all[k].stamp.bytes + 1, s);
        if (s == shard.index) mine.push_back(k);
    }
    return mine;
}

}  // namespace lidar_obstacles::fleet

// SPDX-License-Identifier: BSD-3-Clause
#include "run_shard.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

#include "claims.h"
#include "common/interrupt.h"
#include "detect.h"
#include "isolated.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "lidar_obstacles/recognizer.h"
#include "store.h"

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Parameters and files as they were when the manifest was made.
Detector detectorOf(const Manifest& manifest, const fs::path& file) {
    const DetectorParams params = parseParams(manifest.settings.parameters, file.string());
    if (filesOf(params) != manifest.settings.files)
        throw std::runtime_error(file.string() + ": the recognizer's model or the map is not the one it was made with");
    recognizerOf(params.recognizer.model);  // read once, before there are copies of this process
    return {manifest.settings, params, inputChoiceOf(manifest.settings.input_options)};
}

class ShardRun {
  public:
    ShardRun(const RunOptions& options, const Manifest& manifest)
        : options_(options),
          manifest_(manifest),
          detector_(detectorOf(manifest, options.manifest)),
          store_(options.output),
          owner_(thisProcess()),
          claims_(owner_, options.stale, [this] { return store_.now(); }) {}

    RunReport run(const Shard& shard) {
        std::vector<std::size_t> works = worksOf(manifest_, shard);
        report_.recordings = works.size();
        while (!works.empty() && !apps::isInterrupted()) {
            const std::size_t before = works.size();
            std::vector<std::size_t> left;
            left.reserve(before);
            for (const std::size_t k : works)
                if (!isDealtWith(manifest_.recordings[k])) left.push_back(k);
            works = std::move(left);
            if (works.size() == before && !options_.wait) break;
            if (works.size() == before) usleep(500000);
        }
        report_.left = works.size();
        return report_;
    }

  private:
    /// False if another process is at it, or the run was interrupted.
    bool isDealtWith(const Recording& recording) {
        if (apps::isInterrupted()) return false;
        if (store_.isDone(recording.key, options_.retry_failed)) return noteEarlier(recording);
        const auto claim = claims_.take(store_.claimsOf(recording.key), recording.key);
        if (!claim) return false;
        if (store_.isDone(recording.key, options_.retry_failed)) return noteEarlier(recording);
        return work(recording, *claim);
    }

    bool noteEarlier(const Recording& recording) {
        ++report_.before;
        const Result result = store_.read(recording.key);
        if (result.status == Status::Done) return true;
        ++report_.failed;
        std::fprintf(stderr, "obstacle-fleet: %s: %s before: %s\n", recording.name.c_str(), toString(result.status),
                     result.reason.c_str());
        return true;
    }

    bool work(const Recording& recording, const Claim& claim) {
        const auto start = Clock::now();
        const fs::path folder = store_.begin(recording.key, owner_.word());
        const Ending ending = runIsolated([&] { detectRecording(detector_, recording, folder); }, watchOf(claim));
        if (ending.kind == Ending::Kind::Interrupted || ending.kind == Ending::Kind::NoOutput) {
            std::error_code ignored;
            fs::remove_all(folder, ignored);
            const bool is_ours = ending.kind == Ending::Kind::NoOutput && claim.holds();
            if (is_ours) throw std::runtime_error(ending.reason);
            return false;
        }
        if (ending.kind == Ending::Kind::Failed) {
            store_.begin(recording.key, owner_.word());  // nothing of it stays
            const std::string reason = withName(ending.reason, manifest_.settings, recording.name);
            writeFailure(folder, {Status::Failed, reason, ending.again});
        }
        if (!claim.holds() || !store_.publish(folder, recording.key, options_.retry_failed)) {
            std::error_code ignored;
            fs::remove_all(folder, ignored);
            return false;  // another process took over: what it does is looked at later
        }
        say(recording, secondsSince(start));
        return true;
    }

    Watch watchOf(const Claim& claim) const {
        const double pause = std::min(30.0, options_.stale / 5.0);  // between signs of life [s]
        auto last = Clock::now();
        return {options_.timeout,
                [&claim, last, pause]() mutable {
                    if (secondsSince(last) < pause) return;
                    claim.beat();
                    last = Clock::now();
                },
                [] { return apps::isInterrupted(); }};
    }

    void say(const Recording& recording, double seconds) {
        ++report_.done;
        const Result result = store_.read(recording.key);
        std::printf("%s: %s in %.1f s (%zu of %zu)\n", recording.name.c_str(), toString(result.status), seconds,
                    report_.done + report_.before, report_.recordings);
        std::fflush(stdout);
        if (result.status == Status::Done) return;
        ++report_.failed;
        std::fprintf(stderr, "obstacle-fleet: %s: %s: %s\n", recording.name.c_str(), toString(result.status),
                     result.reason.c_str());
    }

    const RunOptions& options_;
    const Manifest& manifest_;
    Detector detector_;
    Store store_;
    Owner owner_;
    Claims claims_;
    RunReport report_;
};

}  // namespace

RunReport runShard(const RunOptions& options) {
    const Shard shard = chooseShard(options.shard, [](const char* name) { return std::getenv(name); });
    const Manifest manifest = readOwnManifest(options.manifest);
    std::printf("shard %zu of %zu (%s)\n", shard.index, shard.count, shard.source.c_str());
    return ShardRun(options, manifest).run(shard);
}

}  // namespace lidar_obstacles::fleet

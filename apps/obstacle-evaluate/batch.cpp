// SPDX-License-Identifier: BSD-3-Clause
#include "batch.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>

#include "common/interrupt.h"
#include "common/progress_bar.h"
#include "detector.h"

namespace lidar_obstacles::apps {
namespace {

/// One progress bar for all jobs; may be called from any thread.
class SharedProgress {
  public:
    explicit SharedProgress(std::size_t jobs) : shares_(jobs, 0.0) {}

    void update(std::size_t job, double share) {
        const std::lock_guard<std::mutex> lock(mutex_);
        shares_[job] = share;
        ++scans_;
        bar_.update(std::accumulate(shares_.begin(), shares_.end(), 0.0) / static_cast<double>(shares_.size()), scans_);
    }

  private:
    std::mutex mutex_;
    ProgressBar bar_;
    std::vector<double> shares_;
    std::size_t scans_ = 0;
};

/// Leaves of a set what was there up to the last scan of an interrupted run.
void cutTo(const Progress& done, const evaluation::EvaluationOptions& options, evaluation::LabelledSet& set) {
    const auto isLater = [&](const auto& row) {
        return options.match_by_index ? row.scan_index >= static_cast<int>(done.scans)
                                      : row.timestamp > done.last_time + options.time_tolerance;
    };
    set.truth.erase(std::remove_if(set.truth.begin(), set.truth.end(), isLater), set.truth.end());
    set.ego.erase(std::remove_if(set.ego.begin(), set.ego.end(), isLater), set.ego.end());
}

/// What can be judged of a set whose run was interrupted: nothing where too little of it was read to ask for anything.
std::optional<evaluation::SetResult> judgePart(const evaluation::LabelledSet& set,
                                               const evaluation::EvaluationOptions& options) {
    try {
        return evaluation::evaluateSet(set, options);
    } catch (const std::runtime_error&) {
        return std::nullopt;
    }
}

JobResult runJob(const Job& job, const EvaluateOptions& options, const std::function<void(double)>& progress) {
    if (isInterrupted()) return {std::nullopt, 0};
    evaluation::LabelledSet set;  // first the small files: what is wrong with them need not wait for the detector
    set.name = job.files.name;
    set.truth = evaluation::readTruth(job.files.truth, options.pose, options.points_column);
    if (!job.files.ego.empty()) set.ego = evaluation::readEgoPoses(job.files.ego);
    if (!job.files.statics.empty()) set.statics = evaluation::readStaticBoxes(job.files.statics);
    Progress done;
    if (job.files.detections.empty())
        done = writeDetections({job.files.rawlog, options.choice}, job.params, job.detections, progress);
    if (!done.remarks.empty())
        std::fprintf(stderr, "obstacle-evaluate: %s: %s\n", job.files.rawlog.c_str(), done.remarks.c_str());
    set.detections = evaluation::readDetections(job.detections);
    if (!done.interrupted) return {evaluation::evaluateSet(set, options.evaluation), std::nullopt};
    cutTo(done, options.evaluation, set);
    return {judgePart(set, options.evaluation), done.scans};
}

/// A result, or why there is none.
struct Outcome {
    JobResult result;
    std::exception_ptr error;
};

Outcome tryJob(const Job& job, const EvaluateOptions& options, const std::function<void(double)>& progress) {
    try {
        return {runJob(job, options, progress), nullptr};
    } catch (...) {
        return {{}, std::current_exception()};
    }
}

}  // namespace

std::vector<JobResult> runJobs(const std::vector<Job>& jobs, const EvaluateOptions& options) {
    std::vector<Outcome> outcomes(jobs.size());
    SharedProgress progress(jobs.size());
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t k = next++; k < jobs.size(); k = next++)
            outcomes[k] = tryJob(jobs[k], options, [&, k](double share) { progress.update(k, share); });
    };
    std::vector<std::thread> threads;
    for (int t = 1; t < options.jobs && static_cast<std::size_t>(t) < jobs.size(); ++t) threads.emplace_back(work);
    work();
    for (std::thread& t : threads) t.join();
    std::vector<JobResult> results;
    for (Outcome& o : outcomes) {
        if (o.error) std::rethrow_exception(o.error);
        results.push_back(std::move(o.result));
    }
    return results;
}

}  // namespace lidar_obstacles::apps

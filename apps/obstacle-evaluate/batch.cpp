#include "batch.h"

#include <atomic>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>

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

evaluation::SetResult runJob(const Job& job, const EvaluateOptions& options,
                             const std::function<void(double)>& progress) {
    evaluation::LabelledSet set;  // first the small files: what is wrong with them need not wait for the detector
    set.name = job.files.name;
    set.truth = evaluation::readTruth(job.files.truth, options.pose, options.points_column);
    if (!job.files.ego.empty()) set.ego = evaluation::readEgoPoses(job.files.ego);
    if (!job.files.statics.empty()) set.statics = evaluation::readStaticBoxes(job.files.statics);
    if (job.files.detections.empty())
        writeDetections({job.files.rawlog, options.sensor_label}, job.params, job.detections, progress);
    set.detections = evaluation::readDetections(job.detections);
    return evaluation::evaluateSet(set, options.evaluation);
}

/// A result, or why there is none.
struct Outcome {
    evaluation::SetResult result;
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

std::vector<evaluation::SetResult> runJobs(const std::vector<Job>& jobs, const EvaluateOptions& options) {
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
    std::vector<evaluation::SetResult> results;
    for (Outcome& o : outcomes) {
        if (o.error) std::rethrow_exception(o.error);
        results.push_back(std::move(o.result));
    }
    return results;
}

}  // namespace lidar_obstacles::apps

// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Detector runs and evaluations of many recordings, several at a time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/evaluate.h"
#include "lidar_obstacles/params.h"
#include "options.h"

namespace lidar_obstacles::apps {

/// One recording under one variant.
struct Job {
    SetFiles files;
    DetectorParams params;
    std::string detections;  ///< obstacles.csv: read, and written before that where `files.detections` is ""
};

/// What came of a job.
struct JobResult {
    /// Not set where the run was interrupted before anything of the set could be judged. Where it was interrupted later
    /// the scans up to there are judged.
    std::optional<evaluation::SetResult> result;
    std::optional<std::size_t> interrupted_at;  ///< first scan that a signal left out; not set: none
};

/// Works off all jobs, `options.jobs` at a time.
/// @return one result per job, in the order of the jobs, whatever the number of threads.
/// @throws the error of the first job, in their order, that failed.
std::vector<JobResult> runJobs(const std::vector<Job>& jobs, const EvaluateOptions& options);

}  // namespace lidar_obstacles::apps

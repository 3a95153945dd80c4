/// @file
/// Detector runs and evaluations of many recordings, several at a time.
#pragma once

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

/// Works off all jobs, `options.jobs` at a time.
/// @return one result per job, in the order of the jobs, whatever the number of threads.
/// @throws the error of the first job, in their order, that failed.
std::vector<evaluation::SetResult> runJobs(const std::vector<Job>& jobs, const EvaluateOptions& options);

}  // namespace lidar_obstacles::apps

// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which part of the work is this process's: number i of n parts, counted from 0.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "manifest.h"

namespace lidar_obstacles::fleet {

struct Shard {
    std::size_t index = 0;
    std::size_t count = 1;
    std::string source = "whole";  ///< what said so: "--shard", the name of a variable, "whole"
};

/// The value of a variable of the environment; null if it is not set.
using Environment = std::function<const char*(const char*)>;

/// From `words` ("I/N", 0 <= I < N) if they are not empty, else from the first of these that is set: the array of Slurm
/// (SLURM_ARRAY_TASK_ID, _COUNT, _MIN, _STEP), Open MPI (OMPI_COMM_WORLD_RANK, _SIZE), other MPIs (PMI_RANK, PMI_SIZE),
/// the tasks of srun (SLURM_PROCID, SLURM_NTASKS); else all.
/// @throws apps::UsageError naming what is not right, also for an array of Slurm whose numbers do not follow each
/// other.
Shard chooseShard(const std::string& words, const Environment& environment);

/// The recordings of a shard, by their place in the manifest: of those with the same key the first, largest first, each
/// to the shard that has the fewest bytes so far. Those that could not be read are left out.
std::vector<std::size_t> worksOf(const Manifest& manifest, const Shard& shard);

}  // namespace lidar_obstacles::fleet

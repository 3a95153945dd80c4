// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The output folder: a folder for each piece of work, there as a whole or not at all.
///
///     results/ab/<key>/result.json   what came of it: done, damaged or failed, why, counts
///                      obstacles.csv, scans.csv, tracks.csv, timings.csv      (not where it failed)
///     claims/ab/<key>.0              who is at it now (claims.h)
///     unfinished/<key>.<who>/        results that are being written
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace lidar_obstacles::fleet {

enum class Status : std::uint8_t {
    Done,
    Damaged,  ///< what stands before a damage is there
    Failed,   ///< there is nothing but a reason
};
/// "done", "damaged" or "failed".
const char* toString(Status status);

/// What result.json says first; `counts` is the rest of it, as text.
struct Result {
    Status status = Status::Done;
    std::string reason;  ///< of what went wrong; empty where all went well
    bool again = false;  ///< the recording need not be to blame: it is tried again by the next run
};

class Store {
  public:
    /// Makes the folder. @throws std::runtime_error naming it.
    explicit Store(std::filesystem::path folder);

    std::filesystem::path resultOf(const std::string& key) const;
    std::filesystem::path claimsOf(const std::string& key) const;
    /// True if the work is done, or failed and need not be tried again.
    /// @param retry_failed  also what failed or was damaged before began_ns is to be tried again.
    bool isDone(const std::string& key, bool retry_failed) const;
    /// What came of it. @throws std::runtime_error naming result.json if it is not there or not what was written.
    Result read(const std::string& key) const;

    /// An empty folder to write results into.
    std::filesystem::path begin(const std::string& key, const std::string& who) const;
    /// Gives a folder of results their place, and takes the folder away. Results that are there stay, but for what is
    /// to be tried again. What killed processes left of the same work goes. @return false if results were there.
    /// @throws std::runtime_error naming the folder.
    bool publish(const std::filesystem::path& unfinished, const std::string& key, bool retry_failed) const;
    /// The time of the file system [ns]: clocks of machines differ.
    std::int64_t now() const;

  private:
    std::filesystem::path folder_;
    std::int64_t began_ns_ = 0;  ///< failures before that may be tried again
};

/// Writes result.json of work that failed. @throws std::runtime_error
void writeFailure(const std::filesystem::path& folder, const Result& result);

}  // namespace lidar_obstacles::fleet

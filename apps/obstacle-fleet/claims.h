// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Who is at a piece of work. Any number of processes, on any machines that share the folder, may ask for it at the
/// same time: one gets it. That needs hard links, which are atomic on local disks, NFS, Lustre, BeeGFS, and no locks.
///
/// A claim is a file `<key>.<n>`; the highest n holds. Claim n+1 may be made once claim n is stale:
/// * its process is gone, as far as it ran on this machine since it was started, or
/// * it was the same task of Slurm before Slurm started it again, or
/// * it gave no sign of life for `stale` seconds, by the clock of the file system.
/// A process that was only asleep sees that it holds no more, and drops its results.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace lidar_obstacles::fleet {

/// A process, among those of all machines.
struct Owner {
    std::string machine;        ///< differs between machines, starts of one, and containers
    std::int64_t process = 0;   ///< its number
    std::int64_t started = 0;   ///< when it was started [ticks since the machine was]
    std::string job;            ///< of Slurm; "": none
    std::int64_t restarts = 0;  ///< of the job

    /// In names of files.
    std::string word() const;
};
/// This process.
Owner thisProcess();
/// False if it is certain that `other` has ended, seen from `me`.
bool mayLive(const Owner& other, const Owner& me);

/// A claim that is held; released with the object.
class Claim {
  public:
    Claim(std::filesystem::path file, std::filesystem::path stem) : file_(std::move(file)), stem_(std::move(stem)) {}
    Claim(Claim&& other) noexcept;
    Claim& operator=(Claim&&) = delete;
    ~Claim();

    /// A sign of life.
    void beat() const;
    /// False if another process has taken over.
    bool holds() const;

  private:
    std::filesystem::path file_;  ///< empty: moved from
    std::filesystem::path stem_;  ///< the key, in the claims' folder
};

class Claims {
  public:
    /// @param stale  seconds without a sign of life.
    /// @param now    the time of the file system [ns].
    Claims(Owner owner, double stale, std::function<std::int64_t()> now)
        : owner_(std::move(owner)), stale_(stale), now_(std::move(now)) {}

    /// The claim to a key; nullopt if another process holds it.
    /// @param folder  of the claims to this and other keys; it exists.
    /// @throws std::runtime_error naming the folder if nothing can be written there.
    std::optional<Claim> take(const std::filesystem::path& folder, const std::string& key) const;

  private:
    bool isStale(const std::filesystem::path& claim) const;
    std::optional<std::filesystem::path> link(const std::filesystem::path& folder, const std::string& name) const;

    Owner owner_;
    double stale_;
    std::function<std::int64_t()> now_;
};

}  // namespace lidar_obstacles::fleet

// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Work in a process of its own: where it crashes, hangs or eats the memory, only that work is lost. The process is a
/// copy of this one (fork without exec), so it starts with all libraries and the model in memory.
#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace lidar_obstacles::fleet {

/// The results cannot be written: no other work would fare better.
class OutputError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};
/// Something outside the recording went wrong: another try may go well.
class PassingError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

struct Ending {
    enum class Kind : std::uint8_t { Well, Failed, NoOutput, Interrupted };
    Kind kind = Kind::Well;
    std::string reason;  ///< of Failed and NoOutput
    bool again = false;  ///< Failed: another try may go well
};

struct Watch {
    double timeout = 0.0;           ///< the work is ended after that [s]; 0: never
    std::function<void()> beat;     ///< called about once a second
    std::function<bool()> is_over;  ///< true: the work is ended, and did not happen
};

/// Runs `work` and says how it ended: what it throws is a reason (OutputError: NoOutput; PassingError and lack of
/// memory: Failed, again), as are signals and the timeout. The process must have one thread.
/// @throws std::runtime_error if no process can be made.
Ending runIsolated(const std::function<void()>& work, const Watch& watch);

}  // namespace lidar_obstacles::fleet

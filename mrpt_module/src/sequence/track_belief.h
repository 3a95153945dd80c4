// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a track is, and where its front is: beliefs that outlast a scan.
#pragma once

#include <array>
#include <tuple>

#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/tracking.h"

namespace lidar_obstacles {

inline constexpr double kCreeping = 0.3;  ///< what is slower is not told from the errors of boxes [m/s]

/// Classes over time: the mean of their log-probabilities over the last seconds, each by how much was seen, counted as
/// so many independent looks as the root of their number, since one scan's mistake is often the next one's as well.
class ClassBelief {
  public:
    /// @param dt  since the last look [s]; @param quality  of the look, above 0: 1 where all there is was seen well
    void look(const ClassProbabilities& seen, double dt, double quality);
    /// What drives is no wall and what runs is no pedestrian, however it looks.
    /// @param speed  that it surely has, over ground [m/s]; @param travelled  since it began [m]
    void moved(double speed, double travelled);
    /// Adds up to 1.
    ClassProbabilities probabilities() const;
    ObstacleClass best() const { return best_; }

  private:
    static constexpr std::size_t kClasses = std::tuple_size_v<ClassProbabilities>;

    std::array<double, kClasses> mean_log_{};
    std::array<double, kClasses> motion_{};  ///< log-likelihoods of how it moves
    double looks_ = 0.0;
    double weight_ = 0.0;  ///< of what `mean_log_` is made of
    ObstacleClass best_ = ObstacleClass::Unknown;
};

/// Which of a body's four directions is its front: log-odds with memory.
class DirectionBelief {
  public:
    /// The heading of a box, so many quarter turns off the body's yaw.
    void see(int quarters);
    /// How it moves in its own axes [m/s], for so long [s].
    void move(const Eigen::Vector2d& velocity, double dt);
    /// Only the axis along the yaw can be the body's length, or only the one across it.
    void proveAxis(bool along);
    /// Turns by quarters that the yaw needs now (0 .. 3); the belief is that of the turned yaw afterwards.
    int takeTurn();
    bool known() const;

  private:
    double axis_ = 0.2;   ///< for: the yaw is along the body, not across
    double front_ = 0.0;  ///< for: the yaw points to the front, not to the back
};

}  // namespace lidar_obstacles

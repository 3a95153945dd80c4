// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/searched_place.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// The rings of one sensor that come down near the vehicle, told above the ground that the vehicle stands on: one
/// plane, so that steps are steps of the scan and not of a model that bends.
class NearGround {
  public:
    struct Cell {
        float height = 0.0f;      ///< above the plane [m]
        float range = -1.0f;      ///< from the sensor, horizontal [m]; negative: no return
        std::int32_t point = -1;  ///< of the cloud
        bool left_out = false;    ///< a return where nothing is searched
        bool isReturn() const { return range >= 0.0f; }
    };

    /// @param cloud   with a view; must outlive this.
    /// @param sensor  number of it in cloud.allSensors().
    NearGround(const PointCloud& cloud, const GroundModel& model, const DetectorParams& params, std::size_t sensor);

    int rings() const { return rings_; }  ///< from the lowest up to the last below the horizon
    int columns() const { return columns_; }
    int wrap(int column) const {
        return column < 0 ? column + columns_ : column >= columns_ ? column - columns_ : column;
    }
    const Cell& at(int ring, int column) const { return cells_[static_cast<std::size_t>(ring) * columns_ + column]; }
    /// Did the beam meet, or pass, the plane near enough to be looked at?
    bool isNear(const Cell& cell) const { return cell.isReturn() && crossing(cell) <= reach_; }
    /// Can the ground on which the vehicle stands go on to there?
    bool isLevel(const Cell& cell) const {
        return std::abs(cell.height) <= std::max(2.0f * step_, steepest_ * cell.range);
    }
    /// Where the beam of a cell without a return would meet the plane [m]; infinite where it does not come down, and
    /// where nothing is searched.
    float expectedRange(int ring, int column) const {
        return expected_[static_cast<std::size_t>(ring) * columns_ + column];
    }
    /// Where the beam that ends at a cell passed the plane [m]: nearer than the cell where that is below the plane.
    float crossing(const Cell& cell) const {
        return cell.height >= 0.0f ? cell.range : cell.range * sensor_height_ / (sensor_height_ - cell.height);
    }
    /// Does something that is higher than a low thing stand right there, seen by a ring above?
    bool isFoot(int ring, int column) const;
    /// The place so far away from the sensor in the direction of a column, seen from above.
    Eigen::Vector2f place(int column, float range) const { return origin_ + range * direction_[column]; }
    /// The same in the direction of a return.
    Eigen::Vector2f placeOn(const Cell& cell, float range) const {
        return origin_ + range / std::max(cell.range, 0.01f) * (cloud_.xyz[cell.point].head<2>() - origin_);
    }

    float step() const { return step_; }          ///< smallest of interest [m]
    float steepest() const { return steepest_; }  ///< rise over run of ground
    float tallest() const { return tallest_; }    ///< of a low thing [m]
    float reach() const { return reach_; }        ///< [m]

  private:
    void fill(const SensorRays& rays, int first_ring, const DetectorParams& params);
    void setLevel();
    void setDirections();
    void setExpected(const SensorRays& rays);

    const PointCloud& cloud_;
    SearchedPlace searched_;
    int rings_ = 0, columns_ = 0;
    int all_rings_ = 0;  ///< with those above the horizon that may hit what stands here
    float step_, steepest_, tallest_, reach_;
    Eigen::Vector2f slope_ = Eigen::Vector2f::Zero();   ///< of the plane
    Eigen::Vector2f origin_ = Eigen::Vector2f::Zero();  ///< of the rays, seen from above
    float sensor_z_ = 0.0f;
    float sensor_height_ = 0.0f;  ///< above the plane [m]
    std::vector<Cell> cells_;
    std::vector<float> elevation_;  ///< of each ring above the sensor's horizon: sine
    std::vector<float> expected_;
    std::vector<Eigen::Vector2f> direction_;  ///< of each column, unit length
};

}  // namespace lidar_obstacles

/// @file
/// How large a track's body is, outside the filter of its motion: where its four faces are, as seen from a point that
/// is fixed to the body. Growing a face moves the box's centre and not that point, so that it makes no velocity.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace lidar_obstacles {

/// Faces counter-clockwise from the front: front, left, back, right; the number times 90 degrees is the direction of
/// its outward normal, relative to the body's yaw.
inline constexpr std::size_t kFaces = 4;

/// What is known of where the edge of a box is.
enum class EdgeGrade : unsigned char {
    Guess,       ///< nobody saw it: completed
    Silhouette,  ///< where the returns end: the body may go on, behind something or between two beams
    Seen         ///< returns lie on the face
};

/// Views of one number (where a face is, how high a body is), the best and newest of them; their weighted median is
/// what is believed. One odd view (a scrap, a merger) does not move it.
class BestViews {
  public:
    /// Adds a view; `weight` > 0. What was seen before fades a little.
    void add(double value, double weight);
    double value() const { return value_; }
    /// Sum of the weights that are kept: 1 per good view.
    double weight() const { return weight_; }
    /// Standard deviation of the value [m].
    double std() const;
    /// Adds `shift` to all views.
    void move(double shift);
    /// No view says more than `limit` from now on.
    void cut(double limit);

  private:
    struct View {
        double value = 0.0;
        double weight = 0.0;
    };
    void settle();

    static constexpr std::size_t kKept = 12;
    std::array<View, kKept> views_{};  ///< rising by value
    std::size_t count_ = 0;
    double value_ = 0.0;
    double weight_ = 0.0;
};

/// The four faces: their distances from the body's point along their outward normals [m].
class BodyShape {
  public:
    BestViews& face(std::size_t k) { return faces_[k]; }
    const BestViews& face(std::size_t k) const { return faces_[k]; }
    double length() const { return extent(0); }
    double width() const { return extent(1); }
    /// Of the axis of face `k` (0, 1), at least some centimetres [m].
    double extent(std::size_t k) const;
    /// The box's centre, from the body's point, along yaw and to the left of it [m].
    Eigen::Vector2d center() const;
    /// Renames the faces after the yaw was turned by `quarters` times 90 degrees.
    void turn(int quarters);

  private:
    std::array<BestViews, kFaces> faces_;
};

}  // namespace lidar_obstacles

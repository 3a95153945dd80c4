// SPDX-License-Identifier: BSD-3-Clause
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
    /// Adds a view; `weight` > 0. What was seen before keeps the share `keep` of its weight.
    void add(double value, double weight, double keep);
    double value() const { return value_; }
    /// Sum of the weights that are kept: 1 per good view.
    double weight() const { return weight_; }
    /// Standard deviation of the value [m].
    double std() const;

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

/// One axis of a body: its extent, and where along it the body's point lies.
class BodyAxis {
  public:
    /// Where the two edges of a view are, from the body's point [m], both outwards: ahead and behind.
    struct View {
        std::array<double, 2> edge{};
        std::array<EdgeGrade, 2> grade{};
        double quality = 1.0;  ///< 0 .. 1
        bool ends = false;     ///< beams went where the body was believed to go on: it ends where the view does
    };

    void begin(const View& view);
    /// The extent is the best views'; where the body's point lies follows the face that is seen, so that a growing
    /// body grows at its other end.
    void learn(const View& view);
    double extent() const;
    /// From the body's point to a face [m]; 0: ahead, 1: behind.
    double face(std::size_t side) const;
    double faceStd(std::size_t side) const;
    /// From the body's point to the middle, positive ahead [m].
    double center() const { return center_; }
    void reverse();

  private:
    void addExtent(const View& view);
    void anchor(std::size_t side, double at);

    BestViews all_;   ///< of the extent, also those that were completed
    BestViews seen_;  ///< without these
    double center_ = 0.0;
    std::array<double, 2> variance_{};  ///< of the faces [m2]
};

/// Both axes: along the yaw and across it, faces counter-clockwise from the front.
class BodyShape {
  public:
    BodyAxis& axis(std::size_t k) { return axes_[k]; }
    double face(std::size_t k) const { return axes_[k % 2].face(k / 2); }
    double faceStd(std::size_t k) const { return axes_[k % 2].faceStd(k / 2); }
    double extent(std::size_t k) const { return axes_[k].extent(); }
    /// The box's centre, from the body's point, along yaw and to the left of it [m].
    Eigen::Vector2d center() const { return {axes_[0].center(), axes_[1].center()}; }
    /// Renames the faces after the yaw was turned by 180 degrees.
    void reverse();

  private:
    std::array<BodyAxis, 2> axes_;
};

}  // namespace lidar_obstacles

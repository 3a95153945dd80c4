// SPDX-License-Identifier: BSD-3-Clause
#include "box_labels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "lidar_obstacles/evaluation/truth.h"
#include "samples.h"

namespace lidar_obstacles::apps {
namespace {

/// A box, ready to be asked how far points are from it.
class Reach {
  public:
    explicit Reach(const LabelledBox& labelled)
        : labelled_(labelled),
          T_box_vehicle_(Eigen::AngleAxisd(-labelled.box.yaw, Eigen::Vector3d::UnitZ()) *
                         Eigen::Translation3d(-labelled.box.center)) {}

    /// From the box to a point, 0 inside [m].
    double distanceTo(const Eigen::Vector3d& point) const {
        const Eigen::Vector3d in_box = T_box_vehicle_ * point;
        return (in_box.cwiseAbs() - 0.5 * labelled_.box.size).cwiseMax(0.0).norm();
    }
    const LabelledBox& labelled() const { return labelled_; }

  private:
    const LabelledBox& labelled_;
    Eigen::Isometry3d T_box_vehicle_;
};

constexpr simulation::ReturnLabel kOpen{kUnsure, ObjectKind::Noise};
constexpr simulation::ReturnLabel kStanding{0, ObjectKind::Wall};

bool isIn(const LabelledView& view, const Eigen::Vector3d& point) {
    return std::abs(std::atan2(point.y(), point.x())) <= view.half_angle && point.head<2>().norm() <= view.reach;
}

/// @param boxes  the smallest first.
simulation::ReturnLabel labelOf(const Eigen::Vector3d& point, const std::vector<Reach>& boxes,
                                const LabelledView& view) {
    if (!isIn(view, point)) return kOpen;
    bool near = false;
    for (const Reach& box : boxes) {
        const double distance = box.distanceTo(point);
        near = near || distance <= kBoxDoubt;
        if (distance > kBoxSlack) continue;
        const LabelledBox& labelled = box.labelled();
        return labelled.kind ? simulation::ReturnLabel{labelled.id, *labelled.kind} : kOpen;
    }
    return near ? kOpen : kStanding;
}

}  // namespace

std::vector<simulation::ReturnLabel> labelsByBoxes(const PointCloud& cloud, const std::vector<LabelledBox>& boxes,
                                                   const LabelledView& view) {
    std::vector<LabelledBox> by_size = boxes;
    std::stable_sort(by_size.begin(), by_size.end(),
                     [](const LabelledBox& a, const LabelledBox& b) { return a.box.size.prod() < b.box.size.prod(); });
    const std::vector<Reach> smallest_first(by_size.begin(), by_size.end());
    std::vector<simulation::ReturnLabel> labels;
    labels.reserve(cloud.size());
    for (const Eigen::Vector3f& p : cloud.xyz) labels.push_back(labelOf(p.cast<double>(), smallest_first, view));
    return labels;
}

LabelledType labelledTypeOf(const std::string& type) {
    using evaluation::Group;
    if (type == "ignore" || type == "dontcare" || type == "misc") return {true, std::nullopt};
    if (const auto kind = kindNamed(type)) return {true, kind};
    switch (evaluation::groupOf(type)) {
        case Group::Vehicle:
            return {true, ObjectKind::Car};
        case Group::Pedestrian:
            return {true, ObjectKind::Pedestrian};
        case Group::Cyclist:
            return {true, ObjectKind::Cyclist};
        case Group::Other:
            break;
    }
    return {};
}

}  // namespace lidar_obstacles::apps

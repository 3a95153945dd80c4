// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/scan_alignment.h"
#include "scan/median.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

constexpr double kFinalReach = 0.04;  // error of a return and of a cell's middle [m]
constexpr int kMaxSteps = 10;
constexpr float kEvenly = static_cast<float>(SurfaceMap::kEdge * SurfaceMap::kEdge / 12.0);  // variance of a full cell

/// One pass over all points: the normal equations of what they say.
class Pass {
  public:
    Pass(const SurfaceMap& map, const Eigen::Isometry3d& T_world_vehicle, double reach)
        : map_(map),
          T_(T_world_vehicle),
          R_(T_world_vehicle.linear().cast<float>()),
          noise_(static_cast<float>(reach * reach)) {}

    void add(const MatchPoint& point, const Eigen::Vector3f& straight) {
        const Eigen::Vector3f lever = R_ * straight;
        const Eigen::Vector3d q = T_.translation() + lever.cast<double>();
        const SurfaceHit ground = map_.groundAt(q);
        constexpr float kNearGround = 0.4f;  // above that it stands [m]
        if (ground.cell && std::abs(ground.offset.z()) < kNearGround) {
            const float far = ground.offset.z() * ground.offset.z() / noise_;
            addRow(Eigen::Vector3f::UnitZ(), lever, ground.offset.z(), weightOf(far) / noise_);
            count(std::abs(ground.offset.z()), weightOf(far));
            return;
        }
        const SurfaceHit standing = map_.standingAt(q);
        if (!standing.cell) return;
        agreement[eighthOf(straight)] += static_cast<double>(
            point.tangent.isZero() ? addAlone(standing, lever)
                                   : addSurface(standing, lever, R_.topLeftCorner<2, 2>() * point.tangent));
    }

    Matrix6d H = Matrix6d::Zero();
    Vector6d g = Vector6d::Zero();
    double fit = 0.0;                   ///< returns that lie on a surface, by how well they do
    std::array<double, 8> agreement{};  ///< the same, by how sharp that surface is as well, in each direction
    std::vector<float> distances;

  private:
    /// Half at one and a half standard deviations, next to nothing at five.
    static float weightOf(float chi_squared) {
        const float share = 1.0f / (1.0f + chi_squared / 5.0f);
        return share * share;
    }

    static std::size_t eighthOf(const Eigen::Vector3f& p) {
        return (p.x() > 0.0f ? 1U : 0U) + (p.y() > 0.0f ? 2U : 0U) + (std::abs(p.x()) > std::abs(p.y()) ? 4U : 0U);
    }

    void count(float distance, float weight) {
        distances.push_back(distance);
        fit += static_cast<double>(weight);
    }

    void addRow(const Eigen::Vector3f& v, const Eigen::Vector3f& lever, float error, float weight) {
        Eigen::Matrix<float, 6, 1> row;
        row << v, lever.cross(v);
        const Vector6d wide = row.cast<double>();
        H.selfadjointView<Eigen::Lower>().rankUpdate(wide, static_cast<double>(weight));
        g += static_cast<double>(weight * error) * wide;
    }

    /// What goes on to both sides says only how far it is across. @return how well it agrees.
    float addSurface(const SurfaceHit& hit, const Eigen::Vector3f& lever, const Eigen::Vector2f& tangent) {
        const Eigen::Vector2f across(-tangent.y(), tangent.x());
        const float error = across.dot(hit.offset.head<2>());
        const float variance = across.dot(hit.cell->spread * across) + noise_;
        const float weight = weightOf(error * error / variance);
        addRow({across.x(), across.y(), 0.0f}, lever, error, weight / variance);
        count(std::abs(error), weight);
        return weight * noise_ / variance;
    }

    /// A post, a corner, a twig: along each axis of what its cell holds, unless that fills the cell.
    /// @return how well it agrees.
    float addAlone(const SurfaceHit& hit, const Eigen::Vector3f& lever) {
        const Eigen::Vector2f across = hit.cell->across, along(-across.y(), across.x());
        const Eigen::Array2f offset(across.dot(hit.offset.head<2>()), along.dot(hit.offset.head<2>()));
        const Eigen::Array2f sharp =
            (1.0f / (hit.cell->variance.array() + noise_) - 1.0f / (kEvenly + noise_)).max(0.0f);
        const float weight = weightOf((offset.square() * sharp).sum());
        addRow({across.x(), across.y(), 0.0f}, lever, offset[0], weight * sharp[0]);
        addRow({along.x(), along.y(), 0.0f}, lever, offset[1], weight * sharp[1]);
        count(std::abs(offset[0]), weight);
        return weight * noise_ * sharp[0];
    }

    const SurfaceMap& map_;
    const Eigen::Isometry3d& T_;
    Eigen::Matrix3f R_;
    float noise_;
};

/// The step to the least squares of the points and the expectation.
Vector6d stepOf(const Pass& pass, const Eigen::Isometry3d& pose, const ExpectedMove& expected) {
    Vector6d off, trust;
    const Eigen::AngleAxisd turn(pose.linear() * expected.T_world_vehicle.linear().transpose());
    off << pose.translation() - expected.T_world_vehicle.translation(), turn.angle() * turn.axis();
    const double place = expected.place_std * expected.place_std, angle = expected.turn_std * expected.turn_std;
    trust << Eigen::Vector3d::Constant(1.0 / place), Eigen::Vector3d::Constant(1.0 / angle);
    Matrix6d H = pass.H;
    H.diagonal() += trust;
    Vector6d g = pass.g + trust.cwiseProduct(off);
    constexpr double kHeld = 1e9;  // more than any scan says [1/m^2]
    H.topLeftCorner<2, 2>() += kHeld * expected.held * expected.held.transpose();
    g.head<2>() += kHeld * expected.held.dot(off.head<2>()) * expected.held;
    return -H.ldlt().solve(g);
}

Eigen::Isometry3d stepped(const Eigen::Isometry3d& pose, const Vector6d& step) {
    Eigen::Isometry3d next = pose;
    const double angle = step.tail<3>().norm();
    if (angle > 0.0) next.linear() = Eigen::AngleAxisd(angle, step.tail<3>() / angle) * pose.linear();
    next.translation() += step.head<3>();
    return next;
}

void judge(Pass& pass, std::size_t points, Alignment& a) {
    const double share = points == 0 ? 0.0 : 1.0 / static_cast<double>(points);
    a.fit = share * pass.fit;
    for (std::size_t k = 0; k < a.agreement.size(); ++k) a.agreement[k] = share * pass.agreement[k];
    a.overlap = share * static_cast<double>(pass.distances.size());
    if (!pass.distances.empty()) a.residual = static_cast<double>(medianOf(pass.distances));
    // what is left of the place when the other four are free
    Eigen::Matrix4d rest = pass.H.bottomRightCorner<4, 4>();
    rest.diagonal().array() += 1e-9;
    const Eigen::Matrix<double, 4, 2> both = pass.H.bottomLeftCorner<4, 2>();
    a.information = pass.H.topLeftCorner<2, 2>() - both.transpose() * rest.ldlt().solve(both);
}

}  // namespace

Alignment align(const SurfaceMap& map, const MatchPoints& scan, const std::vector<Eigen::Vector3f>& straight,
                const ExpectedMove& expected) {
    Alignment a;
    a.T_world_vehicle = expected.T_world_vehicle;
    double reach = std::max(expected.reach, kFinalReach);
    for (int step = 1;; ++step) {
        Pass pass(map, a.T_world_vehicle, reach);
        for (std::size_t k = 0; k < straight.size(); k += expected.every) pass.add(scan.points[k], straight[k]);
        pass.H = pass.H.selfadjointView<Eigen::Lower>();
        const Vector6d way = stepOf(pass, a.T_world_vehicle, expected);
        a.T_world_vehicle = stepped(a.T_world_vehicle, way);
        constexpr double kStill = 0.002, kStillTurn = 0.0002;  // [m], [rad]
        const bool still = way.head<3>().norm() < kStill && way.tail<3>().norm() < kStillTurn;
        if (reach == kFinalReach && (still || step >= kMaxSteps)) {
            judge(pass, (straight.size() + expected.every - 1) / expected.every, a);
            return a;
        }
        reach = std::max(kFinalReach, 0.5 * reach);
    }
}

}  // namespace lidar_obstacles

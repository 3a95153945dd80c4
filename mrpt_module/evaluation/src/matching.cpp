// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/evaluation/matching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "lidar_obstacles/evaluation/box_overlap.h"

namespace lidar_obstacles::evaluation {
namespace {

/// Shortest augmenting paths with potentials; rows and columns count from 1, 0 is where a path begins.
class Assignment {
  public:
    explicit Assignment(const Eigen::MatrixXd& cost)
        : cost_(cost), n_(cost.rows()), u_(n_ + 1), v_(n_ + 1), row_of_(n_ + 1, 0), from_(n_ + 1, 0) {
        u_.setZero();
        v_.setZero();
    }

    std::vector<int> solve() {
        for (Eigen::Index row = 1; row <= n_; ++row) augment(row);
        std::vector<int> column(static_cast<std::size_t>(n_), -1);
        for (Eigen::Index j = 1; j <= n_; ++j)
            column[static_cast<std::size_t>(at(row_of_, j) - 1)] = static_cast<int>(j - 1);
        return column;
    }

  private:
    using Indices = std::vector<Eigen::Index>;
    static Eigen::Index& at(Indices& v, Eigen::Index k) { return v[static_cast<std::size_t>(k)]; }

    /// Gives one more row a column.
    void augment(Eigen::Index row) {
        at(row_of_, 0) = row;
        Eigen::VectorXd least = Eigen::VectorXd::Constant(n_ + 1, std::numeric_limits<double>::infinity());
        std::vector<bool> used(static_cast<std::size_t>(n_) + 1, false);
        Eigen::Index column = 0;
        do column = step(column, least, used);
        while (at(row_of_, column) != 0);
        while (column != 0) {
            at(row_of_, column) = at(row_of_, at(from_, column));
            column = at(from_, column);
        }
    }

    /// Extends the tree of paths by the column that costs least; returns it.
    Eigen::Index step(Eigen::Index column, Eigen::VectorXd& least, std::vector<bool>& used) {
        used[static_cast<std::size_t>(column)] = true;
        const Eigen::Index row = at(row_of_, column);
        Eigen::Index next = 0;
        double delta = std::numeric_limits<double>::infinity();
        for (Eigen::Index j = 1; j <= n_; ++j) {
            if (used[static_cast<std::size_t>(j)]) continue;
            const double reduced = cost_(row - 1, j - 1) - u_[row] - v_[j];
            if (reduced < least[j]) {
                least[j] = reduced;
                at(from_, j) = column;
            }
            if (least[j] < delta) {
                delta = least[j];
                next = j;
            }
        }
        for (Eigen::Index j = 0; j <= n_; ++j) {
            if (used[static_cast<std::size_t>(j)]) {
                u_[at(row_of_, j)] += delta;
                v_[j] -= delta;
            } else {
                least[j] -= delta;
            }
        }
        return next;
    }

    const Eigen::MatrixXd& cost_;
    Eigen::Index n_;
    Eigen::VectorXd u_;  ///< potential of each row
    Eigen::VectorXd v_;  ///< potential of each column
    Indices row_of_;     ///< row of each column, 0: none
    Indices from_;       ///< the column before it on its path
};

/// How well a detection fits an object; 0 where it may not be it.
double score(const TruthObject& object, const Detection& detection, const MatchOptions& options) {
    const double gate = object.group == Group::Vehicle ? options.max_distance
                                                       : std::min(options.max_distance, options.max_distance_small);
    const double apart = (object.box.center - detection.box.center).head<2>().norm();
    const double reach = 0.5 * (object.box.size.head<2>().norm() + detection.box.size.head<2>().norm());
    if (!(apart <= std::max(gate, reach))) return 0.0;
    if (options.class_aware && detection.group != Group::Other && detection.group != object.group) return 0.0;
    constexpr double kTiny = 1e-9;
    const double shared = sharedArea(object.box, detection.box);
    const double own = std::max(kTiny, detection.box.size.x() * detection.box.size.y());
    const double iou = shared / std::max(kTiny, own + object.box.size.x() * object.box.size.y() - shared);
    const double on_object = shared / own;
    if (iou < options.min_iou && on_object < 0.5 && apart > gate) return 0.0;
    return iou + 0.3 * on_object + 0.1 * std::max(0.0, 1.0 - apart / gate) + 1e-3;
}

}  // namespace

std::vector<int> minimumCostAssignment(const Eigen::MatrixXd& cost) {
    if (cost.rows() != cost.cols()) throw std::invalid_argument("minimumCostAssignment: the matrix is not square");
    return Assignment(cost).solve();
}

IndexPairs pairsOfLargestScore(const Eigen::MatrixXd& score) {
    const Eigen::Index larger = std::max(score.rows(), score.cols());
    Eigen::MatrixXd cost = Eigen::MatrixXd::Zero(larger, larger);
    cost.topLeftCorner(score.rows(), score.cols()) = -score;
    const std::vector<int> column = minimumCostAssignment(cost);
    IndexPairs pairs;
    for (Eigen::Index i = 0; i < score.rows(); ++i) {
        const Eigen::Index j = column[static_cast<std::size_t>(i)];
        if (j < score.cols() && score(i, j) > 0.0)
            pairs.emplace_back(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
    }
    return pairs;
}

IndexPairs matchBoxes(const std::vector<TruthObject>& objects, const std::vector<Detection>& detections,
                      const MatchOptions& options) {
    Eigen::MatrixXd scores(static_cast<Eigen::Index>(objects.size()), static_cast<Eigen::Index>(detections.size()));
    for (Eigen::Index i = 0; i < scores.rows(); ++i) {
        for (Eigen::Index j = 0; j < scores.cols(); ++j)
            scores(i, j) =
                score(objects[static_cast<std::size_t>(i)], detections[static_cast<std::size_t>(j)], options);
    }
    return pairsOfLargestScore(scores);
}

}  // namespace lidar_obstacles::evaluation

// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Measures the features of groups of returns.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "lidar_obstacles/beams.h"
#include "lidar_obstacles/features.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

struct Footprint;
class LookedColumns;
class Quantiles;

/// Measures groups of one scan; those that several sensors see, as the one does that sees them best. Keeps its memory
/// from one group to the next; not to be used by several threads.
class FeatureExtractor {
  public:
    /// @param beams, ground  of one scan with a view; must outlive this.
    FeatureExtractor(const Beams& beams, const GroundModel& ground);
    ~FeatureExtractor();

    /// The features of a hypothesis that are measured; the others are zero. All zero where it has no returns.
    /// @param footprint  of its returns.
    FeatureVector operator()(const Hypothesis& hypothesis, const Footprint& footprint);

    const Beams& beams() const { return beams_; }

  private:
    static constexpr float kFar = 1e9f;
    static constexpr int kMany = 1 << 30;
    static constexpr std::size_t kListed = 1000;  ///< what a return in the view weighs against one that is not

    /// Where the group was hit in one column of the view.
    struct Column {
        float near = kFar, far = -kFar;  ///< horizontal distance of its returns [m]
        std::int32_t lowest = -1;        ///< returns
        std::int32_t highest = -1;
        int low_ring = kMany, high_ring = -1;  ///< of these

        bool hit() const { return lowest >= 0; }
    };
    /// Where one ring hit it.
    struct RingRun {
        int first = kMany, last = -kMany;  ///< columns, counted from the group's reference
        std::int32_t from = -1, to = -1;   ///< returns there
        int returns = 0;
    };
    /// A return of the group.
    struct Member {
        float x, y;    ///< [m]
        float height;  ///< above the ground [m]
        float range;   ///< horizontal [m]
        int column;    ///< counted from the group's reference
        int ring;
    };
    /// What all of its returns add up to.
    struct Sums {
        Eigen::Vector2f mean = Eigen::Vector2f::Zero();  ///< place of its returns from the first one, added up [m]
        float xx = 0.0f, xy = 0.0f, yy = 0.0f;           ///< products of these [m^2]
        float height = 0.0f, height_squared = 0.0f;
        float low = kFar, high = -kFar;  ///< heights [m]
        float nearest = kFar;            ///< [m]
        std::array<int, 5> bins{};       ///< returns by height
    };
    /// What is around a return, whatever group it is in.
    struct Neighbours {
        std::int32_t next;   ///< on its ring; -1: none
        std::int32_t above;  ///< on the next ring of its column; -1: none
        float rough;         ///< Beams::roughness() [m]
        bool jumps;          ///< the next one is much nearer or farther
        bool steep;          ///< the one above stands rather than leans
    };
    struct Box;
    struct ColumnEvidence;
    enum class Between : std::uint8_t { Nothing, Free, Hidden };

    const std::vector<std::int32_t>& chooseSensor(const std::vector<std::int32_t>& points);
    void gather(const std::vector<std::int32_t>& points);
    void gatherColumns(const std::vector<std::int32_t>& points);
    Box measureBox(const Footprint& footprint, FeatureVector& f) const;
    void measureHeights(FeatureVector& f);
    void measureProfile(const Box& box, FeatureVector& f) const;
    void measureRings(FeatureVector& f);
    void measureColumns(FeatureVector& f) const;
    ColumnEvidence evidenceOf(const Column& c, int column, float bottom) const;
    void weighBeam(std::int32_t j, const Column& c, float bottom, ColumnEvidence& e) const;
    std::int32_t firstFrom(int ring, int step, int column) const;
    Between lookBetween(int column, float line, float highest) const;
    void measureGaps(FeatureVector& f) const;
    void measureEnds(FeatureVector& f) const;
    void measureNotches(FeatureVector& f) const;
    float deepestNotch(const RingRun& run, int ring, const Eigen::Vector2f& ahead) const;
    void measureSurface(const std::vector<std::int32_t>& points, FeatureVector& f);
    void measureEdges(const Box& box, FeatureVector& f);
    const Neighbours& neighboursOf(std::int32_t i);
    bool mine(std::int32_t i) const { return owner_[i] == stamp_; }
    /// Column of the view of the group's k-th one.
    int viewColumn(std::size_t k) const;
    float surfaceTop(std::int32_t i);

    const Beams& beams_;
    const GroundModel& ground_;
    std::vector<std::int32_t> owner_;  ///< of each return: the group that was measured last and holds it
    std::int32_t stamp_ = 0;
    std::vector<float> surface_top_;   ///< of each return, as far as asked for; below -1e8: not yet
    std::vector<std::uint8_t> known_;  ///< of each return: are its neighbours known?
    std::unique_ptr<Neighbours[]> neighbours_;
    int first_ring_ = 0;                        ///< of the sensor that sees the group best
    int end_ring_;                              ///< past its last
    Eigen::Vector3f origin_;                    ///< of its rays
    std::vector<std::int32_t> of_sensor_;       ///< its returns of the group, where there are other sensors
    std::vector<Member> members_;               ///< the group's returns, in its order
    Sums sums_;                                 ///< of them
    std::unique_ptr<LookedColumns> looked_at_;  ///< a group's columns are counted without those where nobody looked
    int reference_ = 0;                         ///< column that the group's are counted from
    int first_column_ = 0;                      ///< of the group, counted from the reference
    std::vector<Column> columns_;
    std::vector<RingRun> runs_;
    std::unique_ptr<Quantiles> numbers_;
};

}  // namespace lidar_obstacles

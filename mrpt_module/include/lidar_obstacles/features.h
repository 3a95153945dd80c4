/// @file
/// What is measured of a group of returns to tell what it is. Every feature is a number with a unit.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lidar_obstacles/beams.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

struct Footprint;

/// The features in their order; featureInfos() says what each is.
enum class Feature : std::uint8_t {
    Returns,
    Range,
    Length,
    Width,
    Facing,
    Top,
    Bottom,
    TopLimit,
    MeanHeight,
    HeightSpread,
    ShareKnee,
    ShareHip,
    ShareChest,
    ShareHead,
    ShareAbove,
    WidthLow,
    WidthMiddle,
    WidthHigh,
    Lean,
    RingWidthSpread,
    Rings,
    RingShare,
    Fill,
    Through,
    Under,
    Hidden,
    GroundInside,
    Floating,
    GapShare,
    GapFree,
    GapHidden,
    GoesOnMore,
    GoesOnLess,
    HiddenMore,
    HiddenLess,
    GoesUp,
    GoesDown,
    RoughMedian,
    RoughHigh,
    RoughMetres,
    Jumps,
    EdgeMean,
    EdgeHigh,
    Thickness,
    Steep,
    Gap,
    NextGap,
    Pieces,
    RingStep,
    BeamStep,
    SensorHeight,
    Noise,
    Apart,
    LessShare,
    MoreWhole,
    MoreVehicle,
    MorePerson,
    MoreStructure,
    LessWhole,
    LessVehicle,
    LessPerson,
    LessStructure,
    Count
};

constexpr std::size_t kFeatures = static_cast<std::size_t>(Feature::Count);
using FeatureVector = std::array<float, kFeatures>;

struct FeatureInfo {
    const char* name;
    const char* unit;  ///< "" for shares and counts
    const char* text;
};
/// Name, unit and meaning of each.
const std::array<FeatureInfo, kFeatures>& featureInfos();

/// Is it told of the verdicts on the parts (measureParts), not measured?
constexpr bool isOfParts(Feature k) { return k >= Feature::Apart && k < Feature::Count; }

/// What is thought of the two parts of a hypothesis: of the one with more returns and of the other. A piece has no
/// parts: -1 each.
/// @param tree  its parts, scored.
void measureParts(const Hypothesis& hypothesis, const std::vector<Hypothesis>& tree, FeatureVector& f);

/// Measures groups of one scan. Keeps its memory from one group to the next; not to be used by several threads.
class FeatureExtractor {
  public:
    /// @param beams, ground  of one scan with a view; must outlive this.
    FeatureExtractor(const Beams& beams, const GroundModel& ground);

    /// The features of a hypothesis without those of its parts. All zero where it has no returns.
    /// @param footprint  of its returns.
    FeatureVector operator()(const Hypothesis& hypothesis, const Footprint& footprint);

    const Beams& beams() const { return beams_; }

  private:
    /// Where the group was hit in one column of the view.
    struct Column {
        float near = 0.0f, far = 0.0f;  ///< horizontal distance of its returns [m]
        std::int32_t lowest = -1;       ///< returns
        std::int32_t highest = -1;
    };
    /// Where one ring hit it.
    struct RingRun {
        int first = 0, last = 0;          ///< columns, counted from the group's reference
        std::int32_t from = -1, to = -1;  ///< returns there
        int returns = 0;
    };
    struct Box;
    struct ColumnEvidence;
    enum class Between : std::uint8_t { Nothing, Free, Hidden };

    void gather(const std::vector<std::int32_t>& points);
    Box measureBox(const std::vector<std::int32_t>& points, const Footprint& footprint, FeatureVector& f) const;
    void measureHeights(const std::vector<std::int32_t>& points, FeatureVector& f);
    void measureProfile(const std::vector<std::int32_t>& points, const Box& box, FeatureVector& f) const;
    void measureRings(FeatureVector& f);
    void measureColumns(FeatureVector& f) const;
    ColumnEvidence evidenceOf(const Column& c, int column, float bottom) const;
    void weighBeam(std::int32_t j, const Column& c, float bottom, ColumnEvidence& e) const;
    std::int32_t firstFrom(int ring, int step, int column) const;
    Between lookBetween(int column, float line, float highest) const;
    void measureGaps(FeatureVector& f) const;
    void measureEnds(FeatureVector& f) const;
    void measureSurface(const std::vector<std::int32_t>& points, FeatureVector& f);
    void measureEdges(const std::vector<std::int32_t>& points, const Box& box, FeatureVector& f);
    bool mine(std::int32_t i) const { return owner_[i] == stamp_; }
    /// Column of the view of the group's k-th one.
    int viewColumn(std::size_t k) const {
        return beams_.cloud().view.wrap(reference_ + first_column_ + static_cast<int>(k));
    }
    float surfaceTop(std::int32_t i);

    const Beams& beams_;
    const GroundModel& ground_;
    std::vector<std::int32_t> owner_;  ///< of each return: the group that was measured last and holds it
    std::int32_t stamp_ = 0;
    std::vector<float> surface_top_;  ///< of each return, as far as asked for; below -1e8: not yet
    int reference_ = 0;               ///< column that the group's are counted from
    int first_column_ = 0;            ///< of the group, counted from the reference
    std::vector<Column> columns_;
    std::vector<RingRun> runs_;
    std::vector<float> numbers_;
};

}  // namespace lidar_obstacles

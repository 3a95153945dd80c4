// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is measured of a group of returns to tell what it is. Every feature is a number with a unit.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

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
    NotchDepth,
    NotchRings,
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
    ToldUnknown,
    ToldVehicle,
    ToldPedestrian,
    ToldCyclist,
    ToldStructure,
    ToldVehiclePart,
    ToldPersonPart,
    ToldMixture,
    BesideStructure,
    BesideVehicle,
    BesidePerson,
    BesideOther,
    BesideCount,
    NearStructure,
    NearVehicle,
    NearPerson,
    NearOther,
    NearCount,
    AboutStructure,
    AboutVehicle,
    AboutPerson,
    AboutOther,
    AboutCount,
    NextAway,
    NextStructure,
    NextVehicle,
    NextPerson,
    NextSize,
    NextTop,
    NextBottom,
    StructureAway,
    StructureSize,
    VehicleAway,
    VehicleSize,
    PersonAway,
    PersonSize,
    Count
};

constexpr std::size_t kFeatures = static_cast<std::size_t>(Feature::Count);
/// The first ones speak of a group by itself; the others of what stands about it, which is known only after grouping.
constexpr std::size_t kGroupFeatures = static_cast<std::size_t>(Feature::ToldUnknown);
using FeatureVector = std::array<float, kFeatures>;

struct FeatureInfo {
    const char* name;
    const char* unit;  ///< "" for shares and counts
    const char* text;
};
/// Name, unit and meaning of each.
const std::array<FeatureInfo, kFeatures>& featureInfos();

/// Does it tell what was thought of parts and neighbours? All others are measured.
constexpr bool isOpinion(Feature k) { return k >= Feature::Apart && k < Feature::Count; }

/// What is thought of the two parts of a hypothesis: of the one with more returns and of the other. A piece has no
/// parts: -1 each.
/// @param tree  its parts, scored.
void measureParts(const Hypothesis& hypothesis, const std::vector<Hypothesis>& tree, FeatureVector& f);

}  // namespace lidar_obstacles

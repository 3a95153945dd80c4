#include "lidar_obstacles/features.h"

namespace lidar_obstacles {
namespace {

const std::array<FeatureInfo, kFeatures> kInfos = {{
    {"returns", "", "logarithm of the number of returns, base 2"},
    {"range", "m", "horizontal distance of the nearest return from the sensor"},
    {"length", "m", "longer side of the smallest rectangle, seen from above"},
    {"width", "m", "shorter side"},
    {"facing", "", "how far the longer side is turned to the line of sight: 0 along it, 1 across"},
    {"top", "m", "height that its surfaces reach above the ground, followed beyond the region"},
    {"bottom", "m", "height of the lowest return"},
    {"top_limit", "m", "height at which the next ring passed above it, 10 at most"},
    {"mean_height", "m", "mean height of the returns"},
    {"height_spread", "m", "standard deviation of the heights"},
    {"share_knee", "", "share of the returns below .4 m"},
    {"share_hip", "", "from .4 to .9 m"},
    {"share_chest", "", "from .9 to 1.4 m"},
    {"share_head", "", "from 1.4 to 1.9 m"},
    {"share_above", "", "above 1.9 m"},
    {"width_low", "", "extent along the longer side of the lower third of the heights, as a share of it"},
    {"width_middle", "", "of the middle third"},
    {"width_high", "", "of the upper third"},
    {"lean", "m", "how much farther from the sensor the upper third is than the lower one"},
    {"ring_width_spread", "", "standard deviation of the widths that the rings see, over their mean"},
    {"rings", "", "rings that hit it"},
    {"ring_share", "", "those over the rings that its height has room for at its range"},
    {"fill", "", "returns over the beams between the first and the last of each ring"},
    {"through", "", "share of the beams through its volume that ended well behind it"},
    {"under", "", "beams that passed below it, over its columns"},
    {"hidden", "", "share of the beams towards it that something nearer ended"},
    {"ground_inside", "", "share of its columns with ground returns between its near and far side"},
    {"floating", "", "share of its columns in which the next beam down passed below it and went on"},
    {"gap_share", "", "share of the columns between its ends in which nothing of it was hit"},
    {"gap_free", "m", "width of those in which beams passed where it would have stopped them, below its windows"},
    {"gap_hidden", "m", "width of those in which something nearer ended the beams"},
    {"goes_on_more", "", "share of the rings at whose end the surface goes on beside it, on the side with more"},
    {"goes_on_less", "", "on the side with less"},
    {"hidden_more", "", "share of the rings at whose end something nearer stands, on the side with more"},
    {"hidden_less", "", "on the side with less"},
    {"goes_up", "", "share of the columns in which the next ring up hits the same surface, which is not in it"},
    {"goes_down", "", "the same for the next ring down"},
    {"rough_median", "", "distance of returns to the line between their neighbours, over the scan's noise: median"},
    {"rough_high", "", "the same: nine in ten are smaller"},
    {"rough_metres", "m", "the same median in metres"},
    {"jumps", "", "share of neighbouring beams inside it between which the range jumps"},
    {"edge_mean", "m", "mean distance of the returns to the nearer of the rectangle's sides towards the sensor"},
    {"edge_high", "m", "the same: nine in ten are smaller"},
    {"thickness", "", "smaller over larger standard deviation, seen from above"},
    {"steep", "", "share of the steps from ring to ring that rise more than they run"},
    {"gap", "m", "widest gap between the pieces it is made of"},
    {"next_gap", "m", "to the nearest other piece"},
    {"pieces", "", "how many pieces it is made of, 16 at most"},
    {"ring_step", "m", "distance of neighbouring rings at its range"},
    {"beam_step", "m", "distance of neighbouring beams of a ring at its range"},
    {"sensor_height", "m", "height of the sensor above the ground"},
    {"noise", "m", "of the scan's ranges"},
}};

}  // namespace

const std::array<FeatureInfo, kFeatures>& featureInfos() { return kInfos; }

}  // namespace lidar_obstacles

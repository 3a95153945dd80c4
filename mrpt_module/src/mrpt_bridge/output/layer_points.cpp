// SPDX-License-Identifier: BSD-3-Clause
// The returns of a scan, each drawn once: in the most telling of the visible layers that it belongs to.
#include <algorithm>
#include <cmath>
#include <mutex>

#include "mrpt_bridge/output/layer_objects.h"
#include "mrpt_bridge/output/scene_style.h"

namespace lidar_obstacles {
namespace {

using mrpt::img::TColor;

constexpr std::uint8_t kHidden = 255;

/// Blue, green, yellow, red for 0 .. 1.
TColor rainbow(float t) {
    const float s = 3.F * std::clamp(t, 0.F, 1.F);
    const auto channel = [](float v) { return static_cast<std::uint8_t>(255.F * std::clamp(v, 0.F, 1.F)); };
    return {channel(s - 1.F), channel(s < 2.F ? 0.3F + 0.7F * s : 3.F - s), channel(1.F - (s - 0.5F))};
}

/// Layer and colour of every return.
class Painting {
  public:
    Painting(const LayerData& data, const LayerSet& visible)
        : data_(data),
          visible_(visible),
          layer_(data.cloud.size(), kHidden),
          color_(data.cloud.size(), TColor(95, 95, 100)) {}

    void paintRaw(PointColor by) {
        if (!has(visible_, Layer::Raw)) return;
        const std::uint16_t rings =
            data_.cloud.ring.empty() ? 1 : 1 + *std::max_element(data_.cloud.ring.begin(), data_.cloud.ring.end());
        for (std::size_t i = 0; i < data_.cloud.size(); ++i) {
            layer_[i] = static_cast<std::uint8_t>(Layer::Raw);
            color_[i] = rawColor(i, by, rings);
        }
    }

    void paintStages() {
        const GroundModel& ground = data_.result.ground;
        for (std::size_t i = 0; i < ground.is_ground.size(); ++i)
            if (ground.is_ground[i]) set(Layer::Ground, i, {150, 118, 84});
        for (const std::int32_t i : data_.result.candidates) {
            const auto k = static_cast<std::size_t>(i);
            set(Layer::Candidates, k, heightColor(ground.height.empty() ? 0.F : ground.height.at(k)));
        }
        for (const std::int32_t i : data_.result.filtered)
            set(Layer::Filtered, static_cast<std::size_t>(i), {255, 60, 60});
        for (const RejectedCluster& r : data_.result.clusters.rejected)
            for (const std::int32_t i : r.cluster.points)
                set(Layer::Rejected, static_cast<std::size_t>(i), {225, 0, 225});
        for (const Obstacle& o : data_.result.obstacles)
            for (const std::int32_t i : o.points) set(Layer::Clusters, static_cast<std::size_t>(i), clusterColor(o.id));
    }

    std::uint8_t layer(std::size_t i) const { return layer_[i]; }
    const TColor& color(std::size_t i) const { return color_[i]; }

  private:
    TColor rawColor(std::size_t i, PointColor by, std::uint16_t rings) const {
        const PointCloud& cloud = data_.cloud;
        if (by == PointColor::Intensity && !cloud.intensity.empty()) return rainbow(std::sqrt(cloud.intensity[i]));
        if (by == PointColor::Ring && !cloud.ring.empty())
            return rainbow(static_cast<float>(cloud.ring[i]) / static_cast<float>(std::max(1, rings - 1)));
        const auto& height = data_.result.ground.height;
        return heightColor(height.empty() ? cloud.xyz[i].z() : height[i]);
    }

    void set(Layer layer, std::size_t i, const TColor& color) {
        if (!has(visible_, layer)) return;
        layer_.at(i) = static_cast<std::uint8_t>(layer);
        color_.at(i) = color;
    }

    const LayerData& data_;
    const LayerSet& visible_;
    std::vector<std::uint8_t> layer_;
    std::vector<TColor> color_;
};

}  // namespace

bool isPointLayer(Layer layer) {
    return layer == Layer::Raw || layer == Layer::Ground || layer == Layer::Candidates || layer == Layer::Filtered ||
           layer == Layer::Clusters || layer == Layer::Rejected;
}

void PointLayer::assign(std::vector<mrpt::math::TPoint3Df> points, std::vector<TColor> colors) {
    {
        const std::unique_lock lock(m_pointsMtx.data);
        m_vertex_buffer_data = std::move(points);
        m_color_buffer_data = std::move(colors);
    }
    notifyChange();
}

void SceneLayers::Objects::fillPoints(const LayerData* data, const LayerSet& visible, PointColor color) {
    std::array<std::vector<mrpt::math::TPoint3Df>, kLayers> points;
    std::array<std::vector<TColor>, kLayers> colors;
    if (data) {
        Painting painting(*data, visible);
        painting.paintRaw(color);
        painting.paintStages();
        for (std::size_t i = 0; i < data->cloud.size(); ++i) {
            const std::uint8_t k = painting.layer(i);
            if (k == kHidden) continue;
            const Eigen::Vector3f& p = data->cloud.xyz[i];
            points[k].emplace_back(p.x(), p.y(), p.z());
            colors[k].push_back(ink(painting.color(i)));
        }
    }
    for (std::size_t k = 0; k < kLayers; ++k) {
        if (!isPointLayer(static_cast<Layer>(k))) continue;
        counts_[k] = points[k].size();
        clouds_[k]->assign(std::move(points[k]), std::move(colors[k]));
    }
}

void SceneLayers::Objects::fillVoxels(const LayerData* data) {
    std::vector<mrpt::math::TPoint3Df> points;
    if (data)
        for (const Eigen::Vector3f& v : data->voxels) points.emplace_back(v.x(), v.y(), v.z());
    counts_[static_cast<std::size_t>(Layer::Voxels)] = points.size();
    std::vector<TColor> colors(points.size(), ink(TColor(120, 170, 235)));
    clouds_[static_cast<std::size_t>(Layer::Voxels)]->assign(std::move(points), std::move(colors));
}

}  // namespace lidar_obstacles

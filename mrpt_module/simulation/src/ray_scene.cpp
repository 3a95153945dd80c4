// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/ray_scene.h"

#include <array>
#include <stdexcept>
#include <string>
#include <utility>

#include "embree.h"

namespace lidar_obstacles::simulation {
namespace {

/// The device of the process. One thread builds: the tree, and so the last bit of a distance, does not depend on how
/// many there are.
RTCDevice device() {
    static const std::shared_ptr<RTCDeviceTy> instance(rtcNewDevice("threads=1"), [](RTCDevice d) {
        if (d) rtcReleaseDevice(d);
    });
    if (!instance) throw std::runtime_error("Embree cannot be started");
    return instance.get();
}

void check() {
    const RTCError error = rtcGetDeviceError(device());
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (error != RTC_ERROR_NONE) throw std::runtime_error("Embree error " + std::to_string(error));
}

std::shared_ptr<void> newScene() {
    return {rtcNewScene(device()), [](void* scene) { rtcReleaseScene(static_cast<RTCScene>(scene)); }};
}

RTCScene sceneOf(const std::shared_ptr<void>& scene) { return static_cast<RTCScene>(scene.get()); }

RTCRayHit toEmbree(const Ray& ray) {
    RTCRayHit query{};
    query.ray = {ray.origin.x(),
                 ray.origin.y(),
                 ray.origin.z(),
                 ray.near,
                 ray.direction.x(),
                 ray.direction.y(),
                 ray.direction.z(),
                 ray.time,
                 ray.far,
                 0xffffffffU,
                 0,
                 0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return query;
}

}  // namespace

RayMesh::RayMesh(Mesh mesh) {
    auto data = std::make_shared<Data>();
    data->mesh = std::move(mesh);
    data->scene = newScene();
    const Mesh& m = data->mesh;
    RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                             m.vertices.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            3 * sizeof(std::uint32_t), m.triangles.size());
    check();
    std::copy(m.vertices.begin(), m.vertices.end(), static_cast<Eigen::Vector3f*>(vertices));
    std::copy(m.triangles.begin(), m.triangles.end(), static_cast<std::array<std::uint32_t, 3>*>(indices));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(sceneOf(data->scene), geometry);
    rtcReleaseGeometry(geometry);
    // Watertight: no ray slips through between two triangles.
    rtcSetSceneFlags(sceneOf(data->scene), RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(sceneOf(data->scene));
    check();
    data_ = std::move(data);
}

std::optional<float> RayMesh::distance(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                                       float limit) const {
    RTCRayHit query = toEmbree({origin, direction, 0.0f, 0.0f, limit});
    intersect(sceneOf(data_->scene), query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return query.ray.tfar;
}

RayScene::RayScene() : scene_(newScene()) {
    // Built for one scan and thrown away: the tree of some dozen bodies need not be the best.
    rtcSetSceneBuildQuality(sceneOf(scene_), RTC_BUILD_QUALITY_MEDIUM);
    rtcSetSceneFlags(sceneOf(scene_), RTC_SCENE_FLAG_ROBUST);
}

void RayScene::add(const RayMesh& mesh, const std::vector<Eigen::Isometry3d>& poses) {
    RTCGeometry instance = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, sceneOf(mesh.data_->scene));
    rtcSetGeometryTimeStepCount(instance, static_cast<unsigned>(poses.size()));
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Eigen::Matrix<float, 4, 4, Eigen::ColMajor> m = poses[i].matrix().cast<float>();
        rtcSetGeometryTransform(instance, static_cast<unsigned>(i), RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, m.data());
    }
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(sceneOf(scene_), instance, static_cast<unsigned>(bodies_.size()));
    rtcReleaseGeometry(instance);
    check();
    bodies_.push_back(mesh);
}

void RayScene::commit() {
    rtcCommitScene(sceneOf(scene_));
    check();
}

std::optional<RayHit> RayScene::cast(const Ray& ray) const {
    RTCRayHit query = toEmbree(ray);
    intersect(sceneOf(scene_), query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const Eigen::Vector3f normal(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z);
    return RayHit{query.ray.tfar, query.hit.instID[0], query.hit.primID, normal.normalized()};
}

}  // namespace lidar_obstacles::simulation

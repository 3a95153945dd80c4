// SPDX-License-Identifier: BSD-3-Clause
#include "exports/foxglove_schemas.h"

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace lidar_obstacles::apps {
namespace {

using Json = nlohmann::ordered_json;
using Fields = std::initializer_list<std::pair<const char*, Json>>;

Json number() { return {{"type", "number"}}; }
Json text() { return {{"type", "string"}}; }
Json truth() { return {{"type", "boolean"}}; }
Json count() { return {{"type", "integer"}, {"minimum", 0}}; }
Json bytes() { return {{"type", "string"}, {"contentEncoding", "base64"}}; }
Json list(const Json& of) { return {{"type", "array"}, {"items", of}}; }

/// One of the numbers 0 to last.
Json choice(int last) {
    Json one_of = Json::array();
    for (int k = 0; k <= last; ++k) one_of.push_back({{"const", k}});
    return {{"oneOf", one_of}};
}

/// All fields are required.
Json object(const Fields& fields) {
    Json json = {{"type", "object"}, {"properties", Json::object()}, {"required", Json::array()}};
    for (const auto& [name, schema] : fields) {
        json["properties"][name] = schema;
        json["required"].push_back(name);
    }
    return json;
}

Json seconds(const Json& whole) {
    const Json part = {{"type", "integer"}, {"minimum", 0}, {"maximum", 999999999}};
    return {{"type", "object"}, {"properties", {{"sec", whole}, {"nsec", part}}}};
}
Json time() { return seconds(count()); }
Json duration() { return seconds({{"type", "integer"}}); }

Json vector2() { return object({{"x", number()}, {"y", number()}}); }
Json vector3() { return object({{"x", number()}, {"y", number()}, {"z", number()}}); }
Json quaternion() { return object({{"x", number()}, {"y", number()}, {"z", number()}, {"w", number()}}); }
Json color() { return object({{"r", number()}, {"g", number()}, {"b", number()}, {"a", number()}}); }
Json pose() { return object({{"position", vector3()}, {"orientation", quaternion()}}); }
Json packed() { return list(object({{"name", text()}, {"offset", count()}, {"type", choice(8)}})); }

Json arrow() {
    return object({{"pose", pose()},
                   {"shaft_length", number()},
                   {"shaft_diameter", number()},
                   {"head_length", number()},
                   {"head_diameter", number()},
                   {"color", color()}});
}

Json cube() { return object({{"pose", pose()}, {"size", vector3()}, {"color", color()}}); }

Json cylinder() {
    return object({{"pose", pose()},
                   {"size", vector3()},
                   {"bottom_scale", number()},
                   {"top_scale", number()},
                   {"color", color()}});
}

Json line() {
    return object({{"type", choice(2)},
                   {"pose", pose()},
                   {"thickness", number()},
                   {"scale_invariant", truth()},
                   {"points", list(vector3())},
                   {"color", color()},
                   {"colors", list(color())},
                   {"indices", list(count())}});
}

Json triangles() {
    return object({{"pose", pose()},
                   {"points", list(vector3())},
                   {"color", color()},
                   {"colors", list(color())},
                   {"indices", list(count())}});
}

Json label() {
    return object({{"pose", pose()},
                   {"billboard", truth()},
                   {"font_size", number()},
                   {"scale_invariant", truth()},
                   {"color", color()},
                   {"text", text()}});
}

Json model() {
    return object({{"pose", pose()},
                   {"scale", vector3()},
                   {"color", color()},
                   {"override_color", truth()},
                   {"url", text()},
                   {"media_type", text()},
                   {"data", bytes()}});
}

Json sceneUpdate() {
    const Json entity = object({{"timestamp", time()},
                                {"frame_id", text()},
                                {"id", text()},
                                {"lifetime", duration()},
                                {"frame_locked", truth()},
                                {"metadata", list(object({{"key", text()}, {"value", text()}}))},
                                {"arrows", list(arrow())},
                                {"cubes", list(cube())},
                                {"spheres", list(cube())},
                                {"cylinders", list(cylinder())},
                                {"lines", list(line())},
                                {"triangles", list(triangles())},
                                {"texts", list(label())},
                                {"models", list(model())}});
    const Json deletion = object({{"timestamp", time()}, {"type", choice(1)}, {"id", text()}});
    return object({{"deletions", list(deletion)}, {"entities", list(entity)}});
}

Json pointCloud() {
    return object({{"timestamp", time()},
                   {"frame_id", text()},
                   {"pose", pose()},
                   {"point_stride", count()},
                   {"fields", packed()},
                   {"data", bytes()}});
}

Json grid() {
    return object({{"timestamp", time()},
                   {"frame_id", text()},
                   {"pose", pose()},
                   {"column_count", count()},
                   {"cell_size", vector2()},
                   {"row_stride", count()},
                   {"cell_stride", count()},
                   {"fields", packed()},
                   {"data", bytes()}});
}

Json frameTransform() {
    return object({{"timestamp", time()},
                   {"parent_frame_id", text()},
                   {"child_frame_id", text()},
                   {"translation", vector3()},
                   {"rotation", quaternion()}});
}

Json log() {
    return object({{"timestamp", time()},
                   {"level", choice(5)},
                   {"message", text()},
                   {"name", text()},
                   {"file", text()},
                   {"line", count()}});
}

}  // namespace

std::string foxgloveSchema(const std::string& name) {
    if (name == "SceneUpdate") return sceneUpdate().dump();
    if (name == "PointCloud") return pointCloud().dump();
    if (name == "Grid") return grid().dump();
    if (name == "FrameTransform") return frameTransform().dump();
    if (name == "Log") return log().dump();
    throw std::invalid_argument("no schema of Foxglove's: " + name);
}

}  // namespace lidar_obstacles::apps

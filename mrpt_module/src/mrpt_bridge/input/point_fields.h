// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What MRPT's point maps tell of each point besides its place. Its versions name that differently: up to 2.5 there is
/// nothing but the intensity of CPointsMapXYZI, from 2.11 on all maps can be asked for ring, time and intensity, from
/// 2.15 on for fields by their names; in 3 CPointsMapXYZI has gone.
#pragma once

#if __has_include(<mrpt/maps/CPointsMapXYZI.h>)
#include <mrpt/maps/CPointsMapXYZI.h>
#else
#include <mrpt/maps/CGenericPointsMap.h>
#endif

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lidar_obstacles {

/// Empty where the map does not have the field for every point.
struct PointFields {
    std::vector<float> intensity;
    std::vector<float> time;  ///< after the observation's stamp [s]
    std::vector<std::uint16_t> ring;
};

namespace point_fields {

/// The higher, the newer the way to ask.
template <int N>
struct Version : Version<N - 1> {};
template <>
struct Version<0> {};

template <class Map>
auto ring(const Map& map, Version<3>) -> decltype(map.getPointsBufferRef_uint16_field("ring")) {
    return map.getPointsBufferRef_uint16_field("ring");
}
template <class Map>
auto ring(const Map& map, Version<2>) -> decltype(map.getPointsBufferRef_uint_field("ring")) {
    return map.getPointsBufferRef_uint_field("ring");
}
template <class Map>
auto ring(const Map& map, Version<1>) -> decltype(map.getPointsBufferRef_ring()) {
    return map.getPointsBufferRef_ring();
}
template <class Map>
const std::vector<std::uint16_t>* ring(const Map&, Version<0>) {
    return nullptr;
}

template <class Map>
auto time(const Map& map, Version<2>) -> decltype(map.getPointsBufferRef_float_field("t")) {
    return map.getPointsBufferRef_float_field("t");
}
template <class Map>
auto time(const Map& map, Version<1>) -> decltype(map.getPointsBufferRef_timestamp()) {
    return map.getPointsBufferRef_timestamp();
}
template <class Map>
const std::vector<float>* time(const Map&, Version<0>) {
    return nullptr;
}

template <class Map>
auto intensity(const Map& map, Version<2>) -> decltype(map.getPointsBufferRef_float_field("intensity")) {
    return map.getPointsBufferRef_float_field("intensity");
}
template <class Map>
auto intensity(const Map& map, Version<1>) -> decltype(map.getPointsBufferRef_intensity()) {
    return map.getPointsBufferRef_intensity();
}
template <class Map>
const std::vector<float>* intensity(const Map&, Version<0>) {
    return nullptr;
}

/// The field's values, if there is one for each point.
template <class Value, class Field>
std::vector<Value> copyOf(const Field* field, std::size_t points) {
    if (!field || field->size() != points) return {};
    return {field->begin(), field->end()};
}

}  // namespace point_fields

/// @param map  a point map of MRPT.
template <class Map>
PointFields pointFieldsOf(const Map& map) {
    constexpr point_fields::Version<3> kNewest;
    const std::size_t n = map.size();
    return {point_fields::copyOf<float>(point_fields::intensity(map, kNewest), n),
            point_fields::copyOf<float>(point_fields::time(map, kNewest), n),
            point_fields::copyOf<std::uint16_t>(point_fields::ring(map, kNewest), n)};
}

#if __has_include(<mrpt/maps/CPointsMapXYZI.h>)

/// MRPT's point map with an intensity.
using IntensityMap = mrpt::maps::CPointsMapXYZI;

/// A map of so many points, to be filled.
inline IntensityMap::Ptr makeIntensityMap(std::size_t points) {
    auto map = IntensityMap::Create();
    map->resize(points);  // MRPT 2.14 takes an intensity only where one has its place
    return map;
}

inline void setIntensity(IntensityMap& map, std::size_t i, float intensity) { map.setPointIntensity(i, intensity); }

/// Those of a map that pointFieldsOf() cannot ask for them: of MRPT up to 2.5. Empty if it has none.
inline std::vector<float> intensitiesOf(const mrpt::maps::CPointsMap& map) {
    std::vector<float> all;
    if (const auto* xyzi = dynamic_cast<const IntensityMap*>(&map))
        for (std::size_t i = 0; i < map.size(); ++i) all.push_back(xyzi->getPointIntensity_fast(i));
    return all;
}

#else  // MRPT 3

using IntensityMap = mrpt::maps::CGenericPointsMap;

inline IntensityMap::Ptr makeIntensityMap(std::size_t points) {
    auto map = IntensityMap::Create();
    map->registerField_float("intensity");
    map->resize(points);
    return map;
}

inline void setIntensity(IntensityMap& map, std::size_t i, float intensity) {
    map.setPointField_float(i, "intensity", intensity);
}

inline std::vector<float> intensitiesOf(const mrpt::maps::CPointsMap&) { return {}; }

#endif

}  // namespace lidar_obstacles

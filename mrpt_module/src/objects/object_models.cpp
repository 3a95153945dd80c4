// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/object_models.h"

#include <array>

namespace lidar_obstacles {
namespace {

struct Row {
    ObjectKind kind;
    const char* name;
    ObstacleClass cls;
};

constexpr auto kVehicle = ObstacleClass::Vehicle, kCyclist = ObstacleClass::Cyclist, kUnknown = ObstacleClass::Unknown,
               kStructure = ObstacleClass::Structure;

/// In the order of the values.
constexpr std::array kTable{
    Row{ObjectKind::Ground, "ground", kUnknown},
    Row{ObjectKind::Noise, "noise", kUnknown},
    Row{ObjectKind::Car, "car", kVehicle},
    Row{ObjectKind::Van, "van", kVehicle},
    Row{ObjectKind::Truck, "truck", kVehicle},
    Row{ObjectKind::Bus, "bus", kVehicle},
    Row{ObjectKind::Tram, "tram", kVehicle},
    Row{ObjectKind::Trailer, "trailer", kVehicle},
    Row{ObjectKind::Tractor, "tractor", kVehicle},
    Row{ObjectKind::Motorcycle, "motorcycle", kVehicle},
    Row{ObjectKind::Cyclist, "cyclist", kCyclist},
    Row{ObjectKind::Motorcyclist, "motorcyclist", kCyclist},
    Row{ObjectKind::ScooterRider, "scooter_rider", kCyclist},
    Row{ObjectKind::ChairUser, "chair_user", kCyclist},
    Row{ObjectKind::Pedestrian, "pedestrian", ObstacleClass::Pedestrian},
    Row{ObjectKind::Bicycle, "bike", kUnknown},
    Row{ObjectKind::Scooter, "scooter", kUnknown},
    Row{ObjectKind::Bin, "bin", kUnknown},
    Row{ObjectKind::Bollard, "bollard", kUnknown},
    Row{ObjectKind::Animal, "animal", kUnknown},
    Row{ObjectKind::Wall, "wall", kStructure},
    Row{ObjectKind::Fence, "fence", kStructure},
    Row{ObjectKind::Hedge, "hedge", kStructure},
    Row{ObjectKind::Bush, "bush", kStructure},
    Row{ObjectKind::Tree, "tree", kStructure},
    Row{ObjectKind::Pole, "pole", kStructure},
    Row{ObjectKind::Sign, "sign", kStructure},
    Row{ObjectKind::Rail, "rail", kStructure},
    Row{ObjectKind::Kerb, "kerb", kStructure},
    Row{ObjectKind::Step, "step", kStructure},
    Row{ObjectKind::Ramp, "ramp", kStructure},
    Row{ObjectKind::Overhead, "overhead", kStructure},
    Row{ObjectKind::Scaffold, "scaffold", kStructure},
    Row{ObjectKind::Furniture, "furniture", kStructure},
    Row{ObjectKind::Crate, "crate", kStructure},
    Row{ObjectKind::Pile, "pile", kStructure},
};

struct OtherName {
    const char* name;
    ObjectKind kind;
};

/// Names that sets of labels use beside those of the table.
constexpr std::array kOtherNames{
    OtherName{"sedan", ObjectKind::Car},
    OtherName{"suv", ObjectKind::Car},
    OtherName{"hatch", ObjectKind::Car},
    OtherName{"person", ObjectKind::Pedestrian},
    OtherName{"person_sitting", ObjectKind::Pedestrian},
    OtherName{"bicyclist", ObjectKind::Cyclist},
    OtherName{"rider", ObjectKind::Cyclist},
    OtherName{"trunk", ObjectKind::Tree},
};

const Row& rowOf(ObjectKind kind) { return kTable[static_cast<std::size_t>(kind)]; }

}  // namespace

const char* nameOf(ObjectKind kind) { return rowOf(kind).name; }

std::optional<ObjectKind> kindNamed(const std::string& name) {
    for (const Row& row : kTable)
        if (name == row.name) return row.kind;
    for (const OtherName& other : kOtherNames)
        if (name == other.name) return other.kind;
    return std::nullopt;
}

ObstacleClass classOf(ObjectKind kind) { return rowOf(kind).cls; }

const std::vector<ObjectKind>& allKinds() {
    static const std::vector<ObjectKind> kinds = [] {
        std::vector<ObjectKind> all;
        all.reserve(kTable.size());
        for (const Row& row : kTable) all.push_back(row.kind);
        return all;
    }();
    return kinds;
}

SizeLimits sizeLimitsOf(ObstacleClass cls, float top) {
    constexpr float kLow = 2.2f;  // trucks and buses are higher
    constexpr auto kLowest = static_cast<float>(kLeastVehicleHeight);
    switch (cls) {
        case ObstacleClass::Vehicle:
            return top < kLow ? SizeLimits{7.0f, 2.6f, kLowest, 4.5f} : SizeLimits{19.0f, 3.6f, kLowest, 4.5f};
        case ObstacleClass::Pedestrian:
            return {2.2f, 1.5f, 0.5f, 2.3f};
        case ObstacleClass::Cyclist:
            return {2.8f, 1.5f, 0.6f, 2.4f};
        case ObstacleClass::Structure:
        case ObstacleClass::Unknown:
            break;
    }
    return {1e9f, 1e9f, 0.0f, 1e9f};
}

}  // namespace lidar_obstacles

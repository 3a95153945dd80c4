#include "lidar_obstacles/simulation/models.h"

#include <functional>
#include <map>

#include "people_models.h"
#include "vehicle_shape.h"

namespace lidar_obstacles::simulation {
namespace {

using Maker = std::function<Model()>;

std::map<std::string, Maker> makers() {
    std::map<std::string, Maker> all;
    for (const VehicleShape& shape : vehicleShapes()) all[shape.name] = [&shape] { return vehicleModel(shape); };
    all["pedestrian"] = [] { return personModel("pedestrian", 1.76, true); };
    all["tall_pedestrian"] = [] { return personModel("tall_pedestrian", 1.88, true); };
    all["child"] = [] { return personModel("child", 1.20, true); };
    all["standing_pedestrian"] = [] { return personModel("standing_pedestrian", 1.72, false); };
    all["cyclist"] = cyclistModel;
    return all;
}

}  // namespace

std::vector<std::string> modelNames() {
    std::vector<std::string> names;
    for (const auto& [name, maker] : makers()) names.push_back(name);
    return names;
}

std::shared_ptr<const Model> modelNamed(const std::string& name) {
    const auto all = makers();
    const auto it = all.find(name);
    return it == all.end() ? nullptr : std::make_shared<const Model>(it->second());
}

}  // namespace lidar_obstacles::simulation

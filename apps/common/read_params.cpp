// SPDX-License-Identifier: BSD-3-Clause
#include "common/read_params.h"

#include "lidar_obstacles/mrpt_bridge/config_file.h"

namespace lidar_obstacles::apps {

DetectorParams readParams(const std::string& config, const std::vector<std::string>& assignments) {
    DetectorParams params = config.empty() ? DetectorParams{} : loadParams(config);
    for (const std::string& assignment : assignments) setParam(params, assignment);
    validate(params);
    return params;
}

}  // namespace lidar_obstacles::apps

// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parameters that keys change, whoever works with them.
#pragma once

#include "lidar_obstacles/params.h"

namespace lidar_obstacles::apps {

class ParamsInUse {
  public:
    virtual ~ParamsInUse() = default;
    virtual const DetectorParams& params() const = 0;
    /// @throws std::exception saying why all stays as it was.
    virtual void setParams(const DetectorParams& params) = 0;

  protected:
    ParamsInUse() = default;
    ParamsInUse(const ParamsInUse&) = default;
    ParamsInUse& operator=(const ParamsInUse&) = default;
};

}  // namespace lidar_obstacles::apps

// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Precompiled header of the core: Eigen and OpenCV take longer to read than most of its files.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

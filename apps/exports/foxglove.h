// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Scans as the messages that Foxglove shows, in JSON (https://docs.foxglove.dev/docs/visualization/message-schemas).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "exports/mcap_writer.h"
#include "exports/scan_output.h"

namespace lidar_obstacles::apps {

/// Topics: `/tf` (FrameTransform: where `vehicle` is in `world`), `/points` (PointCloud), `/grid` (Grid), `/obstacles`
/// (SceneUpdate), `/log` (Log). Schemas are Foxglove's.
const std::vector<McapChannel>& foxgloveChannels();

/// The messages of one scan, stamped with its first firing.
///
/// * `/tf`: only where the vehicle's pose is known; without any, all is in the frame `vehicle`.
/// * `/points`: x y z [m], intensity, class (ReturnKind), track (-1: none) of every return.
/// * `/grid`: cells of 20 cm or more around what was seen; field `state`: 0 unknown, 1 free, 2 occupied. None for an
/// empty grid.
/// * `/obstacles`: a cube, a text and, where known, arrows of heading and speed per obstacle; its numbers as metadata.
/// * `/log`: counts of the scan; a warning where the ground was not found or the vehicle's poses broke off.
std::vector<McapMessage> foxgloveMessages(const ScanOutput& scan);

/// Base64 with padding; "" for no bytes.
std::string base64(const std::string& bytes);

}  // namespace lidar_obstacles::apps

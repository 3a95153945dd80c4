#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Plays a recording in a loop through the detector with tracks, as fast as it goes, and prints memory and track numbers;
# fails if memory grows. usage: scripts/soak.sh [HOURS] [RECORDING]
#   HOURS      of the recording's time (24: some 70 minutes of an idle core)
#   RECORDING  rawlog or capture; default: 20 s of the shipped street, ten scans a second
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

hours=${1:-24} input=${2:-output/soak/street.rawlog}
install_packages run build test
use_ccache
cmake --preset release >/dev/null
cmake --build --preset release --parallel "$(nproc)" --target lidar_obstacles_soak obstacle-simulate >/dev/null
if [ $# -lt 2 ]; then
    mkdir -p output/soak
    build/release/apps/obstacle-simulate/obstacle-simulate datasets/scenarios/street.yaml --from 20 --to 40 \
        --output output/soak/street >/dev/null 2>&1
fi
soak=$(find build/release/tests -name lidar_obstacles_soak -type f)
"$soak" "$input" "$hours"

#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Zones against the simulator's truth, low things on built scenes and on ground without any, and health on recordings.
#
# scripts/zones.sh [SCENES] [FIRST_SEED]     random streets and sidewalks, 40 scans each (default 250: 10 000 scans)
# LIDAR_OBSTACLES_DATA=DIR: every recording in DIR and in datasets/ must be well.
set -euo pipefail
cd "$(dirname "$0")/.."
scenes=${1:-250}
first=${2:-1}
build=${BUILD:-build/release}
status=0
"$build/tests/zones_truth" datasets/presets/zones.yaml "$scenes" "$first" || status=$?
"$build/tests/low_truth" "$((scenes < 40 ? scenes : 40))" "$first"
"$build/tests/low_distances"
shopt -s nullglob
output=$(mktemp -d)
trap 'rm -rf "$output"' EXIT
for recording in datasets/*.rawlog "${LIDAR_OBSTACLES_DATA:-/nowhere}"/*.{rawlog,pcap}; do
    "$build/apps/obstacle-replay/obstacle-replay" "$recording" --output "$output" >/dev/null 2>&1 || true
    health=$(python3 -c 'import json, sys; print(json.dumps(json.load(open(sys.argv[1]))["health"]))' "$output/summary.json")
    echo "$(basename "$recording"): health $health"
    [ "$health" = "{}" ] || status=1
done
exit "$status"

#!/usr/bin/env bash
# From nothing to obstacles: installs the packages, builds the tools and runs them on a real VLP-16 scan.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

scan=/usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog
build=build/demo
out=output/demo

install_packages run build
use_ccache

say "Building the tools in $build"
cmake --preset release -B "$build" -DLIDAR_OBSTACLES_BUILD_TESTS=OFF -DLIDAR_OBSTACLES_BUILD_BENCHMARKS=OFF
cmake --build "$build" --parallel "$(nproc)"

say "Finding obstacles in $scan"
"$build"/apps/obstacle-replay/obstacle-replay "$scan" --config config.ini --output "$out" \
    --scenes all --grids all --pictures all

say "Obstacles (vehicle frame: x forward, y left; metres, degrees)"
awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i
                   printf "%4s  %-10s %7s %7s %7s %6s %6s %8s %8s\n",
                          "id", "class", "x", "y", "length", "width", "height", "heading", "returns"; next }
         { yaw = $at["heading_valid"] == 1 ? sprintf("%.0f", $at["yaw"] * 57.29578) : "-"
           printf "%4s  %-10s %7.2f %7.2f %7.2f %6.2f %6.2f %8s %8d\n", $at["id"], $at["class"], $at["x"], $at["y"],
                  $at["length"], $at["width"], $at["height"], yaw, $at["num_points"] }' "$out/obstacles.csv"

say "Results in $out"
find "$out" -type f | sort

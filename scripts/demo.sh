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

say "The ten nearest of $(($(wc -l <"$out/obstacles.csv") - 1)) obstacles (x forward, y left, metres; heading in degrees)"
awk -F, '
    NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
    { degrees = $at["yaw"] * 57.29578
      heading = $at["heading_valid"] ? int(degrees + (degrees < 0 ? -0.5 : 0.5)) : "-"
      printf "%.2f %s %.2f %.2f %.2f %.2f %.2f %s %d\n", sqrt($at["x"] ^ 2 + $at["y"] ^ 2), $at["class"], $at["x"],
             $at["y"], $at["length"], $at["width"], $at["height"], heading, $at["num_points"] }' "$out/obstacles.csv" |
    sort -n | awk '
    BEGIN { row = "%-10s %8s %8s %8s %8s %8s %8s %8s\n"
            printf row, "class", "x", "y", "length", "width", "height", "heading", "returns" }
    NR <= 10 { printf row, $2, $3, $4, $5, $6, $7, $8, $9 }'

say "Results in $out"
find "$out" -type f | sort

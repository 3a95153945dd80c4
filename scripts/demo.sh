#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# From nothing to obstacles: installs the packages, builds obstacle-replay and runs it on a real VLP-16 scan and on a
# simulated street, where cars, people and riders are tracked. Within five minutes on two cores. obstacle-check is built
# as well: it looks at a recording of one's own first.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

scan=/usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog
street=datasets/street_tracks.rawlog
build=build/demo
replay=$build/apps/obstacle-replay/obstacle-replay
out=output/demo

# table CSV ROWS: the nearest vehicles, people and cyclists of the last scan.
table() {
    awk -F, -v last="$(tail -n 1 "$1" | cut -d, -f2)" '
        function number(name) { return $at[name] == "" ? "-" : sprintf("%.1f", $at[name]) }
        NR == 1 { for (i = 1; i <= NF; ++i) at[$i] = i; next }
        $at["scan_index"] != last || $at["class"] !~ /^(vehicle|pedestrian|cyclist)$/ { next }
        { speed = $at["vx"] == "" ? "-" : sprintf("%.1f", sqrt($at["vx"] ^ 2 + $at["vy"] ^ 2))
          print $at["distance"], $at["id"], $at["class"], int(100 * $at["probability"] + 0.5), number("distance"), number("x"),
                number("y"), number("length"), number("width"), number("height"), speed, number("age"), $at["num_points"] }
        ' "$1" | sort -n | awk -v rows="$2" '
        BEGIN { row = "%6s  %-10s %5s %9s %7s %7s %7s %6s %7s %7s %6s %8s\n"
                printf row, "number", "class", "sure", "distance", "x", "y", "length", "width", "height", "speed", "age", "returns" }
        NR <= rows { printf row, $2, $3, $4 "%", $5, $6, $7, $8, $9, $10, $11, $12, $13 }'
}

install_packages run build
use_ccache

say "Building obstacle-replay and obstacle-check in $build"
cmake --preset release -B "$build" -DLIDAR_OBSTACLES_BUILD_TESTS=OFF -DLIDAR_OBSTACLES_BUILD_BENCHMARKS=OFF \
    -DLIDAR_OBSTACLES_BUILD_EXAMPLES=OFF -DCMAKE_UNITY_BUILD=ON # a third of the time
cmake --build "$build" --parallel "$(nproc)" --target obstacle-replay obstacle-check

say "A real VLP-16 scan: $scan"
"$replay" "$scan" --config config.ini --output "$out/scan" --scenes all --grids all --pictures all
table "$out/scan/obstacles.csv" 6

say "A simulated street, 1.4 s of it: $street"
"$replay" "$street" --config config.ini --output "$out/street" --classes vehicle,pedestrian,cyclist,unknown \
    --view 2,0,38,180,50 --size 1280x720 --pictures all --scenes 13
echo "The tracks, nearest first (x forward, y left; metres, m/s, seconds):"
table "$out/street/obstacles.csv" 20

picture=$out/street/picture_000013.png
say "Results in $out; look at $out/scan/picture_000000.png and $picture"
find "$out" -type f ! -name 'picture_00000[1-9].png' ! -name 'picture_00001[0-2].png' | sort
if [ -n "${DISPLAY-}${WAYLAND_DISPLAY-}" ] && [ -t 1 ] && command -v xdg-open >/dev/null; then
    xdg-open "$picture" >/dev/null 2>&1 &
fi

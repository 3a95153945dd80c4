#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Writes the config files of datasets/presets: every parameter, those that differ from the default with the reason.
# usage: scripts/make_presets.sh [FOLDER]      (default: datasets/presets)
# To be run again whenever a parameter comes or goes. OBSTACLE_REPLAY names the tool where it is not in build/release.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"

replay=$(realpath "${OBSTACLE_REPLAY:-$repo/build/release/apps/obstacle-replay/obstacle-replay}")
output=${1:-$repo/datasets/presets}
mkdir -p "$output"

# preset NAME FIRST-LINE: reads lines "section.key=value | why" from the standard input.
preset() {
    local name=$1 title=$2 lines assignments=()
    lines=$(cat)
    while IFS= read -r line; do
        assignments+=(--set "${line%% |*}")
    done <<<"$lines"
    {
        printf '# %s\n# Differs from the defaults where a line begins with "why:". Written by scripts/make_presets.sh.\n' "$title"
        "$replay" --print-config "${assignments[@]}" | awk -v lines="$lines" '
            BEGIN {
                n = split(lines, line, "\n")
                for (i = 1; i <= n; ++i) {
                    key = line[i]; sub(/=.*/, "", key)
                    reason[key] = line[i]; sub(/^[^|]*\| */, "", reason[key])
                }
            }
            NR == 1 { next }
            /^\[/ { section = $0; gsub(/[][]/, "", section) }
            / = / && (section "." $1) in reason { print "# why: " reason[section "." $1] }
            { print }'
    } >"$output/$name.ini.new"
    mv "$output/$name.ini.new" "$output/$name.ini"
}

preset car "A car on roads, the lidar on its roof; origin at the middle of the rear axle." <<'END'
region.front=80 | at 50 km/h the way ahead is what counts: 80 m are 6 s
region.rear=40 | what comes from behind is seen in time at 40 m
region.lateral=25 | lanes, kerb and sidewalk; houses behind them only cost time
gates.max_bottom=2 | the roof with the lidar on it must not hit what hangs there
region.own_body=box(-1.1, 3.9, -1.05, 1.05) | a car of 5 m with mirrors; measure yours, or use --learn-own-body
END

preset delivery-robot "A slow robot among people on sidewalks, the lidar 0.5 to 1 m above the ground; origin at its middle." <<'END'
region.front=25 | at 1.5 m/s 25 m are more than 15 s
region.rear=15 | enough for bicycles that come from behind
region.lateral=15 | the sidewalk and the lane beside it
region.own_body=box(-0.5, 0.5, -0.4, 0.4) | a small robot; measure yours, or use --learn-own-body
low.enabled=true | it falls over kerbs and down stairs
gates.max_bottom=1.4 | a flag or mast of 1.3 m must not hit what hangs there
END

preset fixed-post "A lidar on a post or a gantry that does not move and watches a street; tell its height and tilt by --sensor-pose." <<'END'
region.own_body=none | nothing of a vehicle is in view
octomap.mode=spurious | a place that is watched for months sees rain and snow; where the sensor stands, earlier scans tell best
tracking.max_hidden=6 | a bus that stops hides what is behind it for longer than a passing car
END

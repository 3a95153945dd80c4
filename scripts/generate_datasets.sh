#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Generates the simulated data sets that are too large to be part of the repository: rawlogs with their truth.
# usage: scripts/generate_datasets.sh [FOLDER] [NAME...]
#   FOLDER  where to (default: output/datasets)
#   NAME    of a scenario in datasets/scenarios, or `sample` for the two that are in datasets/; default: monza street delivery yaw-grid
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

folder=${1:-output/datasets}
shift || true
names=("$@")
[ ${#names[@]} -gt 0 ] || names=(monza street delivery yaw-grid)
build=build/release
simulate=$build/apps/obstacle-simulate/obstacle-simulate

# generate PREFIX SCENARIO [OPTION...]
generate() {
    local prefix=$1 scenario=$2
    shift 2
    say "$prefix"
    "$simulate" "datasets/scenarios/$scenario.yaml" --output "$prefix" "$@"
}

install_packages run build
use_ccache
cmake --preset release >/dev/null
cmake --build "$build" --parallel "$(nproc)" --target obstacle-simulate

for name in "${names[@]}"; do
    case $name in
        sample)
            generate datasets/street_sample street --from 14 --to 30 --stride 20 --odometry
            generate output/street_tracks street --from 7.2 --to 8.6
            cp output/street_tracks.rawlog datasets/
            ;;
        monza) generate "$folder/monza" monza --odometry ;;
        *) generate "$folder/${name//-/_}" "$name" ;;
    esac
done

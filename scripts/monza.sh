#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The paper's experiment (Sec. V): a lap with one van, its distance, relative heading and velocity over time with 16
# planes and decimated to 8, and the table of mean errors. The lap is simulated where it is not there yet.
# usage: scripts/monza.sh [PREFIX] [OPTION...]   options go to obstacle-evaluate monza
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

prefix=output/monza/monza
if [ $# -gt 0 ] && [[ $1 != -* ]]; then
    prefix=$1
    shift
fi
build=build/demo

install_packages run build evaluation
use_ccache

say "Building the tools in $build"
cmake --preset release -B "$build" -DLIDAR_OBSTACLES_BUILD_TESTS=OFF -DLIDAR_OBSTACLES_BUILD_BENCHMARKS=OFF
cmake --build "$build" --parallel "$(nproc)"

if [ ! -e "${prefix}_gt.csv" ]; then
    say "Simulating a lap: $prefix.rawlog"
    mkdir -p "$(dirname "$prefix")"
    "$build"/apps/obstacle-simulate/obstacle-simulate datasets/scenarios/monza.yaml --output "$prefix"
fi

say "Evaluating it"
"$build"/apps/obstacle-evaluate/obstacle-evaluate monza --prefix "$prefix" --output output/monza/results \
    --jobs "$(nproc)" "$@"

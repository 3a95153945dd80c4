#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The paper's experiment (Sec. V): a lap with one van, its distance, relative heading and velocity over time with 16
# planes and decimated to 8, and the table of mean errors. The lap is simulated where it is not there yet.
# usage: scripts/monza.sh [--docs] [PREFIX] [OPTION...]   options go to obstacle-evaluate monza
#   --docs   brings the table and the figures of docs/paper.md up to date
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

prefix=output/monza/monza results=output/monza/results docs=0
if [ "${1-}" = --docs ]; then
    docs=1
    shift
fi
if [ $# -gt 0 ] && [[ $1 != -* ]]; then
    prefix=$1
    shift
fi
build=build/demo

# table: the rows of docs/paper.md's table, from the table that the tool printed last
table() {
    awk '
        BEGIN { name["16_plane"] = "16 rings, `16-plane`"; name["8_plane"] = "8 rings, `8-plane`"
                name["auto_16"] = "16 rings, `auto`"; name["auto_8"] = "8 rings, `auto`" }
        function group(k) { sub(/[+]/, "", $k); return $k " / " $(k + 1) " / " $(k + 2) " / " $(k + 3) }
        $1 in name && NF == 18 { row[$1] = "| " name[$1] " | " $3 " % | " group(5) " | " group(9) " | " group(13) " |" }
        END { print row["16_plane"]; print row["8_plane"]; print row["auto_16"]; print row["auto_8"] }' "$results/log.txt"
}

# The rows in docs/paper.md that begin as the table does are taken out, and the new ones stand where the first one stood.
write_docs() {
    local new=output/monza/paper.md
    awk -v rows="$(table)" '
        /^[|] (16 rings, `16-plane`|8 rings, `8-plane`|(16|8) rings, `auto`) [|]/ { if (!done++) print rows; next }
        { print }' docs/paper.md >"$new"
    mv "$new" docs/paper.md
    cp "$results"/fig_{16,8}_plane.png docs/
}

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
"$build"/apps/obstacle-evaluate/obstacle-evaluate monza --prefix "$prefix" --output "$results" \
    --jobs "$(nproc)" "$@" | tee output/monza/log.txt
mv output/monza/log.txt "$results/"
[ $docs -eq 0 ] || write_docs

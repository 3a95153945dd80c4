#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Recordings per second of `obstacle-fleet run` against one obstacle-replay after the other, on the same recordings, in turn.
# usage: scripts/fleet_throughput.sh FOLDER [TIMES] [PROCESSES]
#   FOLDER     with recordings, all of them good
#   TIMES      how often each (3); what counts is the best of each
#   PROCESSES  at the same time, of both (1)
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"

[ -d "${1-}" ] || die "usage: scripts/fleet_throughput.sh FOLDER [TIMES] [PROCESSES]"
folder=$(realpath "$1") times=${2:-3} processes=${3:-1}
bin=$repo/build/release/apps
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$bin/obstacle-fleet/obstacle-fleet" manifest "$folder" --output "$work/manifest.jsonl"

replays() {
    # shellcheck disable=SC2016
    find "$folder" -type f -print0 | sort -z | xargs -0 -P "$processes" -I{} \
        sh -c '"$1" "$2" --output "$3/$(basename "$2")" >/dev/null 2>&1' sh "$bin/obstacle-replay/obstacle-replay" {} "$work/replay"
    rm -rf "$work/replay"
}
fleet() {
    seq 0 $((processes - 1)) | xargs -P "$processes" -I{} \
        "$bin/obstacle-fleet/obstacle-fleet" run "$work/manifest.jsonl" --output "$work/fleet" --shard "{}/$processes" >/dev/null
    rm -rf "$work/fleet"
}
# best NAME: the least wall time and the least time of the processor [s].
best() { awk -v name="$1" '$1 == name { if (!w || $2 < w) w = $2; if (!c || $3 < c) c = $3 } END { printf "%.2f %.2f", w, c }' "$work/times"; }
TIMEFORMAT='%R %U %S'
for ((k = 0; k < times; ++k)); do
    for name in replays fleet; do
        { time "$name" 2>/dev/null; } 2>"$work/time"
        read -r wall user system <"$work/time"
        echo "$name $wall $(awk "BEGIN { print $user + $system }")" | tee -a "$work/times"
    done
done
read -r replay_wall replay_cpu < <(best replays; echo)
read -r fleet_wall fleet_cpu < <(best fleet; echo)
awk "BEGIN { printf \"throughput against separate obstacle-replay runs: %.2f by the clock, %.2f by time of the processor\n\", \
    $replay_wall / $fleet_wall, $replay_cpu / $fleet_cpu }"

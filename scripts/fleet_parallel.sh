#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs a manifest with GNU parallel, on this machine or several, and merges.
# usage: scripts/fleet_parallel.sh MANIFEST OUTPUT [JOBS] [OPTION OF PARALLEL]...
#   JOBS   processes on each machine (as many as there are cores); four shards are made for each
#   e.g.   scripts/fleet_parallel.sh night.jsonl /data/night 8 --sshlogin node1,node2
#          (the machines see MANIFEST, the recordings and OUTPUT under the same paths)
# OBSTACLE_FLEET names the program, where it is not in the PATH. The same command again takes up what was cut off.
# Exit code: that of the merge; 1 also where a shard was killed.
set -euo pipefail

[ $# -ge 2 ] || { sed -n '3,9s/^# //p' "$0" >&2; exit 2; }
command -v parallel >/dev/null || { echo "GNU parallel is missing: apt-get install parallel" >&2; exit 1; }
manifest=$(realpath "$1") output=$(realpath -m "$2") jobs=${3:-$(nproc)}
[[ $jobs =~ ^[1-9][0-9]*$ ]] || { echo "JOBS $jobs: must be a number of at least 1" >&2; exit 2; }
fleet=${OBSTACLE_FLEET:-obstacle-fleet}
shards=$((4 * jobs))
mkdir -p "$output"

# A shard that a signal killed is done once more; one that ended with 1 has listed what failed.
parallel --will-cite --jobs "$jobs" --line-buffer --joblog "$output/parallel.log" "${@:4}" \
    "$(printf '%q ' "$fleet" run "$manifest" --output "$output")" --shard "{}/$shards; code=\$?; [ \$code -le 1 ] ||" \
    "$(printf '%q ' "$fleet" run "$manifest" --output "$output")" --shard "{}/$shards" \
    ::: $(seq 0 $((shards - 1))) || true
"$fleet" merge "$manifest" --output "$output"

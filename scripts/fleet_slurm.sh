#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Hands a manifest to Slurm: an array of tasks, each a shard, and a merge when all have ended.
# usage: scripts/fleet_slurm.sh MANIFEST OUTPUT TASKS [--sbatch OPTION]... [--run OPTION]... [--merge OPTION]...
#   MANIFEST          of `obstacle-fleet manifest`; all nodes see it, the recordings and OUTPUT under the same paths
#   TASKS             number of shards: some more than there are cores
#   --sbatch OPTION   for sbatch, both times, e.g. --sbatch --partition=night
#   --run OPTION      for `obstacle-fleet run`, e.g. --run --timeout=3600
#   --merge OPTION    for `obstacle-fleet merge`, e.g. --merge --baseline=last/fleet.sqlite
# OBSTACLE_FLEET names the program, where it is not in the PATH. Prints the two numbers of the jobs. The same command
# again takes up what was cancelled. Output of the tasks: OUTPUT/logs.
set -euo pipefail

[ $# -ge 3 ] || { sed -n '3,11s/^# //p' "$0" >&2; exit 2; }
manifest=$(realpath "$1") output=$(realpath -m "$2") tasks=$3
shift 3
sbatch=() run=() merge=()
while [ $# -ge 2 ]; do
    case $1 in
        --sbatch) sbatch+=("$2") ;;
        --run) run+=("$2") ;;
        --merge) merge+=("$2") ;;
        *) echo "unknown argument '$1'; see the head of $0" >&2 && exit 2 ;;
    esac
    shift 2
done
[ $# -eq 0 ] || { echo "$1 wants a value; see the head of $0" >&2; exit 2; }
[[ $tasks =~ ^[1-9][0-9]*$ ]] || { echo "TASKS $tasks: must be a number of at least 1" >&2; exit 2; }
fleet=${OBSTACLE_FLEET:-obstacle-fleet}
mkdir -p "$output/logs"

# A task that a signal killed is put back into the queue, five times at most; it takes up what it had not done. One that
# ended by itself (0, 1: some recordings failed) is not.
task=$(
    cat <<'TASK'
"$@"
code=$?
if [ $code -gt 130 ] && [ "${SLURM_RESTART_COUNT:-0}" -lt 5 ]; then
    echo "ended by signal $((code - 128)): back into the queue"
    scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"
fi
exit $code
TASK
)
# script COMMAND: a batch script, with words quoted for the shell.
script() { printf '#!/bin/bash\nset -- %s\n%s\n' "$(printf '%q ' "${@:2}")" "$1"; }

job=$(script "$task" "$fleet" run "$manifest" --output "$output" "${run[@]}" |
    sbatch --parsable --job-name=obstacle-fleet --array="0-$((tasks - 1))" --ntasks=1 --cpus-per-task=1 --requeue \
        --open-mode=append --output="$output/logs/%A_%a.log" "${sbatch[@]}")
merging=$(script '"$@"' "$fleet" merge "$manifest" --output "$output" "${merge[@]}" |
    sbatch --parsable --job-name=obstacle-fleet-merge --dependency="afterany:$job" --ntasks=1 --cpus-per-task=1 \
        --output="$output/logs/merge_%j.log" "${sbatch[@]}")
echo "$job $merging"

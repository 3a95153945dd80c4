#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# How good the boxes of tracks are for each `[tracking] stamp`, each against the truth of its instant: a table.
# usage: scripts/stamps.sh [SCANS_OF_STREET]      (default: all 800 of the shipped street, at ten a second)
# Environment: as scripts/accuracy.sh, which writes the table into BENCHMARK.md
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

[ -d "${LIDAR_OBSTACLES_DATA-}" ] || die "LIDAR_OBSTACLES_DATA names no folder of labelled sets"
[ -f "${LIDAR_OBSTACLES_EVAL_TRACKS-}" ] || die "LIDAR_OBSTACLES_EVAL_TRACKS names no eval_tracks.py"
seconds=$(awk -v n="${1:-800}" 'BEGIN { print n / 10 }')
apps=build/release/apps
work=output/accuracy
mkdir -p "$work"

# row NAME PREFIX STAMP: a line of the table
row() {
    local name=$1 prefix=$2 stamp=$3 found="$work/$1_stamp_$3" truth=(--gt "$2_gt.csv" --ego "$2_ego.csv" --gt-pose ref)
    "$apps/obstacle-replay/obstacle-replay" "$prefix.rawlog" --output "$found" --set "tracking.stamp=$stamp" >/dev/null 2>&1
    case $stamp in
        seen) truth[5]=obs ;;
        now)
            /usr/bin/python3 scripts/truth_now.py "$prefix"_{gt,ego}.csv "$found/obstacles.csv" "$found/now_gt.csv"
            truth[1]=$found/now_gt.csv
            ;;
    esac
    /usr/bin/python3 "$LIDAR_OBSTACLES_EVAL_TRACKS" "${truth[@]}" --det "$found/obstacles.csv" --json "$found/tracks.json" >/dev/null
    truth=("${truth[@]:0:2}" "${truth[@]:4:2}") # eval_boxes.py has no --ego
    /usr/bin/python3 "$(dirname "$LIDAR_OBSTACLES_EVAL_TRACKS")/eval_boxes.py" "${truth[@]}" --det "$found/obstacles.csv" \
        --json "$found/boxes.json" >/dev/null
    /usr/bin/python3 - "$name" "$stamp" "$found" <<'PY'
import json, sys
name, stamp, folder = sys.argv[1:]
t, b = (json.load(open('%s/%s.json' % (folder, k))) for k in ('tracks', 'boxes'))
truth = {'seen': 'when the laser saw it (`obs`)', 'scan': 'timestamp (`ref`)', 'now': 'end of the scan'}
def of(tracks, boxes):
    c = boxes['centre_m']
    return '%.2f | %.2f | %.2f / %.2f | %.2f' % (tracks['f1'], tracks['hota'], c['median'], c['p95'], boxes['iou']['mean'])
def boxes(group):
    return b[group].get('all', b[group])
print('| %s | %s | %s | %s | %s |' % (name, stamp, truth[stamp], of(t['vehicle'], boxes('vehicle')),
                                    of(t['person'], boxes('pedestrian'))))
PY
}

street=$work/street_stamps
[ $# -eq 0 ] && street=$work/street_all
[ $# -eq 0 ] && [ "$street.rawlog" -nt datasets/scenarios/street.yaml ] ||
    "$apps/obstacle-simulate/obstacle-simulate" datasets/scenarios/street.yaml --to "$seconds" --output "$street" >/dev/null 2>&1
echo "| sequence | \`stamp\` | truth at | vehicles: F1 | HOTA | centre [m]: median / p95 | IoU | people: F1 | HOTA | centre [m]: median / p95 | IoU |"
echo "|---|---|---|---|---|---|---|---|---|---|---|"
for stamp in seen scan now; do row sim_street "$LIDAR_OBSTACLES_DATA/sim_street" $stamp; done
for stamp in seen scan now; do row street "$street" $stamp; done

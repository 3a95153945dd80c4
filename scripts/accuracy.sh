#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures the detector on every labelled set and on the simulated scenarios, and writes BENCHMARK.md's
# tables. Times are told as well: for an idle machine.
# usage: scripts/accuracy.sh [OUTPUT.md]      (default: BENCHMARK.md)
#        scripts/accuracy.sh --check BUILD    fails where BENCHMARK.md is older than the code: the rows of one short set,
#                                             measured with the tools of a build
# Environment:
#   LIDAR_OBSTACLES_DATA         folder of the labelled sets (datasets/README.md)
#   LIDAR_OBSTACLES_EVAL_TRACKS  eval_tracks.py; eval_points.py and eval_boxes.py lie beside it
set -euo pipefail
shopt -s inherit_errexit
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

[ -d "${LIDAR_OBSTACLES_DATA-}" ] || die "LIDAR_OBSTACLES_DATA names no folder of labelled sets"
[ -f "${LIDAR_OBSTACLES_EVAL_TRACKS-}" ] || die "LIDAR_OBSTACLES_EVAL_TRACKS names no eval_tracks.py"
output=${1:-BENCHMARK.md} build=build/release
if [ "${1-}" = --check ]; then
    [ -d "${2-}" ] || die "usage: scripts/accuracy.sh --check BUILD"
    build=$2
fi
data=$LIDAR_OBSTACLES_DATA
tracks=$LIDAR_OBSTACLES_EVAL_TRACKS
points=$(dirname "$tracks")/eval_points.py
replay=$build/apps/obstacle-replay/obstacle-replay
simulate=$build/apps/obstacle-simulate/obstacle-simulate
peer=$build/tests/benchmark/lidar_obstacles_pcl_peer
work=output/accuracy
mkdir -p "$work"
# shellcheck source=scripts/sequence_tables.sh
. scripts/sequence_tables.sh

# detect NAME INPUT RINGS: obstacles.csv in $work/NAME_RINGS
detect() { "$replay" "$2" --output "$work/$1_$3" --planes "$3" --set tracking.enabled=false >/dev/null 2>&1; }

# judge FOLDER JSON EVALUATION-OPTION...: what eval_tracks.py says of the boxes in FOLDER
judge() {
    local folder=$1 json=$2
    shift 2
    /usr/bin/python3 "$tracks" "$@" --det "$folder/obstacles.csv" --json "$json" >/dev/null
}

# row NAME RINGS EVALUATION-OPTION...: one line of the table of classes
row() {
    local name=$1 rings=$2
    shift 2
    judge "$work/${name}_$rings" "$work/${name}_$rings.json" "$@"
    /usr/bin/python3 - "$name" "$rings" "$work/${name}_$rings.json" <<'PY'
import json, sys
name, rings, file = sys.argv[1:]
r = json.load(open(file))
def of(group):
    g = r.get(group)
    if not g: return '- | - | -'
    return '%.2f / %.2f | **%.2f** | %s' % (g['precision'], g['recall'], g['f1'], '%.2f' % g['ece'] if 'ece' in g else '-')
b = r['blind']
print('| %s | %s | %s | %s | %.2f %% (%d) |' % (name, rings, of('vehicle'), of('person'), 100 * b['share'], b['longest_run']))
PY
}

# simulated NAME SCENARIO OPTION...: rawlog and truth in $work/NAME, made anew where the scenario is younger
simulated() {
    local name=$1
    shift
    [ "$work/$name.rawlog" -nt "$1" ] || "$simulate" "$@" --output "$work/$name" >/dev/null 2>&1
}

classes() {
    local rings name seed kind
    echo "| set | rings | vehicle: precision / recall | F1 | ECE | people: precision / recall | F1 | ECE | near without any box (longest run) |"
    echo "|---|---|---|---|---|---|---|---|---|"
    for rings in 16 8 4; do
        detect sim_street "$data/sim_street.rawlog" $rings
        row sim_street $rings --prefix "$data/sim_street"
        detect kitti_0001 "$data/kitti_0001_16.rawlog" $rings
        row kitti_0001 $rings --gt "$data/kitti_0001_16_gt.csv" --fov 80
        for name in street delivery monza; do
            simulated $name "datasets/scenarios/$name.yaml" --stride 5
            detect $name "$work/$name.rawlog" $rings
            row $name $rings --prefix "$work/$name"
        done
    done
    for rings in 16 8; do random_row $rings; done
}

# 40 scenes of seeds that no training uses (obstacle-train counts up from its --seed), their scans in one table.
random_row() {
    local rings=$1 seed kind
    local all="$work/random_$rings"
    mkdir -p "$all"
    : >"$all/obstacles.csv"
    for seed in $(seq 900001 900040); do
        kind=$(echo street car-park sidewalk forest-road track | cut -d' ' -f$((seed % 5 + 1)))
        simulated "random_$seed" --random "$kind" --seed "$seed" --stride 8
        detect "random_$seed" "$work/random_$seed.rawlog" "$rings"
    done
    /usr/bin/python3 scripts/join_sets.py "$work" "$rings" "$all"
    row random "$rings" --gt "$all/gt.csv"
}

# Boxes of vehicles whatever their class; the paper by itself beside the default.
boxes() {
    local set rings way
    echo "| set | rings | method | recall | nearest face [m]: mean / median / p95 | heading [deg]: mean / median / p95 | off > 20 deg | IoU: mean / median | fragments per scan |"
    echo "|---|---|---|---|---|---|---|---|---|"
    for rings in 16 8; do
        for set in kitti_0001_16 kitti_0048_16 sim_street sim_yaw_sedan; do
            for way in auto paper; do boxes_row $set $rings $way; done
        done
    done
}

# judge_boxes SET BOXES.csv: what eval_boxes.py says of them, in $work/boxes.json
judge_boxes() {
    local truth=(--prefix "$data/$1")
    case $1 in kitti*) truth=(--gt "$data/$1_gt.csv" --fov 80) ;; esac
    /usr/bin/python3 "$(dirname "$tracks")/eval_boxes.py" "${truth[@]}" --det "$2" --json "$work/boxes.json" >/dev/null
}

# boxes_row SET RINGS auto|paper
boxes_row() {
    local set=$1 rings=$2 way=$3 options=()
    [ "$way" = auto ] || options=(--set pipeline.bare_paper=true --set "pipeline.algorithm=$rings-plane")
    "$replay" "$data/$set.rawlog" --output "$work/boxes" --planes "$rings" --set tracking.enabled=false "${options[@]}" >/dev/null 2>&1
    judge_boxes "$set" "$work/boxes/obstacles.csv"
    /usr/bin/python3 - "$set" "$rings" "$way" "$work/boxes.json" <<'PY'
import json, sys
name, rings, way, file = sys.argv[1:]
r = json.load(open(file))
v = r['vehicle']['all'] if 'all' in r['vehicle'] else r['vehicle']
face, turn = v['face_m'], v['h180_deg']
print('| %s | %s | %s | %.2f | %.2f / %.2f / %.2f | %.1f / %.1f / %.1f | %.0f %% | %.2f / %.2f | %.2f |' % (
    name, rings, way, v['recall'], face['mae'], face['median'], face['p95'], turn['mae'], turn['median'], turn['p95'],
    100 * v['h180_over20'], v['iou']['mean'], v['iou']['median'], r['unmatched_per_scan'].get('fragment', 0.0)))
PY
}

singles() {
    local set height
    echo "| set | vehicle boxes that are one | vehicle returns in one | person boxes that are one | structure in any box |"
    echo "|---|---|---|---|---|"
    for set in nuscenes:1.84 kitti:1.73; do
        height=${set#*:} set=points_${set%:*}
        detect "$set" "$data/points/$set.rawlog" 16
        /usr/bin/python3 "$points" --clouds "$data/points/$set" --height "$height" --det "$work/${set}_16/obstacles.csv" \
            --json "$work/$set.json" >/dev/null
        /usr/bin/python3 - "$set" "$work/$set.json" <<'PY'
import json, sys
r = json.load(open(sys.argv[2]))
print('| %s | %.2f | %.2f | %.2f | %.2f |' % (sys.argv[1], r['vehicle']['precision'], r['vehicle']['covered'], r['person']['precision'], r['structure']['covered_by_any']))
PY
    done
}

# What the tutorials of the Point Cloud Library make of the same scans, and how long both take.
peers() {
    local set rings=16
    echo "| set | recall | IoU: mean / median | PCL, ms a scan: p50 / p95 | here: p50 / p95 | PCL / here |"
    echo "|---|---|---|---|---|---|"
    for set in kitti_0001_16 kitti_0048_16 sim_street; do
        "$peer" "$data/$set.rawlog" "$work/peer.csv" $rings >"$work/peer.txt"
        judge_boxes "$set" "$work/peer.csv"
        /usr/bin/python3 - "$set" "$work/boxes.json" "$work/peer.txt" <<'PY'
import json, sys
v = json.load(open(sys.argv[2]))['vehicle']
v = v.get('all', v)
print('| %s | %.2f | %.2f / %.2f | %s' % (sys.argv[1], v['recall'], v['iou']['mean'], v['iou']['median'], open(sys.argv[3]).read().strip()))
PY
    done
}

# The drive of KITTI is short and has vehicles and people: scan by scan, and with tracks.
check() {
    local rings line single followed old=0
    for rings in 16 8; do
        detect kitti_0001 "$data/kitti_0001_16.rawlog" $rings
        single=$(row kitti_0001 $rings --gt "$data/kitti_0001_16_gt.csv" --fov 80)
        followed=$(track_row kitti_0001 $rings "$data/kitti_0001_16.rawlog" --gt "$data/kitti_0001_16_gt.csv" --fov 80)
        for line in "$single" "$followed"; do
            [ -n "$line" ] || die "a row is empty"
            grep -qxF -- "$line" BENCHMARK.md || { echo "BENCHMARK.md lacks: $line" && old=1; }
        done
    done
    [ $old -eq 0 ] || die "BENCHMARK.md is older than the code: scripts/accuracy.sh writes it"
}

# measured_by COMMAND: how a row is measured; it stands above its table
measured_by() { printf 'Each row: `%s`\n\n' "$1"; }

machine() {
    local compiler
    compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$build/CMakeCache.txt")
    echo "Measured on: $(LC_ALL=C lscpu | sed -n 's/^Model name: *//p'); $("$compiler" --version | sed -n 1p);" \
        "MRPT $(dpkg-query -W -f '${Version}' libmrpt-obs-dev)."
}

if [ "${1-}" = --check ]; then
    check
    exit
fi
install_packages run build test peer
use_ccache
cmake --preset release >/dev/null
cmake --build --preset release --parallel "$(nproc)" --target obstacle-replay obstacle-simulate lidar_obstacles_pcl_peer >/dev/null
{
    echo "# Benchmark"
    echo
    echo "Written by \`scripts/accuracy.sh\`; one model for all. Tracking is off, except in the tables that say"
    echo "otherwise. Truth counts with 15 returns or more and a nearest face within 30 m; a box is right if it stands on an object of its class. *Near without any box*: objects within 15 m,"
    echo "whatever the class. ECE: calibration error. \`street\`, \`delivery\`, \`monza\`: the shipped scenarios, every fifth scan;"
    echo "\`random\`: 40 scenes of seeds that no training uses. The truth counts the returns of all 16 rings whatever the number that"
    echo "is used: of the random vehicles 7 % have no return on the 8 rings, and 3 % one or two."
    echo
    machine
    echo "The README's figures of the standard tracker (constant velocity, GIoU gate; six sequences of KITTI tracking with a published"
    echo "detector's boxes; docs/tracking.md) were measured once; no program in the repository repeats them. Above each table is the command of"
    echo "a row; the truth of KITTI is named by \`--gt SET_gt.csv --fov 80\`, and the rows of method *paper* add \`--set pipeline.bare_paper=true\`."
    echo "The scripts \`eval_*.py\` come with the labelled sets; \`obstacle-evaluate\` gives the same figures without them."
    echo
    measured_by "obstacle-replay SET.rawlog --output OUT --planes RINGS --set tracking.enabled=false; eval_tracks.py --prefix SET --det OUT/obstacles.csv"
    classes
    echo
    echo "With tracks, every scan; \`random_streets\`: ten of seeds that no training uses. Velocities are those of vehicles whose track"
    echo "is 1 s old; parked ones stand still in the truth, moving ones are faster than 1 m/s:"
    echo
    measured_by "obstacle-replay SET.rawlog --output OUT --planes RINGS; eval_tracks.py --prefix SET --det OUT/obstacles.csv"
    tracks
    echo
    echo "The same sequences, 16 rings, over time (of vehicles whose track is 1 s old), near the vehicle, and with tracks beside without"
    echo "(IoU and heading of vehicles' boxes, whatever their class):"
    echo
    measured_by "as above, and with --set tracking.enabled=false; eval_tracks.py --near 10 (people: --max-range 5), eval_boxes.py"
    over_time
    echo
    echo "Time from a scan in memory to its boxes and tracks, one core of the machine above:"
    echo
    measured_by "obstacle-replay SET.rawlog --output OUT --planes RINGS; timing_ms of OUT/summary.json"
    times_table
    echo
    echo "Each \`[tracking] stamp\` against the truth of its instant (\`scripts/stamps.sh\`), 16 rings, tracks on; centres and overlap are those of"
    echo "boxes whatever their class:"
    echo
    measured_by "obstacle-replay SET.rawlog --output OUT --set tracking.stamp=STAMP; eval_tracks.py, eval_boxes.py --gt SET_gt.csv --det OUT/obstacles.csv"
    scripts/stamps.sh
    echo
    echo "Boxes of vehicles whatever their class (rows of structure left out), tracking off; *paper*: \`pipeline.bare_paper\`:"
    echo
    measured_by "obstacle-replay SET.rawlog --output OUT --planes RINGS --set tracking.enabled=false; eval_boxes.py --prefix SET --det OUT/obstacles.csv"
    boxes
    echo
    echo "The Point Cloud Library on the same scans: points within 40 m thinned to voxels of .1 m, the ground taken out as a plane by RANSAC,"
    echo "Euclidean clusters, rectangles of the closeness criterion; scan by scan in turn with the detector (no tracks), one core:"
    echo
    measured_by "lidar_obstacles_pcl_peer SET.rawlog OUT.csv 16; eval_boxes.py --prefix SET --det OUT.csv"
    peers
    echo
    echo "Single real scans with labelled returns, 16 rings:"
    echo
    measured_by "obstacle-replay SET.rawlog --output OUT --planes 16 --set tracking.enabled=false; eval_points.py --clouds SET --height HEIGHT --det OUT/obstacles.csv"
    singles
} >"$output.new"
mv "$output.new" "$output"
say "written: $output"

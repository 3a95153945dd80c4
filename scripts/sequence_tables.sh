# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash disable=SC2154 # variables of scripts/accuracy.sh, which reads this file
# Tables of sequences, with tracks.

# The sequences at every turn of the sensor, with tracks.
tracks() {
    local name rings
    echo "| sequence | rings | vehicles: F1 | HOTA | id switches | people: F1 | HOTA | id switches | near without any box (longest run) | parked, told moving | speed of moving: error [m/s] median / p95 | reversed |"
    echo "|---|---|---|---|---|---|---|---|---|---|---|---|"
    for rings in 16 8; do
        track_row sim_street $rings "$data/sim_street.rawlog" --prefix "$data/sim_street"
        track_row kitti_0001 $rings "$data/kitti_0001_16.rawlog" --gt "$data/kitti_0001_16_gt.csv" --fov 80
        for name in street delivery monza; do
            simulated "${name}_all" "datasets/scenarios/$name.yaml"
            track_row "$name" $rings "$work/${name}_all.rawlog" --prefix "$work/${name}_all"
        done
        random_streets $rings
    done
}

# follow NAME RINGS INPUT: obstacles.csv with tracks in $work/NAME_tracks_RINGS
follow() { "$replay" "$3" --output "$work/$1_tracks_$2" --planes "$2" >/dev/null 2>&1; }

# track_row NAME RINGS INPUT EVALUATION-OPTION...
track_row() {
    local name=$1 rings=$2
    follow "$name" "$rings" "$3"
    shift 3
    tracks_judged "$name" "$rings" "$@"
}

# tracks_judged NAME RINGS EVALUATION-OPTION...: one line of the table of tracks
tracks_judged() {
    local name=$1 rings=$2
    shift 2
    judge "$work/${name}_tracks_$rings" "$work/${name}_tracks_$rings.json" "$@"
    /usr/bin/python3 - "$name" "$rings" "$work/${name}_tracks_$rings.json" <<'PY'
import json, sys
name, rings, file = sys.argv[1:]
r = json.load(open(file))
def of(group):
    g = r.get(group)
    return '%.2f | **%.2f** | %d' % (g['f1'], g['hota'], g['idsw']) if g else '- | - | -'
def share(value): return '-' if value is None else '%.1f %%' % (100 * value)
b, v = r['blind'], r['vehicle']['velocity']
speed = v['moving']
print('| %s | %s | %s | %s | %.2f %% (%d) | %s | %s | %s |' % (
    name, rings, of('vehicle'), of('person'), 100 * b['share'], b['longest_run'], share(v['standing_told_moving']),
    '%.2f / %.2f' % (speed['median'], speed['p95']) if speed['n'] else '-', share(v['heading360']['reversed'])))
PY
}

# The same sequences over time and near the vehicle, and boxes with tracks beside those without.
over_time() {
    local name
    echo "| sequence | parked: speed p95 [m/s] | yaw, length from scan to scan, p95 | moving: direction known | people within 5 m found, tracks off | without any box within 10 m, longest run | vehicles: F1, tracks off / on | IoU, off / on | heading p95, off / on [deg] |"
    echo "|---|---|---|---|---|---|---|---|---|"
    over_time_row sim_street "$data/sim_street.rawlog" --gt "$data/sim_street_gt.csv"
    over_time_row kitti_0001 "$data/kitti_0001_16.rawlog" --gt "$data/kitti_0001_16_gt.csv" --fov 80
    for name in street delivery monza; do over_time_row $name "$work/${name}_all.rawlog" --gt "$work/${name}_all_gt.csv"; done
}

# over_time_row NAME INPUT EVALUATION-OPTION...: after tracks(), whose boxes it looks at
over_time_row() {
    local name=$1 on="$work/$1_tracks_16" off="$work/$1_all_16" boxes way
    boxes=$(dirname "$tracks")/eval_boxes.py
    detect "${name}_all" "$2" 16
    shift 2
    for way in "$on" "$off"; do
        judge "$way" "$way/tracks.json" "$@" --near 10
        /usr/bin/python3 "$boxes" "$@" --det "$way/obstacles.csv" --json "$way/boxes.json" >/dev/null
    done
    judge "$off" "$off/near.json" "$@" --max-range 5
    /usr/bin/python3 - "$name" "$on" "$off" <<'PY'
import json, sys
name, on, off = sys.argv[1:]
def read(folder, what): return json.load(open('%s/%s.json' % (folder, what)))
def number(value, text): return '-' if value is None else text % value
t, near, blind = read(on, 'tracks')['vehicle'], read(off, 'near'), read(on, 'tracks')['blind']
ways = [read(way, 'tracks')['vehicle'] for way in (off, on)]
shapes = [read(way, 'boxes')['vehicle'] for way in (off, on)]
shapes = [s.get('all', s) for s in shapes]
known, jitter = t['velocity']['heading360'], t['jitter']
print('| %s | %s | %s, %s | %s | %s | %d | %.2f / %.2f | %.2f / %.2f | %.1f / %.1f |' % (
    name, number(t['velocity']['standing']['p95'], '%.2f'), number(jitter['yaw_deg']['p95'], '%.1f deg'),
    number(jitter['length_m']['p95'], '%.2f m'), number(known['n'] / known['of'] if known['of'] else None, '%.2f'),
    number((near.get('person') or {}).get('recall'), '%.2f'), blind['longest_run'],
    ways[0]['f1'], ways[1]['f1'], shapes[0]['iou']['mean'], shapes[1]['iou']['mean'],
    shapes[0]['h180_deg']['p95'], shapes[1]['h180_deg']['p95']))
PY
}

# What the runs of tracks() took.
times_table() {
    local name rings
    echo "| sequence | rings | returns in a scan | time of a scan [ms]: median / p95 / p99 | most of it, medians [ms] |"
    echo "|---|---|---|---|---|"
    for rings in 16 8; do
        for name in sim_street kitti_0001 street delivery monza; do times_row $name $rings; done
    done
}

# times_row NAME RINGS
times_row() {
    /usr/bin/python3 - "$1" "$2" "$work/$1_tracks_$2/summary.json" <<'PY'
import json, sys
name, rings, file = sys.argv[1:]
r = json.load(open(file))
stages = r['timing_ms']
total = stages.pop('total')
most = sorted(stages.items(), key=lambda s: -s[1]['median'])[:3]
print('| %s | %s | %d | %.1f / %.1f / %.1f | %s |' % (name, rings, r['returns'] / r['scans'], total['median'], total['p95'], total['p99'],
                                                    ', '.join('%s %.1f' % (stage, t['median']) for stage, t in most)))
PY
}

# Ten streets drawn from seeds that no training uses, one after the other.
random_streets() {
    local rings=$1 seed
    local streets="$work/streets"
    mkdir -p "$streets/joined_$rings" "$work/random_streets_tracks_$rings"
    for seed in $(seq 900005 5 900050); do
        simulated "streets/random_$seed" --random street --seed "$seed"
        follow "streets/random_$seed" "$rings" "$streets/random_$seed.rawlog"
        ln -sfn "random_${seed}_tracks_$rings" "$streets/random_${seed}_$rings"
    done
    /usr/bin/python3 scripts/join_sets.py "$streets" "$rings" "$streets/joined_$rings"
    cp "$streets/joined_$rings/obstacles.csv" "$work/random_streets_tracks_$rings/"
    tracks_judged random_streets "$rings" --gt "$streets/joined_$rings/gt.csv"
}

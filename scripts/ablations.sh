#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What each part of the recognizer is worth: small models trained without it, judged on random scenes that no training
# uses. Writes docs/ablations.md. usage: scripts/ablations.sh [SCENES [JUDGED [OUTPUT.md]]]
#   SCENES  of each training (350: all in all about an hour of two idle cores; 25 are the fewest that calibrate)
#   JUDGED  random scenes of seeds that no training uses (40)
# Environment: LIDAR_OBSTACLES_EVAL_TRACKS names eval_tracks.py
set -euo pipefail
shopt -s inherit_errexit # a detector that fails in judge() ends it all
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

[ -f "${LIDAR_OBSTACLES_EVAL_TRACKS-}" ] || die "LIDAR_OBSTACLES_EVAL_TRACKS names no eval_tracks.py"
scenes=${1:-350} judged=${2:-40} output=${3:-docs/ablations.md}
apps=build/release/apps
work=output/ablations/$judged
mkdir -p "$work"
install_packages run build test
use_ccache
cmake --preset release >/dev/null
cmake --build --preset release --parallel "$(nproc)" --target obstacle-train obstacle-replay obstacle-simulate >/dev/null

# Features by what they look at (names as in features.h).
size=length,width,facing,top,bottom,top_limit
profile=mean_height,height_spread,share_knee,share_hip,share_chest,share_head,share_above,width_low,width_middle,width_high,lean
rings=returns,rings,ring_share,ring_width_spread,fill,pieces
beams=through,under,hidden,ground_inside,floating,gap_share,gap_free,gap_hidden
beyond=goes_on_more,goes_on_less,hidden_more,hidden_less,goes_up,goes_down
surface=rough_median,rough_high,rough_metres,jumps,edge_mean,edge_high,thickness,steep
told=told_vehicle,told_cyclist,told_pedestrian,told_structure,told_unknown,told_mixture,told_vehicle_part,told_person_part
notches=notch_depth,notch_rings
scale=range,gap,next_gap,ring_step,beam_step,sensor_height,noise
parts=apart,less_share,more_whole,more_vehicle,more_person,more_structure,less_whole,less_vehicle,less_person,less_structure
about=$(for place in beside near about; do for what in structure vehicle person other count; do printf '%s_%s,' $place $what; done; done)
about+=next_away,next_structure,next_vehicle,next_person,next_size,next_top,next_bottom
about+=,structure_away,structure_size,vehicle_away,vehicle_size,person_away,person_size

# The scenes that judge: those of scripts/accuracy.sh.
judges() {
    local seed kind
    for seed in $(seq 900001 $((900000 + judged))); do
        kind=$(echo street car-park sidewalk forest-road track | cut -d' ' -f$((seed % 5 + 1)))
        [ -f "$work/random_$seed.rawlog" ] ||
            "$apps/obstacle-simulate/obstacle-simulate" --random "$kind" --seed "$seed" --stride 8 --output "$work/random_$seed" >/dev/null 2>&1
    done
}

# judge RINGS OPTION...: F1 of vehicles and of people, with these options of obstacle-replay
judge() {
    local rings=$1 rawlog found="$work/judged_$1"
    shift
    rm -rf "$found" "$work"/random_*_"$rings"
    mkdir -p "$found"
    for rawlog in "$work"/random_*.rawlog; do
        "$apps/obstacle-replay/obstacle-replay" "$rawlog" --output "${rawlog%.rawlog}_$rings" --planes "$rings" \
            --set tracking.enabled=false "$@" >/dev/null 2>&1
    done
    /usr/bin/python3 scripts/join_sets.py "$work" "$rings" "$found" >/dev/null
    /usr/bin/python3 "$LIDAR_OBSTACLES_EVAL_TRACKS" --gt "$found/gt.csv" --det "$found/obstacles.csv" --json "$found/f1.json" >/dev/null
    /usr/bin/python3 -c '
import json, sys
r = json.load(open(sys.argv[1]))
print(" | ".join("%.3f" % r[g]["f1"] if r.get(g) else "-" for g in ("vehicle", "person")))' "$found/f1.json"
}

# model NAME TRAINING-OPTION...: a line of the table
model() {
    local name=$1 file="$work/model.txt"
    shift
    "$apps/obstacle-train/obstacle-train" --scenes "$scenes" --output "$file" "$@" >/dev/null 2>"$work/train.log" ||
        die "$name: $(tail -n 1 "$work/train.log")"
    judged "$name" --set "recognizer.model=$file"
}

# judged NAME OPTION...: a line of the table, with these options of obstacle-replay
judged() {
    local name=$1 by_16 by_8
    shift
    by_16=$(judge 16 "$@")
    by_8=$(judge 8 "$@")
    echo "| $name | $by_16 | $by_8 |"
}

judges
{
    echo "# Ablations"
    echo
    echo "Written by \`scripts/ablations.sh $scenes $judged\`: models of $scenes scenes (the one that is compiled in: 1000), each trained without"
    echo "something, judged on $judged random scenes of seeds that no training uses, tracking off. F1 of boxes with their class within"
    echo "30 m. *Rules*: the paper by itself (\`pipeline.bare_paper\`), classes by size; there is no other rule beside the score."
    echo
    echo "| model | 16 rings, vehicles | people | 8 rings, vehicles | people |"
    echo "|---|---|---|---|---|"
    model "all features, noise drawn from .5 to 3 cm"
    for group in size profile rings beams beyond surface notches told scale parts about; do
        model "without \`$group\`" --without "${!group}"
    done
    model "noise of 1.5 cm in all scenes" --noise 0.015
    judged rules --set pipeline.bare_paper=true
    echo
    echo "| group | features |"
    echo "|---|---|"
    for group in size profile rings beams beyond surface notches told scale parts about; do echo "| \`$group\` | ${!group//,/, } |"; done
} >"$output.new"
mv "$output.new" "$output"
say "written: $output"

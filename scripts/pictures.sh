#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Draws the pictures of the documents, or says which of them are older than the code. Windows are drawn by their tests.
# usage: scripts/pictures.sh [FOLDER]           all of them, into FOLDER (default: docs)
#        scripts/pictures.sh --check BUILD      street.png, and those of the recordings that come with the project, with the
#                                               tools of a build; fails where one does not look as it does in docs/.
#                                               street.gif is made of the same scenes and not compared, as its 68 frames
#                                               take long and have 48 colours
# Others make fig_*.png (scripts/monza.sh) and fleet_drift.png (a report of obstacle-fleet, by hand).
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

sample=datasets/street_sample real=/usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog
users=vehicle,pedestrian,cyclist,unknown
street_view=(--classes "$users" --view "11,-0.5,30,180,40")

# replay NAME INPUT OPTION...: results in $work/NAME
replay() {
    local name=$1
    shift
    "$build/apps/obstacle-replay/obstacle-replay" "$@" --output "$work/$name" >"$work/log.txt" 2>&1 ||
        die "$name: $(cat "$work/log.txt")"
}

# street_scan SECONDS: the simulated street so far in $work/street, and its scan 44: from above and behind, without the walls' boxes.
street_scan() {
    "$build/apps/obstacle-simulate/obstacle-simulate" datasets/scenarios/street.yaml --to "$1" --output "$work/street" >/dev/null
    replay large "$work/street.rawlog" "${street_view[@]}" --size 1280x720 --pictures 44
    cp "$work/large/picture_000044.png" "$output/street.png"
}

# The same as a scan and as seven seconds.
draw_street() {
    street_scan 8
    replay small "$work/street.rawlog" "${street_view[@]}" --size 760x428 --pictures all
    ffmpeg -v error -y -framerate 10 -start_number 12 -i "$work/small/picture_%06d.png" -vf \
        "split[a][b];[a]palettegen=max_colors=48:stats_mode=full[p];[b][p]paletteuse=dither=none:diff_mode=rectangle" \
        "$output/street.gif"
}

# Single scans: both cases of the paper's Fig. 5, zones, the real one.
draw_scans() {
    local hulls=("$sample.rawlog" --planes 8 --set pipeline.algorithm=8-plane --explain --classes "$users" --pictures all)
    replay two_sides "${hulls[@]}" --to 0 --view 10.5,-2,21,190,48
    replay one_side "${hulls[@]}" --from 7 --to 7 --view 17.5,6.5,17,225,48
    ffmpeg -v error -y -i "$work/two_sides/picture_000000.png" -i "$work/one_side/picture_000007.png" -filter_complex \
        "[0]crop=800:640:240:90,pad=808:640:0:0:white[a];[1]crop=800:640:240:80[b];[a][b]hstack" -frames:v 1 "$output/hulls.png"
    replay zones "$sample.rawlog" --to 0 --zones datasets/presets/zones.yaml --pictures all --view 5,0,30,-180,55
    cp "$work/zones/picture_000000.png" "$output/zones.png"
    replay scan "$real" --pictures all --grids all
    cp "$work/scan/picture_000000.png" "$output/sample_scan.png"
    ffmpeg -v error -y -i "$work/scan/grid_000000.png" -vf "crop=1200:800" -frames:v 1 "$output/sample_grid.png"
}

# layer INPUT SCAN LAYERS [OPTION...]: the next part of docs/layers.png, without the texts at the top
layer() {
    local input=$1 scan=$2 layers=$3
    shift 3
    replay layer "$input" --to "$scan" --view 23.5,-2.5,64,180,44 --size 408x640 --layers "$layers" --record "$work/frames" "$@"
    mv "$work/frames/$(printf 'frame_%06d.png' "$scan")" "$work/$(printf 'layer_%02d.png' "$parts")"
    parts=$((parts + 1))
}

draw_layers() {
    local parts=0 name
    for name in height intensity ring; do layer "$sample.rawlog" 0 raw --color $name; done
    for name in ground candidates grid morphology clusters clusters,fit clusters,merges; do
        layer "$sample.rawlog" 0 $name
    done
    layer "$sample.rawlog" 0 candidates,region --set region.front=18 --set region.lateral=7
    layer "$sample.rawlog" 0 boxes,labels --classes "$users"
    layer "$sample.rawlog" 0 boxes,truth --truth ${sample}_gt.csv
    layer "$sample.rawlog" 0 boxes --zones datasets/presets/zones.yaml
    layer datasets/street_tracks.rawlog 13 boxes,tracks
    ffmpeg -v error -y -framerate 1 -i "$work/layer_%02d.png" -vf "crop=408:280:0:360,tile=3x5:padding=4:color=0x333333" \
        -frames:v 1 "$output/layers.png"
}

# Windows on a virtual display, as their tests see them; rain as a frame of a video.
draw_windows() {
    local name rain=(--from 100 --to 120 --view "3,0,34,180,45" --size 800x600 --set octomap.mode=spurious)
    "$build/apps/obstacle-simulate/obstacle-simulate" datasets/scenarios/street.yaml --to 12.1 --rain 0.05 \
        --output "$work/rain" >/dev/null
    replay rain "$work/rain.rawlog" "${rain[@]}" --layers ground,filtered,voxels,clusters,boxes,labels --record "$work/frames"
    cp "$work/frames/frame_000120.png" "$output/window_rain.png"
    for name in camera outlines look panels; do
        LIDAR_OBSTACLES_PICTURES=$work "$build/tests/window_${name}_test" >"$work/log.txt" 2>&1 ||
            die "window_${name}_test: $(cat "$work/log.txt")"
    done
    cp "$work"/window{,_tracks,_camera,_outlines,_light,_features}.png "$output"
}

# The page of a minute of the street, in headless Chromium.
draw_page() {
    command -v node >/dev/null || die "replay_page.png needs Node.js"
    "$build/apps/obstacle-simulate/obstacle-simulate" datasets/scenarios/street.yaml --to 60 --output "$work/street60" >/dev/null
    replay page "$work/street60.rawlog" --to 599 --report "$work/page.html"
    node tests/node/shoot_page.mjs "$(realpath "$work/page.html")" 44 "$output/replay_page.png"
}

# MRPT's viewer on an annotated rawlog: the first scene is row 12 of its list, behind the poses that were read ahead; a border is
# dragged upwards.
shoot_rawlogviewer() {
    local picture=$1 x11=(env DISPLAY=":$2" HOME="$work/home" LIBGL_ALWAYS_SOFTWARE=1)
    cd "$work"
    "${x11[@]}" openbox >/dev/null 2>&1 &
    "${x11[@]}" RawLogViewer street_obstacles.rawlog >/dev/null 2>&1 &
    "${x11[@]}" timeout 60 xdotool search --sync --onlyvisible --name RawLogViewer windowmove --sync 0 0 windowsize 1280 860 >/dev/null
    # a tip stands before it, which comes late
    "${x11[@]}" timeout 60 xdotool search --sync --onlyvisible --name 'Tip of the Day' windowclose sleep 2 \
        mousemove 90 346 click 1 sleep 5 mousemove 840 409 mousedown 1 sleep 1 mousemove 840 300 sleep 1 \
        mousemove 840 220 mouseup 1 sleep 2 mousemove 840 500 click --repeat 14 --delay 200 5 sleep 3
    ffmpeg -v error -y -f x11grab -video_size 1280x860 -draw_mouse 0 -i ":$2" -frames:v 1 "$picture"
}

draw_rawlogviewer() {
    local display picture x
    picture=$(realpath "$output")/rawlogviewer.png
    replay annotated "$sample.rawlog" --classes "$users" --annotate "$work/street_obstacles.rawlog"
    rm -rf "$work/home" "$work/display" && mkdir "$work/home"
    Xvfb -displayfd 3 -screen 0 1280x860x24 3>"$work/display" >/dev/null 2>&1 &
    x=$!
    until [ -s "$work/display" ]; do sleep 0.1; done
    display=$(cat "$work/display")
    (shoot_rawlogviewer "$picture" "$display")
    kill $x && wait $x || true # the viewer and the window manager end with their display
}

# check: whether the pictures in $output look as those in docs/; letters and lines differ a little between drivers.
check() {
    local picture alike old=0
    for picture in "$output"/*.png; do
        alike=$(ffmpeg -hide_banner -i "docs/$(basename "$picture")" -i "$picture" -lavfi ssim -f null - 2>&1 |
            sed -n 's/.* All:\([0-9.]*\) .*/\1/p') || true
        printf '%-16s structural similarity %s\n' "$(basename "$picture")" "${alike:-of other sizes}"
        awk -v alike="${alike:-0}" 'BEGIN { exit !(alike < 0.97) }' && old=1
    done
    [ $old -eq 0 ] || die "docs/ has pictures that are older than the code: scripts/pictures.sh draws them"
}

if [ "${1-}" = --check ]; then
    [ -d "${2-}" ] || die "usage: scripts/pictures.sh --check BUILD"
    build=$2
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    output=$work/docs
    mkdir "$output"
    street_scan 4.5
    draw_scans
    draw_layers
    check
    exit
fi
output=${1:-docs} work=$PWD/output/pictures build=build/release
install_packages run build test
use_ccache
cmake --preset release >/dev/null
cmake --build --preset release --parallel "$(nproc)" --target obstacle-replay obstacle-simulate \
    window_camera_test window_outlines_test window_look_test window_panels_test
mkdir -p "$work"
draw_street
draw_scans
draw_layers
draw_windows
draw_page
draw_rawlogviewer

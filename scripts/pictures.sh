#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Draws the README's picture and animation, docs/street.png and docs/street.gif: eight seconds of the simulated street.
# usage: scripts/pictures.sh [FOLDER]      (default: docs)
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

output=${1:-docs}
work=output/pictures
install_packages run build
use_ccache
cmake --preset release >/dev/null
cmake --build --preset release --parallel "$(nproc)" --target obstacle-replay obstacle-simulate

build/release/apps/obstacle-simulate/obstacle-simulate datasets/scenarios/street.yaml --to 8 --output "$work/street"

# draw SIZE EVERY: pictures in $work/SIZE, from above and behind, without the walls' boxes
draw() {
    build/release/apps/obstacle-replay/obstacle-replay "$work/street.rawlog" --classes vehicle,pedestrian,cyclist,unknown \
        --view 11,-0.5,30,180,40 --size "$1" --pictures "$2" --output "$work/$1"
}
draw 1280x720 44
cp "$work/1280x720/picture_000044.png" "$output/street.png"
draw 760x428 all
ffmpeg -v error -y -framerate 10 -start_number 12 -i "$work/760x428/picture_%06d.png" -vf \
    "split[a][b];[a]palettegen=max_colors=48:stats_mode=full[p];[b][p]paletteuse=dither=none:diff_mode=rectangle" \
    "$output/street.gif"
ls -l "$output"/street.png "$output"/street.gif

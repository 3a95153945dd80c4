#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Measures the page of obstacle-replay --report: 600 scans of the simulated street (60 s), played in headless Chromium that
# draws in software. Prints size, time to load, frames per second and the load of the machine; fails above 30 MB or below
# LEAST frames per second.
# usage: scripts/replay_page.sh [--least N] [BUILD]      default: 0 frames per second, build/release, which is built first
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

least=0
if [ "${1-}" = --least ]; then
    [ $# -ge 2 ] || die "--least N: frames per second"
    least=$2
    shift 2
fi
build=${1:-build/release}
command -v node >/dev/null && command -v chromium >/dev/null || die "needs the packages nodejs and chromium"
if [ $# -eq 0 ]; then
    use_ccache
    cmake --preset release >/dev/null
    cmake --build --preset release --parallel "$(nproc)" --target obstacle-replay obstacle-simulate
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$build/apps/obstacle-simulate/obstacle-simulate" datasets/scenarios/street.yaml --output "$work/street" >/dev/null
"$build/apps/obstacle-replay/obstacle-replay" "$work/street.rawlog" --to 599 --report "$work/page.html" --output "$work/results" >/dev/null
load=$(cut -d' ' -f1 /proc/loadavg)
node tests/node/play_page.mjs "$work/page.html" "" 1280x800 10 >"$work/seen.json"
python3 - "$work" "$load" "$least" <<'EOF'
import json, os, sys

work, load, least = sys.argv[1], sys.argv[2], float(sys.argv[3])
seen = json.load(open(work + "/seen.json"))
megabytes = os.path.getsize(work + "/page.html") / 1e6
if seen["failed"] or seen["errors"]:
    sys.exit(f"the page does not work: {seen['failed']} {seen['errors']}")
fps = seen["frames_per_second"]
print(f"{seen['scans']} scans, {megabytes:.1f} MB, loads in {seen['load_ms'] / 1000:.1f} s and plays at {fps:.1f} frames/s, 1280 x 800,")
print(f"with {100 * seen['share']:.0f} % of the background's points while the camera turns; load of the machine {load} on {os.cpu_count()} cores.")
cost = seen["processor_ms_per_frame"]
print(f"A frame takes {cost['all']:.0f} ms of processor time with all points, {cost['fewest']:.0f} ms with a fifth of the background's.")
if seen["scans"] != 600 or megabytes > 30 or fps < least:
    sys.exit("expected: 600 scans, at most 30 MB" + (f", {least:g} frames/s" if least else ""))
EOF

#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs clang-tidy with .clang-tidy: all checks on the core; on the files with MRPT's headers, which take three times
# as long, the size limits only.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"

# Configured only, for the compile commands: clang cannot read g++'s precompiled headers.
build=$repo/build/tidy
(cd "$repo" && cmake --preset dev -B "$build" -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON \
    -DCMAKE_UNITY_BUILD=ON -DLIDAR_OBSTACLES_BUILD_TESTS=OFF >/dev/null)

# tidy REGEX [OPTION...]: checks the files whose path matches.
tidy() {
    local regex=$1 findings
    shift
    findings=$(run-clang-tidy -quiet -extra-arg=-Wno-shadow -extra-arg=-Wno-unknown-warning-option -j "$(nproc)" -p "$build" "$@" "$regex" 2>/dev/null) && return 0
    sed -e 's/\x1b\[[0-9;]*m//g' -e '/^clang-tidy/d' <<<"$findings" >&2
    return 1
}

# The files of libraries and tools are joined into large ones in the build folder: headers are read once for eight files.
core="mrpt_module/src/(scan|ground|grid|objects|sequence|[^/]*$)|mrpt_module/CMakeFiles/lidar_obstacles_core.dir/Unity|mrpt_module/evaluation/"
failed=0
tidy "$repo/(build/tidy/)?($core)" -checks=-bugprone-suspicious-include || failed=1
bridge="mrpt_module/(src|CMakeFiles)/(lidar_obstacles_)?mrpt_bridge|mrpt_module/(simulation|live|testing)/(src|CMakeFiles)/"
tidy "$repo/((build/tidy/)?($bridge)|build/tidy/apps/.*/Unity/|apps/|examples/)" -checks='-*,readability-function-*' || failed=1
[ $failed -eq 0 ] || die "clang-tidy has findings, see above"

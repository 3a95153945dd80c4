#!/usr/bin/env bash
# Runs clang-tidy with .clang-tidy: all checks on the core; on the files with MRPT's headers, which take three times
# as long, the size limits only.
# usage: scripts/check_tidy.sh [BUILD_DIR]   BUILD_DIR (default build/dev) has been configured
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"

build=${1:-$repo/build/dev}

# tidy REGEX [OPTION...]: checks the files of BUILD_DIR whose path matches.
tidy() {
    local regex=$1 findings
    shift
    findings=$(run-clang-tidy -quiet -j "$(nproc)" -p "$build" "$@" "$regex" 2>/dev/null) && return 0
    sed -e 's/\x1b\[[0-9;]*m//g' -e '/^clang-tidy/d' <<<"$findings" >&2
    return 1
}

failed=0
tidy "$repo/mrpt_module/src/[^/]*$" || failed=1
tidy "$repo/(mrpt_module/src/mrpt_bridge|apps)/" -checks='-*,readability-function-*' || failed=1
[ $failed -eq 0 ] || die "clang-tidy has findings, see above"

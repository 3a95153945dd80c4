#!/usr/bin/env bash
# Runs clang-tidy (size limits of functions, likely bugs; see .clang-tidy) over the library's core.
# usage: scripts/check_tidy.sh [BUILD_DIR [REGEX]]   BUILD_DIR is configured; REGEX selects other files
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"

build=${1:-$repo/build/dev}
files=${2:-/mrpt_module/src/[^/]*\\.cpp\$}
log=$build/clang-tidy.log
if ! run-clang-tidy -quiet -j "$(nproc)" -p "$build" "$files" >"$log" 2>&1; then
    grep -v -e '^clang-tidy' -e 'warnings generated' -e 'Suppressed' "$log" >&2 || true
    die "clang-tidy has findings, see above"
fi

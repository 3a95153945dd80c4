#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds what has threads of its own with ThreadSanitizer and runs its tests and those of the tracker: scripts/races.sh [REGEX]
# REGEX chooses among the tests. Exit code 0: no data race, no lock taken in two orders; each that is found is in build/tsan/races.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

install_packages run build test
use_ccache
say "Building with ThreadSanitizer"
cmake --preset tsan >/dev/null
cmake --build --preset tsan --parallel "$(nproc)"
say "Running the tests"
# Kernels that shuffle the memory by more than 28 bits leave it no room; containers may not be allowed to change that.
as_it_lies=(setarch "$(uname -m)" --addr-no-randomize)
"${as_it_lies[@]}" true 2>/dev/null || as_it_lies=()
rm -rf build/tsan/races
mkdir -p build/tsan/races
failed=0
"${as_it_lies[@]}" ctest --preset tsan ${1:+-R "$1"} || failed=1
reports=(build/tsan/races/report.*)
if [ -e "${reports[0]}" ]; then
    cat "${reports[@]}" >&2
    die "${#reports[@]} programs with a race, see build/tsan/races"
fi
[ $failed -eq 0 ] || say "No race. Tests that failed want a program that keeps up with a sensor, which it does not ten times slower"

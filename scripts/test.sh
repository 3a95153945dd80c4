#!/usr/bin/env bash
# From nothing to tested: installs the packages, builds, runs all tests, and once more under the sanitizers.
# usage: scripts/test.sh [--quick]   --quick leaves the sanitizers out
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

sanitize=1
case "${1-}" in
    "") ;;
    --quick) sanitize=0 ;;
    *) die "unknown argument '$1'; usage: scripts/test.sh [--quick]" ;;
esac

install_packages run build evaluation test
use_ccache

# build_and_test PRESET: configures, builds and runs the tests of a preset of CMakePresets.json.
build_and_test() {
    say "Building and testing: $1"
    cmake --preset "$1"
    cmake --build --preset "$1" --parallel "$(nproc)"
    ctest --preset "$1"
}

say "Checking the format"
scripts/check_format.sh
build_and_test dev
say "Checking with clang-tidy (some minutes)"
scripts/check_tidy.sh
[ $sanitize -eq 0 ] || build_and_test sanitize

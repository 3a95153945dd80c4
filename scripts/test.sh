#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# From nothing to tested: installs the packages, builds once, runs every test.
# usage: scripts/test.sh [--full]   --full adds the reference of the headers, whether pictures and tables of the documents
# are those of this code, clang-tidy, and the tests again under the sanitizers
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

full=0
case "${1-}" in
    "") ;;
    --full) full=1 ;;
    *) die "unknown argument '$1'; usage: scripts/test.sh [--full]" ;;
esac

install_packages run build evaluation test
[ $full -eq 0 ] || install_packages clang
# A Node.js from elsewhere brings its npm along and keeps Debian's out.
command -v npm >/dev/null || install_packages node
install_node_packages
use_ccache

# build_and_test PRESET: configures, builds and runs the tests of a preset of CMakePresets.json. Most files are
# joined into large ones, and a program's tests are run at once: for one time, that takes less of it. LLVM's
# linker reads none of the 170 libraries behind MRPT's.
build_and_test() {
    local linker=""
    ! command -v ld.lld >/dev/null || linker=-fuse-ld=lld
    say "Building and testing: $1"
    LDFLAGS="${LDFLAGS-} $linker" cmake --preset "$1" -DCMAKE_UNITY_BUILD=ON -DLIDAR_OBSTACLES_TEST_PROGRAMS=ON
    cmake --build --preset "$1" --parallel "$(nproc)"
    ctest --preset "$1"
}

say "Checking the format and the documents"
scripts/check_format.sh
scripts/check_docs.sh
build_and_test dev
[ $full -eq 1 ] || exit 0
say "Checking the docstrings"
scripts/reference.sh
say "Checking whether pictures and tables are those of this code"
scripts/pictures.sh --check build/dev
if [ -d "${LIDAR_OBSTACLES_DATA-}" ] && [ -f "${LIDAR_OBSTACLES_EVAL_TRACKS-}" ]; then
    scripts/accuracy.sh --check build/dev
fi
say "Checking with clang-tidy (some minutes)"
scripts/check_tidy.sh
build_and_test sanitize

#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Whether the code runs on 64 bit ARM as it does here: two builds on this machine and one for aarch64, whose tests run
# under QEMU. Needs root rights and a Debian mirror.
# usage: scripts/test_aarch64.sh [OPTION_OF_TEST_ON_SH...]      (--keep, --folder DIR, --ccache DIR, --mirror URL)
# 1. On this machine, `char` unsigned as on ARM and no vector instructions: the same boxes within a millimetre.
# 2. In a chroot with Debian's cross compiler and the libraries for arm64: core, mrpt_bridge and obstacle-replay, the
#    tests of core, and the boxes of this machine within a millimetre.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

sample=datasets/street_tracks.rawlog
reference=aarch64-reference # in the copy of the repository, too: not in build/, which is not copied
# The tests that need core alone: of tests/CMakeLists.txt those that link no other library of ours.
mapfile -t tests < <(sed -nE 's/^lidar_obstacles_test[(]([a-z_]+) lidar_obstacles_synthetic_scene FILES$/\1/p' tests/CMakeLists.txt)
[ ${#tests[@]} -gt 0 ] || die "tests/CMakeLists.txt: no test was found that links core alone"

# boxes BUILD [COMMAND...]: obstacles.csv of the sample with the obstacle-replay of a build.
boxes() {
    local build=$1
    shift
    "$@" "$build/apps/obstacle-replay/obstacle-replay" "$sample" --output "$build/boxes" >"$build/boxes.log" ||
        { cat "$build/boxes.log" && die "$build: obstacle-replay failed"; }
}

# compare A B: each row of two obstacles.csv has a counterpart in the other, of the same scan and class and within a
# millimetre and a tenth of a degree.
compare() {
    awk -F, '
        function turned(d) { # a heading holds modulo 180 degrees
            d -= 3.14159265 * int(d / 3.14159265 + (d < 0 ? -0.5 : 0.5)); return d < -0.00175 || d > 0.00175 }
        function alike(text, i, f, d) {
            split(text, f, ",")
            for (i = 5; i <= 10; ++i) { d = f[i] - $i; if (d < -0.00101 || d > 0.00101) return 0 }
            return !turned(f[11] - $11) }
        FNR == 1 { next }
        NR == FNR { row[$2, $4, ++count[$2, $4]] = $0; ++first; next }
        { ++second; found = 0
          for (k = 1; k <= count[$2, $4] && !found; ++k)
              if (row[$2, $4, k] != "" && alike(row[$2, $4, k])) { row[$2, $4, k] = ""; found = 1 }
          same += found
          if (!found) printf "  only in the second: scan %s, %s at %s, %s m\n", $2, $4, $5, $6 }
        END { rows = first > second ? first : second
              printf "%d of %d boxes are the same\n", same, rows
              exit !(rows > 0 && same == rows) }' "$1" "$2"
}

# build NAME [OPTION_OF_CMAKE...]: obstacle-replay alone.
build() {
    local name=$1
    shift
    cmake --preset release -B "build/$name" -DLIDAR_OBSTACLES_BUILD_BENCHMARKS=OFF -DLIDAR_OBSTACLES_BUILD_EXAMPLES=OFF \
        "$@" >/dev/null
    cmake --build "build/$name" --parallel "$(nproc)" --target obstacle-replay
}

# In the chroot.
test_in_chroot() {
    local packages=(g++-aarch64-linux-gnu qemu-user cmake ninja-build pkg-config ccache libcli11-dev nlohmann-json3-dev
        libeigen3-dev) package build=build/aarch64
    # libmrpt-common-dev of the PC would do for apt, but its config.h tells of other alignments than the libraries have
    for package in libmrpt-{common,maps,obs,opengl}-dev libyaml-cpp-dev libboost-dev liboctomap-dev libopencv-dev libpcap-dev \
        zlib1g-dev libgtest-dev libgmock-dev libtinyxml2-dev; do packages+=("$package:arm64"); done
    export DEBIAN_FRONTEND=noninteractive
    dpkg --add-architecture arm64
    apt-get update -q
    apt-get install -q -y --no-install-recommends "${packages[@]}"
    use_ccache
    say "Building for aarch64"
    cmake --preset release -B "$build" --toolchain cmake/aarch64-linux-gnu.cmake -DLIDAR_OBSTACLES_BUILD_EXAMPLES=OFF \
        -DLIDAR_OBSTACLES_BUILD_BENCHMARKS=OFF
    cmake --build "$build" --parallel "$(nproc)" --target obstacle-replay "${tests[@]}"
    say "Testing under QEMU"
    # What takes how long is no question for an emulator.
    printf '%s\n' "${tests[@]}" | xargs -P "$(nproc)" -I{} \
        qemu-aarch64 "$build/tests/{}" --gtest_brief=1 --gtest_filter=-*LessThanAMillisecond
    say "Comparing the boxes with those of the other machine"
    boxes "$build" qemu-aarch64
    compare "$reference/obstacles.csv" "$build/boxes/obstacles.csv"
}

if [ "${1-}" = --in-chroot ]; then
    test_in_chroot
    exit
fi

[ "$(id -u)" -eq 0 ] || die "making a chroot needs root rights"
install_packages run build test
use_ccache
say "Building as usual, and without vector instructions, char unsigned"
build portable-usual
build portable-plain -DCMAKE_CXX_FLAGS="-funsigned-char -DEIGEN_DONT_VECTORIZE -fno-tree-vectorize -fno-tree-slp-vectorize"
for name in usual plain; do boxes "build/portable-$name"; done
compare build/portable-usual/boxes/obstacles.csv build/portable-plain/boxes/obstacles.csv
trap 'rm -rf "${repo:?}/$reference"' EXIT
mkdir -p "$reference"
cp build/portable-usual/boxes/obstacles.csv "$reference/"
scripts/test_on.sh bookworm "$@" --run 'scripts/test_aarch64.sh --in-chroot'

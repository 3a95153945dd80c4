#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Installs packages in an empty chroot of Debian, uses them there as a reader of the README does, and removes them.
# usage: packaging/check_debs.sh DIR [--release bookworm|trixie] [--mirror URL]
# Fails where a package cannot be installed, the tools do not find the obstacles of a real scan, a project does not build
# against the libraries, or something is left after `apt-get purge`. Needs root rights and a Debian mirror.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/../scripts/lib.sh"

# In the chroot, in a folder with the packages and the consumer project.
use_packages() {
    export DEBIAN_FRONTEND=noninteractive
    local ours=(liblidar-obstacles0 liblidar-obstacles-dev lidar-obstacles-tools lidar-obstacles-doc)
    apt-get update -q
    say "Installing the tools alone"
    apt-get install -q -y --no-install-recommends ./debs/lidar-obstacles-tools_*.deb ./debs/liblidar-obstacles0_*.deb \
        mrpt-common libegl-mesa0 libgl1-mesa-dri
    obstacle-replay /usr/share/mrpt/datasets/test_velodyne_VLP16.rawlog --output out --pictures all --grids all --scenes all
    [ "$(wc -l <out/obstacles.csv)" -gt 20 ] || die "hardly any obstacles in the sample scan"
    ls out/picture_000000.png out/grid_000000.png out/scene_000000.3Dscene out/summary.json
    obstacle-replay /usr/share/lidar_obstacles/street_sample.rawlog --config /usr/share/lidar_obstacles/config.ini --output street
    obstacle-simulate /usr/share/lidar_obstacles/scenarios/street.yaml --to 1 --output simulated
    obstacle-check /usr/share/lidar_obstacles/street_tracks.rawlog
    local tool
    for tool in /usr/bin/obstacle-*; do
        "$tool" --help >/dev/null || die "$tool --help fails"
        [ -s "/usr/share/man/man1/${tool##*/}.1.gz" ] || die "$tool has no man page"
    done

    say "Building a project against the library"
    apt-get install -q -y --no-install-recommends ./debs/liblidar-obstacles-dev_*.deb ./debs/lidar-obstacles-doc_*.deb \
        g++ cmake make pkg-config libgmock-dev
    cmake -S install -B consumer -DCMAKE_BUILD_TYPE=Debug
    cmake --build consumer --parallel "$(nproc)"
    for program in core_user evaluation_user mrpt_user live_user; do consumer/$program; done
    # shellcheck disable=SC2046
    g++ -std=c++17 install/core_user.cpp $(pkg-config --cflags --libs lidar_obstacles) -o with_pkg_config
    ./with_pkg_config
    local examples=/usr/share/doc/lidar-obstacles-doc/examples
    cmake -S $examples/rawlog_test -B rawlog
    cmake --build rawlog
    ctest --test-dir rawlog --output-on-failure --no-tests=error
    cmake -S $examples/minimal -B minimal
    cmake --build minimal
    minimal/minimal /usr/share/lidar_obstacles/street_sample.rawlog >boxes.txt
    grep -q 'vehicle at' boxes.txt || die "examples/minimal finds no vehicle"

    say "Removing the packages"
    apt-get purge -q -y "${ours[@]}"
    local left
    left=$(find / -xdev \( -path "$PWD" -o -path /proc -o -path /sys \) -prune -o -iname '*lidar*obstacles*' -print)
    [ -z "$left" ] || die "left behind: $left"
    [ -z "$(find /usr/bin -name 'obstacle-*')" ] || die "tools were left behind"
    say "All is well: installed, used, built against, removed"
}

if [ "${1-}" = --in-chroot ]; then
    cd /root/check && use_packages
    exit
fi

[ -d "${1-}" ] || die "usage: packaging/check_debs.sh DIR [--release NAME] [--mirror URL]"
debs=$(cd "$1" && pwd)
shift
release=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release) mirror=http://deb.debian.org/debian
while [ $# -gt 0 ]; do
    [ $# -ge 2 ] || die "$1 wants a value"
    case $1 in
        --release) release=$2 ;;
        --mirror) mirror=$2 ;;
        *) die "unknown argument '$1'; see the head of $0" ;;
    esac
    shift 2
done
[ "$(id -u)" -eq 0 ] || die "making a chroot needs root rights"
install_packages chroot

root=$(mktemp -d /var/tmp/lidar_obstacles_debs_XXXX)
trap 'rm -rf --one-file-system "$root" "$root.log"' EXIT
say "Making an empty chroot of Debian $release in $root"
unshare --mount debootstrap --variant=minbase "$release" "$root" "$mirror" >"$root.log" || die "debootstrap failed: $(tail -n 3 "$root.log")"
cp /etc/resolv.conf /etc/hosts "$root/etc/"
echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io" # a chroot need not survive a power cut
mkdir -p "$root"/root/check/{debs,packaging,scripts}
cp "$debs"/*.deb "$root/root/check/debs/"
cp -r "$repo/tests/install" "$root/root/check/"
cp "$repo/packaging/check_debs.sh" "$root/root/check/packaging/"
cp "$repo/scripts/lib.sh" "$root/root/check/scripts/"
# shellcheck disable=SC2016
unshare --mount --pid --fork --kill-child bash -euc '
    mount -t proc proc "$1/proc"
    mount --rbind /dev "$1/dev"
    exec chroot "$1" /usr/bin/env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin \
        bash /root/check/packaging/check_debs.sh --in-chroot' bash "$root"

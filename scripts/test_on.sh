#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds, tests and runs the demo on a Debian release with nothing installed: in a chroot that debootstrap makes, which
# is removed at the end. Needs root rights and a Debian mirror.
# usage: scripts/test_on.sh RELEASE [OPTION...] [-- OPTION_OF_TEST_SH...]
#   RELEASE        bookworm (Debian 12), trixie (Debian 13) or sid, which may fail: what it has is not known before
#   --folder DIR   where the chroot is made (a new folder in /var/tmp); one that --keep left there is used again
#   --keep         leaves the chroot with what was built in it, and prints where
#   --run COMMAND  instead of scripts/test.sh and scripts/demo.sh, in the copy of the repository; `bash` is a shell there
#   --ccache DIR   the compiler's cache, for a later run
#   --mirror URL   http://deb.debian.org/debian
# What LIDAR_OBSTACLES_DATA, LIDAR_OBSTACLES_EVAL_BOXES and LIDAR_OBSTACLES_EVAL_TRACKS name (the labelled data and
# the independent evaluations) is there as well.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"

inside=/root/lidar_obstacles # where the copy of the repository lies in the chroot

# run_inside COMMAND...: mounts what a system needs and runs the command there. The caller gives it a namespace of its
# own: mounts and processes end with it, so that removing the chroot meets neither.
run_inside() {
    local name
    mount -t proc proc "$root/proc"
    mount -t sysfs -o ro sysfs "$root/sys"
    mount --rbind /dev "$root/dev"
    for name in ccache data boxes tracks; do
        [ -z "${!name}" ] || mount --bind "${!name}" "$root/srv/$name"
    done
    chroot "$root" /usr/bin/env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin TERM="${TERM:-dumb}" \
        ${ccache:+CCACHE_DIR=/srv/ccache} ${data:+LIDAR_OBSTACLES_DATA=/srv/data} \
        ${boxes:+LIDAR_OBSTACLES_EVAL_BOXES=/srv/boxes/"$(basename "$LIDAR_OBSTACLES_EVAL_BOXES")"} \
        ${tracks:+LIDAR_OBSTACLES_EVAL_TRACKS=/srv/tracks/"$(basename "$LIDAR_OBSTACLES_EVAL_TRACKS")"} "$@"
}

# Files as they lie in the working tree, without what was built there. What was built in the chroot stays; files that
# changed since the last copy are new to it, for they may have changed before it was built. All others keep their time:
# they need no second compilation, and ccache finds nothing again once the time of a precompiled header differs.
copy_repository() {
    local copy=$root$inside.copy file
    rm -rf "$copy"
    mkdir "$copy"
    tar -C "$repo" --exclude=./build --exclude=./output --exclude=./.git -c . | tar -C "$copy" --no-same-owner -x
    if [ -e "$root$inside" ]; then
        find "$copy" -type f -printf '%P\0' | while IFS= read -r -d '' file; do
            if cmp -s "$copy/$file" "$root$inside/$file"; then
                touch -r "$root$inside/$file" "$copy/$file"
            else
                touch "$copy/$file"
            fi
        done
        [ ! -e "$root$inside/build" ] || mv "$root$inside/build" "$copy/build"
        rm -rf "${root:?}$inside"
    fi
    mv "$copy" "$root$inside"
}

make_chroot() {
    if [ ! -e "$root$inside" ]; then
        say "Making a chroot of Debian $release in $root"
        unshare --mount debootstrap --variant=minbase "$release" "$root" "$mirror" >"$root.log" ||
            die "debootstrap failed: $(tail -n 3 "$root.log")"
        rm "$root.log"
    fi
    cp /etc/resolv.conf /etc/hosts "$root/etc/"
    echo force-unsafe-io >"$root/etc/dpkg/dpkg.cfg.d/unsafe-io" # a chroot need not survive a power cut
    mkdir -p "$root"/srv/{ccache,data,boxes,tracks}
    copy_repository
}

remove_chroot() {
    if [ $keep -eq 1 ]; then
        say "Left as it is: $root"
    else
        rm -rf --one-file-system "$root" "$root.log"
    fi
}

# absolute DIR: its full path; the folder is made.
absolute() { mkdir -p "$1" && (cd "$1" && pwd); }

if [ "${1-}" = --in-namespace ]; then
    shift
    run_inside "$@"
    exit
fi

release=${1-}
[[ $release =~ ^(bookworm|trixie|sid)$ ]] || die "no release '$release'; usage: scripts/test_on.sh bookworm|trixie|sid [OPTION...]"
shift
root='' keep=0 command='' ccache='' mirror=http://deb.debian.org/debian
data=${LIDAR_OBSTACLES_DATA:+$(realpath "$LIDAR_OBSTACLES_DATA")}
boxes=${LIDAR_OBSTACLES_EVAL_BOXES:+$(dirname "$(realpath "$LIDAR_OBSTACLES_EVAL_BOXES")")}
tracks=${LIDAR_OBSTACLES_EVAL_TRACKS:+$(dirname "$(realpath "$LIDAR_OBSTACLES_EVAL_TRACKS")")}
while [ $# -gt 0 ] && [ "$1" != -- ]; do
    case $1 in
        --keep) keep=1 && shift && continue ;;
        --folder | --run | --ccache | --mirror) [ $# -ge 2 ] || die "$1 wants a value" ;;
        *) die "unknown argument '$1'; see the head of $0" ;;
    esac
    case $1 in
        --folder) root=$(absolute "$2") ;;
        --run) command=$2 ;;
        --ccache) ccache=$(absolute "$2") ;;
        --mirror) mirror=$2 ;;
    esac
    shift 2
done
[ $# -eq 0 ] || shift

[ "$(id -u)" -eq 0 ] || die "making a chroot needs root rights"
install_packages chroot
[ -n "$root" ] || root=$(mktemp -d /var/tmp/lidar_obstacles_"$release"_XXXX)
[ -e "$root$inside" ] || [ -z "$(ls -A "$root")" ] || die "--folder $root: not empty, and no chroot of this script"
trap remove_chroot EXIT
make_chroot
export root ccache data boxes tracks
say "Running in Debian $release, $root"
# shellcheck disable=SC2016
unshare --mount --pid --fork --kill-child "$0" --in-namespace \
    bash -euc 'cd "$1"; shift; if [ -n "$1" ]; then eval "$1"; else shift; scripts/test.sh "$@"; scripts/demo.sh; fi' \
    bash "$inside" "$command" "$@" <&0 &
# unshare itself pays no heed to INT and TERM; killed, it takes all that runs in the namespace with it.
trap 'kill -KILL %1; wait; exit 130' INT TERM
wait %1

#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Builds the Debian packages of this machine's release, and checks them with lintian.
# usage: packaging/build_debs.sh [--output DIR] [--install-check]
#   --output DIR      where the packages go (output/debs)
#   --install-check   installs them in an empty chroot and uses them there, see packaging/check_debs.sh; needs root rights
# DEBFULLNAME and DEBEMAIL name who the packages are from, as Debian's own tools have it.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/../scripts/lib.sh"
cd "$repo"

output=output/debs check=0
while [ $# -gt 0 ]; do
    case $1 in
        --output) [ $# -ge 2 ] || die "--output wants a folder" && output=$2 && shift 2 ;;
        --install-check) check=1 && shift ;;
        *) die "unknown argument '$1'; see the head of $0" ;;
    esac
done
build=build/packages
maintainer="${DEBFULLNAME:-lidar_obstacles maintainers} <${DEBEMAIL:-maintainers@example.org}>"
# The day of the release, for the packages' changelogs and for what is built into them.
day=$(sed -nE '0,/^## [0-9.]+ \(/s/^## [0-9.]+ \((.*)\)/\1/p' CHANGELOG.md)
[ -n "$day" ] || die "CHANGELOG.md names no release with its day: ## X.Y.Z (YYYY-MM-DD)"
SOURCE_DATE_EPOCH=$(date -u -d "$day" +%s)
export SOURCE_DATE_EPOCH

install_packages run build package
use_ccache
# As Debian hardens its own packages, and with all symbols bound at the start: then the tables of them are read only.
export DEB_BUILD_MAINT_OPTIONS=hardening=+bindnow DEB_CXXFLAGS_STRIP=-g
flags="$(dpkg-buildflags --get CXXFLAGS) $(dpkg-buildflags --get CPPFLAGS)"
links=$(dpkg-buildflags --get LDFLAGS)
say "Building in $build"
cmake --preset release -B "$build" -DBUILD_SHARED_LIBS=ON -DLIDAR_OBSTACLES_PACKAGES=ON -DCMAKE_INSTALL_PREFIX=/usr \
    -DLIDAR_OBSTACLES_BUILD_TESTS=OFF -DLIDAR_OBSTACLES_BUILD_BENCHMARKS=OFF -DLIDAR_OBSTACLES_BUILD_EXAMPLES=OFF \
    -DCMAKE_CXX_FLAGS="$flags" -DCMAKE_SHARED_LINKER_FLAGS="$links" -DCMAKE_EXE_LINKER_FLAGS="$links" \
    -DLIDAR_OBSTACLES_MAINTAINER="$maintainer" -Drelease_date="$(date -u -d "$day" -R)"
cmake --build "$build" --parallel "$(nproc)"

say "Checking the hardening"
# Told by the flags alone: a library without arrays on its stacks has nothing to guard.
[[ $flags == *-fstack-protector-strong* ]] || die "dpkg-buildflags does not guard the stack: $flags"
while IFS= read -r -d '' program; do
    head -c 4 "$program" | grep -q ELF || continue
    readelf -dW "$program" | grep -q BIND_NOW || die "$program: symbols are not bound at the start"
    readelf -hW "$program" | grep -q 'Type: *DYN' || die "$program: lies at a fixed address"
done < <(find "$build/mrpt_module" "$build/apps" -type f \( -name 'lib*.so.*' -o -perm -u+x \) -print0)

say "Packing into $output"
mkdir -p "$output"
output=$(realpath "$output")
rm -f "$output"/*.deb
(umask 022 && cd "$build" && cpack -B "$output")
rm -rf "$output/_CPack_Packages"
ls -l "$output"/*.deb

say "Checking with lintian"
lintian --fail-on error --tag-display-limit 0 --allow-root "$output"/*.deb
[ $check -eq 0 ] || packaging/check_debs.sh "$output"

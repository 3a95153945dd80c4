# SPDX-License-Identifier: BSD-3-Clause
# Sourced by demo.sh and test.sh: what it takes to build on a Debian machine with nothing installed.
# shellcheck shell=bash

repo=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

say() { printf '\n== %s\n' "$*"; }
die() {
    printf 'error: %s\n' "$*" >&2
    exit 1
}

# packages_of SECTION...: names listed in these sections of packages.txt.
packages_of() {
    awk -v wanted=" $* " '
        { sub(/#.*/, "") }
        /^\[/ { gsub(/[][ ]/, ""); active = index(wanted, " " $0 " "); next }
        active && NF { print $1 }' "$repo/scripts/packages.txt"
}

is_installed() { [[ $(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null) == installed* ]]; }

has_candidate() { [[ $(apt-cache policy "$1") =~ Candidate:\ [^\(] ]]; }

# as_root COMMAND...: as it is for root, else through sudo.

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    elif command -v sudo >/dev/null; then
        sudo "$@"
    else
        die "installing packages needs root rights: run this as root, or install sudo"
    fi
}

# install_packages SECTION...: installs what is not there yet; needs neither root, apt lists nor network when all is.
install_packages() {
    local package missing=() unknown=() update="" release
    command -v apt-get >/dev/null ||
        die "no apt here: this script sets up Debian 12 and 13; scripts/packages.txt lists what to install elsewhere"
    for package in $(packages_of "$@"); do
        is_installed "$package" || missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0

    say "Installing packages: ${missing[*]}"
    as_root apt-get update -q || update="; apt-get update failed"
    for package in "${missing[@]}"; do
        has_candidate "$package" || unknown+=("$package")
    done
    release=$(sed -n 's/^PRETTY_NAME="\(.*\)"/\1/p' /etc/os-release)
    [ ${#unknown[@]} -eq 0 ] || die "$release offers no package ${unknown[*]} (Debian 12 and 13, bookworm and trixie, do)$update"
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}" ||
        die "apt-get install failed$update"
}

# Sends compiler calls through ccache where it is installed; CMake takes the first variable when it configures.
# The others let precompiled headers and a clone elsewhere hit the cache.
use_ccache() {
    command -v ccache >/dev/null || return 0
    export CMAKE_CXX_COMPILER_LAUNCHER=ccache
    export CCACHE_BASEDIR=$repo CCACHE_NOHASHDIR=1 CCACHE_SLOPPINESS=pch_defines,time_macros
    export CCACHE_DEPEND=1 # what a file includes is what the compiler says, not a run of the preprocessor before it
}

# Every C++ file of ours, zero-terminated.
our_sources() {
    find "$repo"/mrpt_module "$repo"/apps "$repo"/examples "$repo"/tests \( -name '*.h' -o -name '*.cpp' \) -print0 | sort -z
}

# install_node_packages: what tests/node lists, into build/node. Tests that need them are skipped where this fails.
install_node_packages() {
    local folder=$repo/build/node
    cmp -s "$repo/tests/node/package.json" "$folder/package.json" && [ -d "$folder/node_modules" ] && return 0
    command -v npm >/dev/null || { say "No npm here: the tests that need Node.js packages are skipped"; return 0; }
    say "Installing Node.js packages into build/node"
    mkdir -p "$folder"
    cp "$repo/tests/node/package.json" "$folder/"
    npm install --prefix "$folder" --no-audit --no-fund --silent ||
        { rm -f "$folder/package.json"; say "npm failed: the tests that need Node.js packages are skipped"; }
}

#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Puts the licence's SPDX line at the head of every source, script, CMake file and part of a page that has none.
# usage: scripts/spdx.sh [--check]      --check changes nothing, and fails naming the files without one
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

tag="SPDX-License-Identifier: BSD-3-Clause"

files() {
    our_sources
    find scripts packaging .ci cmake -type f \( -name '*.sh' -o -name '*.py' -o -name '*.cmake' -o -path .ci/run \) -print0
    find CMakeLists.txt mrpt_module apps examples tests packaging -name CMakeLists.txt -print0
    find tests -name '*.cmake' -print0
    find apps/exports/page examples tests/node -type f -regex '.*[.]\(js\|mjs\|css\|html\|py\)' -print0
}

missing=()
while IFS= read -r -d '' file; do
    head -n 2 "$file" | grep -qF "$tag" || missing+=("$file")
done < <(files)
if [ "${1-}" = --check ]; then
    [ ${#missing[@]} -eq 0 ] || die "without '$tag', run scripts/spdx.sh: ${missing[*]}"
    exit 0
fi
for file in "${missing[@]}"; do
    case $file in
        *.h | *.cpp | *.js | *.mjs) sed -i "1i // $tag" "$file" ;;
        *.css) sed -i "1i /* $tag */" "$file" ;;
        *.html) sed -i "1a <!-- $tag -->" "$file" ;; # the type of the document comes first
        *) if head -c 2 "$file" | grep -q '^#!'; then sed -i "1a # $tag" "$file"; else sed -i "1i # $tag" "$file"; fi ;;
    esac
done
say "${#missing[@]} files have it now"

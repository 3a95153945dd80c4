#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs the fuzzing targets one after the other: scripts/fuzz.sh [--keep] [SECONDS_EACH [TARGET...]]
# They begin with the files of fuzz_seeds, of tests/fuzz/corpus and of earlier runs (build/fuzz/corpus). What they find
# is kept in build/fuzz/findings; 0 findings: exit code 0.
#   --keep   afterwards writes the smallest files that reach the same code, 64 kB at most of each target, to
#            tests/fuzz/corpus
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

keep=0
[ "${1-}" != --keep ] || { keep=1 && shift; }
seconds=${1:-600}
targets=("${@:2}")
[ ${#targets[@]} -gt 0 ] || targets=(capture rawlog packets config model zones requests scenario detector tracker)
build=build/fuzz kept=tests/fuzz/corpus
install_packages run build clang
use_ccache
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --parallel "$(nproc)"
mkdir -p "$build/findings" "$build/seeds"
"$build/tests/fuzz/fuzz_seeds" "$build/seeds"
# MRPT asks for as much memory as a damaged length says: it has to be told that there is none.
limits=(-timeout=60 -rss_limit_mb=4096 -malloc_limit_mb=4096)
export ASAN_OPTIONS=allocator_may_return_null=1:max_allocation_size_mb=64:detect_leaks=0:alloc_dealloc_mismatch=0

# keep_corpus TARGET: one archive of the files that are worth their bytes.
keep_corpus() {
    local chosen=$build/chosen/$1 size=0 bytes file list=()
    rm -rf "$chosen" && mkdir -p "$chosen" "$kept"
    "$build/tests/fuzz/fuzz_$1" -merge=1 -max_len=16384 "${limits[@]}" -artifact_prefix="$build/findings/$1-" "$chosen" "$build/corpus/$1" 2>/dev/null
    while read -r bytes file; do
        [ $((size += bytes)) -le 64000 ] || break
        list+=("$file")
    done < <(find "$chosen" -type f -printf '%s %f\n' | sort -n)
    tar -C "$chosen" --sort=name --owner=0 --group=0 --numeric-owner --mtime=@0 -cJf "$kept/$1.tar.xz" "${list[@]}"
}

failed=0
for target in "${targets[@]}"; do
    mkdir -p "$build/corpus/$target"
    [ ! -f "$kept/$target.tar.xz" ] || tar -C "$build/corpus/$target" -xJf "$kept/$target.tar.xz"
    "$build/tests/fuzz/fuzz_$target" -max_total_time="$seconds" "${limits[@]}" -max_len=100000 -print_final_stats=1 \
        -artifact_prefix="$build/findings/$target-" "$build/corpus/$target" "$build/seeds/$target" || failed=1
    [ $keep -eq 0 ] || keep_corpus "$target"
done
[ $failed -eq 0 ] || die "findings in $build/findings"

#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs the fuzzing targets one after the other: scripts/fuzz.sh [SECONDS_EACH [TARGET...]]
# What they learned is kept in build/fuzz/corpus, what they find in build/fuzz/findings; 0 findings: exit code 0.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"

seconds=${1:-600}
targets=("${@:2}")
[ ${#targets[@]} -gt 0 ] || targets=(capture rawlog packets config model zones requests scenario detector tracker)
build=$repo/build/fuzz
(cd "$repo" && cmake --preset fuzz >/dev/null && cmake --build --preset fuzz)
mkdir -p "$build/findings" "$build/seeds"
"$build/tests/fuzz/fuzz_seeds" "$build/seeds"
# MRPT asks for as much memory as a damaged length says: it has to be told that there is none.
export ASAN_OPTIONS=allocator_may_return_null=1:max_allocation_size_mb=64:detect_leaks=0:alloc_dealloc_mismatch=0
failed=0
for target in "${targets[@]}"; do
    mkdir -p "$build/corpus/$target"
    "$build/tests/fuzz/fuzz_$target" -max_total_time="$seconds" -timeout=20 -rss_limit_mb=4096 -malloc_limit_mb=4096 -max_len=100000 -print_final_stats=1 \
        -artifact_prefix="$build/findings/$target-" "$build/corpus/$target" "$build/seeds/$target" || failed=1
done
[ $failed -eq 0 ] || die "findings in $build/findings"

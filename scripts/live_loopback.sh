#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What obstacle-live makes of two minutes of a sensor on loopback: at 754 packets/s (single return) and at 1508 (dual),
# clean and with packets dropped, duplicated, late and garbage between them. Prints a table; fails if a count is wrong,
# memory grows or, without --counts-only, a clean run's p50 or p95 latency is above 10 ms.
# usage: scripts/live_loopback.sh [--seconds N] [--bin DIR] [--counts-only] [RECORDING]
#   --seconds N    of each of the four runs (120)
#   --bin DIR      build folder's apps/ (build/release/apps)
#   RECORDING      rawlog or capture with packets (datasets/street_sample.rawlog)
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"

seconds=120 bin=$repo/build/release/apps input=$repo/datasets/street_sample.rawlog limit_ms=10
while [ $# -gt 0 ]; do
    case $1 in
        --seconds) seconds=$2 && shift ;;
        --bin) bin=$2 && shift ;;
        --counts-only) limit_ms=0 ;;
        -*) die "unknown argument '$1'; see the head of $0" ;;
        *) input=$1 ;;
    esac
    shift
done
live=$bin/obstacle-live/obstacle-live
send=$bin/velodyne-send/velodyne-send
[ -x "$live" ] && [ -x "$send" ] || die "no $live and $send: build them first (cmake --preset release && cmake --build --preset release)"

work=$(mktemp -d)
receiver='' sender=''
cleanup() {
    local process
    for process in $receiver $sender; do kill "$process" 2>/dev/null || true; done
    rm -rf "$work"
}
trap cleanup EXIT

# number FILE KEY: the value of "KEY": in a JSON file; 0 if it is not there.
number() {
    local value
    value=$(grep -o "\"$2\": *[0-9.]*" "$1" | head -n 1 | sed 's/.*: *//')
    echo "${value:-0}"
}

resident_kb() { awk '/^VmRSS/ { print $2 }' "/proc/$receiver/status" 2>/dev/null || true; }

# start_receiver: sets receiver and endpoint.
start_receiver() {
    rm -f "$work"/*
    : >"$work/messages"
    "$live" --listen 127.0.0.1:0 --no-data 30 --report 0 --statistics "$work/statistics.json" \
        >"$work/obstacles.jsonl" 2>"$work/messages" &
    receiver=$!
    for _ in $(seq 300); do
        endpoint=$(sed -n 's/.*listening on \([0-9.:]*\),.*/\1/p' "$work/messages")
        [ -z "$endpoint" ] || return 0
        kill -0 "$receiver" 2>/dev/null || break
        sleep 0.1
    done
    die "obstacle-live did not start: $(cat "$work/messages")"
}

# watch_memory PID: samples the receiver's memory once a second while PID runs; sets rss_first (after a quarter of the
# time, warmed up) and rss_last, the means of five samples each [kB].
watch_memory() {
    local samples=() n
    while kill -0 "$1" 2>/dev/null; do
        samples+=("$(resident_kb)")
        sleep 1
    done
    n=${#samples[@]}
    mean() { printf '%s\n' "$@" | awk '{ s += $1 } END { print int(s / NR) }'; }
    rss_first=$(mean "${samples[@]:n/4:5}")
    rss_last=$(mean "${samples[@]: -5}")
}

failed=0
# expect WHAT GOT WANTED
expect() {
    [ "$2" = "$3" ] && return 0
    printf 'error: %s: %s %s, %s expected\n' "$run" "$2" "$1" "$3" >&2
    failed=1
}

# measure NAME OPTION...: one run.
measure() {
    run=$1 && shift
    local sent s key p50 p95 p99
    start_receiver
    "$send" "$input" --to "$endpoint" --duration "$seconds" "$@" >"$work/sent.json" &
    sender=$!
    watch_memory "$sender"
    wait "$sender"
    sender=
    sleep 1
    kill -INT "$receiver"
    wait "$receiver" || die "$run: obstacle-live failed: $(cat "$work/messages")"
    receiver=

    sent=$work/sent.json s=$work/statistics.json
    expect packets "$(number "$s" packets)" "$(number "$sent" packets)"
    expect "packets lost" "$(number "$s" lost)" "$(number "$sent" dropped)"
    expect "packets late" "$(number "$s" late)" "$(number "$sent" reordered)"
    expect "duplicate packets" "$(number "$s" duplicates)" "$(number "$sent" duplicated)"
    expect "malformed datagrams" "$(number "$s" malformed)" "$(number "$sent" garbage)"
    for key in foreign unclear outages mode_changes restarts overflows scans_undecodable; do
        expect "$key" "$(number "$s" $key)" 0
    done
    expect "lines of results" "$(wc -l <"$work/obstacles.jsonl")" "$(number "$s" detected)"
    # Everything is there after the first quarter; the allocator may still keep a little more.
    [ $((rss_last - rss_first)) -le 2048 ] || expect "kB more memory at the end" $((rss_last - rss_first)) "2048 at most"
    p50=$(number "$s" p50) p95=$(number "$s" p95) p99=$(number "$s" p99)
    if [ $limit_ms -gt 0 ] && [ $# -le 1 ] && ! awk -v a="$p50" -v b="$p95" -v m=$limit_ms 'BEGIN { exit a > m || b > m }'; then
        expect "ms latency (p50 / p95)" "$p50 / $p95" "$limit_ms at most"
    fi
    printf '| %s | %s | %s | %s | %s | %s | %s | %s | %.2f / %.2f / %.2f | %.1f -> %.1f |\n' "$run" \
        "$(number "$s" packets)" "$(number "$s" lost)" "$(number "$s" late)" "$(number "$s" duplicates)" \
        "$(number "$s" malformed)" "$(number "$s" detected)" "$(number "$s" scans_dropped)" "$p50" "$p95" "$p99" \
        "$(awk "BEGIN { print $rss_first / 1024 }")" "$(awk "BEGIN { print $rss_last / 1024 }")"
}

faults="--drop 0.05 --duplicate 0.05 --reorder 0.05 --garbage 0.05"
echo "$(basename "$input"), $seconds s each; load of the machine $(cut -d' ' -f1-3 /proc/loadavg), $(nproc) cores"
echo
echo "| stream | packets | lost | late | duplicate | malformed | scans | dropped | latency p50 / p95 / p99 [ms] | RSS [MiB] |"
echo "|---|---|---|---|---|---|---|---|---|---|"
measure "754/s"
measure "1508/s" --dual
# shellcheck disable=SC2086
measure "754/s, faults" $faults
# shellcheck disable=SC2086
measure "1508/s, faults" --dual $faults
echo
echo "load of the machine at the end $(cut -d' ' -f1-3 /proc/loadavg)"
exit $failed

#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# obstacle-fleet under a real Slurm: munge, slurmctld and two slurmd on this machine, 200 generated recordings, tasks that
# are killed and requeued, a node that is drained in the middle. Passes if what is merged then has the same bytes as that of
# a single process, and no recording was done twice.
# usage: scripts/test_fleet_slurm.sh [--folder DIR] [--recordings N]
#   --folder DIR     for recordings (kept), results and logs (output/fleet_slurm)
#   --recordings N   how many (200)
# As root; installs slurmctld, slurmd, slurm-client and munge. Uses keys, ports and folders of its own, and ends what it
# started. The excerpt of the logs is DIR/excerpt.log.
set -euo pipefail
# shellcheck source=scripts/lib.sh
. "$(dirname "$0")/lib.sh"
cd "$repo"

folder=output/fleet_slurm count=200
while [ $# -gt 0 ]; do
    [ $# -ge 2 ] || die "$1 wants a value"
    case $1 in
        --folder) folder=$2 ;;
        --recordings) count=$2 ;;
        *) die "unknown argument '$1'; see the head of $0" ;;
    esac
    shift 2
done
[ "$(id -u)" -eq 0 ] || die "munge, slurmctld and slurmd are started as root"
install_packages build slurm
folder=$(realpath -m "$folder")
bin=$repo/build/release/apps
use_ccache
cmake --preset release >/dev/null
cmake --build --preset release --parallel "$(nproc)" --target obstacle-fleet obstacle-simulate >/dev/null
fleet=$bin/obstacle-fleet/obstacle-fleet

say "Generating recordings in $folder/recordings"
mkdir -p "$folder/recordings"
kinds=(street car-park sidewalk forest-road track park open-road)
for ((k = 0; k < count; ++k)); do
    name=$folder/recordings/$(printf '%03d' $k)_${kinds[k % 7]}
    [ -f "$name.rawlog" ] && continue
    "$bin/obstacle-simulate/obstacle-simulate" --random "${kinds[k % 7]}" --seed $((k + 1)) --to 1.05 \
        --output "$folder/new" >/dev/null 2>&1
    mv "$folder/new.rawlog" "$name.rawlog"
done
rm -f "$folder"/new*
head -c 150000 "$folder/recordings/000_street.rawlog" >"$folder/recordings/cut_off.rawlog"
echo "no capture" >"$folder/recordings/junk.pcap"

say "One process"
rm -rf "$folder"/{single,slurm,cluster}
(cd "$folder" && "$fleet" manifest recordings --output manifest.jsonl)
"$fleet" run "$folder/manifest.jsonl" --output "$folder/single" >"$folder/single.log" 2>&1 || [ $? -eq 1 ]
"$fleet" merge "$folder/manifest.jsonl" --output "$folder/single" || [ $? -eq 1 ]

say "Starting munge, slurmctld and two slurmd"
cluster=$folder/cluster
mkdir -p "$cluster"/{state,spool1,spool2}
dd if=/dev/urandom of="$cluster/munge.key" bs=128 count=1 status=none
chmod 400 "$cluster/munge.key"
cat >"$cluster/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=$(hostname -s)(127.0.0.1)
SlurmctldPort=16817
AuthType=auth/munge
CryptoType=crypto/munge
AuthInfo=socket=$cluster/munge.socket,cred_expire=5
SlurmUser=root
SlurmdUser=root
StateSaveLocation=$cluster/state
SlurmdSpoolDir=$cluster/spool_%n
SlurmctldPidFile=$cluster/slurmctld.pid
SlurmdPidFile=$cluster/slurmd_%n.pid
SlurmctldLogFile=$cluster/slurmctld.log
SlurmdLogFile=$cluster/slurmd_%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_min_interval=500000,batch_sched_delay=0
SchedulerTimeSlice=5
ReturnToService=2
KillWait=2
NodeName=node1 NodeHostname=$(hostname -s) NodeAddr=127.0.0.1 Port=16818 CPUs=1 State=UNKNOWN
NodeName=node2 NodeHostname=$(hostname -s) NodeAddr=127.0.0.1 Port=16819 CPUs=1 State=UNKNOWN
PartitionName=night Nodes=node1,node2 Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$cluster/slurm.conf
pids=()
stop() {
    scancel --user=root 2>/dev/null || true
    for ((k = 0; k < 20; ++k)); do
        [ -n "$(squeue -h 2>/dev/null)" ] || break
        sleep 0.5
    done
    [ ${#pids[@]} -eq 0 ] || kill "${pids[@]}" 2>/dev/null || true
    wait || true
}
trap stop EXIT
munged --foreground --force --key-file="$cluster/munge.key" --socket="$cluster/munge.socket" \
    --pid-file="$cluster/munge.pid" --log-file="$cluster/munge.log" --seed-file="$cluster/munge.seed" >/dev/null 2>&1 &
pids+=($!)
sleep 1
slurmctld -D -i >/dev/null 2>&1 &
pids+=($!)
for node in node1 node2; do
    slurmd -D -N $node >/dev/null 2>&1 &
    pids+=($!)
done
for ((k = 0; k < 60; ++k)); do
    [ "$(sinfo -h -N -t idle -o %N 2>/dev/null | wc -l)" -eq 2 ] && break
    sleep 1
done
sinfo -N -o "%N %T %c" | tee "$cluster/sinfo.log"
[ "$(sinfo -h -N -t idle -o %N | wc -l)" -eq 2 ] || die "the nodes do not come up: see $cluster"

say "Eight tasks on two nodes"
OBSTACLE_FLEET=$fleet scripts/fleet_slurm.sh "$folder/manifest.jsonl" "$folder/slurm" 8 >"$folder/jobs"
read -r job merging <"$folder/jobs"
events=$cluster/events.log
event() { printf '[%s] test: %s\n' "$(date +%Y-%m-%dT%H:%M:%S.%3N)" "$*" | tee -a "$events"; }
results() { { find "$folder/slurm/results" -name result.json 2>/dev/null || true; } | wc -l; }
await() { # NUMBER of results
    for ((k = 0; k < 3000 && $(results) < $1; ++k)); do sleep 0.1; done
    [ "$(results)" -ge "$1" ] || die "no progress: see $folder/slurm/logs"
}
# The claim of a process that lives; empty if there is none now.
holder() {
    local claim
    while IFS= read -r claim; do
        [ -d "/proc/$(field process "$claim")" ] && echo "$claim" && return
    done < <(find "$folder/slurm/claims" -name '*.[0-9]' -exec cat {} + 2>/dev/null)
    return 0
}
field() { sed -nE "s/.*\"$1\":\"?([0-9]+).*/\1/p" <<<"$2"; }
kill_one() {
    local claim=""
    for ((k = 0; k < 3000; ++k)); do
        claim=$(holder)
        [ -z "$claim" ] || break
        sleep 0.02
    done
    [ -n "$claim" ] || die "nobody works: see $folder/slurm/logs"
    event "kill -9 $(field process "$claim"), obstacle-fleet of job $(field job "$claim"), with $(results) results there"
    kill -9 "$(field process "$claim")" || event "it had ended"
}
task_on() { { squeue -h -r -t RUNNING -w "$1" -o %i || true; } | head -n 1; }

await $((count / 10))
kill_one
await $((count / 5))
task=$(task_on node1)
event "scontrol requeue $task, that runs on node1"
scontrol requeue "$task" || event "it had ended"
await $((count / 3))
event "drain node2, with $(task_on node2) on it"
scontrol update nodename=node2 state=drain reason="test: fan"
sleep 1
task=$(task_on node2)
if [ -n "$task" ]; then
    event "scontrol requeue $task: it goes on elsewhere"
    scontrol requeue "$task" || event "it had ended"
fi
await $((count / 2))
kill_one
await $((count * 3 / 5))
event "node2 is back"
scontrol update nodename=node2 state=resume
await $((count * 3 / 4))
kill_one
for ((k = 0; k < 600; ++k)); do
    [ -n "$(squeue -h)" ] || break
    sleep 1
done
[ -z "$(squeue -h)" ] || die "jobs $job and $merging do not end: $(squeue)"

say "Comparing"
logs=$folder/slurm/logs
{
    grep -E 'version|submit_batch|Requeu|_job_complete: .*WEXIT|sched: Allocate|update_node' "$cluster/slurmctld.log"
    cat "$events"
} | sort >"$folder/excerpt.log"
cat "$events" "$logs"/merge_*.log
restarts=$(cat "$logs"/*_*.log | grep -c '^shard ')
[ "$restarts" -ge 11 ] || die "tasks were not started again: $restarts starts of 8 tasks"
done_lines=$(cat "$logs"/*.log | grep -cE ': (done|damaged|failed) in ')
twice=$(cat "$logs"/*.log | grep -E ': (done|damaged|failed) in ' | cut -d: -f1 | sort | uniq -d)
[ -z "$twice" ] || die "done twice: $twice"
cmp "$folder/single/fleet.sqlite" "$folder/slurm/fleet.sqlite" || die "fleet.sqlite differs"
cmp "$folder/single/report.html" "$folder/slurm/report.html" || die "report.html differs"
cmp "$folder/single/failures.csv" "$folder/slurm/failures.csv" || die "failures.csv differs"
diff -r --exclude=timings.csv "$folder/single/results" "$folder/slurm/results" || die "results differ"
left=$(find "$folder/slurm/unfinished" -type f)
[ -z "$left" ] || die "left by killed tasks: $left"
event "$restarts starts of 8 tasks, $done_lines recordings done once each: fleet.sqlite, report.html, failures.csv and results are those of one process"
tail -n 1 "$events" >>"$folder/excerpt.log"

#!/usr/bin/env bash
# tests/cluster/on_slurm.sh [INTERPLAY]   runs an array of 8 shards on Slurm, kills a task with SIGKILL, requeues it, merges, and
# compares the rows with those of one process. Run by hand where `sbatch` works; a Slurm of one node will do.
set -euo pipefail
interplay=$(realpath "${1:-target/release/interplay}")
work=$(mktemp -d "${TMPDIR:-/tmp}/interplay-slurm.XXXXXX")
trap 'rm -rf "$work"' EXIT
cd "$work"

cat >plan.toml <<'PLAN'
scenario = ["intersection/nice", "lane-change/front-nice", "roundabout/nice"]
planner = ["conservative", "negotiation"]
style = ["nice", "tough"]
jitter = { position_m = 0.1, speed_mps = 0.1 }
samples = 10
PLAN

echo "== one process"
"$interplay" sweep plan.toml --out one >/dev/null
"$interplay" sweep merge one --to one.parquet --no-timings >/dev/null

# The script of the book, with the first run of the third task cut off by SIGKILL.
cat >sweep.sh <<SCRIPT
#!/bin/sh
#SBATCH --job-name=sweep
#SBATCH --array=1-8
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=$work/task-%a.log
if [ "\$SLURM_ARRAY_TASK_ID" = 3 ] && [ "\${SLURM_RESTART_COUNT:-0}" = 0 ]; then
    "$interplay" sweep "$work/plan.toml" --out "$work/shards" --jobs 1 &
    pid=\$!
    while [ ! -s "$work/shards/journal-3-of-8.jsonl" ]; do sleep 0.01; done
    kill -KILL \$pid
    wait \$pid || true
    cp "$work/shards/journal-3-of-8.jsonl" "$work/killed.jsonl"
    scontrol requeue "\${SLURM_ARRAY_JOB_ID}_\${SLURM_ARRAY_TASK_ID}"
    sleep 60
    exit 1
fi
exec "$interplay" sweep "$work/plan.toml" --out "$work/shards" --jobs 1
SCRIPT

echo "== eight tasks, the third killed and requeued"
job=$(sbatch --parsable sweep.sh)
for _ in $(seq 300); do
    # A requeued task waits for some time before it begins again.
    scontrol show job "$job" -o 2>/dev/null | grep -q 'Reason=BeginTime' && scontrol release "$job" 2>/dev/null || true
    [ "$(find shards -name 'shard-*-of-8.parquet' 2>/dev/null | wc -l)" = 8 ] && break
    sleep 1
done
grep -l "shard 3/8, as the scheduler says" task-3.log >/dev/null
echo "rows of the killed task before it was requeued: $(wc -l <killed.jsonl)"
[ "$(grep -c 'as the scheduler says' task-3.log)" -ge 2 ] || { echo "the third task was not requeued"; exit 1; }
grep -h 'made before' task-3.log

"$interplay" sweep merge shards >/dev/null
"$interplay" sweep merge shards --to shards.parquet --no-timings
cmp one.parquet shards.parquet
echo "== the rows of eight tasks are those of one process, byte for byte"

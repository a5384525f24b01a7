#!/usr/bin/env python3
"""tests/cluster/on_hyperqueue.py INTERPLAY   runs 4 shards as tasks of HyperQueue, merges, and compares with one process.

Run by hand; needs `pip install hyperqueue`, which brings a server and a worker of its own.
"""

import pathlib
import subprocess
import sys
import tempfile

from hyperqueue import Job, LocalCluster
from hyperqueue.cluster import WorkerConfig

interplay = str(pathlib.Path(sys.argv[1]).resolve())
plan = ["--scenario", "intersection/nice", "--planner", "idm", "--planner", "conservative", "--starts", "8"]


def run(*words):
    subprocess.run([interplay, *words], check=True, stdout=subprocess.DEVNULL)


with tempfile.TemporaryDirectory() as folder, LocalCluster() as cluster:
    one, shards = f"{folder}/one", f"{folder}/shards"
    run("sweep", *plan, "--out", one)
    cluster.start_worker(WorkerConfig(cores=2))
    client = cluster.client()
    job = Job()
    for shard in range(4):
        # A job of Python counts its tasks from 0; those of `hq submit --array 1-4` are numbered as Interplay wants them.
        line = f'HQ_TASK_ID=$((HQ_TASK_ID + 1)) exec "$@"'
        words = [interplay, "sweep", *plan, "--out", shards, "--shards", "4"]
        job.program(["sh", "-c", line, "sh", *words], stdout=f"{folder}/{shard}.out", stderr=f"{folder}/{shard}.err")
    client.wait_for_jobs([client.submit(job)])
    said = [pathlib.Path(f"{folder}/{shard}.err").read_text().splitlines()[0] for shard in range(4)]
    print("\n".join(said))
    run("sweep", "merge", one, "--to", f"{folder}/one.parquet", "--no-timings")
    run("sweep", "merge", shards, "--to", f"{folder}/shards.parquet", "--no-timings")
    same = pathlib.Path(f"{folder}/one.parquet").read_bytes() == pathlib.Path(f"{folder}/shards.parquet").read_bytes()
    print("the rows are those of one process, byte for byte" if same else "the rows DIFFER")
    sys.exit(not same)

#!/bin/sh
# One run of everything that is timed: criterion on our planners' recorded problems, then ours beside IPOPT.
# PYTHON names an interpreter with casadi and numpy (pip install casadi).
set -eu
cd "$(dirname "$0")/../.."
export OMP_NUM_THREADS=1
cargo bench -p interplay-planners --bench plan
cargo build --release --quiet -p interplay-planners --example solve_problems
"${PYTHON:-python3}" tests/peers/bench_ipopt.py

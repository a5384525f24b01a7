#!/usr/bin/env bash
# Instructions per interior-point iteration of the structured solver, counted by valgrind (the same on every run, however busy
# the machine), against the budgets beside this script. Exits with 1 if a budget is exceeded; without valgrind it says so
# and exits with 0. `--bless` writes what was counted, and a tenth more, as the new budgets.
set -euo pipefail
cd "$(dirname "$0")/../.."
budgets=tests/instructions/budgets.txt
if ! command -v valgrind >/dev/null; then
    echo "instructions: valgrind is not installed, nothing was counted"
    exit 0
fi
cargo build --release --quiet --locked -p interplay-planners --example hot_loop
program=${CARGO_TARGET_DIR:-target}/release/examples/hot_loop
counted=$(mktemp)
trap 'rm -f "$counted" "$counted.callgrind"' EXIT
failed=0
for kind in human conservative negotiation; do
    iterations=$(valgrind --tool=callgrind --toggle-collect='*solve_all*' --callgrind-out-file="$counted.callgrind" \
        "$program" "$kind" 2>"$counted.log")
    total=$(awk '/^summary:|^totals:/ { print $2; exit }' "$counted.callgrind")
    each=$((total / iterations))
    budget=$(awk -v kind="$kind" '$1 == kind { print $2 }' "$budgets" 2>/dev/null || true)
    printf 'instructions: %-13s %7d per iteration (%d iterations), budget %s\n' "$kind" "$each" "$iterations" "${budget:-none}"
    printf '%s %d\n' "$kind" $((each * 11 / 10)) >>"$counted"
    if [[ -n "$budget" && "$each" -gt "$budget" ]]; then failed=1; fi
done
rm -f "$counted.log"
if [[ "${1:-}" == --bless ]]; then
    cp "$counted" "$budgets"
elif ((failed)); then
    echo "instructions: over budget; if that is worth it, run tests/instructions/count.sh --bless" >&2
    exit 1
fi

#!/usr/bin/env bash
# Where the work of negotiation goes: instructions inside the planner during whole runs, counted by valgrind (the same on every
# run, however busy the machine), as shares of all that the planner executes. Without valgrind it says so and exits with 0.
set -euo pipefail
cd "$(dirname "$0")/../.."
if ! command -v valgrind >/dev/null; then
    echo "instructions: valgrind is not installed, nothing was counted"
    exit 0
fi
cargo build --release --quiet --locked -p interplay --bin interplay
program=${CARGO_TARGET_DIR:-target}/release/interplay
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Counts inside one function: count FUNCTION SCENARIO.
count() {
    valgrind --tool=callgrind --toggle-collect="$1" --callgrind-out-file="$folder/counted" "$program" run "$2" --no-record \
        --set 'counterfactual=[]' >/dev/null 2>"$folder/log" || test -s "$folder/counted"
    callgrind_annotate --inclusive=yes --threshold=100 "$folder/counted" 2>/dev/null >"$folder/functions"
}

# Instructions inside a function of what was counted last, with all that it calls; 0 if it was never called.
inside() {
    awk -v name="$1" 'index($0, name) { gsub(",", "", $1); print $1; found = 1; exit } END { if (!found) print 0 }' "$folder/functions"
}

scenarios=("$@")
if ((${#scenarios[@]} == 0)); then scenarios=(intersection/nice lane-change/front-nice ramp-merge/nice left-turn/nice); fi
echo "| scenario | million instructions a run | comparison of classes | descent | fallback plan: comparison | its descent | safety filter | rest |"
echo "|---|---|---|---|---|---|---|---|"
for scenario in "${scenarios[@]}"; do
    count '*negotiation::Negotiation as *::plan' "$scenario"
    all=$(inside 'PROGRAM TOTALS')
    search=$(inside 'Optimiser<S>::explore_class')
    descent=$(inside 'Optimiser<S>::descend ')
    filter=$(inside 'Filter::admits')
    count '*Conservative::optimise' "$scenario"
    companion_search=$(inside 'Optimiser<S>::explore_class')
    companion_descent=$(inside 'Optimiser<S>::descend ')
    count '*Filter::admits' "$scenario"
    filter_search=$(inside 'Optimiser<S>::explore_class')
    filter_descent=$(inside 'Optimiser<S>::descend ')
    awk -v scenario="$scenario" -v all="$all" -v search="$((search - companion_search - filter_search))" \
        -v descent="$((descent - companion_descent - filter_descent))" -v cs="$companion_search" -v cd="$companion_descent" \
        -v filter="$filter" 'BEGIN {
            printf "| `%s` | %.0f | %.0f %% | %.0f %% | %.0f %% | %.0f %% | %.0f %% | %.0f %% |\n", scenario, all / 1e6,
                100 * search / all, 100 * descent / all, 100 * cs / all, 100 * cd / all, 100 * filter / all,
                100 * (all - search - descent - cs - cd - filter) / all
        }'
done

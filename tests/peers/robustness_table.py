"""The table of docs/robustness.md from the rows of sweeps.

    pip install pandas pyarrow
    python tests/peers/robustness_table.py SWEEP [SWEEP ...]

Each sweep is a folder with `runs.parquet`. A line is a scenario with one change; pairs are runs from the same start. Of two
runs the one with the better place of the ego and without contact is nearer to the front.
"""

import math
import sys

import pandas


def wilson(count, of, z=1.959964):
    """Wilson's interval of 95 % of a share, in per cent."""
    share = count / of
    middle = (share + z * z / (2 * of)) / (1 + z * z / of)
    half = z / (1 + z * z / of) * math.sqrt(share * (1 - share) / of + z * z / (4 * of * of))
    return 100 * (middle - half), 100 * (middle + half)


def mcnemar(a, b):
    """The exact probability of a split at least as uneven as `a` to `b` if both were equally likely."""
    n = a + b
    tail = sum(math.comb(n, k) for k in range(min(a, b) + 1)) / 2**n
    return min(1.0, 2 * tail)


def split(better, worse):
    """Counts of pairs that are better and worse, and their probability."""
    return f"{better} / {worse}", f"{mcnemar(better, worse):.1e}"


def pairs_of(rows, base):
    """Two columns of text for the places, two for the times."""
    pair = rows.merge(base, on="sample", suffixes=("", "_base"))
    clean = (pair.contacts == 0, pair.contacts_base == 0)
    better = clean[0] & (~clean[1] | (pair.ego_place < pair.ego_place_base))
    worse = clean[1] & (~clean[0] | (pair.ego_place > pair.ego_place_base))
    place = split(int(better.sum()), int(worse.sum()))
    later = (pair.completed_s - pair.completed_s_base).dropna()
    sooner, after = int((later < -1e-9).sum()), int((later > 1e-9).sum())
    text, p = split(sooner, after)
    median = f"{later.median():+.1f}" if len(later) else "-"
    return [*place, f"{text}, {median}", p]


def line(scenario, change, rows, base):
    kept = int(rows.order_kept.fillna(False).astype(bool).sum())
    low, high = wilson(kept, len(rows))
    done = rows.completed_s.dropna()
    cells = [
        scenario,
        change,
        f"{100 * kept / len(rows):.0f} % ({low:.0f} to {high:.0f})",
        *(["-"] * 4 if base is None else pairs_of(rows, base)),
        str(int((rows.contacts > 0).sum())),
        f"{rows.ego_gap_m.min():.3f}",
        f"{done.min():.1f} to {done.max():.1f}" if len(done) else "-",
        str(int(rows.has_task.astype(bool).sum() - rows.success.astype(bool).sum())),
        str(int(rows.plans_failed.sum())),
    ]
    return "| " + " | ".join(cells) + " |"


def main():
    for folder in sys.argv[1:]:
        table = pandas.read_parquet(f"{folder}/runs.parquet")
        for scenario in dict.fromkeys(table.scenario):
            rows = table[table.scenario == scenario]
            base = rows[rows.planner == "as-written"]
            for planner in sorted(set(rows.planner), key=lambda name: (name != "as-written", name)):
                change = "nothing" if planner == "as-written" else planner
                print(line(scenario, change, rows[rows.planner == planner], None if change == "nothing" else base))


if __name__ == "__main__":
    main()

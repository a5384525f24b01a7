"""The tables of docs/evidence/robustness.md from the rows of sweeps.

    pip install pandas pyarrow
    python tests/peers/robustness_table.py starts settled unpersuaded unexpressed ramps unpriced
    python tests/peers/robustness_table.py --roads roads wide

Each sweep is a folder with `runs.parquet`. A line is a scenario with one change; pairs are runs from the same start. Of two
runs the one with the better place of the ego and without contact is nearer to the front. With `--roads` it is the tables of real roads.
"""

import math
import sys
import tomllib
from pathlib import Path

import pandas

#: How the changes of an arm are called.
ARMS = {
    "vehicle.ego.driver.settled_steps=29": "Mechanism off: the whole plan of the other counts as settled (`settled_steps`)",
    "vehicle.ego.driver.w_4=0.0": "Mechanism off: no persuasion (`w_4 = 0`)",
    "vehicle.ego.driver.ahead_share=1.0": "As printed: it is drawn back where it is ahead (`ahead_share = 1`)",
    "vehicle.ego.driver.slack_weight=0.0": "Mechanism off: no expression (`slack_weight = 0`)",
    "vehicle.ego.driver.expressed_bounds=interval": 'As printed: it may not seem surer (`expressed_bounds = "interval"`)',
    "vehicle.ego.driver.retreat_dearer_at_most=1e6": "No price of patience (`retreat_dearer_at_most = 1e6`)",
    "vehicle.front.driver.style=tough": "A front driver who ignores the ego",
    "vehicle.front.driver.style=nice": "A nice front driver",
    "conservative": "A conservative ego",
}
#: Arms that are left out of a scenario in which they change no run.
ONLY_IF_ANOTHER = ("ahead_share", "front.driver")
HEAD = [
    "scenario", "what is changed", "order as in the figure, 95 % interval", "ego nearer to the front / further back", "p",
    "ego done sooner / later, median difference s", "p", "touched", "smallest gap m", "ego done s", "failed plans",
]
#: Real roads: what counts beside the scenario, and the planners in the order of the columns.
ROADS = {"left-turn": "left turn", "narrow-passage": "narrow passage", "t-junction": "T-junction", "roundabout": "roundabout"}
ORDERS = {
    "on-ramp/five": "on-ramp with five", "all-way-stop/four": "all-way stop with four",
    "overtaking/oncoming": "overtaking with oncoming traffic", "curve/lane-drop-cars": "lane drop in a curve",
}
DRIVERS = ["conservative", "negotiation", "bayesian", "game", "cooperative", "human", "idm"]
TITLES = {"bayesian": "Bayesian", "idm": "IDM", "as-written": "as written"}


def wilson(count, of, z=1.959964):
    """Wilson's interval of 95 % of a share, in per cent."""
    share = count / of
    middle = (share + z * z / (2 * of)) / (1 + z * z / of)
    half = z / (1 + z * z / of) * math.sqrt(share * (1 - share) / of + z * z / (4 * of * of))
    return 100 * (middle - half), 100 * (middle + half)


def share(count, of):
    low, high = wilson(count, of)
    return f"{100 * count / of:.0f} % ({max(low, 0):.0f} to {high:.0f})"


def mcnemar(a, b):
    """The exact probability of a split at least as uneven as `a` to `b` if both were equally likely."""
    n = a + b
    tail = sum(math.comb(n, k) for k in range(min(a, b) + 1)) / 2**n
    return min(1.0, 2 * tail)


def split(better, worse):
    """Counts of pairs that are better and worse, and their probability."""
    return f"{better} / {worse}", f"{mcnemar(better, worse):.1e}".replace("1.0e+00", "1").replace("e-0", "e-")


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
    median = f"{later.median() + 0.0:+.1f}".replace("-0.0", "+0.0") if len(later) else "-"
    return [*place, f"{text}, {median}", p]


def line(scenario, change, rows, base):
    kept = int(rows.order_kept.astype("boolean").fillna(False).sum())
    done = rows.completed_s.dropna()
    cells = [
        scenario,
        change,
        share(kept, len(rows)),
        *(["-"] * 4 if base is None else pairs_of(rows, base)),
        str(int((rows.contacts > 0).sum())),
        f"{rows.ego_gap_m.min():.3f}",
        f"{done.min():.1f} to {done.max():.1f}" if len(done) else "-",
        str(int(rows.plans_failed.sum())),
    ]
    return "| " + " | ".join(cells) + " |"


def head(cells):
    print("| " + " | ".join(cells) + " |\n|" + "---|" * len(cells))


def scenarios(folder):
    """The scenarios of a sweep in the order of its plan."""
    return tomllib.loads(Path(folder, "plan.toml").read_text())["scenario"]


def starts(folders):
    """Every scenario of the first sweep with all changes that any of the sweeps has."""
    tables = [pandas.read_parquet(f"{folder}/runs.parquet") for folder in folders]
    head(HEAD)
    for scenario in scenarios(folders[0]):
        base = None
        for table in tables:
            of_scenario = table[table.scenario == scenario]
            for planner in sorted(set(of_scenario.planner), key=lambda name: (name != "as-written", name)):
                rows = of_scenario[of_scenario.planner == planner].sort_values("sample")
                if planner != "as-written":
                    same = list(rows.digest) == list(base.digest)
                    if not (same and any(word in planner for word in ONLY_IF_ANOTHER)):
                        print(line(scenario, ARMS.get(planner, planner), rows, base))
                elif base is None:
                    base = rows
                    print(line(scenario, "nothing", rows, None))


def off_road(rows, planners):
    counts = {name: int(rows[(rows.planner == name) & rows.leaves_road.astype(bool)].shape[0]) for name in planners}
    return ", ".join(f"{TITLES.get(name, name)} {count}" for name, count in counts.items() if count) or "0"


def roads(folder, wide=None):
    """Which vehicle goes first on real roads, and whether the order is that of the file; with a last row from wider starts."""
    table = pandas.read_parquet(f"{folder}/runs.parquet")
    titles = [TITLES.get(name, name) for name in DRIVERS]
    head(["start", "what counts", *titles, "off the road"])
    for scenario in scenarios(folder):
        family, _, style = scenario.partition("/")
        rows = table[table.scenario == scenario]
        if family in ROADS:
            own = rows[rows.planner == "as-written"].driver.iloc[0]
            first = style.endswith("nice")
            counted = (rows.ego_place == 1) if first else (rows.ego_place > 1)
            cells = [share(int(counted[rows.planner == name].sum()), int((rows.planner == name).sum())) for name in DRIVERS]
            cells = [f"**{cell}**" if name == own else cell for name, cell in zip(DRIVERS, cells)]
            kind = f"{ROADS[family]}, {'nice' if first else 'tough'}"
            print("| " + " | ".join([kind, "ego first" if first else "ego second", *cells, off_road(rows, DRIVERS)]) + " |")
    print()
    planners = ["as-written", *DRIVERS]
    head(["start", *(TITLES.get(name, name) for name in planners), "off the road"])
    for scenario, title in ORDERS.items():
        order_row(title, table[table.scenario == scenario], planners)
    if wide:
        order_row("the same, up to 10 m and 0.95 m/s", pandas.read_parquet(f"{wide}/runs.parquet"), planners)


def order_row(title, rows, planners):
    kept = rows.order_kept.astype("boolean").fillna(False)
    cells = [share(int(kept[rows.planner == name].sum()), int((rows.planner == name).sum())) for name in planners]
    print("| " + " | ".join([title, *cells, off_road(rows, planners)]) + " |")


if __name__ == "__main__":
    roads(*sys.argv[2:]) if sys.argv[1] == "--roads" else starts(sys.argv[1:])

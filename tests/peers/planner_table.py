"""The tables of docs/evidence/planner-benchmark.md from the rows of a sweep.

    python tests/peers/planner_table.py FOLDER [--interplay PROGRAM]

The figures are those of `interplay compare FOLDER --json`. A sweep whose planners all know the others' plans gives the overview, the
pairs against the conservative planner, and how often the ego is first by family; one with planners that infer them gives the table of
all planners and their pairs. Probabilities are corrected by Holm's method for the rows of their column.
"""

import argparse
import functools
import json
import subprocess

NAMES = {"bayesian": "Bayesian", "idm": "IDM", "nash": "Nash"}
STYLES = ["nice", "continuum", "tough", "idm"]
TOLD = ["conservative", "cooperative", "negotiation", "bayesian", "game", "idm"]
INFERRED = [f"{name} (inferred)" for name in ("conservative", "negotiation", "bayesian", "game")]
ALL = [
    "conservative", INFERRED[0], "negotiation", INFERRED[1], "bayesian", INFERRED[2], "game", INFERRED[3],
    "contingency", "nash", "cooperative", "idm",
]
#: Pairs of planners that are compared where some infer plans.
PAIRS = [(name, name.removesuffix(" (inferred)")) for name in INFERRED]
PAIRS += [(name, INFERRED[0]) for name in [*INFERRED[1:], "contingency"]] + [("nash", "conservative")]


@functools.cache
def compared(program, folder, baseline):
    """What `interplay compare` says, by family and style (None: all of them) and planner."""
    command = [program, "compare", folder, "--baseline", baseline, "--json"]
    said = json.loads(subprocess.run(command, stdout=subprocess.PIPE, check=True).stdout)
    return {(g["family"], g["style"]): {p["planner"]: p for p in g["planners"]} for g in said["groups"]}


def title(planner):
    name, inferred, _ = planner.partition(" (inferred)")
    return NAMES.get(name, name) + (", inferred" if inferred else "")


def share(value, interval=True):
    text = f"{100 * value['count'] / value['of']:.1f} %"
    low, high = (100 * bound for bound in value["interval"])
    return f"{text} ({low:.1f} to {high:.1f})" if interval else text


def whole(value):
    return f"{100 * value['count'] / value['of']:.0f} %"


def contacts(row):
    return f"{row['contacts']} ({row['contacts_by_ego']})" if row["contacts"] else "0"


def signed(number):
    return f"{number:+.2f}".replace("-", "−")


def delay(versus):
    if versus["success"] is None or versus["delay_s"] is None:
        return ""
    low, high = (f"{bound:.2f}".replace("-", "−") for bound in versus["delay_interval_s"])
    return "0" if versus["delay_s"] == 0 else f"{signed(versus['delay_s'])} ({low} to {high})"


def holm(probabilities):
    """Corrected for how many there are, in the order given."""
    order = sorted(range(len(probabilities)), key=lambda at: probabilities[at])
    corrected, least = [0.0] * len(order), 0.0
    for rank, at in enumerate(order):
        least = max(least, min(1.0, (len(order) - rank) * probabilities[at]))
        corrected[at] = least
    return corrected


def probability(p):
    if p >= 0.995:
        return "p = 1"
    return f"p = {p:.2f}" if p >= 0.01 else "p < 1e-300" if p < 1e-300 else f"p = {p:.0e}".replace("e-0", "e-")


def line(cells):
    print(("| " + " | ".join(cells) + " |").replace("|  |", "| |"))


def head(cells):
    print()
    line(cells)
    print("|" + "---|" * len(cells))


def pairs(rows):
    """Names and comparisons as a table; in `brakes hard` a win is a run in which only the baseline does."""
    head(["", "success: wins / losses", "place: ahead / behind", "brakes hard: only the other / only this", "time to the goal [s], 95 %"])
    columns = []
    for key in ("success", "place", "hard_braking"):
        splits = [versus[key] for _, versus in rows]
        corrected = holm([split["p"] for split in splits])
        columns.append([
            f"{s['wins']:,} / {s['losses']:,}" + (f" ({probability(p)})" if s["wins"] + s["losses"] else "")
            for s, p in zip(splits, corrected)
        ])
    for (name, versus), *cells in zip(rows, *columns):
        line([name, *cells, delay(versus)])


def told(look):
    groups = look("conservative")
    everything = groups[None, None]
    planners = [name for name in TOLD if name in everything]
    head(["", *map(title, planners)])
    for style in [*STYLES, None]:
        word = "all" if style is None else style.replace("idm", "IDM")
        line([f"success, {word}", *(share(groups[None, style][name]["success"]) for name in planners)])
    cells = {
        "time to the goal [s]": lambda row: f"{row['completed_s']['mean']:.2f}",
        "ego first": lambda row: whole(row["first"]),
        "ego brakes hard": lambda row: share(row["hard_braking"]),
        "others brake hard": lambda row: share(row["others_hard_braking"]),
        "contacts of the ego (by the ego)": contacts,
        "stuck": lambda row: f"{row['deadlocks']:,}",
        "off the road": lambda row: f"{row['off_road']['count']:,}",
        "plans that failed": lambda row: f"{row['plans_failed']:,}",
    }
    for word, cell in cells.items():
        line([word, *(cell(everything[name]) for name in planners)])
    pairs([(title(name), everything[name]["versus_baseline"]) for name in planners[1:]])
    shown = [name for name in planners if name not in ("cooperative", "idm")]
    head(["", *map(title, shown)])
    for family in sorted({family for family, _ in groups if family}):
        nice, tough = groups[family, "nice"], groups[family, "tough"]
        cells = [f"{whole(nice[name]['first'])} / {whole(tough[name]['first'])}" for name in shown]
        if len(set(cells)) > 1:
            line([family, *cells])


def inferred(look):
    groups = look("conservative")
    head(
        ["", "success, nice", "continuum", "tough", "IDM", "all", "time [s]", "ego first", "brakes hard", "stuck", "off the road", "plans failed", "contacts (by the ego)"]
    )
    for name in ALL:
        row = groups[None, None][name]
        line([
            title(name),
            *(share(groups[None, style][name]["success"], interval=False) for style in STYLES),
            share(row["success"]),
            f"{row['completed_s']['mean']:.2f}",
            whole(row["first"]),
            f"{100 * row['hard_braking']['count'] / row['hard_braking']['of']:.1f} %",
            str(row["deadlocks"]),
            str(row["off_road"]["count"]),
            str(row["plans_failed"]),
            contacts(row),
        ])
    pairs([(f"{title(name)}, against {title(other)}", look(other)[None, None][name]["versus_baseline"]) for name, other in PAIRS])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("--interplay", default="interplay")
    given = parser.parse_args()
    look = functools.partial(compared, given.interplay, given.folder)
    planners = look("conservative")[None, None]
    print(f"{planners['conservative']['runs']:,} runs a planner")
    (inferred if INFERRED[0] in planners else told)(look)


if __name__ == "__main__":
    main()

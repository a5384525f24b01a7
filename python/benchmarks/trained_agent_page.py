"""Makes the page of the trained agent from what ``examples/train_ppo.py OUT`` left: ``python trained_agent_page.py OUT DOCS``.

It writes ``evidence/trained-agent.md`` and ``images/trained-agent.svg`` into the folder DOCS. It needs matplotlib.
"""

from __future__ import annotations

import csv
import sys
from collections import defaultdict
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

import interplay

PLANNERS = ("conservative", "negotiation", "idm", "idle", "random")
CLAIMS = {"success": "success", "contacts": "contacts", "hard_braking": "brakes hard"}


def percent(share: dict[str, Any]) -> str:
    """A share with its interval."""
    low, high = (100 * edge for edge in share["interval"])
    return f"{100 * share['count'] / share['of']:.1f} % ({low:.1f} to {high:.1f})"


def curves(out: Path, picture: Path) -> dict[str, float]:
    """Draws the learning curves; returns the last share of goals of each seed."""
    rows = list(csv.DictReader((out / "curves.csv").open()))
    by_seed: dict[str, list[dict[str, str]]] = defaultdict(list)
    for row in rows:
        by_seed[row["seed"]].append(row)
    figure, axes = plt.subplots(figsize=(7, 3), layout="constrained")
    for number, (seed, points) in enumerate(by_seed.items(), start=1):
        decisions = [int(point["decisions"]) / 1e3 for point in points]
        axes.plot(decisions, [100 * float(point["goal"]) for point in points], label=f"seed {number}")
    axes.set(xlabel="decisions [thousand]", ylabel="goals of the last 200 episodes [%]", ylim=(0, 101))
    axes.legend(loc="lower right", ncols=5, fontsize="small")
    axes.grid(alpha=0.3)
    picture.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(picture, metadata={"Date": None})
    return {seed: float(points[-1]["goal"]) for seed, points in by_seed.items()}


def table(figures: dict[str, Any]) -> list[str]:
    """A table for each style: a row for each planner."""
    lines = []
    for group in (group for group in figures["groups"] if group["style"] is not None):
        planners = {entry["planner"]: entry for entry in group["planners"]}
        networks = sorted(name for name in planners if name.startswith("ppo"))
        lines += [f"Others: **{group['style']}**", "", "| | success | contacts | brakes hard | time to the goal [s] |", "|---|---|---|---|---|"]
        for name in [*networks, *PLANNERS]:
            entry = planners[name]
            reached = entry["completed_s"]
            time = f"{reached['mean']:.2f}" if reached and reached["mean"] is not None else ""
            cells = [name, percent(entry["success"]), f"{entry['contacts']} of {entry['runs']}", percent(entry["hard_braking"]), time]
            lines.append("| " + " | ".join(cells) + " |")
        lines.append("")
    return lines


def main() -> None:
    """Writes the page."""
    out, docs = Path(sys.argv[1]), Path(sys.argv[2])
    last = curves(out, docs / "images/trained-agent.svg")
    test, unmet = (interplay.compare(out / name, "--by", "scenario") for name in ("test", "unmet"))
    head = (Path(__file__).with_name("trained_agent_head.md")).read_text()
    shares = ", ".join(f"{100 * share:.1f} %" for share in last.values())
    lines = [
        head.rstrip().replace("LAST_SHARES", shares).replace("RUNS", f"{test['runs'] + unmet['runs']:,}"),
        "",
        "![Goals of the last 200 episodes over decisions, for five seeds](../images/trained-agent.svg)",
        "",
        "## On unseen starts, among humans as in training",
        "",
        *table(test),
        "## Among humans of weights that it never met",
        "",
        *table(unmet),
    ]
    (docs / "evidence/trained-agent.md").write_text("\n".join(lines).rstrip() + "\n")


if __name__ == "__main__":
    main()

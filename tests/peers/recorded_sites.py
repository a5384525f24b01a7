"""How well drivers predict the cars of sites on which they were not fitted: every site left out once.

    python tests/peers/recorded_sites.py CLONES [--fetch] [--program INTERPLAY] [--starts 300] [--keep FOLDER] [--json FILE]

CLONES has clones of the repositories of `commonroad_clones.py`, each in a folder OWNER+NAME; `--fetch` clones those that are missing. The files
of each site are written into a folder of its own and read by `interplay predict --leave-one-out`. The table has a row a
site and a column a model: the error along the road after 3 s as a share of that at constant velocity [%], with its 95 % interval by a bootstrap
over cars. The last row pools all sites, the one before it the cars that move sideways. Without clones it says that it skips.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from commonroad_clones import SITES, content, fetch, files, site_of

LEAST_BYTES = 3000
LEAST_VEHICLES = 3


def extract(clones, folder):
    """Writes the distinct files of each site; returns how many there are, by site."""
    known, counts = set(), {}
    for repository, path, place, size in files(clones):
        site = site_of(path)
        if site is None or size < LEAST_BYTES or place[1] in known:
            continue
        known.add(place[1])
        text = content(place)
        if text.count(b"<dynamicObstacle ") + text.count(b"<obstacle ") < LEAST_VEHICLES:
            continue
        counts[site] = counts.get(site, 0) + 1
        to = Path(folder, site, f"{counts[site]:03}+{path.rsplit('/', 1)[-1]}")
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_bytes(text)
        print(f"{site}: {repository} {path}", file=sys.stderr)
    return counts


def table(document):
    groups = document["groups"]
    names = [model["name"] for model in groups[0]["models"][1:]]
    print("| site | starts (cars) | " + " | ".join(names) + " |\n|---|---" + "|---" * len(names) + "|")
    for group in groups:
        ratios = [model["along_ratio_to_constant_velocity"] for model in group["models"][1:]]
        cells = [f"{100 * it['value']:.0f} ({100 * it['low']:.0f} to {100 * it['high']:.0f})" for it in ratios]
        print(f"| {group['name']} | {group['starts']} ({group['cars']}) | " + " | ".join(cells) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("clones")
    parser.add_argument("--fetch", action="store_true")
    parser.add_argument("--program", default="interplay")
    parser.add_argument("--starts", type=int, default=300)
    parser.add_argument("--keep")
    parser.add_argument("--json")
    options = parser.parse_args()
    if options.fetch:
        fetch(options.clones)
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.keep or scratch
        counts = extract(options.clones, folder)
        if len(counts) < 2:
            print(f"skipped: {len(counts)} sites of recorded cars below {options.clones}")
            return
        sites = [str(Path(folder, site)) for site in SITES if site in counts]
        words = ["predict", *sites, "--leave-one-out", "--starts", str(options.starts), "--json"]
        done = subprocess.run([options.program, *words], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(done.stderr)
        print(done.stderr, file=sys.stderr)
        if options.json:
            Path(options.json).write_text(done.stdout)
        table(json.loads(done.stdout))


if __name__ == "__main__":
    main()

"""Lorries and buses at every kind of junction: do all drivers come round, on the road, without contact and without standing?

    python tests/peers/long_vehicles.py [--binary target/release/interplay] [--out FOLDER] [--first 6000] [--count 4] [--jobs 1]
        [--drivers human idm ...] [--kinds crossing ...] [--bodies truck bus]

Two bodies of 12 m, every kind of road whose turns have a radius, nine drivers, and two radii: the smallest at which `interplay check`
does not remark on the turn, in tenths of a metre, and 1.5 times that. A ring or a bend of one lane needs a wider lane than cars do, at
any usual radius, so there it is the width of the lane, and 1.2 times that. Alone, each kind has four ways through it. In traffic, the ego of
`streets/KIND/FIRST` and the numbers after it is the long vehicle. A run is well if the vehicle arrives, leaves the road by at most
5 cm, begins no contact, and does not stand without a reason. The rows stay in FOLDER (`interplay sweep` goes on where it stopped).
Exit codes: 0 all are well, 1 some are not, 2 a street or a radius could not be made.
"""

import argparse
import collections
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

DRIVERS = ["human", "idm", "conservative", "negotiation", "bayesian", "game", "cooperative", "contingency", "nash"]
BODIES = ["truck", "bus"]
OFF_ROAD_M = 0.05
#: A vehicle that moves off from a line is slow for a moment, and nothing holds it any more.
STANDING_S = 2.0
#: Ends of the search for the smallest radius [m]. Ramps of motorways are not tighter than 25 m.
LEAST_M, MOST_M = 2.5, 40.0
LEAST_OF_KIND_M = {"on-ramp": 25.0}

ARMS = [("west-in", "south-out"), ("south-in", "east-out"), ("west-in", "north-out"), ("south-in", "west-out")]
TEE = [("west-in", "south-out"), ("south-in", "east-out"), ("east-in", "south-out"), ("south-in", "west-out")]
WAYS = [("south-in", "east-out"), ("south-in", "north-out"), ("south-in", "west-out"), ("west-in", "south-out")]
WIDE = [("south-in-0", "east-out-0"), ("south-in-0", "north-out-0"), ("south-in-1", "west-out-1"), ("west-in-0", "south-out-0")]


def bend(sign: int):
    """A road of one lane around a corner with a radius of 15 m."""
    pieces = f"[{{ straight_m = 80.0 }}, {{ turn_deg = {sign * 90.0}, radius_m = 15.0 }}, {{ straight_m = 80.0 }}]"
    return lambda width_m: f'kind = "curve"\nlane_width_m = {width_m}\nlane_count = 1\npieces = {pieces}\n'


def form(kind: str, key: str = "turn_radius_m", more: str = ""):
    return lambda radius_m: f'kind = "{kind}"\n{key} = {radius_m}\n{more}'


#: Of each kind: its road at a radius, its ways, where the vehicle starts [m], the kind of street with traffic, and the larger radius as a
#: multiple of the smallest.
KINDS = {
    "t-junction": (form("t-junction"), TEE, 45.0, "tee", 1.5),
    "crossing": (form("crossing"), ARMS, 45.0, "crossing", 1.5),
    "all-way-stop": (form("all-way-stop"), ARMS, 45.0, "stop", 1.5),
    "turning-lanes": (form("crossing", more="turning_lanes = true\n"), [("west-in-0", "south-out"), ("south-in", "east-out"), ("west-in-1", "north-out"), ("south-in", "west-out")], 40.0, None, 1.5),
    "roundabout": (form("roundabout", "lane_width_m"), WAYS, 30.0, "ring", 1.2),
    "roundabout-2": (form("roundabout", "radius_m", "lane_count = 2\n"), WIDE, 30.0, "ring2", 1.5),
    "bend-left": (bend(1), [(0, 0)], 30.0, None, 1.2),
    "bend-right": (bend(-1), [(0, 0)], 30.0, None, 1.2),
    "on-ramp": (form("on-ramp", "ramp_radius_m"), [("ramp", "main-0")], 20.0, "ramp", 1.5),
}


def place(lane) -> str:
    return str(lane) if isinstance(lane, int) else f'"{lane}"'


def alone(kind: str, way: int, number: int, body: str, radius_m: float) -> str:
    road, ways, along_m, *_ = KINDS[kind]
    start, goal = ways[way]
    speed_mps = 6.0 + 1.3 * number
    return (
        f'title = "{kind}"\nshows = "A long vehicle turns"\nduration_s = 45.0\nconduct = "people"\n[defaults]\nclass = "car"\n'
        f'[[vehicle]]\nname = "ego"\nclass = "{body}"\n'
        f"start = {{ lane = {place(start)}, along_m = {along_m - 1.7 * number:.1f}, speed_mps = {speed_mps:.1f} }}\n"
        f"goal = {{ lane = {place(goal)}, speed_mps = 10.0 }}\n[road]\n" + road(radius_m)
    )


def in_traffic(kind: str, number: int, body: str, radius_m: float) -> str:
    key = re.search(r"\n(\w+) = ", KINDS[kind][0](1.0)).group(1)
    return (
        f'extends = "streets/{KINDS[kind][3]}/{number}"\ntitle = "{kind} {number}"\nduration_s = 45.0\n[road]\n{key} = {radius_m}\n'
        f'[[vehicle]]\nname = "ego"\nclass = "{body}"\n'
    )


class Streets:
    def __init__(self, options):
        self.options, self.smallest = options, {}

    def check(self, text: str):
        """What `check` says, and whether the file is sound."""
        with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
            file.write(text)
            file.flush()
            done = subprocess.run([self.options.binary, "check", file.name], capture_output=True, text=True)
        return done.stdout + done.stderr, done.returncode == 0

    def fits(self, kind: str, way: int, body: str, tenths: int) -> bool:
        said, is_sound = self.check(alone(kind, way, 0, body, tenths / 10))
        return is_sound and "too tight" not in said and "covers a width" not in said

    def smallest_m(self, kind: str, way: int, body: str):
        """The smallest radius in tenths of a metre without a remark."""
        if (kind, way, body) not in self.smallest:
            # A wide turn may be worse than a smaller one, so the search goes up in metres first.
            tried = range(int(10 * LEAST_OF_KIND_M.get(kind, LEAST_M)), int(10 * MOST_M) + 1, 10)
            high = next((tenths for tenths in tried if self.fits(kind, way, body, tenths)), None)
            if high is None:
                sys.exit(f"{kind}, way {way}, {body}: no radius up to {MOST_M} m works")
            low = high - 10 if high > tried.start else high
            while high > low + 1:
                middle = (low + high) // 2
                low, high = (low, middle) if self.fits(kind, way, body, middle) else (middle, high)
            self.smallest[kind, way, body] = high / 10
        return self.smallest[kind, way, body]

    def from_m(self, kind: str, way: int, body: str, least_m: float) -> float | None:
        """The first radius from one on, in tenths of a metre, without a remark."""
        tried = range(round(10 * least_m), int(10 * MOST_M) + 1, 2)
        return next((tenths / 10 for tenths in tried if self.fits(kind, way, body, tenths)), None)

    def write(self, folder: Path):
        """All files; returns those that could not be made."""
        refused = []
        for body in self.options.bodies:
            for kind in self.options.kinds:
                ways = KINDS[kind][1]
                radii = [self.smallest_m(kind, way, body) for way in range(len(ways))]
                print(f"{body} {kind}: smallest radii {radii}", file=sys.stderr, flush=True)
                for name, times in [("tight", 1.0), ("wide", KINDS[kind][4])]:
                    for number in range(self.options.count):
                        way = number % len(ways)
                        radius_m = self.from_m(kind, way, body, times * radii[way])
                        if radius_m is None:
                            refused.append((kind, number, body, name, f"no radius up to {MOST_M} m is without a remark"))
                            continue
                        text = alone(kind, way, number, body, radius_m)
                        (folder / f"alone_{kind}_{body}_{name}_{number}.toml").write_text(text)
                    for number in range(self.options.first, self.options.first + self.options.count):
                        if KINDS[kind][3] is None:
                            continue
                        text = in_traffic(kind, number, body, round(times * max(radii), 1))
                        said, is_sound = self.check(text)
                        if is_sound:
                            (folder / f"traffic_{kind}_{body}_{name}_{number}.toml").write_text(text)
                        else:
                            refused.append((kind, number, body, name, said))
        return refused


def faults(row) -> list[str]:
    found = []
    if row.get("error"):
        return ["error"]
    # A road without junctions has no last lane to arrive on.
    if row["completed_s"] is None and "_bend-" not in row["scenario"]:
        found.append("not round")
    if (row.get("off_road_m") or 0.0) > OFF_ROAD_M:
        found.append("off the road")
    if row.get("contact_by_ego"):
        found.append("contact at fault")
    elif row.get("ego_contact"):
        found.append("hit by another")
    if (row.get("unexplained_standing_s") or 0.0) > STANDING_S:
        found.append("stands")
    return found


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", type=lambda path: Path(path).resolve(), default=Path("target/release/interplay").resolve())
    parser.add_argument("--out", type=Path, default=Path("sweeps/long-vehicles"))
    parser.add_argument("--first", type=int, default=6000)
    parser.add_argument("--count", type=int, default=4)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--drivers", nargs="*", default=DRIVERS)
    parser.add_argument("--kinds", nargs="*", default=list(KINDS))
    parser.add_argument("--bodies", nargs="*", default=BODIES)
    options = parser.parse_args()
    files = options.out / "files"
    files.mkdir(parents=True, exist_ok=True)
    for old in files.glob("*.toml"):
        old.unlink()
    refused = Streets(options).write(files)
    for kind, number, body, name, said in refused:
        print(f"not made: {kind} {number} {body} {name}: {said.splitlines()[0]}")
    plan = options.out / "long.toml"
    planners = json.dumps(options.drivers)
    plan.write_text(f'title = "Long vehicles"\nscenario = ["files"]\nplanner = {planners}\n')
    rows_folder = options.out / "rows"
    done = subprocess.run([options.binary, "sweep", plan, "--out", rows_folder, "--jobs", str(options.jobs)], stdout=subprocess.DEVNULL)
    if done.returncode not in (0, 1):
        return 2
    rows = [json.loads(line) for line in (rows_folder / "journal.jsonl").open()]
    tell([row | ((row["result"] or {}).get("traffic") or {}) | {"planner": row["planner"]} for row in rows])
    return 2 if refused else 0


def tell(rows):
    table, told = collections.defaultdict(collections.Counter), []
    for row in rows:
        place, kind, body, radius, number = Path(row["scenario"]).stem.split("_")
        found = faults(row)
        for key in [(place, body, row["planner"], radius)]:
            table[key].update(["runs"] + (found or ["well"]))
        if found:
            told.append((place, kind, body, radius, number, row["planner"], ", ".join(found), row.get("off_road_m"), row.get("unexplained_standing_s")))
    heads = ["runs", "well", "not round", "off the road", "contact at fault", "hit by another", "stands", "error"]
    print("| | body | driver | radius | " + " | ".join(heads) + " |\n|" + "---|" * (4 + len(heads)))
    for key in sorted(table):
        print("| " + " | ".join(key) + " | " + " | ".join(str(table[key][head]) for head in heads) + " |")
    for one in sorted(told):
        print(*one)


if __name__ == "__main__":
    sys.exit(main())

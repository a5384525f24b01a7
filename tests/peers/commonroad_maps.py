"""Whether a network holds the maps of CommonRoad: turns each map of a folder into a scenario and drives a car along it.

    python tests/peers/commonroad_maps.py FOLDER [INTERPLAY]

FOLDER has scenarios in the XML format of CommonRoad, versions 2018b and 2020a, for instance `tests/test_scenarios` of the
repository CommonRoad/commonroad-io. Each lanelet becomes a lane: the points in the middle between its bounds, its width at
each of them, its successors and neighbours. A line a map says how many lanes there are, how many had to be made narrower
because their inner edge would cross itself in a bend, and whether a car drives along the longest lane and its successors.
"""

import math
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml
from pathlib import Path

MARGIN = 0.98
MOST_CLIPS = 40


def points(bound):
    return [tuple(float(point.find(axis).text) for axis in "xy") for point in bound.findall("point")]


class Lane:
    """A lanelet as a lane: the middle between its bounds, and its width over the arc length of the middle."""

    def __init__(self, lanelet, known):
        self.name = f"l{lanelet.get('id')}"
        pairs = list(zip(points(lanelet.find("leftBound")), points(lanelet.find("rightBound"))))
        middles = [(((a + c) / 2, (b + d) / 2), math.dist((a, b), (c, d))) for (a, b), (c, d) in pairs]
        kept = middles[:1]
        for place, width in middles[1:]:
            if math.dist(place, kept[-1][0]) > 1e-3:
                kept.append((place, width))
        self.points = [place for place, _ in kept]
        self.widths = [width for _, width in kept]
        self.along = [0.0]
        for a, b in zip(self.points, self.points[1:]):
            self.along.append(self.along[-1] + math.dist(a, b))
        refs = lambda tag: [f"l{other.get('ref')}" for other in lanelet.findall(tag) if other.get("ref") in known]
        self.successors = refs("successor")
        self.beside = {}
        for side in ("Left", "Right"):
            other = lanelet.find(f"adjacent{side}")
            if other is not None and other.get("ref") in known:
                self.beside[side.lower()] = (f"l{other.get('ref')}", other.get("drivingDir") == "opposite")

    def toml(self):
        pairs = lambda rows: "[" + ", ".join(f"[{a:.6f}, {b:.6f}]" for a, b in rows) + "]"
        lines = ["[[road.lane]]", f'name = "{self.name}"', f"points = {pairs(self.points)}"]
        lines.append(f"width_m = {pairs(zip(self.along, self.widths))}")
        if self.successors:
            lines.append("successors = [" + ", ".join(f'"{name}"' for name in self.successors) + "]")
        for side, (name, oncoming) in self.beside.items():
            lines.append(f'{side} = {{ lane = "{name}", oncoming = {str(oncoming).lower()} }}')
        return "\n".join(lines) + "\n"


def scenario(lanes):
    """The map with one car on its longest lane."""
    by_name = {lane.name: lane for lane in lanes}
    route = [max(lanes, key=lambda lane: lane.along[-1])]
    while len(route) < 3 and route[-1].successors:
        after = by_name[route[-1].successors[0]]
        if after in route:
            break
        route.append(after)
    names = ", ".join(f'"{lane.name}"' for lane in route)
    head = 'title = "Map"\nshows = "A car on a map"\nduration_s = 10.0\n[road]\nkind = "network"\n'
    car = f'[[vehicle]]\nname = "ego"\nroute = [{names}]\n'
    car += f'start = {{ lane = "{route[0].name}", along_m = 3.0, speed_mps = 5.0 }}\ngoal = {{ speed_mps = 8.0 }}\n'
    return head + "".join(lane.toml() for lane in lanes) + car + "[expect]\noff_road_at_most_m = 0.1\n"


def interplay(program, command, text):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "map.toml"
        path.write_text(text)
        more = ["--no-record"] if command == "run" else []
        done = subprocess.run([program, command, str(path), *more], capture_output=True, text=True)
    return done.returncode, " ".join(done.stderr.replace("│", " ").replace("×", " ").split()), done.stdout


def report(path, program):
    root = xml.parse(path).getroot()
    lanelets = root.findall("lanelet")
    known = {lanelet.get("id") for lanelet in lanelets}
    lanes = [Lane(lanelet, known) for lanelet in lanelets]
    narrowed = set()
    for _ in range(MOST_CLIPS):
        code, words, _ = interplay(program, "check", scenario(lanes))
        too_wide = re.search(r"lane `(\w+)` is [\d.]+ m wide where it turns.*?less than ([\d.]+) m works", words)
        if code == 0 or not too_wide:
            break
        narrowed.add(too_wide[1])
        lane = next(lane for lane in lanes if lane.name == too_wide[1])
        lane.widths = [min(width, MARGIN * float(too_wide[2])) for width in lane.widths]
    if code != 0:
        return f"{path.stem:28} {len(lanes):3} lanes: refused: {words[:300]}"
    code, words, out = interplay(program, "run", scenario(lanes))
    drives = "drives" if code == 0 else f"does not drive: {words or out}"
    return f"{path.stem:28} {len(lanes):3} lanes: holds, {len(narrowed)} made narrower, {drives}"


def main():
    folder, program = Path(sys.argv[1]), (sys.argv[2:] or ["interplay"])[0]
    for path in sorted(folder.glob("*.xml")):
        print(report(path, program), flush=True)


if __name__ == "__main__":
    main()

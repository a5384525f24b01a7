"""Our on-ramp beside SUMO's: lowest speed, vehicles that stand, lost time and flow, with the same road and demand.

    pip install eclipse-sumo
    python tests/peers/sumo_ramp.py [--binary target/release/interplay] [--seconds 120] [--drivers idm people mixed]

Two lanes, an acceleration lane of 180 m, and a ramp on which curves permit 15.5 m/s; 1,500 + 500 and 2,000 + 700 vehicles an hour with
exponential headways of at least 1 s, a tenth of them lorries. SUMO drives its default drivers (Krauss, LC2013), and ours drive what
`--drivers` names. Lost time is the share by which a vehicle is slower than it wants to be. Ends well with a word where SUMO is missing.
"""

import argparse
import csv
import json
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
from pathlib import Path

DEMANDS = [(1500, 500), (2000, 700)]
PEOPLE = [("nice", 0.3), ("considerate", 0.2), ("normal", 0.2), ("assertive", 0.1), ("tough", 0.1)]
STANDS_MPS = 1.0


def mix_of(drivers: str, mps: float) -> str:
    """The sorts of vehicles of a flow that come with a speed, a tenth of them lorries."""
    human = lambda style: f'{{ kind = "human", style = "{style}" }}'
    idm = '{ kind = "idm" }'
    sorts = [(0.9, idm)] if drivers == "idm" else [(share, human(style)) for style, share in PEOPLE]
    if drivers == "mixed":
        sorts[0] = (sorts[0][0], idm)
    lorry = human("normal") if drivers == "people" else idm
    truck = f'class = "truck", goal = {{ speed_mps = 21.0 }}, driver = {lorry}'
    rows = [f"{{ share = 0.1, speed_mps = {min(mps, 21.0)}, vehicle = {{ {truck} }} }}"]
    return ", ".join(rows + [f"{{ share = {share}, vehicle = {{ driver = {driver} }} }}" for share, driver in sorts])


def scenario(drivers: str, main_per_h: int, ramp_per_h: int, seconds: float) -> str:
    def flow(name: str, per_h: int, lanes: str, mps: float) -> str:
        head = f'[[flow]]\nname = "{name}"\nvehicles_per_h = {per_h}\nfrom = {lanes}\nalong_m = 5.0\nspeed_mps = {mps}\n'
        return f"{head}vehicle = {{ goal = {{ speed_mps = 25.0 }} }}\nmix = [{mix_of(drivers, mps)}]\n"

    return (
        f'title = "A ramp"\nshows = "Two flows merge"\nduration_s = {seconds}\n'
        'budget = { plans = 100_000_000, steps = 1_000_000_000 }\nroad = { kind = "on-ramp" }\ndefaults = { class = "car" }\n'
        + flow("main", main_per_h, '["main-0", "main-1"]', 25.0)
        + flow("ramp", ramp_per_h, '["ramp"]', 15.0)
        + 'to = [{ lane = "main-0", share = 1.0 }]\n'
        + '[[detector]]\nname = "behind"\nlanes = ["main-0", "main-1"]\nalong_m = 480.0\n'
    )


def run_ours(binary: Path, folder: Path, drivers: str, demand, seconds: float):
    """Rows (is on the ramp, lowest speed, share of time lost), vehicles that passed the detector, and contacts."""
    (folder / "ramp.toml").write_text(scenario(drivers, *demand, seconds))
    counts = folder / "counts.csv"
    command = [binary, "run", folder / "ramp.toml", "--no-record", "--json", "--detectors", counts]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        sys.exit(done.stderr)
    report = json.loads(done.stdout)
    driven = [one for one in report["vehicles"] if one.get("min_speed_mps") is not None]
    rows = [(one["name"].startswith("ramp"), one["min_speed_mps"], 1 - (one["wanted_speed_share"] or 1)) for one in driven]
    passed = sum(int(row["vehicles"]) for row in csv.DictReader(counts.open()) if row["lane"].startswith("main"))
    return rows, passed, len(report["collisions"])


def run_sumo(folder: Path, demand, seconds: float):
    """The same of SUMO."""
    write = lambda name, text: (folder / name).write_text(text)
    node = lambda name, x, y: f'<node id="{name}" x="{x}" y="{y}"/>'
    write("n.xml", "<nodes>" + node("a", -200, 0) + node("b", 0, 0) + node("c", 180, 0) + node("d", 480, 0) + node("r", -140, -50) + "</nodes>")
    edge = lambda name, ends, lanes, mps: f'<edge id="{name}" from="{ends[0]}" to="{ends[1]}" numLanes="{lanes}" speed="{mps}"/>'
    write("e.xml", "<edges>" + edge("main", "ab", 2, 27.8) + edge("join", "bc", 3, 27.8) + edge("out", "cd", 2, 27.8) + edge("ramp", "rb", 1, 15.5) + "</edges>")
    link = lambda a, b, i, j: f'<connection from="{a}" to="{b}" fromLane="{i}" toLane="{j}"/>'
    links = [("ramp", "join", 0, 0), ("main", "join", 0, 1), ("main", "join", 1, 2), ("join", "out", 1, 0), ("join", "out", 2, 1)]
    write("c.xml", "<connections>" + "".join(link(*one) for one in links) + "</connections>")
    sorts = '<vType id="lorry" vClass="truck" length="12" maxSpeed="21" probability="0.1"/><vType id="car" length="4.5" maxSpeed="25" probability="0.9"/>'
    flow = lambda name, per_h, lane, mps: (
        f'<flow id="{name}" type="all" route="{name}" begin="0" end="{seconds}" period="exp({per_h / 3600})" departLane="{lane}" departSpeed="{mps}"/>'
    )
    routes = '<route id="main" edges="main join out"/><route id="ramp" edges="ramp join out"/>'
    write("r.xml", f'<routes><vTypeDistribution id="all">{sorts}</vTypeDistribution>{routes}'
          + flow("main", demand[0], "random", "max") + flow("ramp", demand[1], "0", "max") + "</routes>")
    loops = "".join(f'<inductionLoop id="d{lane}" lane="out_{lane}" pos="100" period="{seconds}" file="loops.xml"/>' for lane in (0, 1))
    write("d.xml", f"<additional>{loops}</additional>")
    quietly = {"cwd": folder, "check": True, "capture_output": True}
    tool = lambda name: shutil.which(name) or str(Path(__import__("sumo").SUMO_HOME) / "bin" / name)
    subprocess.run([tool("netconvert"), "-n", "n.xml", "-e", "e.xml", "-x", "c.xml", "-o", "net.xml"], **quietly)
    subprocess.run([tool("sumo"), "-n", "net.xml", "-r", "r.xml", "-a", "d.xml", "--end", str(seconds), "--seed", "1", "--step-length", "0.1",
                    "--tripinfo-output", "trips.xml", "--tripinfo-output.write-unfinished", "--fcd-output", "fcd.xml",
                    "--collision.action", "warn", "--collision-output", "hits.xml"], **quietly)
    lowest = {}
    for _, element in ET.iterparse(folder / "fcd.xml"):
        if element.tag == "vehicle":
            name = element.get("id")
            lowest[name] = min(lowest.get(name, 99.0), float(element.get("speed")))
        element.clear()
    trips = ET.parse(folder / "trips.xml").getroot()
    lost = {one.get("id"): float(one.get("timeLoss")) / max(float(one.get("duration")), 1e-3) for one in trips}
    rows = [(name.startswith("ramp"), mps, lost.get(name, 0.0)) for name, mps in lowest.items()]
    passed = sum(int(one.get("nVehContrib")) for one in ET.parse(folder / "loops.xml").getroot())
    hits = len(ET.parse(folder / "hits.xml").getroot()) if (folder / "hits.xml").exists() else 0
    return rows, passed, hits


def line(name: str, demand, seconds: float, result) -> str:
    rows, passed, contacts = result
    cells = []
    for is_ramp in (False, True):
        some = [row for row in rows if row[0] == is_ramp] or [(is_ramp, 0.0, 0.0)]
        stand = sum(mps < STANDS_MPS for _, mps, _ in some)
        cells += [f"{min(mps for _, mps, _ in some):.1f}", f"{stand} of {len(some)}", f"{100 * sum(lost for *_, lost in some) / len(some):.0f} %"]
    return f"| {demand[0]} + {demand[1]} | {name} | " + " | ".join(cells) + f" | {3600 * passed / seconds:.0f} | {contacts} |"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", type=Path, default=Path("target/release/interplay"))
    parser.add_argument("--seconds", type=float, default=120.0)
    parser.add_argument("--drivers", nargs="*", default=["idm", "people", "mixed"])
    options = parser.parse_args()
    if shutil.which("sumo") is None:
        try:
            import sumo  # noqa: F401
        except ImportError:
            print("skipped: SUMO is not installed (pip install eclipse-sumo)")
            return 0
    print(f"{options.seconds:.0f} s each; speeds in m/s, flow 100 m behind the acceleration lane in vehicles an hour\n")
    print("| demand | drivers | main: lowest | stand | lost | ramp: lowest | stand | lost | flow | contacts |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for demand in DEMANDS:
        with tempfile.TemporaryDirectory() as folder:
            print(line("SUMO", demand, options.seconds, run_sumo(Path(folder), demand, options.seconds)), flush=True)
        for drivers in options.drivers:
            with tempfile.TemporaryDirectory() as folder:
                ours = run_ours(options.binary.resolve(), Path(folder), drivers, demand, options.seconds)
                print(line(drivers, demand, options.seconds, ours), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())

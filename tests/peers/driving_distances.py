"""How far simulated traffic is from recorded traffic: gaps, braking and lane changes of drivers on the roads, and from the starts, of records.

    python tests/peers/driving_distances.py FOLDER [--program INTERPLAY] [--drivers human:measured,human:normal,idm] [--scenes 6] [--seed 1]

FOLDER is a site as `recorded_sites.py --keep` writes it. Of its scenes some are drawn by the seed; in each, every record is replaced by a driver,
which starts where the record does. The runs are exported to CommonRoad's format, read again, and counted by the same code as the records
(`interplay predict --driving`). Without scenes the script says that it skips.
"""

import argparse
import random
import re
import subprocess
import sys
import tempfile
from pathlib import Path

LEAST_VEHICLES = 8


def simulated(program, path, driver, folder, number):
    """Drives a scene with drivers in place of its records, and writes it as a scene with a name of its own."""
    with tempfile.TemporaryDirectory() as scratch:
        words = [program, "import", str(path), "--out", f"{scratch}/scene.toml", "--replace", f"all={driver}"]
        if subprocess.run(words, capture_output=True).returncode != 0:
            return False
        words = [program, "run", f"{scratch}/scene.toml", "--no-record", "--export", f"{scratch}/driven.xml"]
        try:
            subprocess.run(words, capture_output=True, timeout=600, cwd=scratch)
        except subprocess.TimeoutExpired:
            return False
        driven = Path(scratch, "driven.xml")
        if not driven.exists():
            return False
        # Windows of one recording would be joined by their names.
        text = re.sub(r'benchmarkID="[^"]*"', f'benchmarkID="ZAM_Simulated-{number}_1_T-1"', driven.read_text(), count=1)
        Path(folder, f"{number:03}.xml").write_text(text)
        return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder")
    parser.add_argument("--program", default="interplay")
    parser.add_argument("--drivers", default="human:measured,human:normal,idm")
    parser.add_argument("--scenes", type=int, default=6)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    found = [path for path in sorted(Path(options.folder).glob("*.xml")) if path.read_bytes().count(b"<dynamicObstacle") >= LEAST_VEHICLES]
    if not found:
        print(f"skipped: no recorded scenes in {options.folder}")
        return
    drawn = random.Random(options.seed).sample(found, len(found))
    with tempfile.TemporaryDirectory() as scratch:
        groups = [options.folder]
        for driver in options.drivers.split(","):
            group = Path(scratch, driver.replace(":", "-"))
            group.mkdir()
            count = 0
            for path in drawn:
                count += simulated(options.program, path, driver, group, count)
                if count == options.scenes:
                    break
            print(f"{driver}: {count} scenes", file=sys.stderr, flush=True)
            groups += [str(group)] if count else []
        print(subprocess.run([options.program, "predict", *groups, "--driving"], capture_output=True, text=True).stdout)


if __name__ == "__main__":
    main()

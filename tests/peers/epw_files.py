"""Weather files of public repositories: read as pvlib reads them, or refused with a line.

    pip install pvlib
    python3 tests/peers/epw_files.py FOLDER_OR_FILE ... [--table OUT.md]

The files are not part of the project: their licences differ. `FOLDER` holds `.epw` files at any depth; those that `MANIFEST` below names
come from the repositories there (`git show HEAD:PATH > FILE`). Of each file the number of rows, the mean temperature and the year's sum
of global radiation are compared with pvlib's reader, where that reads it. Skips, and says so, without files or pvlib.
"""
import json
import os
import subprocess
import sys
from pathlib import Path

try:
    import pvlib
except ImportError as error:
    print(f"skipped: {error}; pip install pvlib")
    sys.exit(0)

# INTERPLAY_WEATHER names the built example, which saves a start of cargo for each file.
PROGRAM = os.environ.get("INTERPLAY_WEATHER", "").split() or [
    "cargo", "run", "--quiet", "--release", "-p", "interplay-building", "--example", "weather", "--"]
MANIFEST = {
    "architecture-building-systems/CityEnergyAnalyst": "cea/databases/weather/*.epw",
    "ugr-sail/sinergym": "sinergym/data/weather/*.epw",
    "ladybug-tools/ladybug": "tests/assets/epw/*.epw",
}


def theirs(file):
    try:
        with open(file, encoding="latin-1") as text:
            data, place = pvlib.iotools.read_epw(text)
    except Exception as error:  # The failures of their reader are listed beside ours.
        return None, f"{type(error).__name__}: {error}"
    return data, place


def judged(file):
    found = json.loads(subprocess.run(PROGRAM + ["read", str(file)], capture_output=True, text=True, check=True).stdout)
    data, place = theirs(file)
    if "refused" in found:
        return found, f"refused: {found['refused']}", "pvlib: " + (place if data is None else f"{len(data)} rows")
    if data is None:
        return found, "read", f"pvlib: {place}"
    temperature, sun = data["temp_air"], data["ghi"]
    differences = []
    if len(data) != found["rows"]:
        differences.append(f"{len(data)} rows")
    missing = (temperature >= 99.9).any() or (sun >= 9999).any() or (temperature < -70).any()
    if not missing and found["refused_in_use"] is None:
        if abs(temperature.mean() - found["mean_c"]) > 1e-3:
            differences.append(f"mean {temperature.mean():.3f} °C")
        hours = 8760 / len(data) if len(data) > 8784 else 1.0
        if abs(sun.sum() * hours / 1000 - found["sun_kwh_per_m2"]) > 0.05:
            differences.append(f"sun {sun.sum() / 1000:.1f} kWh/m²")
    used = found["refused_in_use"]
    return found, f"read; a year's run is refused: {used}; one in February: {found['february']}" if used else "read", "differs: " + ", ".join(differences) if differences else "the same"


def main():
    words = [word for word in sys.argv[1:] if word != "--table"]
    table = words.pop() if "--table" in sys.argv else None
    files = []
    for word in map(Path, words):
        files += sorted(word.rglob("*.epw")) if word.is_dir() else [word]
    if not files:
        print("skipped: no weather file is named; they come from " + ", ".join(MANIFEST))
        sys.exit(0)
    lines = ["| file | latitude | time zone | rows | mean [°C] | sun [kWh/m²] | verdict | pvlib | remarks |", "|---|---|---|---|---|---|---|---|---|"]
    wrong = 0
    for file in files:
        found, verdict, beside = judged(file)
        wrong += beside.startswith("differs")
        if "refused" in found:
            lines.append(f"| {file.name} | | | | | | {verdict} | {beside} | |")
            continue
        remarks = "; ".join(found["remarks"])
        lines.append(
            f"| {file.name} | {found['latitude_deg']:.2f} | {found['time_zone_h']:g} | {found['rows']} | {found['mean_c']:.2f} | "
            f"{found['sun_kwh_per_m2']:.0f} | {verdict} | {beside} | {remarks} |")
    text = "\n".join(lines)
    print(text)
    if table:
        Path(table).write_text(text + "\n")
    print(f"{len(files)} files, {wrong} read otherwise than by pvlib")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()

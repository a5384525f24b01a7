#!/usr/bin/env python3
"""How long `interplay check` takes for scenarios with wrong numbers in them: accepted or refused, it must be quick.

    tests/faults/check_times.py COUNT SEED [INTERPLAY]

Each is an authored scenario in which one to four numbers are multiplied by up to a million, or by as little as a millionth. Prints the share below
a second of processor time, and the slowest ones. Exits with 1 if less than 99 % are below a second, or one takes 10 s.
"""

import pathlib
import random
import re
import resource
import subprocess
import sys
import tempfile

SCENARIOS = pathlib.Path(__file__).resolve().parents[2] / "scenarios/files"
NUMBER = re.compile(r"(?<![\w.\"-])-?\d+\.?\d*(?![\w.\"])")
USUAL_S, LONGEST_S, USUAL_SHARE = 1.0, 10.0, 0.99


def spoilt(text, draw):
    """A text in which a few numbers are others."""
    places = [place for place in NUMBER.finditer(text) if not text[: place.start()].rsplit("\n", 1)[-1].startswith("#")]
    for place in sorted(draw.sample(places, min(len(places), draw.randint(1, 4))), key=lambda place: -place.start()):
        number = float(place[0]) * 10.0 ** draw.uniform(-6, 6)
        written = repr(number) if "." in place[0] else str(int(number))
        text = text[: place.start()] + written + text[place.end() :]
    return text


def main():
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    interplay = sys.argv[3] if len(sys.argv) > 3 else "interplay"
    files = sorted(SCENARIOS.glob("*/*.toml"))
    draw = random.Random(seed)
    times, codes = [], {}
    with tempfile.TemporaryDirectory() as folder:
        mine = pathlib.Path(folder, "mine.toml")
        for number in range(count):
            file = draw.choice(files)
            text = spoilt(file.read_text(), draw)
            text = re.sub(r'(?m)^extends = "(.*\.toml)"', lambda link: f'extends = "{file.parent.joinpath(link[1])}"', text)
            mine.write_text(text)
            before = resource.getrusage(resource.RUSAGE_CHILDREN)
            code = subprocess.run([interplay, "check", mine], capture_output=True, check=False).returncode
            after = resource.getrusage(resource.RUSAGE_CHILDREN)
            used_s = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
            codes[code] = codes.get(code, 0) + 1
            times.append((used_s, file.name, number))
            if used_s > USUAL_S:
                pathlib.Path(tempfile.gettempdir(), f"slow-check-{number}.toml").write_text(text)
    quick = sum(used_s < USUAL_S for used_s, *_ in times)
    print(f"{quick} of {count} below {USUAL_S:.0f} s of processor time; exit codes {codes}")
    for used_s, name, number in sorted(times, reverse=True)[:5]:
        print(f"  {used_s:.2f} s: number {number}, of {name}")
    if quick < USUAL_SHARE * count or max(times)[0] > LONGEST_S or set(codes) - {0, 2}:
        sys.exit(1)


main()

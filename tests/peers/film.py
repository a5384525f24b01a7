"""Are the films of `--animate FILE.mp4` films? A real ffmpeg encodes and decodes them.

    pip install imageio-ffmpeg numpy
    python tests/peers/film.py [--binary target/release/interplay]

For each scenario the film must have the size of the GIF of the same run, last as long to a tenth of a second, and its
first and last pictures must differ from those of the GIF by less than 4 of 255 on average. Prints a table; exits with 1
if a film differs, and with 0 and a word where ffmpeg is missing.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

SCENARIOS = ["lane-change/front-nice", "intersection/nice", "on-ramp/five", "crash/side-impact", "building/four-room-ilc"]
LARGEST_DIFFERENCE = 4.0


def pictures(ffmpeg: str, file: Path, numpy):
    """Size, seconds, and the first and last picture of a film or GIF."""
    probe = subprocess.run([ffmpeg, "-i", file], capture_output=True, text=True).stderr
    size = next(part for line in probe.splitlines() if "Video:" in line for part in line.replace(",", " ").split()
                if "x" in part and part.replace("x", "").isdigit())
    width, height = map(int, size.split("x"))
    raw = subprocess.run([ffmpeg, "-loglevel", "error", "-i", file, "-f", "rawvideo", "-pix_fmt", "rgb24", "-r", "10", "-"],
                         capture_output=True, check=True).stdout
    count = len(raw) // (width * height * 3)
    frames = numpy.frombuffer(raw, dtype=numpy.uint8).reshape(count, height, width, 3)
    return (width, height), count / 10.0, frames[0].astype(float), frames[-1].astype(float)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", default="target/release/interplay")
    binary = Path(parser.parse_args().binary).resolve()
    try:
        import imageio_ffmpeg
        import numpy
    except ImportError:
        print("skipped: no imageio-ffmpeg or numpy here")
        return 0
    ffmpeg = imageio_ffmpeg.get_ffmpeg_exe()
    print(subprocess.run([ffmpeg, "-version"], capture_output=True, text=True).stdout.splitlines()[0])
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(ffmpeg, Path(folder, "ffmpeg"))
        environment = {**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"}
        print("| scenario | size | film s | GIF s | film MB | first differs by | last differs by |\n|---|---|---|---|---|---|---|")
        for scenario in SCENARIOS:
            film, gif = Path(folder, "film.mp4"), Path(folder, "film.gif")
            for file in (film, gif):
                subprocess.run([binary, "run", scenario, "--no-record", "--animate", file], env=environment, check=True,
                               capture_output=True, cwd=folder)
            size, film_s, *ends = pictures(ffmpeg, film, numpy)
            gif_size, gif_s, *gif_ends = pictures(ffmpeg, gif, numpy)
            differences = [float(abs(a - b).mean()) for a, b in zip(ends, gif_ends)] if size == gif_size else [255.0] * 2
            print(f"| {scenario} | {size[0]} × {size[1]} | {film_s:.1f} | {gif_s:.1f} | {film.stat().st_size / 1e6:.2f} "
                  f"| {differences[0]:.1f} | {differences[1]:.1f} |")
            good = size == gif_size and abs(film_s - gif_s) <= 0.1 + 1e-9 and max(differences) < LARGEST_DIFFERENCE
            failures += not good
            film.unlink()
            gif.unlink()
    print("all films are as their GIFs" if failures == 0 else f"{failures} films differ")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Sums the compiler seconds of a build by group of crates, as in docs/evidence/benchmarks.md.

    cargo build --release --timings && tests/build_times.py target/cargo-timings/cargo-timing.html
"""

import collections
import json
import re
import sys

# The first group that has a pattern for a crate counts.
GROUPS = {
    "our own": r"interplay.*",
    "Rerun": r"re_.*|mcap|cros-codecs|prost-reflect|quiver.*|h264-reader|binrw.*|ply-rs-bw|puffin|zstd.*|lz4.*|fixed|ndarray",
    "Arrow": r"arrow.*|flatbuffers|comfy-table|half|lexical.*",
    "Bevy": r"bevy.*",
    "physics and numerics": r"rapier2d|parry2d|nalgebra.*|simba|clarabel|glam.*|wide|safe_arch|matrixmultiply|spade|amd|rust.?fft",
    "image and plot": r"image|moxcms|pxfm|tiff|png|jpeg-decoder|zune.*|plotters.*|ttf-parser|ab_glyph.*|owned_ttf_parser|weezl"
    r"|fdeflate|miniz_oxide|color_quant",
    "gRPC and TLS": r"rustls.*|ring|tonic.*|h2|hyper.*|http.*|prost.*|tokio.*|tower.*|opentelemetry.*|tracing.*|futures.*"
    r"|webpki.*",
}


def group(crate):
    return next((name for name, pattern in GROUPS.items() if re.fullmatch(pattern, crate)), "other")


def main(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    units = json.loads(re.search(r"UNIT_DATA = (\[.*?\]);", text, re.S).group(1))
    seconds, count = collections.Counter(), collections.Counter()
    for unit in units:
        seconds[group(unit["name"])] += unit["duration"]
        count[group(unit["name"])] += 1
    print("| group | units | compiler seconds |\n|---|---|---|")
    for name, total in seconds.most_common():
        print(f"| {name} | {count[name]} | {total:.0f} |")
    wall = max(unit["start"] + unit["duration"] for unit in units)
    print(f"| all | {len(units)} | {sum(seconds.values()):.0f} |\n\nwall time {wall:.0f} s")


if __name__ == "__main__":
    main(sys.argv[1])

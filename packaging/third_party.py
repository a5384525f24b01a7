#!/usr/bin/env python3
"""Prints the licences of everything in the command, or with the word `python` in the package for Python, as Markdown: a table, then
each text once with its crates.

Exits with 1 if a crate states no licence.
"""

import pathlib
import re
import sys

from shipped import ROOT, is_own, product, shipped

NAMES = ("licen", "copying", "notice", "copyright", "unlicense")
# Archives of some crates have no licence text. Of what their manifests state, the first of these applies.
GENERAL = {"MIT": "LICENSE-MIT", "Apache-2.0": "LICENSE-APACHE"}


def texts(folder: pathlib.Path) -> list[str]:
    """The licence texts of a crate."""
    files = sorted(file for file in folder.iterdir() if file.is_file() and file.name.lower().startswith(NAMES))
    return ["\n".join(line.rstrip() for line in file.read_text("utf-8", "replace").strip().splitlines()) for file in files]


def general(package: dict) -> str:
    """The text of the licence that a crate states, for a crate whose archive has none."""
    known = [file for licence, file in GENERAL.items() if licence in (package["license"] or "")]
    if not known:
        sys.exit(f"{package['name']} has no licence text, and there is none here of `{package['license']}`")
    text = (ROOT / known[0]).read_text("utf-8").strip()
    authors = ", ".join(package["authors"]) or f"the authors of {package['repository'] or package['name']}"
    return re.sub(r"^Copyright \(c\).*$", lambda _: f"Copyright (c) {authors}", text, flags=re.MULTILINE)


def main() -> int:
    of = product()
    crates = [package for package in shipped(of) if not is_own(package)]
    unstated = [package["name"] for package in crates if not (package["license"] or package["license_file"])]
    if unstated:
        print(f"no licence is stated by {', '.join(unstated)}", file=sys.stderr)
        return 1
    print(f"# What is in the {'command' if of == 'command' else 'package'}\n\n{len(crates)} crates, the standard library of Rust (MIT OR Apache-2.0), and the font DejaVu Sans.\n")
    print("| crate | version | licence | source |\n|---|---|---|---|")
    by_text: dict[str, list[str]] = {}
    for package in crates:
        title = f"{package['name']} {package['version']}"
        licence = package["license"] or package["license_file"]
        print(f"| {package['name']} | {package['version']} | {licence} | {package['repository'] or ''} |")
        for text in texts(pathlib.Path(package["manifest_path"]).parent) or [general(package)]:
            by_text.setdefault(text, []).append(title)
    font = (ROOT / "assets/fonts/LICENSE-DejaVu").read_text("utf-8").strip()
    by_text.setdefault(font, []).append("DejaVu Sans")
    for text, titles in by_text.items():
        fence = "~~~~"
        print(f"\n## {', '.join(titles)}\n\n{fence}text\n{text}\n{fence}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

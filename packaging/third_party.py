#!/usr/bin/env python3
"""Prints the licences of everything in the command, as Markdown: a table, then each text once with its crates.

Exits with 1 if a crate states no licence.
"""

import pathlib
import sys

from shipped import ROOT, is_own, shipped

NAMES = ("licen", "copying", "notice", "copyright", "unlicense")
# A crate whose archive has no text of its own licence has the general one of the licence that it states.
FALLBACK = "the archive of this crate has no licence text; its manifest states the licence above"


def texts(folder: pathlib.Path) -> list[str]:
    """The licence texts of a crate."""
    files = sorted(file for file in folder.iterdir() if file.is_file() and file.name.lower().startswith(NAMES))
    return ["\n".join(line.rstrip() for line in file.read_text("utf-8", "replace").strip().splitlines()) for file in files]


def main() -> int:
    crates = [package for package in shipped() if not is_own(package)]
    unstated = [package["name"] for package in crates if not (package["license"] or package["license_file"])]
    if unstated:
        print(f"no licence is stated by {', '.join(unstated)}", file=sys.stderr)
        return 1
    print(f"# What is in the command\n\n{len(crates)} crates, and the font DejaVu Sans.\n")
    print("| crate | version | licence | source |\n|---|---|---|---|")
    by_text: dict[str, list[str]] = {}
    for package in crates:
        title = f"{package['name']} {package['version']}"
        licence = package["license"] or package["license_file"]
        print(f"| {package['name']} | {package['version']} | {licence} | {package['repository'] or ''} |")
        for text in texts(pathlib.Path(package["manifest_path"]).parent) or [f"{FALLBACK}: {licence}"]:
            by_text.setdefault(text, []).append(title)
    font = (ROOT / "assets/fonts/LICENSE-DejaVu").read_text("utf-8").strip()
    by_text.setdefault(font, []).append("DejaVu Sans")
    for text, titles in by_text.items():
        fence = "~~~~"
        print(f"\n## {', '.join(titles)}\n\n{fence}text\n{text}\n{fence}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

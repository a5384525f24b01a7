#!/usr/bin/env python3
"""Makes again what the documents show: animations, quoted output, and tables.

    python docs/make.py            the gallery, and each quoted output that is quoted whole
    python docs/make.py --slow     also the tables whose command prints a table with the same heading
    python docs/make.py --list     which commands there are, and nothing else

Run it at the root of a clone with `interplay` on the path. Each command runs in an empty folder that has the files of its page; commands
of cargo and Python run at the root. Afterwards `INTERPLAY_BLESS=1 cargo test --release -p interplay-tests drift` writes down what
was made by which version. A table whose command is "the commands of this page" is put together by hand from what these print, and one of
"versions that were not kept" cannot be made again.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MARK = re.compile(r"<!-- (output of|made by): (.*) -->\n")


def files_of(text, folder):
    """Writes the blocks of a page that are files."""
    for block in re.findall(r"```(?:toml|xml)\n(.*?)\n```", text, re.S):
        name = re.match(r"(?:# |<!-- )(\S+\.(?:toml|xml))", block)
        if name:
            path = Path(folder, name[1])
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(block + "\n")


def said(command, text):
    """The standard output of a command."""
    with tempfile.TemporaryDirectory() as folder:
        files_of(text, folder)
        where = folder if command.startswith("interplay ") else ROOT
        ended = subprocess.run(["sh", "-c", command], cwd=where, stdout=subprocess.PIPE, text=True, check=False)
        return ended.stdout


def table_in(output, heading):
    """The table of an output that has a heading; none if there is none."""
    lines = output.splitlines()
    if heading not in lines:
        return None
    first = lines.index(heading)
    rows = lines[first:]
    end = next((at for at, line in enumerate(rows) if not line.startswith("|")), len(rows))
    return "\n".join(rows[:end])


def made_again(text, kinds):
    """A page with what its marks show made again."""
    pieces, at = [], 0
    for mark in MARK.finditer(text):
        kind, command = mark[1], mark[2]
        if kind not in kinds or command.startswith(("the commands", "versions")):
            continue
        below = text[mark.end():]
        if kind == "output of":
            block = re.match(r"\n*```\w*\n(.*?)```", below, re.S)
            new = said(command, text[: mark.start()])
            # What is quoted in part is for people to choose again; the test says whether it still holds.
            whole = block and block[1].splitlines()[:1] == new.splitlines()[:1] and len(block[1].splitlines()) == len(new.splitlines())
        else:
            block = re.match(r"((?:\|.*\n)+)", below)
            new = table_in(said(command, text[: mark.start()]), below.split("\n", 1)[0])
            whole = new is not None
            new = new and new + "\n"
        print("made again" if whole else "left as it is", "-", command, file=sys.stderr)
        if whole:
            pieces.append(text[at : mark.end() + block.start(1)] + new)
            at = mark.end() + block.end(1)
    return "".join(pieces) + text[at:]


def main():
    pages = [*sorted(ROOT.glob("docs/**/*.md")), ROOT / "README.md"]
    if "--list" in sys.argv:
        for page in pages:
            for mark in MARK.finditer(page.read_text()):
                print(f"{page.relative_to(ROOT)}: {mark[1]} {mark[2]}")
        return
    subprocess.run(["sh", ROOT / "docs/gallery/make.sh"], check=True)
    kinds = ["output of", "made by"] if "--slow" in sys.argv else ["output of"]
    for page in pages:
        text = page.read_text()
        new = made_again(text, kinds)
        if new != text:
            page.write_text(new)


main()

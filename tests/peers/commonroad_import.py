"""Whether real scenarios of CommonRoad import, load and run: each distinct file of some folders, with counts by reason.

    python tests/peers/commonroad_import.py FOLDER... [--program INTERPLAY] [--seconds 120] [--most 1000]

FOLDER has files in the XML format of CommonRoad, versions 2018b and 2020a; for instance a checkout of CommonRoad/commonroad-io. A file
passes if `import`, `check` and `run` of what was imported end without an error and the XML as it is passes `check`. A file that is
refused is counted under one of the reasons of `commonroad_reasons.txt`, which were fixed beforehand; anything else, a panic above all,
is a failure. Without files the script says that it skips.
"""

import argparse
import collections
import hashlib
import re
import subprocess
import tempfile
from pathlib import Path

LISTED = Path(__file__).with_name("commonroad_reasons.txt").read_text().splitlines()
REASONS = dict(line.split(": ", 1) for line in LISTED if line and not line.startswith("#"))


def said(output):
    return " ".join(output.stderr.replace("│", " ").replace("×", " ").split())


def outcome(path, program, seconds):
    """In a word what became of a file, and the lines that its import printed."""

    def interplay(folder, *words):
        return subprocess.run([program, *words], cwd=folder, capture_output=True, text=True, timeout=seconds)

    with tempfile.TemporaryDirectory() as folder:
        try:
            imported = interplay(folder, "import", str(path.resolve()), "--out", "imported.toml")
            if imported.returncode == 2:
                words = said(imported)
                reason = next((name for name, pattern in REASONS.items() if re.search(pattern, words)), None)
                return (f"refused: {reason}" if reason else f"FAILED: refused for another reason: {words[:200]}"), []
            notes = imported.stdout.splitlines()[:-1]
            for words in [("check", "imported.toml"), ("check", str(path.resolve())), ("run", "imported.toml", "--no-record")]:
                done = imported if imported.returncode else interplay(folder, *words)
                if done.returncode:
                    return f"FAILED: {words[0]} ends with {done.returncode}: {said(done)[:300]}", notes
        except subprocess.TimeoutExpired as late:
            return f"FAILED: {late.cmd[1]} takes more than {seconds} s", []
    return "runs", notes


def files(folders):
    """Scenarios below some folders, each content once."""
    known = set()
    for path in sorted(path for folder in folders for path in Path(folder).rglob("*.xml")):
        content = path.read_bytes()
        digest = hashlib.sha256(content).digest()
        if b"<commonRoad" in content[:4096] and digest not in known:
            known.add(digest)
            yield path


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("folders", nargs="+")
    arguments.add_argument("--program", default="interplay")
    arguments.add_argument("--seconds", type=float, default=120)
    arguments.add_argument("--most", type=int, default=1000)
    asked = arguments.parse_args()
    found = list(files(asked.folders))[: asked.most]
    if not found:
        print("skipped: no scenario of CommonRoad below " + ", ".join(asked.folders))
        return
    counts, notes = collections.Counter(), collections.Counter()
    for path in found:
        result, lines = outcome(path, asked.program, asked.seconds)
        counts[result.split(" ends")[0].split(": refused for")[0]] += 1
        notes.update({re.sub(r"^\d+ |`[^`]*`|\([^)]*\)", "", line).strip() for line in lines})
        if result != "runs":
            print(f"{path.name:60} {result}", flush=True)
    print(f"\n{len(found)} distinct files")
    for result, count in counts.most_common():
        print(f"{count:6} {result}")
    print("\nfiles with each kind of line of the import")
    for note, count in notes.most_common():
        print(f"{count:6} {note}")


if __name__ == "__main__":
    main()

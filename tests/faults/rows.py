"""Rows of finished sweeps: journals and tables with spoilt bytes, for `compare`, `sweep merge`, and sweeps that go on."""

import contextlib
import functools
import json
import pathlib
import random
import shutil
import subprocess
import tempfile
from collections.abc import Iterator

import edits
from target import Commands, Target

PLAN = """scenario = ["intersection/nice"]
planner = ["idm", "conservative"]
samples = 2
jitter = { position_m = 0.1, speed_mps = 0.1 }
set = { duration_s = 1.0 }
"""
FILES = {"compare": "runs.parquet", "merge": "shard-2-of-2.parquet", "resume": "journal.jsonl", "rejoin": "journal-1-of-2.jsonl", "replan": "plan.toml"}
EDITS = ["flip", "flip", "flip", "zero", "cut", "double", "piece", "piece", "line", "number", "number", "swap"]


@functools.cache
def _made(binary: str) -> dict[str, dict[str, bytes]]:
    """The files of a sweep in one piece, and of one in two shards."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "plan.toml").write_text(PLAN)
        parts = [["--out", "whole"], ["--out", "parts", "--shard", "1/2"], ["--out", "parts", "--shard", "2/2"]]
        for part in parts:
            subprocess.run([binary, "sweep", "plan.toml", "--jobs", "1", *part], cwd=folder, capture_output=True, check=True)
        return {kind: {file.name: file.read_bytes() for file in sorted((folder / kind).iterdir())} for kind in ("whole", "parts")}


@functools.cache
def _compared(binary: str) -> str:
    """What `compare` says of the sweep in one piece."""
    with tempfile.TemporaryDirectory() as name:
        pathlib.Path(name, "runs.parquet").write_bytes(_made(binary)["whole"]["runs.parquet"])
        return subprocess.run([binary, "compare", "runs.parquet", "--json"], cwd=name, capture_output=True, check=True).stdout.decode()


def _figures(text: str) -> object:
    """The figures of a comparison without times of computing."""

    def without_times(value: object) -> object:
        if isinstance(value, dict):
            return {key: without_times(inner) for key, inner in value.items() if not key.endswith("_ms") and key != "versions"}
        return [without_times(inner) for inner in value] if isinstance(value, list) else value

    return without_times(json.loads(text[text.index("{") : text.rindex("}") + 1]))


def _edited(content: bytes, edit: list) -> bytes:
    """Bytes with one mistake."""
    kind, where, value, token = edit
    at = int(where * len(content))
    match kind:
        case "flip":
            return content[:at] + bytes([content[at] ^ (1 << value % 8)]) + content[at + 1 :] if content else content
        case "zero":
            return content[:at] + bytes(value) + content[at + value :]
        case "cut":
            return content[:at]
        case "double":
            return content + content[at:]
        case "piece":
            return content[:at] + token.encode("utf-8", "surrogateescape") + content[at:]
        case "swap":
            return content[at:] + content[:at]
    text, dice = content.decode("utf-8", "surrogateescape"), random.Random(value)
    text = edits.other_lines(text, text, dice) if kind == "line" else edits.other_number(text, dice)
    return text.encode("utf-8", "surrogateescape")


def _edit(dice: random.Random) -> list:
    # Most of a table that matters stands at its end.
    where = dice.random() if dice.random() < 0.6 else 1 - dice.random() * 0.2
    return [dice.choice(EDITS), round(where, 5), dice.randint(1, 64), dice.choice(edits.CELLS)]


def _spoil(text: str, _others: list[str], dice: random.Random) -> str:
    command, file, *parts = json.loads(text)
    if dice.random() < 0.7:
        command, parts = dice.choice(list(FILES)), []
        file = FILES[command]
    return json.dumps([command, file, *parts, *(_edit(dice) for _ in range(dice.choice([1, 1, 2])))])


def _targets_of(binary: str) -> Target:
    @contextlib.contextmanager
    def files_beside(folder: pathlib.Path, text: str) -> Iterator[None]:
        _, file, *parts = json.loads(text)
        for kind, files in _made(binary).items():
            (folder / kind).mkdir()
            for name, content in files.items():
                for edit in parts if name == file else []:
                    content = _edited(content, edit)
                (folder / kind / name).write_bytes(content)
        (folder / "plan.toml").write_text(PLAN)
        yield
        shutil.rmtree(folder / "whole", ignore_errors=True)

    def other_results(said: list[str]) -> str | None:
        """Whether a sweep that went on after its journal was spoilt has other results than the one that was not."""
        honest = _figures(_compared(binary))
        return "the sweep goes on to other results" if said[-1].lstrip().startswith("{") and _figures(said[-1]) != honest else None

    seeds = [json.dumps([command, file]) for command, file in FILES.items()]
    return Target("json", seeds, _spoil, _commands, beside=files_beside, may_refuse=frozenset(["compare"]), disagreement=other_results)


def _commands(text: str) -> Commands:
    match json.loads(text)[0]:
        case "compare":
            return ["compare", "whole/runs.parquet"], [["compare", "whole/runs.parquet", "--by", "scenario"]]
        case "merge":
            return ["sweep", "merge", "parts"], [["compare", "parts"]]
        case "rejoin":
            shard = ["sweep", "plan.toml", "--out", "parts", "--jobs", "1", "--shard", "1/2"]
            return shard, [["sweep", "merge", "parts"], ["compare", "parts", "--json"]]
        case "replan":
            return ["compare", "whole"], [["sweep", "plan.toml", "--out", "whole", "--jobs", "1"], ["compare", "whole", "--json"]]
    return ["sweep", "plan.toml", "--out", "whole", "--jobs", "1"], [["compare", "whole", "--json"]]


def targets(binary: str) -> dict[str, Target]:
    """Rows."""
    return {"journal": _targets_of(binary)}

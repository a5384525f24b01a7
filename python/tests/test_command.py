"""The command that comes with the package."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import interplay
from helpers import command

ENTRY = "import sys; sys.argv[0] = 'interplay'; import interplay_command; interplay_command.main()"


def entry(*arguments: str) -> subprocess.CompletedProcess[str]:
    """Calls the entry point as the script of the package does."""
    return subprocess.run([sys.executable, "-c", ENTRY, *arguments], capture_output=True, text=True, timeout=120)


@pytest.mark.parametrize("arguments", [("list",), ("run", "intersection/nice", "--no-record"), ("--version",), ("run", "no-such/thing")])
def test_the_module_says_what_the_entry_point_says(arguments: tuple[str, ...]) -> None:
    one, other = entry(*arguments), command(*arguments)
    assert one.returncode == other.returncode
    assert one.stderr == other.stderr
    if arguments[0] != "run":
        assert one.stdout == other.stdout
    assert "Traceback" not in one.stderr


@pytest.mark.parametrize(
    "code, arguments",
    [
        (0, ("list",)),
        (0, ("run", "intersection/nice", "--no-record")),
        (1, ("run", "lane-change/front-nice", "--planner", "idm", "--set", "vehicle.ego.goal.speed_mps=0.5", "--no-record", "--json")),
        (2, ("run", "no-such/thing")),
        (2, ("run", "--colour")),
        (3, ("run", "intersection/nice", "--record", "file/run.rrd")),
    ],
)
def test_exit_codes_are_those_of_the_command(code: int, arguments: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    monkeypatch.setenv("PYTHONPATH", str(Path(interplay.__file__).parent.parent))
    monkeypatch.chdir(tmp_path)
    found = entry(*arguments)
    assert found.returncode == code, found.stderr
    assert "Traceback" not in found.stderr


@pytest.mark.xfail(strict=True, reason="it names the interpreter")
def test_the_command_calls_itself_by_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    found = entry("run", "intersection/nice", "--record", str(tmp_path / "run.rrd"))
    assert "interplay view" in found.stderr


def test_the_version_is_that_of_the_package() -> None:
    assert interplay.__version__ in entry("--version").stdout


def test_the_command_loads_neither_numpy_nor_gymnasium() -> None:
    words = [sys.executable, "-X", "importtime", "-c", ENTRY, "run", "intersection/nice", "--no-record", "--json"]
    found = subprocess.run(words, capture_output=True, text=True, timeout=120)
    assert found.returncode == 0
    loaded = {line.split("|")[-1].strip().split(".")[0] for line in found.stderr.splitlines() if line.startswith("import time")}
    assert "interplay" in loaded
    assert not loaded & {"numpy", "gymnasium", "pettingzoo", "pandas", "torch", "stable_baselines3"}
    assert json.loads(found.stdout)["passed"] is True


def test_the_environments_do_not_need_what_is_not_installed() -> None:
    words = "import sys; sys.modules['gymnasium'] = None; import interplay; print(interplay.run('intersection/nice').passed)"
    found = subprocess.run([sys.executable, "-c", words], capture_output=True, text=True, timeout=120)
    assert found.stdout.strip() == "True", found.stderr


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_an_interrupt_ends_the_command(tmp_path: Path) -> None:
    words = [sys.executable, "-c", ENTRY, "sweep", "perturbed-starts", "--out", str(tmp_path / "rows")]
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    journal, deadline = tmp_path / "rows" / "journal.jsonl", time.monotonic() + 60
    while not (journal.exists() and journal.stat().st_size) and time.monotonic() < deadline:
        time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=20)
    assert process.returncode in (-signal.SIGINT, 130, 3), said
    assert "Traceback" not in said


@pytest.mark.skipif(os.name != "posix", reason="pipes of POSIX")
@pytest.mark.parametrize("start", [["-c", ENTRY], ["-m", "interplay"]], ids=["entry", "module"])
def test_a_reader_that_leaves_ends_the_command_quietly(start: list[str]) -> None:
    process = subprocess.Popen([sys.executable, *start, "list"], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout is not None and process.stderr is not None
    assert b"all-way-stop" in process.stdout.read(12)
    process.stdout.close()
    said = process.stderr.read().decode()
    process.wait(timeout=20)
    assert "Traceback" not in said and "panicked" not in said


def test_drivers_of_python_are_no_kind_of_the_command(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    found = command("run", "lane-change/front-nice", "--planner", "python", "--record", str(path))
    assert found.returncode == 2
    assert "negotiation" in found.stderr

"""Many runs from a plan, and what they say of the planners."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _native
from ._policies import Network, Registered, as_function
from ._spaces import needs

if TYPE_CHECKING:
    import pandas as pd


def _is_function(value: Any) -> bool:
    return callable(value) or hasattr(value, "function") or hasattr(value, "predict")


def _planners(planners: Any, functions: list[Registered]) -> list[Any]:
    """Planners of a plan, functions of Python as tables; ``functions`` gets those."""
    listed = planners if isinstance(planners, (list, tuple)) else [planners]
    found: list[Any] = []
    for planner in listed:
        if isinstance(planner, Mapping) and all(_is_function(value) for value in planner.values()):
            for name, function in planner.items():
                functions.append(Registered(name, as_function(function), is_of_sweep=True))
                driver = dict(functions[-1].settings)
                kind = driver.pop("kind")
                del driver["registration"]
                found.append({"name": name, "kind": kind, "set": {f"vehicle.ego.driver.{key}": value for key, value in driver.items()}})
        elif isinstance(planner, Network) or str(planner).endswith(".safetensors"):
            file = os.path.abspath(planner.file if isinstance(planner, Network) else planner)
            found.append({"name": Path(file).stem, "kind": "policy", "set": {"vehicle.ego.driver.file": file}})
        else:
            found.append(planner)
    return found


def sweep(
    plan: str | os.PathLike[str] | Mapping[str, Any],
    out: str | os.PathLike[str] | None = None,
    *,
    jobs: int | None = None,
    samples: int | None = None,
    keep_failures: bool = False,
) -> pd.DataFrame:
    """Runs a plan on all cores and returns its rows, those of ``runs.parquet``.

    ``plan`` is the name of a plan in the package, a path, or a dictionary with the keys of a plan, in which ``planner`` may hold
    functions of Python and networks: ``["negotiation", {"mine": function}, "net.safetensors"]``. A function's name and version enter the keys of its runs: what is
    in the folder ``out`` is not run again. Without ``out`` nothing is kept.
    """
    pd, _ = needs("pandas", "pandas"), needs("pyarrow", "pandas")
    if jobs is not None and not 0 <= jobs <= 1024:
        raise ValueError(f"`jobs` is from 0, one for each core, to 1024, and not {jobs}")
    text, functions = None, list[Registered]()
    if isinstance(plan, Mapping):
        written = dict(plan)
        if "planner" in written:
            written["planner"] = _planners(written["planner"], functions)
        if samples is not None:
            written["samples"] = samples
        text, plan = json.dumps(written), "the plan"
    with contextlib.ExitStack() as stack:
        passing = stack.enter_context(tempfile.TemporaryDirectory(ignore_cleanup_errors=True))
        for function in functions:
            stack.enter_context(function)
        folder = Path(passing) / "rows" if out is None else Path(out)
        table, _, unfinished = _native.sweep(os.fspath(plan), folder, text, jobs, samples, keep_failures)
        for function in functions:
            function.raise_failure()
        rows = pd.read_parquet(table)
    if unfinished:
        import warnings

        warnings.warn(f"{unfinished} runs could not be finished: see the column `error`", stacklevel=2)
    return rows


def compare(folder: str | os.PathLike[str], *arguments: str) -> Any:
    """What ``interplay compare FOLDER --json`` says of a folder of rows."""
    import sys

    words = [sys.executable, "-m", "interplay", "compare", os.fspath(folder), "--json", *arguments]
    said = subprocess.run(words, capture_output=True, text=True, check=False)
    if said.returncode:
        raise _native.RunError(said.stderr.strip())
    return json.loads(said.stdout)

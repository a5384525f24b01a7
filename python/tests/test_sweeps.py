"""Many runs from a plan."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import interplay
from helpers import refused
from interplay import PolicyFunction

pytest.importorskip("pandas")
pytest.importorskip("pyarrow")


def plan(*planners: Any, **keys: Any) -> dict[str, Any]:
    """Two short scenarios, with these planners."""
    return {"scenario": ["lane-change/front-nice", "intersection/nice"], "planner": list(planners), **keys}


def test_a_sweep_has_a_row_for_each_run(tmp_path: Path) -> None:
    rows = interplay.sweep(plan("idm", "conservative"), tmp_path / "rows")
    assert sorted(zip(rows["scenario"], rows["planner"])) == [
        ("intersection/nice", "conservative"),
        ("intersection/nice", "idm"),
        ("lane-change/front-nice", "conservative"),
        ("lane-change/front-nice", "idm"),
    ]
    assert rows["error"].isna().all()
    [row] = rows[(rows["scenario"] == "intersection/nice") & (rows["planner"] == "idm")].to_dict("records")
    assert row["digest"] == interplay.run("intersection/nice", "idm").digest
    assert (tmp_path / "rows" / "runs.parquet").exists()


def test_a_function_of_python_is_run_once_for_each_version(tmp_path: Path) -> None:
    calls = []

    def mine(seen: Any) -> Any:
        calls.append(1)
        return [0.0, 0.0]

    first = interplay.sweep(plan("idm", {"mine": PolicyFunction(mine, version="1")}), tmp_path)
    assert sorted(set(first["planner"])) == ["idm", "mine"]
    assert set(first[first["planner"] == "mine"]["plans_failed"]) == {0}
    made = len(calls)
    assert made > 100
    again = interplay.sweep(plan("idm", {"mine": PolicyFunction(mine, version="1")}), tmp_path)
    assert len(calls) == made
    assert again.equals(first)
    newer = interplay.sweep(plan("idm", {"mine": PolicyFunction(mine, version="2")}), tmp_path)
    assert len(calls) == 2 * made
    mine_first, mine_newer = (rows[rows["planner"] == "mine"] for rows in (first, newer))
    assert not set(mine_first["key"]) & set(mine_newer["key"])
    assert set(mine_first["digest"]) == set(mine_newer["digest"]) & set(mine_first["digest"])
    assert set(first[first["planner"] == "idm"]["key"]) <= set(newer["key"])


def test_starts_vary_and_are_counted(tmp_path: Path) -> None:
    varied = plan("idm", vary={"vehicle.ego.start.speed_mps": {"uniform": [0.9, 1.1]}})
    rows = interplay.sweep(varied, tmp_path, samples=3, jobs=1)
    assert len(rows) == 6
    assert len(set(rows["digest"])) == 6


def test_a_folder_of_rows_is_compared(tmp_path: Path) -> None:
    interplay.sweep(plan("idm", "conservative"), tmp_path)
    found = interplay.compare(tmp_path)
    assert found["runs"] == 4
    assert {planner["planner"] for group in found["groups"] for planner in group["planners"]} == {"idm", "conservative"}
    assert "no rows" in refused(lambda: interplay.compare(tmp_path / "nothing"), interplay.RunError)


def test_what_a_function_raises_in_a_sweep_is_raised(tmp_path: Path) -> None:
    def broken(seen: Any) -> Any:
        raise KeyError("the weights are missing")

    assert "weights" in refused(lambda: interplay.sweep(plan({"mine": broken}), tmp_path), KeyError)


def test_a_plan_that_means_nothing_is_refused(tmp_path: Path) -> None:
    for bad in ({"scenario": ["no-such/thing"]}, {"colour": 1}, plan("magic"), plan("idm", samples=-1)):
        assert refused(lambda bad=bad: interplay.sweep(bad, tmp_path / "rows"))  # type: ignore[misc]
    with pytest.raises(interplay.ScenarioError) as caught:
        interplay.sweep({"scenario": ["no-such/thing"]}, tmp_path / "rows")
    assert caught.value.key == "scenario"
    refused(lambda: interplay.sweep("no-such-plan"), interplay.ScenarioError)
    assert not (tmp_path / "rows" / "runs.parquet").exists()


def test_a_plan_in_a_file_is_run(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('title = "Mine"\nscenario = ["intersection/nice"]\nplanner = ["idm"]\n', encoding="utf-8")
    assert list(interplay.sweep(path)["planner"]) == ["idm"]

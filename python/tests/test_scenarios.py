"""Scenarios: listed, loaded, changed, checked, refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import interplay

BROKEN = """extends = "lane-change/front-nice"

[[vehicle]]
name = "ego"
goal = { speed_mps = "fast" }
"""


def test_the_scenarios_of_the_package_are_listed() -> None:
    rows = interplay.list()
    assert len(rows) > 100
    names = [row.name for row in rows]
    assert names == sorted(set(names))
    assert all(row.title and row.shows for row in rows)
    assert any(row.figure for row in rows)


def test_a_scenario_says_what_it_is() -> None:
    scenario = interplay.load("lane-change/front-nice")
    assert scenario.name == scenario.source == "lane-change/front-nice"
    assert scenario.vehicles == ["ego", "front", "rear"]
    assert scenario.drivers == ["negotiation", "human", "human"]
    assert (scenario.duration_s, scenario.step_s, scenario.horizon_steps) == (12.0, 0.1, 30)
    assert not scenario.has_building
    assert "lane-change/front-nice" in repr(scenario)
    assert interplay.load("building/four-room-pid").has_building
    assert interplay.load(scenario) is scenario


def test_a_scenario_is_changed_by_path() -> None:
    for set in ({"duration_s": 5.0}, ["duration_s=5.0"], {"duration_s": np.float64(5)}, "duration_s=5"):
        assert interplay.load("lane-change/front-nice", set=set).duration_s == 5.0
    changed = interplay.load("lane-change/front-nice", set={"vehicle.ego.driver": {"kind": "idm", "headway_s": 2.0}}, seed=9)
    assert changed.drivers[0] == "idm"
    assert changed.seed == 9
    assert "headway_s = 2" in changed.to_toml()
    assert interplay.load("lane-change/front-nice", planner="conservative").drivers[0] == "conservative"
    with pytest.raises(TypeError, match="cannot hold"):
        interplay.load("lane-change/front-nice", set={"duration_s": object()})


def test_a_changed_scenario_keeps_its_changes() -> None:
    changed = interplay.load("lane-change/front-nice", set={"duration_s": 5.0})
    assert interplay.load(changed, seed=9).duration_s == 5.0
    assert interplay.run(changed, planner="idm").simulated_s == 5.0


def test_a_scenario_in_a_file_is_that_scenario(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(interplay.load("lane-change/front-nice").to_toml(), encoding="utf-8")
    mine = interplay.load(path)
    assert mine.name == "mine"
    assert mine.source == str(path)
    assert interplay.run(mine).digest == interplay.run("lane-change/front-nice").digest


def test_an_error_points_to_its_place(tmp_path: Path) -> None:
    path = tmp_path / "broken.toml"
    path.write_text(BROKEN, encoding="utf-8")
    with pytest.raises(interplay.ScenarioError) as caught:
        interplay.load(path)
    error = caught.value
    assert isinstance(error, ValueError)
    assert (error.file, error.line, error.column, error.key) == (str(path), 5, 22, "speed_mps")
    [(file, place, message, hint)] = error.faults
    assert (file, place) == (str(path), (5, 22))
    assert "must be a number" in message
    assert hint is not None and "speed" in hint
    assert str(error).startswith(f"{path}:5:22: ")
    assert BROKEN.splitlines()[4][21:].startswith('"fast"')


def test_all_faults_of_a_file_are_told(tmp_path: Path) -> None:
    path = tmp_path / "broken.toml"
    path.write_text('extends = "lane-change/front-nice"\nduration_s = -1\ncolour = 1\n', encoding="utf-8")
    with pytest.raises(interplay.ScenarioError) as caught:
        interplay.check(path)
    assert {place for _, place, _, _ in caught.value.faults} >= {(3, 1)}
    assert str(caught.value).count("\n") + 1 == len(caught.value.faults)


def test_a_scenario_that_is_not_there_has_no_place() -> None:
    with pytest.raises(interplay.ScenarioError, match="did you mean") as caught:
        interplay.load("lane-chang/front-nice")
    assert (caught.value.file, caught.value.line, caught.value.column, caught.value.key) == (None, None, None, None)


def test_a_check_returns_remarks() -> None:
    assert interplay.check("lane-change/front-nice") == []
    with pytest.raises(interplay.ScenarioError):
        interplay.check("lane-change/front-nice", set={"colour": 1})

"""Whole runs: reports, ticks, pictures, files, and thermal parameters from telemetry."""

from __future__ import annotations

import io
import json
import typing
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import interplay
from helpers import refused, report_of_command

#: A scenario of each family, and more of those with a building.
OF_EACH_FAMILY = list({row.name.split("/")[0]: row.name for row in reversed(interplay.list())}.values())
OTHERS = ["building/four-room-ilc", "building/distributed", "building/office-and-flat", "lane-change/front-nice"]
#: What differs from run to run.
CLOCKS = ("wall_s", "median_ms", "p99_ms", "design_s")


def timeless(report: Any) -> Any:
    """A report without what a clock on the wall said."""
    if isinstance(report, dict):
        return {name: timeless(value) for name, value in report.items() if name not in CLOCKS}
    return [timeless(value) for value in report] if isinstance(report, list) else report


@pytest.mark.parametrize("name", [*OF_EACH_FAMILY, *OTHERS])
def test_a_world_stepped_here_is_the_run_of_the_command(name: str) -> None:
    world = interplay.Simulation(name)
    while world.step():
        pass
    assert world.is_over
    stepped, said = world.finish(), report_of_command(name)
    assert stepped.digest == said["digest"]
    assert stepped.get("phase_digests") == said.get("phase_digests")
    if interplay.load(name).has_building:
        assert stepped.building.digests == said["building"]["digests"]
        assert stepped.building.digests


@pytest.mark.parametrize("name", ["lane-change/front-nice", "building/four-room-pid", "mixed/garage"])
def test_a_report_has_the_keys_of_the_command(name: str) -> None:
    report = interplay.run(name)
    assert timeless(report.to_dict()) == timeless(report_of_command(name))
    assert type(report.to_dict()) is dict
    assert report.scenario == name
    assert report["scenario"] == report.scenario
    assert report.passed is True
    assert "digest" in dir(report)
    assert "colour" in refused(lambda: report.colour, AttributeError)
    assert json.loads(json.dumps(report)) == report


def test_a_run_is_changed_as_the_command_changes_it() -> None:
    report = interplay.run("intersection/nice", "conservative", set={"vehicle.ego.goal.speed_mps": 1.1}, seed=5)
    said = report_of_command("intersection/nice", "--planner", "conservative", "--set", "vehicle.ego.goal.speed_mps=1.1", "--seed", "5")
    assert timeless(report) == timeless(said)
    assert report.seed == 5


def test_the_ticks_of_vehicles_are_arrays() -> None:
    report = interplay.run("lane-change/front-nice")
    frames = report.frames()
    assert frames.vehicles == ["ego", "front", "rear"]
    assert frames["time_s"].shape == (120,)
    assert frames["plan"].shape == (120, 3, 31, 4)
    for name in ("x_m", "y_m", "heading_rad", "speed_mps", "acceleration_mps2", "steering_rad", "urgency", "is_present"):
        assert frames[name].shape == (120, 3)
    assert frames.about["acceleration_mps2"] == ("m/s²", ("time", "vehicle"))
    assert frames.about.keys() == frames.keys()
    assert all(len(axes) == frames[name].ndim for name, (_, axes) in frames.about.items())
    assert np.allclose(np.diff(frames["time_s"]), 0.1)
    assert np.allclose(frames["plan"][0, :, 0, 0], frames["x_m"][0])
    assert frames["gap_m"].min() == pytest.approx(report.min_gap_m, abs=0.02)
    assert "plan (120, 3, 31, 4)" in repr(frames)


def test_the_steps_of_a_building_are_arrays() -> None:
    frames = interplay.run("building/four-room-pid").frames()
    count = len(frames["building_time_s"])
    assert count > 40
    for name in ("temperature_c", "next_c", "reference_c", "band_k", "requested_kw", "heat_kw", "gains_kw"):
        assert frames[name].shape == (count, 4)
        assert frames.about[name][1] == ("building_time", "zone")
    assert frames["ambient_c"].shape == frames["forecast_c"].shape == (count,)
    both = interplay.run("mixed/garage").frames()
    assert both["temperature_c"].shape[0] == both["building_time_s"].shape[0]
    assert both["x_m"].shape[0] == both["time_s"].shape[0]


def test_ticks_are_a_table() -> None:
    pytest.importorskip("pandas")
    table = interplay.run("lane-change/front-nice").to_pandas()
    assert len(table) == 360
    assert list(table["vehicle"][:3]) == ["ego", "front", "rear"]
    assert {"time_s", "x_m", "speed_mps"} <= set(table.columns)
    rooms = interplay.run("building/four-room-pid").to_pandas()
    assert {"time_s", "zone", "temperature_c"} <= set(rooms.columns)


def test_a_notebook_shows_the_moving_picture_and_the_summary() -> None:
    report = interplay.run("intersection/nice")
    html = report._repr_html_()
    assert 'src="data:image/webp;base64,UklGR' in html
    assert "Intersection, crossing driver nice" in html
    assert report.animation("gif").startswith(b"GIF89a")
    assert report.animation("png").startswith(b"\x89PNG")
    assert "bmp" in refused(lambda: report.animation("bmp"))
    assert "img" not in interplay.Report(report)._repr_html_()
    refused(interplay.Report(report).frames, interplay.RunError)


def test_a_run_writes_files(tmp_path: Path) -> None:
    paths = {"record": tmp_path / "run.rrd", "animate": tmp_path / "run.gif", "trajectories": tmp_path / "run.csv"}
    interplay.run("intersection/nice", **paths)  # type: ignore[arg-type]
    assert paths["record"].read_bytes().startswith(b"RRF2")
    assert paths["animate"].read_bytes().startswith(b"GIF")
    assert len(paths["trajectories"].read_text(encoding="utf-8").splitlines()) > 100
    refused(lambda: interplay.run("intersection/nice", animate=tmp_path / "run.doc"))
    assert "needs a `[[detector]]`" in refused(lambda: interplay.run("intersection/nice", detectors=tmp_path / "d.csv"))
    assert "cannot both be" in refused(
        lambda: interplay.run("intersection/nice", animate=tmp_path / "a.gif", record=tmp_path / "a.gif")
    )
    refused(lambda: interplay.run("intersection/nice", record=tmp_path / "no" / "\0"), interplay.RunError)


def test_a_run_writes_series_counts_and_a_scenario_of_commonroad(tmp_path: Path) -> None:
    series = tmp_path / "days.csv"
    interplay.run("building/four-room-pid", series=series)
    assert series.read_text(encoding="utf-8").startswith("time_s,day,step,outdoor_c")
    counts, export = tmp_path / "counts.csv", tmp_path / "driven.xml"
    detector = {"detector": [{"name": "gate", "lanes": [0], "along_m": 1.0, "interval_s": 5.0}]}
    interplay.run("lane-change/front-nice", set=detector, detectors=counts, export=export)
    assert counts.read_text(encoding="utf-8").startswith("detector,")
    assert "<commonRoad" in export.read_text(encoding="utf-8")
    assert (tmp_path / "driven.solution.xml").exists()


def test_a_run_never_overwrites_its_scenario(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text('extends = "intersection/nice"\n', encoding="utf-8")
    assert "would overwrite" in refused(lambda: interplay.run(path, record=path))
    assert path.read_text(encoding="utf-8") == 'extends = "intersection/nice"\n'


def test_who_is_driven_from_outside_cannot_be_in_a_run() -> None:
    assert "driven from outside" in refused(lambda: interplay.run("lane-change/front-nice", "external"))


def telemetry(days: float = 4.0) -> str:
    """A room of 2000 kJ/K behind 5 K/kW to outdoors, measured every half hour, as CSV."""
    capacity, resistance, step_s = 2000.0, 5.0, 1800.0
    random, inside, rows = np.random.default_rng(1), 18.0, ["time_s,inside,outside,heater"]
    for row in range(int(days * 86_400 / step_s)):
        outside = 5.0 + 4.0 * np.sin(2 * np.pi * row / 48)
        heat = 3.0 * (row // 7 % 2)
        rows.append(f"{row * step_s},{inside + random.normal(0, 0.02):.4f},{outside:.4f},{heat}")
        rest = outside + heat * resistance
        inside = rest + (inside - rest) * np.exp(-step_s / (capacity * resistance))
    return "\n".join(rows)


MAPPING: dict[str, Any] = {
    "walls": [["room", "outdoor"]],
    "time": {"column": "time_s", "format": "seconds", "step_s": 1800.0},
    "boundary": [{"name": "outdoor", "temperature": "outside"}],
    "zone": [{"name": "room", "temperature": "inside", "heat": [{"kind": "power", "column": "heater", "unit": "kw"}]}],
}


def test_parameters_are_found_in_telemetry(tmp_path: Path) -> None:
    table, path = tmp_path / "room.csv", tmp_path / "found.toml"
    table.write_text(telemetry(), encoding="utf-8")
    found = interplay.identify(table, MAPPING, scenario=path)
    assert "room" in found.summary()
    assert interplay.load(path).has_building
    before = path.read_text(encoding="utf-8")
    refused(lambda: interplay.identify(table, MAPPING, scenario=path), FileExistsError)
    assert path.read_text(encoding="utf-8") == before


def test_telemetry_may_be_a_table_of_pandas() -> None:
    pandas = pytest.importorskip("pandas")
    table = pandas.read_csv(io.StringIO(telemetry()))
    assert interplay.identify(table, MAPPING) == interplay.identify(table, MAPPING)


def test_a_mapping_that_means_nothing_is_refused() -> None:
    table = io.StringIO(telemetry())
    pandas = pytest.importorskip("pandas")
    words = refused(lambda: interplay.identify(pandas.read_csv(table), {**MAPPING, "colour": 1}), interplay.ScenarioError)
    assert "colour" in words


def test_the_error_of_a_mapping_has_the_attributes_of_an_error() -> None:
    pandas = pytest.importorskip("pandas")
    table = pandas.read_csv(io.StringIO(telemetry()))
    with pytest.raises(interplay.ScenarioError) as caught:
        interplay.identify(table, {"colour": 1})
    assert (caught.value.file, caught.value.line) == ("mapping", 1)


def test_type_checkers_know_attributes_and_kinds(tmp_path: Path) -> None:
    api = pytest.importorskip("mypy.api")
    kinds = typing.get_args(interplay._policies.Kind)
    assert sorted([*kinds, "policy"]) == sorted(interplay._native.driver_kinds())
    code = 'import interplay\nreport = interplay.run("a", "idm")\nreport.{}\nreport.vehicles[0].{}\ninterplay.policy("{}")\n'
    for words, errors in ((("digest", "driver", "idm"), 0), (("digset", "drivr", "imd"), 3)):
        path = tmp_path / f"{words[0]}.py"
        path.write_text(code.format(*words))
        assert api.run([str(path)])[0].count("error:") == errors

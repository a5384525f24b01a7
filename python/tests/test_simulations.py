"""Worlds that are stepped: looked at, steered from outside, copied and resumed."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import interplay
from helpers import equal, refused


def ticks(world: interplay.Simulation) -> list[Any]:
    """All that is left of a world, tick by tick."""
    found = []
    while world.step():
        frame = world.frame()
        assert frame is not None
        found.append(dict(frame))
    return found


@pytest.mark.parametrize("name", ["lane-change/front-nice", "people/lane-keeping", "building/distributed", "mixed/garage"])
def test_a_restored_world_goes_on_bit_for_bit(name: str) -> None:
    world = interplay.Simulation(name)
    for _ in range(15):
        world.step()
    snapshot = world.snapshot()
    assert snapshot.time_s == world.time_s
    rest = ticks(world)
    world.restore(snapshot)
    assert world.time_s == snapshot.time_s
    assert equal(ticks(world), rest)
    other = interplay.Simulation(name)
    other.restore(snapshot)
    assert equal(ticks(other), rest)
    assert other.finish().digest == world.finish().digest


def test_a_snapshot_outlives_its_world() -> None:
    world = interplay.Simulation("lane-change/front-nice")
    world.step()
    snapshot = world.snapshot()
    assert snapshot.to_json().startswith("{")
    del world
    other = interplay.Simulation("lane-change/front-nice")
    other.restore(snapshot)
    assert other.time_s == snapshot.time_s


def test_a_world_may_be_restored_to_one_of_another_scenario() -> None:
    world = interplay.Simulation("lane-change/front-nice")
    world.step()
    other = interplay.Simulation("intersection/nice")
    other.restore(world.snapshot())
    other.step()
    frame = other.frame()
    assert frame is not None
    assert frame.vehicles == ["ego", "front", "rear"]


def test_a_vehicle_is_driven_from_outside() -> None:
    world = interplay.Simulation("lane-change/front-nice", external=["ego"])
    assert world.frame() is None
    before = world.observe("ego")
    world.apply("ego", 1.0, 0.0)
    assert world.step()
    after = world.observe("ego")
    assert after.state[0][3] == pytest.approx(before.state[0][3] + 1.0 * after.step_s)
    frame = world.frame()
    assert frame is not None
    assert frame["acceleration_mps2"][0][0] == pytest.approx(1.0)
    assert frame["x_m"].shape == (1, 3)
    assert "no input" in refused(world.step, interplay.RunError)


def test_a_plan_from_outside_is_told_to_the_others() -> None:
    world = interplay.Simulation("lane-change/front-nice", external="ego")
    plan = np.zeros((30, 2))
    plan[:, 0] = -0.2
    world.apply_plan("ego", plan)
    world.step()
    frame = world.frame()
    assert frame is not None
    speeds = frame["plan"][0, 0, :, 3]
    assert np.all(np.diff(speeds) < 0.0)


def test_the_same_inputs_give_the_same_world() -> None:
    def run() -> interplay.Report:
        world = interplay.Simulation("intersection/nice", external="ego")
        random = np.random.default_rng(4)
        while not world.is_over:
            world.apply("ego", *random.uniform(-0.3, 0.3, 2) * [1.0, 0.05])
            world.step()
        return world.finish()

    assert run().digest == run().digest


def test_inputs_that_are_none_are_refused_and_nothing_moves() -> None:
    world = interplay.Simulation("lane-change/front-nice", external="ego")
    for shape in ((29, 2), (31, 2), (20, 3), (30, 1), (60,), (0, 2), (1, 30, 2)):
        assert refused(lambda shape=shape: world.apply_plan("ego", np.zeros(shape)))  # type: ignore[misc]
    assert refused(lambda: world.apply_plan("ego", np.full((30, 2), np.nan)))
    for numbers in ((np.nan, 0.0), (0.0, np.inf)):
        assert "finite" in refused(lambda numbers=numbers: world.apply("ego", *numbers))  # type: ignore[misc]
    assert "driver of its own" in refused(lambda: world.apply("front", 0.0, 0.0))
    assert "the vehicles are ego, front, rear" in refused(lambda: world.apply("stranger", 0.0, 0.0))
    assert "the vehicles are" in refused(lambda: interplay.Simulation("lane-change/front-nice", external="stranger"))
    refused(lambda: world.observe("stranger"))
    assert world.time_s == 0.0


def test_a_driver_is_given_what_it_sees() -> None:
    world = interplay.Simulation("lane-change/front-nice")
    seen = world.observe("ego")
    assert seen.vehicles[0] == "ego"
    count = len(seen.vehicles)
    assert seen.state.shape == (count, 4)
    assert seen.body_m.shape == (count, 5)
    assert seen.prediction.shape == (count, seen.horizon_steps + 1, 4)
    assert seen.route.shape == (count, 3)
    assert seen.goal.shape == seen.limits.shape == (4,)
    assert seen.limits[0] < 0.0 < seen.limits[1]


def test_a_finished_world_cannot_be_stepped() -> None:
    world = interplay.Simulation("lane-change/front-nice", set={"duration_s": 4.0})
    world.step()
    report = world.finish()
    assert report.simulated_s == pytest.approx(0.1)
    for call in (world.step, world.frame, world.finish, lambda: world.time_s, lambda: world.is_over):
        assert "finished" in refused(call, interplay.RunError)


def test_the_heat_of_a_building_is_decided_from_outside() -> None:
    world = interplay.Simulation("building/four-room-pid")
    zones = world.zones()
    assert len(zones) == 4
    assert zones[0].heating_kw > 0.0
    heats = [zone.heating_kw / 2 for zone in zones]
    world.apply_heats(heats)
    world.step()
    frame = world.frame()
    assert frame is not None
    assert np.allclose(frame["heat_kw"][0], heats)
    for bad in ([1.0], [0.0] * 5, [np.nan] * 4, [np.inf, 0.0, 0.0, 0.0]):
        assert refused(lambda bad=bad: world.apply_heats(bad))  # type: ignore[misc]
    vehicles = interplay.Simulation("lane-change/front-nice")
    assert vehicles.zones() == []
    assert "no building" in refused(lambda: vehicles.apply_heats([1.0]))

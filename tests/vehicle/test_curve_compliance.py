"""Compliance of an axle by its curves in camber and in the place of the wheel: on a rig, in a car, in lanes."""

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import mbs
from mbs import Pose, Simulation, compile, simulate
from mbs.elements.scalar_spring_damper import ScalarSpringDamper
from mbs.vehicle import Car, CarFileError
from mbs.vehicle.builder import CarBuilder
from mbs.vehicle.car import car_from
from mbs.vehicle.springs import AxleSprings
from tests.vehicle.curved_car import curved_content, linked_car

STEER = {"per_moment": 8e-5}
CAMBER = -4e-6  # rad/N
LATERAL = 1.5e-6  # m/N
FORWARD = 8e-7  # m/N
ALL = {
    "camber_per_lateral_force": CAMBER,
    "lateral_per_lateral_force": LATERAL,
    "longitudinal_per_longitudinal_force": FORWARD,
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("compliant")


@pytest.fixture(scope="module")
def content(folder: Path) -> dict[str, Any]:
    return curved_content(linked_car("saloon"), folder)


def compliant(content: dict[str, Any], folder: Path, **axles: dict[str, float]) -> Car:
    changed = dict(content)
    for axle, numbers in axles.items():
        changed[axle] = content[axle] | {"suspension": content[axle]["suspension"] | {"compliance": numbers}}
    return car_from(changed, folder, "compliant", at_rest=False)


def on_rig(car: Car, axle: str, forces: dict[str, float]) -> dict[str, dict[str, float]]:
    """How far forces in both contacts move the wheels of an axle on the ground whose travel is held.

    Returns, by the wheel, ways of the contact, m, inclination with the top to the right and steer to the left, rad.
    """
    m, data = mbs.Model("rig", gravity=(0.0, 0.0, 0.0)), getattr(car, axle)
    m.point_mass("beside", mass=1.0, position=(0.0, 0.0, 0.0))
    b = CarBuilder(m, 0, {})
    b.chassis = SimpleNamespace(frame=m.ground)  # type: ignore[assignment]
    if axle == "front":
        b.rack = m.travel("rack travel")
        m.armature("rack", b.rack, inertia=10.0)
        m.add(ScalarSpringDamper(1e9, 1e5, unit="N").record("held rack", b.rack.affine))
    push, turn = [m.input(f"F{c}") for c in "xyz"], [None, None, m.input("Mz")]
    for corner in data.suspension.corners(b, axle, AxleSprings(data.spring, data.damper, None), None):
        w = corner.side.wheel
        (travel,) = (i for i, c in enumerate(m.coordinates) if c.name == f"wheel travel {w}")
        travel_spring = ScalarSpringDamper(1e9, 1e6, unit="N").record(
            f"held {w}", mbs.common.affine.Affine({travel: 1.0})
        )
        m.add(travel_spring)
        x, y, _ = corner.side.point(data.wheel.centre)
        m.force(f"force {w}", corner.carrier, (x, y, 0.0), inputs=push)
        m.torque(f"moment {w}", corner.carrier, inputs=turn)
        m.sense_position(f"{w}.x", corner.carrier, (x, y, 0.0), "x")
        for name, point in (("y", (x, y, 0.0)), ("top", (x, y, 1.0)), ("front", (x + 1.0, y, 0.0))):
            m.sense_position(f"{w}.{name}", corner.carrier, point, "y")
    run = simulate(compile(m), 2.0, 0.001, {n: ([0.0, 0.5], [0.0, f]) for n, f in forces.items()})

    def moved(name: str) -> float:
        return float(run[name][-1])

    wheels = [f"{axle[0].upper()}{side}" for side in "LR"]
    return {
        w: {
            "x": moved(f"{w}.x"),
            "y": moved(f"{w}.y"),
            "inclination": moved(f"{w}.y") - moved(f"{w}.top"),
            "steer": moved(f"{w}.front") - moved(f"{w}.y"),
        }
        for w in wheels
    }


@pytest.mark.slow
def test_a_rig_finds_the_compliances_of_the_file(content, folder):
    """Each force moves what its number says and nothing else; camber is that of its signs on both sides."""
    stiff, soft = (compliant(content, folder, front=STEER | more) for more in ({}, ALL))
    for forces, requested in (
        ({"Fy": 100.0}, {"y": 100.0 * LATERAL, "inclination": -100.0 * CAMBER}),
        ({"Fx": 100.0}, {"x": 100.0 * FORWARD}),
        ({"Mz": 10.0}, {}),
    ):
        before, after = (on_rig(car, "front", forces) for car in (stiff, soft))
        assert len(before) == 2
        for wheel, values in before.items():
            for name, value in values.items():
                expected = requested.get(name, 0.0)
                assert after[wheel][name] - value == pytest.approx(expected, rel=1e-4, abs=2e-7), (wheel, name, forces)


def test_a_car_keeps_its_books_and_does_so_in_lanes(content, folder):
    """Works are the change of the energy as those of a car without."""
    turn = {"steering": ([0.0, 0.3], [0.0, 0.2]), "brake": ([0.0, 1.0, 1.2], [0.0, 0.0, 0.1])}
    open_books = {}
    for name, more in (("stiff", {}), ("soft", ALL)):
        system = compile(compliant(content, folder, front=STEER | more, rear=STEER | more).model())
        run = simulate(system, 2.0, 0.002, turn, pose=Pose(speed=18.0))
        works = sum(run[f"energy.{w}"] for w in ("drive", "brakes", "tyres", "dampers", "drag", "ground"))
        change = run["energy.total"] - run["energy.total"][0]
        open_books[name] = np.abs(change - works).max() / np.ptp(change)
        assert system.meta["report"]["degrees_of_freedom"] == (26 if more else 18)
    assert open_books["soft"] < max(1.5 * open_books["stiff"], 1e-4)
    variants = [mbs.Variant(inputs=turn, pose=Pose(speed=speed)) for speed in (18.0, 12.0)]
    together = mbs.simulate_many(system, variants, 0.5, 0.002, lanes=2, progress=False)
    assert not together.failures
    assert sum(together.alone) < 20
    alone = Simulation(system, pose=Pose(speed=18.0)).run(0.5, 0.002, inputs=turn, estimate_error=False)
    first = together.trajectories[0]
    assert first is not None
    for name in ("chassis.y", "wheel_RL.inclination", "wheel_FR.Fz"):
        np.testing.assert_allclose(first[name], alone[name], atol=1e-9 * np.ptp(alone[name]))


@pytest.mark.parametrize(
    ("numbers", "match"),
    [
        ({"camber_per_lateral_force": -4e-6}, r"lateral_per_lateral_force is 0 m/N and .*-4e-06 rad/N"),
        (
            {"lateral_per_lateral_force": 1e-6},
            r"lateral_per_lateral_force is 1e-06 m/N and .* 0 rad/N; .* 0\.05 to 1\.5 m",
        ),
        ({"camber_per_lateral_forces": -4e-6}, r"camber_per_lateral_forces"),
        ({"longitudinal_per_longitudinal_force": -1e-7}, r"longitudinal_per_longitudinal_force is -1e-07"),
    ],
)
def test_what_no_wheel_does_is_a_sentence(numbers, match, content, folder):
    with pytest.raises(CarFileError, match=match):
        compliant(content, folder, rear=STEER | numbers)

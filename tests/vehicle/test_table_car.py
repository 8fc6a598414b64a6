"""Cars whose suspensions are tables made of their links, against the cars with the links."""

from functools import cache

import numpy as np
import pytest

from fmu_src.build.car_registry import build_car
from fmu_src.geometry.geometry import geometry, lost_frames
from fmu_src.variables.variables import variable_table
from mbs import Pose, Simulation, System, compile, simulate
from mbs.common.errors import ModelError
from mbs.model.table_bodies import LookupTableBody
from mbs.vehicle import Car, Fidelity, load
from mbs.vehicle.linkages.linkage import Linkage
from tests.vehicle.rigid_car import column_car
from tests.viewer.poses import FramePoses

CAR = "hatchback"
WHEELS = ("FL", "FR", "RL", "RR")
# largest difference between a table and its links between the points of the table
PLACE = 5e-7  # m
TURN = 1e-5  # rad


@cache
def car(name: str) -> Car:
    return load(name)


@cache
def systems(name: str) -> tuple[System, System]:
    return compile(car(name).model(fidelity="table")), compile(car(name).model())


@pytest.mark.slow
def test_fourteen_freedoms_and_all_outputs() -> None:
    tabled, linked = systems(CAR)
    report = tabled.meta["report"]
    assert report["degrees_of_freedom"] == 14
    assert report["rows"] == 7  # six of the chassis, and the rack's drive
    for kind in ("inputs", "parameters", "sensors"):
        assert [x["name"] for x in tabled.meta[kind]] == [x["name"] for x in linked.meta[kind]]


def _off(name: str, axle: str) -> tuple[float, float]:
    """Largest distance and turn of the parts of an axle between the points of their tables."""
    m = car(name).model(fidelity="table")
    linkage = Linkage(car(name), axle)
    rng = np.random.default_rng(5)
    place = turn = 0.0
    for _ in range(25):
        left, right = rng.uniform(-0.06, 0.06, 2)
        rack = rng.uniform(-0.05, 0.05) if axle == "front" else 0.0
        q = linkage.at_springs(linkage.drawn.q, (left, right), rack)
        values = {f"spring compression {axle[0].upper()}L": left, f"spring compression {axle[0].upper()}R": right}
        for part in linkage.model.bodies:
            (tabled,) = (t for t in m.lookup_tables if isinstance(t, LookupTableBody) and t.name == part.name)
            result = tabled.table.value(*(values.get(c.name, rack) for c in tabled.parameters))
            rows = [linkage.full(part.start + k) for k in range(12)]
            exact = np.array([row @ q + constant for row, constant in rows])
            exact[:3] -= tabled.base.com
            place = max(place, float(np.abs(result - exact)[:3].max()))
            turn = max(turn, float(np.abs(result - exact)[3:].max()))
    return place, turn


@pytest.mark.slow
@pytest.mark.parametrize(("name", "axle"), [("prototype", "front"), ("hatchback", "rear")])
def test_tables_are_the_links_at_any_travel_and_rack(name: str, axle: str) -> None:
    place, turn = _off(name, axle)
    assert place < PLACE
    assert turn < TURN


def test_it_drives_as_the_car_with_links() -> None:
    """A swerve with the brakes on, in 1.5 s from 15 m/s."""
    t = np.array([0.0, 0.2, 0.5, 0.8, 1.1, 1.5])
    inputs = {
        "steering": (t, np.array([0.0, 0.0, 0.4, -0.4, 0.0, 0.0])),
        "brake": (t, np.array([0, 0, 0, 0, 0.3, 0.3])),
    }
    tabled, linked = (simulate(s, 1.5, 0.005, inputs=inputs, pose=Pose(speed=15.0)) for s in systems(CAR))
    gap = np.hypot(*(tabled[f"chassis.{c}"] - linked[f"chassis.{c}"] for c in "xy"))
    assert gap.max() < 1e-4
    assert np.abs(linked["chassis.y"]).max() > 0.3
    for wheel in WHEELS:
        change = np.abs(linked[f"wheel_{wheel}.Fz"] - linked[f"wheel_{wheel}.Fz"][0]).max()
        assert np.abs(tabled[f"wheel_{wheel}.Fz"] - linked[f"wheel_{wheel}.Fz"]).max() < 1e-3 * change
    force = np.abs(linked["steering_rack_force"]).max()
    assert np.abs(tabled["steering_rack_force"] - linked["steering_rack_force"]).max() < 1e-3 * force
    works = tabled["energy.dampers"][-1], linked["energy.dampers"][-1]
    assert works[0] == pytest.approx(works[1], rel=1e-3)
    assert tabled.report is not None
    assert linked.report is not None
    assert tabled.report.iterations <= linked.report.iterations


def test_its_wheels_are_drawn_where_those_of_the_car_with_links_are() -> None:
    """Centre and a point of the rim, which steers and turns with its wheel, as drawn and in a run."""
    scenes, drawn = [], []
    inputs = {"steering": (np.array([0.0, 0.5]), np.array([0.0, 0.4]))}
    for system in systems(CAR):
        run = simulate(system, 0.5, 0.005, inputs=inputs, pose=Pose(speed=10.0)).recording()
        assert run.scene is not None
        assert not [item for item in run.missing if "wheel" in item["name"]]
        poses = FramePoses(run.scene, run.columns, len(run.t))
        shapes = [shape for shape in run.scene["shapes"] if shape["kind"] == "wheel"]
        assert [shape["frame"] for shape in shapes] == [f"wheel {wheel}" for wheel in WHEELS]
        drawn.append([poses.points([s["frame"], p]) for s in shapes for p in (s["at"], (0.0, 0.1, s["rim"]))])
        scenes.append(run.scene["frames"])
    assert np.abs(np.subtract(*drawn)).max() < 1e-6
    assert np.ptp(drawn[0][1][:, 2]) > 0.3, "it turns"
    tabled, linked = scenes
    for wheel in WHEELS:
        carrier = linked[linked[f"wheel {wheel}"]["parent"]]["start"]
        centre = np.add(carrier[0], linked[f"wheel {wheel}"]["at"])
        assert np.abs(tabled[tabled[f"wheel {wheel}"]["parent"]]["start"][0] - centre).max() < 5e-3


def test_wheels_of_a_car_by_curves_are_drawn_from_the_outputs_of_its_fmu() -> None:
    (system,) = build_car("commonroad_escort", fidelity=0).systems.values()
    assert lost_frames(system) == []
    actual = geometry(system, variable_table(system.meta, pose=False, step_size=0.01), "Name", "what it is")
    assert actual is not None
    for wheel in WHEELS:
        frame = actual["frames"][f"wheel {wheel}"]
        assert frame["angle"] == f"wheel_{wheel}.angle"
        assert actual["frames"][frame["parent"]]["position"] == [f"wheel_{wheel}.{c}" for c in "xyz"]
    assert actual["missing"] == []


@pytest.mark.slow
def test_stresses_are_refused_and_a_rack_with_mass_is_a_sentence() -> None:
    assert Fidelity.of("table") is Fidelity.TABLE
    assert Fidelity.TABLE.rigid
    with pytest.raises(KeyError, match="not computed by this System"):
        Simulation(systems("prototype")[0]).sensors["bending_moment.SG1"]
    with pytest.raises(ModelError, match=r"steering\.kind is 'column', whose rack is a body"):
        column_car().model(fidelity=Fidelity.TABLE)


@pytest.mark.slow
def test_an_fmu_of_one_fidelity_is_named_after_it() -> None:
    built = build_car("prototype", fidelity=10)
    assert built.name == "prototype_table"
    assert list(built.systems) == [0]
    assert "tabled_size" in built.systems[0].arrays
    with pytest.raises(ValueError, match="it must be one of: 0 rigid"):
        build_car("prototype", fidelity=7)

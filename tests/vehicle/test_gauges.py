"""Gauges of a car file against closed forms; they change no motion."""

from functools import cache
from typing import Any

import numpy as np
import pytest

import mbs
from mbs.flexible import tube
from mbs.vehicle.chassis.gauges.tube_gauge import TubeGauge
from mbs.vehicle.errors import CarFileError
from tests.flexible.structures import straight
from tests.quick import quick
from tests.vehicle.frame_cars import PROTOTYPE

DIAMETER = 0.04  # m
WALL = 0.002  # m
LENGTH = 1.2  # m
SECTION = tube(DIAMETER, WALL)
AREA = np.pi * (DIAMETER - WALL) * WALL
SECOND = np.pi / 64 * (DIAMETER**4 - (DIAMETER - 2 * WALL) ** 4)
FORCE = np.array([70.0, 40.0, -50.0])  # N, on the free end, axes of the car
TORQUE = 9.0  # N m, about the tube from its clamped end to the free one
ROUND_OFF = 1e-7
# the four of the prototype and ten more: every bridge, named fibres and angles, and both ways of an upright tube
TEN: dict[str, dict[str, Any]] = {
    "Q_top": {"tube": ["LRL", "D1L"], "place": 0.25, "bridge": "quarter"},
    "Q_bottom": {"tube": ["LRL", "D1L"], "place": 0.25, "bridge": "quarter", "fibre": "bottom"},
    "Q_left": {"tube": ["LRL", "D1L"], "place": 0.25, "bridge": "quarter", "fibre": "left"},
    "Q_right": {"tube": ["LRL", "D1L"], "place": 0.25, "bridge": "quarter", "fibre": "right"},
    "Q_120": {"tube": ["LRL", "D1L"], "place": 0.25, "bridge": "quarter", "fibre": 120.0},
    "H_left": {"tube": ["LRL", "D1L"], "place": 0.25, "fibre": "left"},
    "A": {"tube": ["LRL", "D1L"], "place": 0.25, "bridge": "axial"},
    "T": {"tube": ["LRL", "D1L"], "place": 0.25, "bridge": "torsion"},
    "Up": {"tube": ["B1L", "B2L"], "place": 0.5, "fibre": "front"},
    "Up0": {"tube": ["B1L", "B2L"], "place": 0.5, "fibre": 0.0},
}
DRIVING = {"steering": ([0.0, 0.1, 0.3], [0.0, 0.0, 0.3]), "throttle": 0.5}


def stresses(direction: tuple[float, float, float], place: float, **gauge: Any) -> dict[str, float]:
    """Readings of a gauge on a tube that is clamped at its first end and loaded at the other."""
    frame = straight(4, LENGTH, SECTION, direction=direction)
    model = frame.finite_element_model()
    fixed, end = np.arange(6), 6 * 4 + np.arange(6)
    load = np.zeros(model.n_dof)
    load[end] = [*FORCE, *(TORQUE * np.array(direction) / np.linalg.norm(direction))]
    free = np.setdiff1d(np.arange(model.n_dof), fixed)
    u = np.zeros(model.n_dof)
    u[free] = np.linalg.solve(model.K.toarray()[np.ix_(free, free)], load[free])
    section = TubeGauge(tube=("A", "B"), place=place, **gauge)
    ends = frame.positions[0], frame.positions[-1]
    readings = section.readings(section.strain_gauge("G", ends, 0.5 * DIAMETER, range(4)), frame)
    # forces act at the nodes only: nothing loads the beams between their ends
    return {reading.quantity: float(reading.row[: model.n_dof] @ u) for reading in readings}


def closed_form(direction: tuple[float, float, float], place: float, fibre: np.ndarray) -> float:
    """Normal stress at a place of the surface, `fibre` across the tube from its axis (unit vector)."""
    along = np.array(direction) / np.linalg.norm(direction)
    moment = np.cross((1.0 - place) * LENGTH * along, FORCE)  # of what lies beyond the place
    arm = 0.5 * DIAMETER * fibre
    return float(FORCE @ along / AREA + np.cross(moment, arm) @ along / SECOND)


WAYS = {
    "top": (0, 0, 1), "bottom": (0, 0, -1), "left": (0, 1, 0), "right": (0, -1, 0), "front": (1, 0, 0),
    "rear": (-1, 0, 0),
}  # fmt: skip


@pytest.mark.parametrize("direction", [(-1.0, 0.0, 0.0), (-0.4, 0.3, 0.2), (0.0, 0.1, 1.0)])
@pytest.mark.parametrize("way", list(WAYS))
def test_a_single_gauge_reads_pull_and_bending_of_the_fibre_that_it_is_named_by(direction, way):
    along = np.array(direction) / np.linalg.norm(direction)
    across = np.array(WAYS[way]) - along * (along @ WAYS[way])
    if np.linalg.norm(across) < 0.3:
        return
    actual = stresses(direction, 0.3, bridge="quarter", fibre=way)
    fibre = across / np.linalg.norm(across)
    assert actual["stress"] == pytest.approx(closed_form(direction, 0.3, fibre), rel=ROUND_OFF)
    both = stresses(direction, 0.3, fibre=way)
    bending = closed_form(direction, 0.3, fibre) - closed_form(direction, 0.3, -fibre)
    assert both["stress"] == pytest.approx(bending, rel=ROUND_OFF)
    assert both["bending_moment"] == pytest.approx(bending * SECOND / DIAMETER, rel=ROUND_OFF)


@pytest.mark.parametrize("angle", [-30.0, 0.0, 45.0, 90.0, 250.0])
@pytest.mark.parametrize(
    ("direction", "start"), [((-0.4, 0.3, 0.2), (0.0, 0.0, 1.0)), ((0.0, 0.1, 1.0), (1.0, 0.0, 0.0))]
)
def test_an_angle_turns_right_handed_about_the_tube_from_its_highest_or_foremost_fibre(direction, start, angle):
    along = np.array(direction) / np.linalg.norm(direction)
    first = np.array(start) - along * (along @ start)
    first /= np.linalg.norm(first)
    a = np.radians(angle)
    fibre = np.cos(a) * first + np.sin(a) * np.cross(along, first)
    actual = stresses(direction, 0.6, bridge="quarter", fibre=angle)["stress"]
    assert actual == pytest.approx(closed_form(direction, 0.6, fibre), rel=ROUND_OFF)


def test_axial_and_torsion_bridges_read_pull_and_twist_alone():
    direction = (-0.4, 0.3, 0.2)
    pull = float(FORCE @ direction / np.linalg.norm(direction))
    axial = stresses(direction, 0.7, bridge="axial")
    assert axial == pytest.approx({"axial_force": pull, "stress": pull / AREA}, rel=ROUND_OFF)
    torsion = stresses(direction, 0.7, bridge="torsion")
    shear = TORQUE * 0.5 * DIAMETER / (2.0 * SECOND)
    assert torsion == pytest.approx({"torsional_moment": TORQUE, "stress": shear}, rel=ROUND_OFF)


@cache
def car(fidelity: int, more: bool) -> mbs.System:
    gauges = PROTOTYPE._data["chassis"]["frame"]["gauges"]
    changed = PROTOTYPE.changed({"chassis.frame.gauges": {**gauges, **TEN}}) if more else PROTOTYPE
    return mbs.compile(changed.model(fidelity=fidelity))


@pytest.mark.slow
@pytest.mark.parametrize("fidelity", quick((3,), (1, 3)))
def test_ten_more_gauges_change_no_mode_no_state_and_no_other_output(fidelity):
    few, many = car(fidelity, False), car(fidelity, True)
    assert many.meta["coordinates"] == few.meta["coordinates"]
    for name in ("M", "flex_K", "flex_C"):
        if name in few.arrays:
            np.testing.assert_array_equal(many.arrays[name], few.arrays[name])
    a, b = (mbs.Simulation(system).run(0.4, 0.005, inputs=DRIVING, estimate_error=False) for system in (few, many))
    for sensor in few.meta["sensors"]:
        np.testing.assert_array_equal(b[sensor["name"]], a[sensor["name"]])
    names = [s["name"] for s in many.meta["sensors"]]
    assert len(names) == len(few.meta["sensors"]) + 10 + 5  # bending twice more than single ones, axial and torsion
    assert names.index("stress.Up0") > names.index("bending_moment.Up0") > names.index("torsional_moment.T")


@pytest.mark.parametrize("fidelity", quick((3,), (1, 3)))
def test_bridges_of_the_driving_car_are_sums_of_its_single_gauges(fidelity):
    run = mbs.Simulation(car(fidelity, True)).run(0.4, 0.005, inputs=DRIVING, estimate_error=False)
    s = {name: run[f"stress.{name}"] for name in (*TEN, "SG1")}
    size = np.abs(s["SG1"]).max()
    assert size > 1e6
    for left, right in (
        (s["SG1"], s["Q_top"] - s["Q_bottom"]),
        (s["H_left"], s["Q_left"] - s["Q_right"]),
        (2.0 * s["A"], s["Q_top"] + s["Q_bottom"]),
        (2.0 * s["A"], s["Q_left"] + s["Q_right"]),
        (s["Up"], s["Up0"]),
    ):
        np.testing.assert_allclose(left, right, rtol=0, atol=1e-7 * size)
    np.testing.assert_allclose(run["axial_force.A"], s["A"] * AREA, rtol=1e-9)


@pytest.mark.parametrize(
    ("gauge", "sentence"),
    [
        ({"tube": ["LRL", "XXL"], "place": 0.5}, r"gauges\.G\.tube is \['LRL', 'XXL'\], which is not a tube .* D1L,"),
        ({"tube": ["D1L", "LRL"], "place": 0.5}, "the tube runs from LRL to D1L, and place counts from LRL"),
        ({"tube": ["XXL", "YYL"], "place": 0.5}, "no tube ends at XXL"),
        ({"tube": ["LRL", "D1L"], "place": 1.5}, r"gauges\.G\.place is 1\.5; it must be 0 or between 0.002 and 1"),
        ({"tube": ["LRL", "D1L"], "place": 0.5, "fibre": "upper"}, r"gauges\.G\.fibre is 'upper'; it must be 'top'"),
        ({"tube": ["LRL", "D1L"], "place": 0.5, "fibre": 400.0}, r"gauges\.G\.fibre is 400\.0; .* 360 deg"),
        ({"tube": ["D1L", "S1L"], "place": 0.5, "fibre": "rear"}, "runs in that direction; name another fibre"),
        ({"tube": ["LRL", "D1L"], "place": 0.5, "bridge": "full"}, r"gauges\.G\.bridge is 'full'; it must be 'half'"),
        ({"tube": ["LRL", "D1L"], "place": 0.5, "bridge": "axial", "fibre": "top"}, "has no fibre, leave it out"),
        ({"tube": ["LRL"], "place": 0.5}, r"gauges\.G\.tube"),
    ],
)
def test_a_gauge_that_cannot_be_is_refused_in_one_sentence(gauge, sentence):
    with pytest.raises(CarFileError, match=sentence) as error:
        PROTOTYPE.changed({"chassis.frame.gauges": {"G": gauge}})
    assert "\n" not in str(error.value)


def test_a_gauge_has_a_name_that_an_output_can_have():
    with pytest.raises(CarFileError, match="front left"):
        PROTOTYPE.changed({"chassis.frame.gauges": {"front left": {"tube": ["LRL", "D1L"], "place": 0.5}}})

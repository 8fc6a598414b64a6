"""Texts and nominal values of the model description: typical sizes, type names, texts of arrays, terminals."""

import re
from collections.abc import Sequence
from xml.etree import ElementTree

import numpy as np
import pytest

import mbs
from benchmarks.car import manoeuvres
from fmu_src.build.car_registry import build_car
from fmu_src.description.description import declared_types
from fmu_src.description.nominal_values import drive_sizes, with_nominal
from fmu_src.description.terminals import terminals
from fmu_src.variables.arrays import arrays, common_text
from fmu_src.variables.variables import Variable, variable_table
from tests.quick import quick

MOST = 60.0  # times the typical size, and a part of it, in common drives
DRIVES = ("slalom", "launch_and_brake")


def with_typical_sizes(systems: Sequence[mbs.System]) -> tuple[Variable, ...]:
    table = variable_table(systems[0].meta, pose=True, step_size=0.002)
    sizes = drive_sizes(systems, table)
    return with_nominal(table, sizes, sizes)


@pytest.fixture(scope="module", params=quick((manoeuvres.PROTOTYPE,), manoeuvres.CARS, "proof"))
def car(request: pytest.FixtureRequest) -> tuple[str, tuple[Variable, ...]]:
    return request.param, with_typical_sizes([manoeuvres.system_of("drop", request.param)])


@pytest.mark.slow
def test_typical_sizes_are_those_of_common_drives_and_equal_on_both_sides(car):
    name, table = car
    nominal = {v.name: v.nominal for v in table if v.causality == "output" and not v.name.startswith("solver.")}
    for wheel in ("FR", "RL", "RR"):
        assert all(nominal[n] == nominal[n.replace("_FL", f"_{wheel}")] for n in nominal if "wheel_FL" in n)
    runs = [manoeuvres.run(drive, 0.01, car=name) for drive in DRIVES]
    largest: dict[str, float] = {}
    for n in [n for n in nominal if n in runs[0]]:  # of all wheels together: they have one typical size
        of_any = re.sub("_(FL|FR|RL|RR)", "", n)
        largest[of_any] = max(largest.get(of_any, 0.0), *(float(np.abs(run[n]).max()) for run in runs))
    largest |= {n: largest.get(re.sub("_(FL|FR|RL|RR)", "", n), 0.0) for n in nominal}
    wrong = [
        f"{n}: nominal {size:g}, {largest[n]:.3g} in drives"
        for n, size in nominal.items()
        if not n.endswith((".angle", "sideslip")) and not n.startswith("energy.")  # grow with time, or stand
        if size is not None and largest.get(n, 0.0) > 1e-6 and not size / MOST < largest[n] < size * MOST
    ]
    assert not wrong, "\n".join(wrong)
    assert nominal["chassis.ax"] in (1.0, 10.0)
    assert nominal["energy.drive"] in (1e3, 1e4, 1e5)


@pytest.mark.slow
def test_typical_accelerations_are_no_jumps_of_a_frame_that_drag_is_new_to():
    systems = list(build_car("hatchback").systems.values())
    nominal = {v.name: v.nominal for v in with_typical_sizes(systems)}
    assert len(systems) == 4
    assert [nominal[f"chassis.{a}"] for a in ("ax", "ay", "az")] == [1.0, 1.0, 1.0]


def test_types_have_names_without_numbers(car):
    types = declared_types(car[1])
    assert {"Angle", "Velocity", "Force", "Count"} <= set(types)
    assert not [n for n in types if any(c.isdigit() for c in n)]
    assert all(t["quantity"] != "Quantity" for t in types.values())


def test_a_text_of_an_array_is_of_all_elements():
    for texts, message in (
        (("x of the centre", "y of the centre", "z of the centre"), "x, y, z of the centre"),
        (("at gauge 1", "at gauge 2", "at gauge 3"), "at gauge 1 to 3"),
        (("along x, forward, here", "along y, left, here"), "along x, forward; y, left, here"),
        (("the same", "the same"), "the same"),
        (("one", "two of them"), "one; two of them"),
    ):
        assert common_text(texts) == message


def test_inputs_of_a_car_are_the_terminal_of_its_driver(car):
    root = ElementTree.fromstring(terminals(arrays(car[1])))
    members = {t.get("name"): [m.get("variableName") for m in t] for t in root.iter("Terminal")}
    assert {"steering", "throttle", "brake", "hand_brake", "selector"} <= set(members["driver"])
    assert "wheel_FL.force" in members["wheel_FL"]
    assert root.find("GraphicalRepresentation/Icon") is not None

"""A truck of 10 t is within the ranges: a car made larger by Froude's similarity moves as the car does, more slowly.

Lengths are multiplied by L, masses by M; with the same gravity times are multiplied by sqrt(L), so that a number in
kg^a m^b s^c is multiplied by M^a L^(b + c/2).
"""

import math

import numpy as np
import pytest

from ali3.typed_paths import annotation_of
from mbs import Pose, compile
from mbs.vehicle import CarWarning, load
from mbs.vehicle.car import car_from
from mbs.vehicle.changed_content import changed_content
from mbs.vehicle.quantities import quantities_in
from mbs.vehicle.section import sections_of
from tests.vehicle.hatchback import drive

L = 1.6
M = 8.0
T = math.sqrt(L)
FORCE = M
POWER = M * L / T
FACTORS = {
    **{"1": 1.0, "rad": 1.0, "deg": 1.0, "m": L, "m2": L**2, "kg": M, "kg.m2": M * L**2, "kg/m3": M / L**3},
    **{"s": T, "Hz": 1.0 / T, "rad/s": 1.0 / T, "m/s": L / T, "s/m": T / L, "N": FORCE, "N/m": FORCE / L},
    **{"N.s/m": FORCE * T / L, "N.m": FORCE * L, "N.m/rad": FORCE * L, "N.m.s/rad": FORCE * L * T, "W": POWER},
    "Pa": FORCE / L**2,
}


def larger(value, quantities):
    """A number, or a list of them or of rows with a quantity each, made larger."""
    if isinstance(value, (tuple, list)):
        columns = len(quantities) > 1 and len(value) == len(quantities) and isinstance(value[0], float)
        each = [[q] for q in quantities] if columns else [quantities] * len(value)
        return [larger(v, q) for v, q in zip(value, each, strict=True)]
    if not isinstance(value, float) or not quantities:
        return value
    (quantity,) = quantities
    return value * FACTORS[quantity.unit]


def larger_car(car):
    """The car, made larger."""
    changes = {"vehicle.category": "truck"}
    for section in sections_of(car):
        if ".frame" in section.path:
            continue
        for name, field in type(section).model_fields.items():
            value = getattr(section, name)
            if name == "accelerometers":
                changes[section.key(name)] = {k: [L * x for x in p] for k, p in value.items()}
            elif isinstance(value, (float, tuple)):
                new = larger(value, quantities_in(annotation_of(field)))
                if new != value:
                    changes[section.key(name)] = new
    return car_from(changed_content(car._data, changes, "truck"), car.folder, "truck", warn=True)


@pytest.mark.slow
def test_a_truck_of_10_t_moves_as_the_car_that_it_is_similar_to():
    """It stands as drawn without a word but of its frame, which is the car's, and brakes in a turn as the car does.

    Its tracks, 1.6 times the car's, are wider than those of trucks, its tyres a little stiffer over their load, and
    this alone is told besides.
    """
    car = load("hatchback")
    with pytest.warns(CarWarning) as caught:
        truck = larger_car(car)
    others = [
        text
        for text in (str(w.message) for w in caught)
        if " track is 2.3" not in text and "is 0.3063 1/deg" not in text
    ]
    assert len(others) == 1
    assert "frame" in others[0]
    assert truck.vehicle.mass == pytest.approx(9400.0)
    runs = []
    for of, length, time in ((car, 1.0, 1.0), (truck, L, T)):
        inputs = {"steering": ([0.0, 0.5 * time, 0.8 * time, 9.0], [0.0, 0.0, 0.3, 0.3])}
        inputs["brake"] = ([0.0, 1.0 * time, 1.3 * time, 9.0], [0.0, 0.0, 0.4, 0.4])
        pose, system = Pose(speed=15.0 * length / time), compile(of.model())
        runs.append(drive(2.0 * time, 0.002 * time, inputs, pose=pose, of=system))
    # speeds at which friction is rounded have no key and stay as in the car: the inner front wheel locks
    for name, factor, size in (
        ("chassis.x", L, 20.0),
        ("chassis.y", L, 1.0),
        ("chassis.vx", L / T, 10.0),
        ("chassis.roll", 1.0, 0.03),
        ("chassis.ay", 1.0, 5.0),
        ("wheel_FL.Fz", M, 4000.0),
        ("wheel_RR.Fy", M, 1000.0),
        ("wheel_FL.omega", 1.0 / T, 40.0),
    ):
        one, other = (run[name] for run in runs)
        assert np.abs(one).max() > 0.5 * size, name
        np.testing.assert_allclose(other / factor, one, atol=1.5e-3 * size, err_msg=name)

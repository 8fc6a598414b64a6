"""Each table of the cars' files omitted: a car that drives, or a sentence that names the table."""

import re

import numpy as np
import pytest

import mbs
from mbs.vehicle import CarFileError, CarWarning, car_names, load
from mbs.vehicle.car import car_from
from mbs.vehicle.changed_content import changed_content
from mbs.vehicle.copy_car import copy_car
from mbs.vehicle.linkages.linkage import Linkage, NotReachedError
from tests.quick import quick
from tests.vehicle.content import new_with, sentences, tables_of

NAMES = car_names()
NEW = [(name, path) for name in NAMES for path in new_with(name, tables_of, NAMES)]
NAMED = ("payload", "chassis.frame.gauges")  # their tables have names that the user chooses
OPTIONAL = {
    *("chassis.accelerometers", "chassis.frame", "chassis.frame.gauges", "chassis.ground_contact", "payload"),
    *("front.alignment", "rear.alignment", "front.tyre.bore", "rear.tyre.bore", "front.stops", "rear.stops"),
    *("front.anti_roll_bar", "rear.anti_roll_bar", "front.suspension.steering_stop"),
    *("front.suspension.bar", "rear.suspension.bar"),
}


def marks(name, path):
    """Each table in the first car that has it, of those that a user names one; the others in the proof run."""
    outer = path.rpartition(".")[0]
    again = outer in NAMED and path != next(p for n, p in NEW if p.startswith(f"{outer}."))
    return pytest.mark.proof if again or (name, path) not in NEW else ()


TABLES = [pytest.param(name, path, marks=marks(name, path)) for name in NAMES for path in tables_of(name)]


def without(name, path):
    """The car without a table."""
    car = load(name)
    data = changed_content(car._data, {}, "x")
    *outer, last = path.split(".")
    table = data
    for key in outer:
        table = table[key]
    del table[last]
    return car_from(data, car.folder, "x", at_rest=False)


@pytest.mark.parametrize(("name", "path"), TABLES)
def test_a_car_or_a_sentence(name, path):
    named = path.rpartition(".")[0] in NAMED
    try:
        car = without(name, path)
    except CarFileError as error:
        assert path not in OPTIONAL
        assert not named
        (line,) = sentences(error, "x: ")
        assert "is missing" in line or "is not in chassis.frame.sections" in line
    else:
        assert path in OPTIONAL or named
        run = mbs.simulate(mbs.compile(car.model()), 0.1, 0.002, inputs={"throttle": 0.5}, estimate_error=False)
        assert run["speed"][-1] > 0.0


def test_without_points_that_touch_the_ground_there_is_no_work_of_it():
    car = mbs.compile(without("hatchback", "chassis.ground_contact").model())
    run = mbs.simulate(car, 0.02, 0.002)
    assert not run["energy.ground"].any()
    assert "chassis.ground_force" not in [s["name"] for s in car.meta["sensors"]]


@pytest.mark.slow
@pytest.mark.parametrize("name", quick(("commonroad_320i", "hatchback"), NAMES, "proof"))
def test_without_stops_it_is_reported_how_far_the_links_follow(name, tmp_path):
    file = copy_car(name, tmp_path / "car")[0].parent / "car.toml"
    text = file.read_text(encoding="utf-8")
    file.write_text(re.sub(r"\[(front|rear)\.stops\]\n(?:.+\n)+", "", text), encoding="utf-8")
    with pytest.warns(CarWarning) as caught:
        car = load(file)
    messages = [str(warning.message) for warning in caught if "stops" in str(warning.message)]
    for axle, line in zip(("front", "rear"), messages, strict=True):
        assert f"car.toml: {axle}.stops is missing" in line
        if not getattr(car, axle).suspension.linked:
            assert "goes from -0.130 to +0.130 m of wheel travel" in line
            continue
        ends = [float(v) for v in re.search(r"follow from ([-+.\d]+) to ([-+.\d]+) m", line).groups()]
        linkage, start = Linkage(car, axle), Linkage(car, axle).drawn.q
        for end in ends:
            q = start
            for part in np.linspace(0.05, 0.98, 40):
                q = linkage.solve(q, np.full(2, part * end), 0.0).q
            with pytest.raises(NotReachedError):
                linkage.solve(q, np.full(2, 1.02 * end), 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("name", quick(("prototype",), ("prototype", "ferrari_250_lm"), "proof"))
def test_without_a_stop_of_the_steering_it_is_reported_how_far_the_links_follow(name, tmp_path):
    file = copy_car(name, tmp_path / "car")[0].parent / "car.toml"
    text = file.read_text(encoding="utf-8")
    file.write_text(re.sub(r"\[front.suspension.steering_stop\]\n(?:.+\n)+", "", text), encoding="utf-8")
    with pytest.warns(CarWarning, match="front.suspension.steering_stop is missing") as caught:
        car = load(file)
    (line,) = (str(warning.message) for warning in caught)
    number = r"([-+.\d]+)"
    rack, travel = re.findall(rf"{number} to {number} m of (?:the rack|wheel travel)", line)
    linkage, full = Linkage(car, "front"), car.steering.rack_travel

    def follow(*places):
        at = linkage.drawn
        for start, end in zip(((0.0, 0.0), *places), places, strict=False):
            for share in np.linspace(0.02, 1.0, 50):
                heave, rack = (a + share * (b - a) for a, b in zip(start, end, strict=True))
                at = linkage.solve(at.q, np.full(2, heave), rack)

    for end in map(float, rack):
        assert abs(end) > full
        follow((0.0, 0.98 * end))
        with pytest.raises(NotReachedError):
            follow((0.0, 0.98 * end), (0.0, 1.02 * end))
    for end in map(float, travel):
        follow((0.0, full), (0.98 * end, full))
        with pytest.raises(NotReachedError):
            follow((0.0, full), (0.98 * end, full), (1.02 * end, full))

"""The same car in the names of other programs gives the same record as in ours; a wrong sign or unit does not pass."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from fmpy import read_model_description

from ali3.alias_file import shipped_names
from hosts.catalogue.car import TestedCar
from hosts.catalogue.execution import perform, reason_against
from hosts.catalogue.registry import standard_test
from hosts.common.errors import HostError
from hosts.driving.manoeuvre import Manoeuvre
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.file import find_aliases
from hosts.fmu.fmu import described
from hosts.fmu.fmu_source import FmuSource
from hosts.fmu.variables import Variables
from tests.hosts.changed_fmu import DESCRIPTION, changed_fmu
from tests.quick import quick

CONSTANTS = {
    "vehicle.steering_wheel_angle_max": 8.0,
    "brake_pressure_max": 12e6,
    "centre_of_mass.x": 0.35,
    "centre_of_mass.y": 0.0,
    "centre_of_mass.z": -0.25,
}
STYLES = ("carmaker", "carsim", "chrono", "osi", "vehicle_interfaces")
NAMES = (
    *(f"chassis.{name}" for name in ("x", "y", "z", "yaw", "pitch", "roll")),
    *(f"chassis.{kind}{axis}" for kind in "vaw" for axis in "xyz"),
    "speed",
    "sideslip",
    "steering_wheel_angle",
)
UNITS_OF_CARSIM = {
    "Vx": "km/h",
    "Yaw": "deg",
    "AVz": "deg/s",
    "Ay": "g",
    "XCG_TM": "m",
    "IMP_STEER_SW": "deg",
    "IMP_PCON_BK": "MPa",
}


def manoeuvre(end=12.0):
    """Steps of steering and pedals, smooth enough for differences, more than one turn to the left, then braking."""
    time = np.linspace(0.0, 12.0, 1201)
    ramp = np.clip(time, 0.0, 1.0)
    steering = 0.28 * np.sin(0.5 * np.pi * ramp) ** 2 + 0.02 * np.sin(2.0 * time)
    late = np.clip(time - 9.0, 0.0, 1.0)
    return Manoeuvre(
        "turn",
        time=time,
        inputs={"steering": steering, "throttle": 0.2 + 0.0 * time, "brake": 0.4 * np.sin(0.5 * np.pi * late) ** 2},
        start={"initial.speed": 15.0},
        stop_time=end,
    )


@pytest.fixture(scope="module")
def ours(foreign_fmu):
    return TestedCar("ours", FmuSource(foreign_fmu("ours")), step=0.01).drive(manoeuvre())


@pytest.fixture
def alias_file(tmp_path):
    def write(style, text=""):
        file = tmp_path / f"my_{style}.toml"
        numbers = "\n".join(f'"{name}" = {value}' for name, value in CONSTANTS.items())
        file.write_text(f'extends = "{style}"\n{text}\n[constants]\n{numbers}', encoding="utf-8")
        return file

    return write


def car_of(fmu, file):
    aliases = Aliases(constants=CONSTANTS) if file is None else find_aliases(file, Variables(described(fmu)))
    return TestedCar(fmu.stem, FmuSource(fmu, aliases), step=0.01)


def largest_errors(ours, theirs):
    """By name, relative to the largest value; the record's ends apart, where differences are one-sided."""
    inner = slice(3, -3)
    return {
        name: float(np.max(np.abs(theirs[name] - ours[name])[inner]) / max(np.max(np.abs(ours[name])), 1e-3))
        for name in NAMES
    }


def test_all_files_that_come_with_the_package_are_tried_here():
    assert tuple(shipped_names()) == STYLES


# Rates are differences over 10 ms, in which inputs are held, and so are half a step late; CarSim's axes do not roll.
TOLERANCES = {"carsim": 2e-3, "chrono": 1e-2, "osi": 3e-3}


@pytest.mark.parametrize("style", quick(("carmaker", "carsim"), STYLES))
def test_the_same_car_gives_the_same_record(style, foreign_fmu, alias_file, ours):
    record = car_of(foreign_fmu(style), alias_file(style)).drive(manoeuvre())
    assert np.ptp(ours["chassis.yaw"]) > 2.0 * np.pi
    assert np.max(np.abs(ours["chassis.roll"])) > 0.02
    errors = largest_errors(ours, record)
    by_rates = {n for n in NAMES if n.startswith("chassis.a")} | (
        {"chassis.vy", "chassis.vz", "sideslip"} if style == "carsim" else set()
    )
    if style == "carsim":
        del errors["chassis.az"], errors["chassis.vz"]  # what rolled axes have of the lateral ones
    assert max(e for n, e in errors.items() if n not in by_rates) < 1e-6, errors
    assert max(e for n, e in errors.items() if n in by_rates) < TOLERANCES.get(style, 1e-6), errors
    assert record["steering"] == pytest.approx(ours["steering"], abs=1e-12)
    assert record["brake"] == pytest.approx(ours["brake"], abs=1e-12)


@pytest.mark.slow
def test_measures_of_the_catalogue_are_the_same(foreign_fmu, alias_file):
    """Of the style with the most that differs."""
    test = standard_test("step_steer")
    cars = (car_of(foreign_fmu("ours"), None), car_of(foreign_fmu("chrono"), alias_file("chrono")))
    for car in cars:
        assert reason_against(test, car, {s.name: s.value for s in test.settings}) is None
    ours, theirs = ({m.name: m.value for m in perform(test, car).measures} for car in cars)
    assert theirs.keys() == ours.keys()
    assert sum(map(math.isfinite, ours.values())) > 10
    for name, value in ours.items():
        assert theirs[name] == pytest.approx(value, rel=2e-2, abs=1e-9, nan_ok=True), name


@pytest.mark.slow
def test_rates_are_of_the_steps_where_rows_are_further_apart(foreign_fmu, alias_file):
    """Also at rows every 0.5 s; yaw counts its turns between them."""
    car = car_of(foreign_fmu("chrono"), alias_file("chrono"))
    each, few = (car.drive(manoeuvre(6.0), record_step=apart) for apart in (None, 0.5))
    assert len(few.time) == 13
    assert np.array_equal(few["chassis.yaw"], each["chassis.yaw"][::50])
    inner = slice(1, -1)  # the ends have differences on one side
    assert few["chassis.ay"][inner] == pytest.approx(each["chassis.ay"][::50][inner], abs=0.1)


@pytest.mark.slow
def test_rates_are_as_good_as_the_step_is_short(foreign_fmu, alias_file):
    errors = []
    for step in (0.01, 0.002):
        exact = replace(car_of(foreign_fmu("ours"), None), step=step).drive(manoeuvre(3.0))
        result = replace(car_of(foreign_fmu("chrono"), alias_file("chrono")), step=step).drive(manoeuvre(3.0))
        errors.append(largest_errors(exact, result)["chassis.ay"])
    assert errors[1] == pytest.approx(errors[0] / 5.0, rel=0.3)


def test_what_drives_senses_the_derived_variables(foreign_fmu, alias_file):
    class Looks:
        def __init__(self):
            self.seen = []

        def act(self, time, observation):
            self.seen.append((time, observation["chassis.yaw"], observation["chassis.ay"], observation["speed"]))
            return {"throttle": 0.1}

    pilot = Looks()
    record = car_of(foreign_fmu("chrono"), alias_file("chrono")).drive(manoeuvre(3.0), pilot)
    _, yaw, ay, speed = np.array(pilot.seen).T
    n = len(yaw)
    assert yaw == pytest.approx(record["chassis.yaw"][:n], abs=1e-9)
    assert speed == pytest.approx(record["speed"][:n], abs=1e-9)
    assert np.isnan(ay[0])
    assert ay[3:] == pytest.approx(record["chassis.ay"][3:n], abs=0.05)


def test_units_that_the_fmu_declares_are_held_against_the_file(foreign_fmu, with_units, alias_file):
    fmu = foreign_fmu("carsim")
    find_aliases(alias_file("carsim"), Variables(described(with_units(fmu, UNITS_OF_CARSIM))))
    other = Variables(described(with_units(fmu, UNITS_OF_CARSIM | {"Vx": "m/s"})))
    with pytest.raises(HostError, match=r"'Vx' is in km/h, the FMU declares m/s; one of them is wrong"):
        find_aliases(alias_file("carsim"), other)
    with pytest.raises(HostError, match=r"'Vx' in the FMU in km/h: its factor must be 3.6 .*, it is 1\."):
        find_aliases(
            alias_file("carsim", '"chassis.vx" = "Vx"'), Variables(described(with_units(fmu, UNITS_OF_CARSIM)))
        )
    with pytest.raises(HostError, match=r"'chassis.x' is in m, but the FMU declares 'Yaw' in deg, another quantity"):
        find_aliases(
            alias_file("carsim", '"chassis.x" = "Yaw"'), Variables(described(with_units(fmu, UNITS_OF_CARSIM)))
        )


def test_a_formula_takes_si_units_only(foreign_fmu, with_units, tmp_path):
    file = tmp_path / "a.toml"
    file.write_text('sideslip = { from = "sideslip(Vx, Vy)" }')
    variables = Variables(described(with_units(foreign_fmu("carsim"), UNITS_OF_CARSIM)))
    with pytest.raises(HostError, match="'Vx' is in km/h in the FMU, formulas take SI units"):
        find_aliases(file, variables)


def test_what_depends_on_the_car_is_asked_for(foreign_fmu):
    variables = Variables(described(foreign_fmu("carmaker")))
    with pytest.raises(HostError) as refusal:
        find_aliases("carmaker", variables)
    assert str(refusal.value) == (
        "carmaker.toml needs numbers of this car, 'vehicle.steering_wheel_angle_max' (angle of the steering wheel at "
        'full lock, rad): write a file with extends = "carmaker" and them in its table [constants], for --aliases.'
    )
    with pytest.raises(HostError, match=r"'centre_of_mass\.x' \(centre of mass at rest ahead.*_angle_max' \(angle of"):
        find_aliases("chrono", Variables(described(foreign_fmu("chrono"))))


def test_a_file_of_another_program_is_refused(foreign_fmu):
    with pytest.raises(HostError, match="this FMU has none, such as 'IMP_STEER_SW'; is it an FMU of that program"):
        find_aliases("carsim", Variables(described(foreign_fmu("carmaker"))))


def test_the_reason_for_a_missing_variable_is_reported(foreign_fmu, alias_file):
    aliases = find_aliases(alias_file("carmaker"), Variables(described(foreign_fmu("carmaker"))))
    assert aliases.why_missing("wheel_FL.Fz") == (
        "carmaker.toml takes 'wheel_FL.Fz' from 'Car.FzFL', which the FMU does not have"
    )
    assert aliases.why_missing("chassis.x") == ""


def test_a_variable_that_is_no_output_is_reported(foreign_fmu, tmp_path, alias_file):
    fmu = foreign_fmu("carmaker")
    result = tmp_path / "local.fmu"

    def local(content: bytes) -> bytes:
        content = re.sub(rb'(name="Car.ay"[^>]*)causality="output"', rb'\1causality="local"', content)
        return content.replace(b'causality="local" initial="calculated"', b'causality="local"')

    changed_fmu(fmu, result, {DESCRIPTION: local})
    aliases = find_aliases(alias_file("carmaker"), Variables(read_model_description(str(result), validate=False)))
    assert aliases.why_missing("chassis.ay") == (
        "carmaker.toml takes 'chassis.ay' from 'Car.ay', which is a local variable of the FMU and not an output"
    )

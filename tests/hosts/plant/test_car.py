"""A car in Python: the bits of its FMU, seeded starts, arrays, saved states."""

import shutil
from collections.abc import Sequence
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.simulation import instantiate_fmu

from hosts.common.errors import HostError
from hosts.plant import Car

INPUTS = ("steering", "throttle")
READS = ("chassis.x", "chassis.y", "speed", "wheel_FL.Fz", "solver.iterations")
SPEED = {"initial.speed": 15.0}


def drive(car: Car, steps: int) -> np.ndarray:
    rows = []
    for k in range(steps):
        car.step([0.3 * np.sin(0.1 * k), 0.4])
        rows.append(car.read(READS))
    return np.array(rows)


def by_fmpy(
    path: Path, start: dict[str, float], inputs: Sequence[str], input_rows: np.ndarray
) -> dict[str, np.ndarray]:
    """All outputs that are real, after each row of inputs, by a plain host."""
    description = fmpy.read_model_description(str(path))
    reference = {v.name: v.valueReference for v in description.modelVariables}
    folder, rows = fmpy.extract(str(path)), []
    slave = instantiate_fmu(folder, description)
    slave.setupExperiment(startTime=0.0)
    slave.setReal([reference[n] for n in start], list(start.values()))
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    outputs = [v.name for v in description.modelVariables if (v.causality, v.type) == ("output", "Real")]
    for k, row in enumerate(input_rows):
        slave.setReal([reference[n] for n in inputs], list(row))
        slave.doStep(k * 0.01, 0.01)
        rows.append(slave.getReal([reference[n] for n in outputs]))
    slave.terminate()
    slave.freeInstance()
    shutil.rmtree(folder)
    return dict(zip(outputs, np.array(rows).T, strict=True))


@pytest.fixture
def car(rigid_fmu: Path):
    with Car(rigid_fmu, inputs=INPUTS) as opened:
        yield opened


@pytest.mark.parametrize(
    ("fmu", "inputs", "start"),
    [
        ("rigid_fmu", INPUTS, SPEED),
        pytest.param(
            "braked_fmu",
            ("steering", "wheel_FL.brake_torque_demand", "wheel_RR.brake_torque_demand"),
            SPEED | {"road.friction": 0.7, "front.spring.stiffness": 18000.0, "initial.yaw": 1.0},
            marks=pytest.mark.slow,
        ),
    ],
)
def test_its_bits_are_those_of_the_fmu_by_a_plain_host(fmu, inputs, start, request):
    """All outputs, with changed parameters, through ports, beyond ranges, and beside inputs that are refused."""
    path, random = request.getfixturevalue(fmu), np.random.default_rng(1)
    input_rows = random.random((40, len(inputs))) * [0.5, *(len(inputs) - 1) * [200.0 if "braked" in fmu else 0.7]]
    input_rows[7, 0], input_rows[20, 1] = 3.0, 1e6
    if fmu == "braked_fmu":
        input_rows[30, 2] = np.nan
    outputs = by_fmpy(path, start, inputs, input_rows)
    with Car(path, inputs=inputs) as car:
        car.reset(3, **start)
        for k, row in enumerate(input_rows):
            for bad in ((np.nan, *row[1:]), row[1:], "none"):
                with pytest.raises(HostError):
                    car.step(bad)
            car.step(row)
            now = car.read(tuple(outputs))
            assert (now == [values[k] for values in outputs.values()]).all()
        assert car.time == pytest.approx(0.4)


def test_a_new_start_and_a_saved_state_give_the_same_bits(car, rigid_fmu):
    car.reset(**SPEED)
    first = drive(car, 20)
    saved = car.save()
    on = drive(car, 20)
    car.restore(saved)
    assert car.time == pytest.approx(0.2)
    assert (drive(car, 20) == on).all()
    car.reset(**SPEED)
    assert (drive(car, 20) == first).all()
    with Car(rigid_fmu, inputs=INPUTS) as other:
        other.restore(saved)
        assert (drive(other, 20) == on).all()


def test_ranges_are_drawn_by_the_seed(car):
    ranges = {"initial.speed": (10.0, 20.0), "road.friction": (0.5, 0.9)}
    drawn = []
    for seed, order in ((1, ranges), (1, dict(reversed(ranges.items()))), (2, ranges)):
        car.reset(seed, **order)
        drawn.append(car.read(("initial.speed", "road.friction")))
    assert (drawn[0] == drawn[1]).all()
    assert (drawn[0] != drawn[2]).all()
    assert all(10.0 <= a <= 20.0 and 0.5 <= b <= 0.9 for a, b in drawn)


def test_warnings_are_those_of_the_fmu(car):
    car.reset(**SPEED)
    car.step([3.0, 0.0])
    message = "'steering' was set to 3 and is held at 1"
    assert [m for m in car.messages if message in m]
    car.reset(**SPEED)
    assert not [m for m in car.messages if message in m]  # those of the start before are gone
    car.step([3.0, 0.0])
    assert len([m for m in car.messages if message in m]) == 1


def test_inconsistent_arguments_are_refused_in_one_sentence(car, rigid_fmu):
    cases = {
        "no start yet": lambda: car.step([0.0, 0.0]),
        "no input 'stering'; did you mean 'steering'[?]": lambda: Car(rigid_fmu, inputs=("stering",)),
        "The names are 'steering'; they must be a list": lambda: Car(rigid_fmu, inputs="steering"),
        "'throttle' is named 2 times": lambda: Car(rigid_fmu, inputs=("throttle", "throttle")),
        "Ports are chosen": lambda: Car(rigid_fmu, ports="brakes"),
        "positive number": lambda: Car(rigid_fmu, step=0.0),
        "no parameter or input 'mass'": lambda: car.reset(mass=3.0),
    }
    for message, call in cases.items():
        with pytest.raises(HostError, match=message):
            call()
    car.reset()
    with pytest.raises(HostError, match="3 inputs are given; the car takes 2"):
        car.step([0.0, 0.0, 0.0])
    with pytest.raises(HostError, match="no variable that is a number 'sped'"):
        car.read(("sped",))
    for bad in ("brake", {"steering": 0.0}, [0.0, "x"], [10**400, 0.0]):
        with pytest.raises(HostError, match="they must be numbers, in an array"):
            car.step(bad)
    with pytest.raises(HostError, match=r"The names have \['speed'\] among them"):
        car.read((["speed"],))  # type: ignore[arg-type]
    locked = np.zeros(2)
    locked.flags.writeable = False
    for into in (np.zeros(3), np.zeros((2, 1)), np.zeros(2, int), [0.0, 0.0], locked):
        with pytest.raises(HostError, match="it must be an array of 2 floats") as refusal:
            car.read(("speed", "chassis.x"), into)
        assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("seed", "parameters", "message"),
    [
        (1, {"initial.speed": (20.0, 10.0)}, "'initial.speed' is [20.0, 10.0]; a range is two numbers, the smaller"),
        (1, {"initial.speed": "fast"}, "'initial.speed' is 'fast'; it must be a number."),
        (-1, {}, "The seed is -1; it must be a whole number from 0, or None."),
        (1, {"initial.sped": 1.0}, "no parameter or input 'initial.sped'; did you mean 'initial.speed' or"),
        (1, {"initial.speed": float("nan")}, "'initial.speed' was set to nan"),
    ],
)
def test_a_start_that_there_is_not_is_one_sentence_and_no_start(car, seed, parameters, message):
    with pytest.raises(HostError) as refusal:
        car.reset(seed, **parameters)
    assert message in str(refusal.value)
    assert "\n" not in str(refusal.value)
    if message.endswith("nan"):
        with pytest.raises(HostError, match="has no start yet"):
            car.step([0.0, 0.0])
    car.reset(**SPEED)
    assert car.read(("speed",)) == pytest.approx(15.0, abs=0.01)


def test_a_car_without_a_start_or_closed_is_refused(rigid_fmu):
    car = Car(rigid_fmu, inputs=INPUTS)
    uses = (lambda: car.step([0.0, 0.0]), lambda: car.read(READS), car.save)
    for use in uses:
        with pytest.raises(HostError, match="has no start yet"):
            use()
    car.reset()
    saved = car.save()
    with pytest.raises(HostError, match="None is not a state of a car"):
        car.restore(None)  # type: ignore[arg-type]
    car.close()
    car.close()
    for use in (*uses, car.reset, lambda: car.restore(saved)):
        with pytest.raises(HostError, match="The car is closed"):
            use()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"car": 1}, "The car is 1; it must be a name, a folder or a file."),
        pytest.param({"ports": ["brakes", "nowhere"]}, "The ports are 'brakes,nowhere'", marks=pytest.mark.slow),
        ({"ports": {"torque": 1}}, "The ports are {'torque': 1}; they must be a list or tuple of texts."),
        ({"car": "rigid", "parameters": 5}, "The parameters are 5; they must be a dictionary."),
        ({"step": "0.01"}, "The communication step of a car is '0.01'; it must be a positive number, in s."),
    ],
)
def test_options_of_another_type_are_refused_in_one_sentence(options, message, rigid_fmu):
    if options.get("car") == "rigid":
        options = options | {"car": rigid_fmu}
    with pytest.raises(HostError, match=message):
        Car(**options)

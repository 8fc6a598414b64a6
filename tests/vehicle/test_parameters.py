"""Every number of a car file that says it may change is a parameter of the FMU and does what the file would do."""

from functools import cache

import numpy as np
import pytest

from mbs import Pose, compile, simulate
from mbs.kernel.header.enumerations import ParameterTarget
from mbs.vehicle import car_names, load
from mbs.vehicle.car import car_from
from mbs.vehicle.changed_content import changed_content
from mbs.vehicle.section import AXES, PRODUCTS, sections_of
from tests.quick import quick

NOT_IN_THE_FILE = {"road.kerb_x", "road.kerb_height"}
H = 0.005  # s
SAME = 1e-9
# a wheel that is turned has another elimination of zeros: a step may stop one iteration earlier or later
SAME_ITERATED = 1e-6
OF_ALL_KINDS = ("prototype", "hatchback", "saloon", "ferrari_250_lm", "commonroad_320i")  # each template is in one
TOGETHER = 8  # parameters that are changed in one run
CHASSIS = {"mass": 0.003, "com": 0.002, "inertia": 0.01, "products": 1.0}
"""Changes of the body, of mass and inertia by parts of them; the checks of a file allow little more."""
SAME_BODY = 2e-6
"""Of another body, whose run begins with other round-off."""
ALONE = ("steering.by_torque",)  # with it the steering wheel is let go


@cache
def model(name):
    return load(name).model()


@cache
def system(name):
    return compile(model(name))


def other(name, path):
    """A plausible value that is not that of the file."""
    q = quantity(name, path)
    value = load(name).values()[path]
    if path == "steering.by_torque":
        return 1.0 - value
    if of_the_body(path):
        what = path.split(".")[1]
        return value + CHASSIS[what] * (value if what in ("mass", "inertia") else 1.0)
    if turns_a_wheel(path):
        return value + 0.003  # rad, some minutes of arc as a workshop sets them
    if value == 0.0:
        return q.low + 0.1 * (q.high - q.low)
    if path.endswith("_power"):
        return max(0.1 * value, q.low)  # a limit that so short a drive meets
    return 0.93 * value if 0.93 * value >= q.least else min(1.07 * value, q.high)


def turns_a_wheel(path):
    """Whether a parameter turns the axis of a wheel on its carrier."""
    return ".alignment." in path


def of_the_body(path):
    """Whether a parameter is mass, centre or inertia of the chassis."""
    return path.startswith("chassis.") and path.split(".")[1] in CHASSIS


def quantity(name, path):
    table, _, field = path.rpartition(".")
    if field in (*AXES, *PRODUCTS):
        return quantity(name, table)
    (section,) = (s for s in sections_of(load(name)) if s.path == table)
    return section.quantity(field)


def driven(compiled, parameters):
    """From rest and from 20 m/s: full throttle, coasting, brake, hand brake, a turn."""
    input_values = {
        "steering": lambda t: 0.15 * np.sin(3.0 * t),
        "throttle": lambda t: 1.0 if t < 0.3 else 0.0,
        "brake": lambda t: 0.0 if t < 0.45 else 0.4,
        "hand_brake": lambda t: 0.0 if t < 0.6 else 0.3,
    }
    inputs = {i["name"]: input_values[i["name"]] for i in compiled.meta["inputs"] if i["name"] in input_values}
    quiet = {"estimate_error": False, "progress": False}
    return [simulate(compiled, 0.7, H, inputs, None, parameters, pose=Pose(speed=v), **quiet) for v in (0.0, 20.0)]


@pytest.mark.parametrize("name", car_names())
def test_every_number_that_may_change_is_tied_to_the_model(name):
    parameters = {p.name: p for p in model(name).parameters}
    assert set(parameters) - NOT_IN_THE_FILE == set(load(name).values())
    for path, value in load(name).values().items():
        q, p = quantity(name, path), parameters[path]
        assert (p.value, p.min, p.max, p.unit) == (value, q.least, q.high, q.unit)
        assert p.tunable == (q.change == "tunable"), path
        assert len(p.description) > 3


@pytest.mark.parametrize("name", car_names())
def test_the_elements_of_a_file_have_the_numbers_that_its_parameters_write(name):
    """In a run a parameter writes its number over that of the file. What is 0 in the file has another value here."""
    car, left_out = load(name), without_assistance(load(name))
    zeros = [p for p, v in car.values().items() if v == 0.0 and p not in left_out and not of_the_body(p)]
    content = changed_content(car._data, {path: other(name, path) for path in zeros}, "x")
    built = car_from(content, car.folder, "x", at_rest=False).model()
    for p in built.parameters:
        for kind, index, number, scale, offset, inverse in p.targets:
            if kind == ParameterTarget.ELEMENT:
                expected = (scale / p.value if inverse else scale * p.value) + offset
                assert built.elements[index].real[number] == pytest.approx(expected, rel=1e-12, abs=1e-12), p.name


def rebuilt(name, values):
    """Runs of the car of a changed file."""
    car = load(name)
    changed = car_from(changed_content(car._data, values, "x"), car.folder, "x", at_rest=False)
    return driven(compile(changed.model()), None)


def differing(name, some, others, same=SAME):
    """Outputs that differ between runs by more than a part `same` of 1 or of their largest value."""
    outputs = [s["name"] for s in system(name).meta["sensors"] if not s["name"].startswith("solver.")]
    result = set()
    for one, other_one in zip(some, others, strict=True):
        for output in outputs:
            largest = np.abs(one[output] - other_one[output]).max()
            if not largest <= same * max(1.0, np.abs(other_one[output]).max()):
                result.add(output)
    return result


def told(car):
    """Parameters of a car that change a run; the density of the air does so by an area only."""
    air = any(value for path, value in car.values().items() if path.startswith("aerodynamics.") and "area" in path)
    hidden = {"aerodynamics.air_density"} if not air else set()
    return [path for path in car.values() if path not in hidden]


def wrong_parameters(name, groups, each=False):
    """Groups of parameters that do something else than the file would do, or that change nothing.

    With `each` also parameters without which a group does the same.
    """
    wrong = []
    for group in groups:
        values = {path: other(name, path) for path in group}
        tuned = driven(system(name), values)
        same = SAME_BODY if any(map(of_the_body, group)) else SAME_ITERATED if any(map(turns_a_wheel, group)) else SAME
        outputs = differing(name, tuned, rebuilt(name, values), same)
        if any(map(of_the_body, group)):  # as a load on a frame, whose own mass stays; a file's frame is another one
            outputs = {output for output in outputs if not output.startswith(("stress.", "bending_moment."))}
        if outputs:
            wrong.append(f"{values} in the FMU and in the file give another {sorted(outputs)}")
        for path in group if each else ():
            without = {p: v for p, v in values.items() if p != path}
            if not differing(name, tuned, driven(system(name), without)):
                wrong.append(f"{path} changes nothing beside {sorted(without)}")
    return wrong


@cache
def kinds(name):
    """Of each parameter that changes a run: the template of its axle, its table's type and keys, and its own key."""
    car, results = load(name), {}
    sections = {s._path: s for s in sections_of(car) if s._path}
    for path in told(car):
        table = max((p for p in sections if path.startswith(f"{p}.")), key=len)
        suspension = getattr(sections.get(path.partition(".")[0]), "suspension", None)
        keys = frozenset(sections[table].model_fields_set)
        results[path] = (type(suspension), type(sections[table]), keys, path.removeprefix(table))
    return results


def without_assistance(car):
    """Parameters that the file of a car without assistance cannot have: it has no limit for it."""
    none = getattr(car.steering, "assistance", 1.0) == 0.0
    return {"steering.assistance", "steering.assistance_limit"} if none else set()


@pytest.mark.slow
@pytest.mark.parametrize("name", quick(OF_ALL_KINDS, car_names(), "proof"))
def test_all_parameters_together_have_the_effect_of_the_file(name):
    """A few at a time; of cars in `OF_ALL_KINDS` those of a kind of their own."""
    car = load(name)
    before = OF_ALL_KINDS[: OF_ALL_KINDS.index(name)] if name in OF_ALL_KINDS else ()
    known = {kind for other_car in before for kind in kinds(other_car).values()}
    without = without_assistance(car)
    own = [path for path, kind in kinds(name).items() if kind not in known and path not in without]
    apart = [[path for path in own if kind(path)] for kind in (turns_a_wheel, of_the_body, ALONE.__contains__)]
    paths = [path for path in own if not any(path in group for group in apart)]
    groups = -(-len(paths) // TOGETHER)
    wrong = wrong_parameters(name, [g for g in (*(paths[k::groups] for k in range(groups)), *apart) if g])
    assert not wrong, "\n".join(wrong)


@pytest.mark.proof
@pytest.mark.parametrize("name", car_names())
def test_a_parameter_has_the_effect_of_the_file(name):
    car = load(name)
    paths = [path for path in told(car) if path not in without_assistance(car)]
    wrong = wrong_parameters(name, [[path] for path in paths], each=True)
    assert not wrong, "\n".join(wrong)

"""An invalid car file is refused with a sentence for each fault, the same in every command and function."""

import os

import pytest

from ali3.command import main
from ali3.typed_paths import annotation_at, keys_of, table_at, value_type_of
from mbs.vehicle import Car, CarFileError, CarWarning, car_names, load
from mbs.vehicle.car import car_from
from mbs.vehicle.changed_content import changed_content
from tests.quick import quick
from tests.vehicle.content import new_with, numbers, problems_of, sentences, tables, warnings_of

FIRST = "prototype"
CAR_NAMES = sorted(car_names(), reverse=True)
SWEPT = quick(("prototype",), CAR_NAMES, "proof")


def refused(changes, name=FIRST, lines=1):
    """The sentences for a car with other values."""
    before = load(name).model_dump()
    with pytest.raises(CarFileError) as refusal:
        load(name).changed(changes)
    result = sentences(refusal.value, f"car '{name}': ")
    assert len(result) == lines or lines is None, result
    assert load(name).model_dump() == before
    return [line.removeprefix(f"car '{name}': ") for line in result]


def test_keys_of_another_kind_are_reported_as_such():
    lines = refused(
        {"steering.kind": "column"} | {f"steering.{key}": 1.0 for key in ("rack_mass", "trail")}, lines=None
    )
    assert not [line for line in lines if "another kind" in line]
    (line,) = refused({"steering.rack_mass": 2.5})
    kind = load(FIRST).steering.kind
    assert line.startswith(f"steering.rack_mass belongs to another kind than '{kind}'; the keys of steering are ")
    lines = refused({"front.suspension.kind": "twist_beam"}, lines=None)
    assert any(line.startswith("front.suspension.points.lower_ball_joint belongs to another kind") for line in lines)


@pytest.mark.slow
@pytest.mark.parametrize("name", quick(("prototype", "commonroad_320i"), CAR_NAMES, "proof"))
@pytest.mark.parametrize("factor", [1000.0, pytest.param(0.001, marks=pytest.mark.proof)])
def test_each_number_in_a_unit_wrong_by_1000_is_reported(name, factor):
    """Each in the first car that has it: its range is that of its name."""
    silent = set()
    values = numbers(name)
    for path in new_with(name, numbers, CAR_NAMES):
        if values[path] and not problems_of({path: factor * values[path]}, name):
            silent.add(path)
    angles = {
        f"{axle}.alignment.{what}_{side}"
        for axle in ("front", "rear")
        for what in ("toe", "camber")
        for side in ("left", "right")
    }
    # a centre of mass just off the middle is a possible one, and so are an angle and a difference of nearly 0
    assert silent <= {"vehicle.reference_point.1"} | (angles | {"brakes.side"} if factor < 1.0 else set())


@pytest.mark.parametrize("name", SWEPT)
@pytest.mark.parametrize("factor", [1000.0, 0.001, -1.0])
def test_each_table_in_a_wrong_unit_or_negative(name, factor):
    for table in tables(load(name)._data):
        changes = {p: factor * v for p, v in numbers(name).items() if p.startswith(f"{table}.")}
        if changes and not table.endswith(".alignment"):  # any sign, and any small angle, is one that a wheel has
            assert problems_of(changes, name), table


@pytest.mark.parametrize("name", SWEPT)
def test_each_table_and_key_that_is_missing(name):
    for path in [*tables(load(name)._data), *(p for p in numbers(name) if not p.split(".")[-1].isdigit())]:
        data = changed_content(load(name)._data, {}, "x")
        *outer, last = path.split(".")
        named = value_type_of(annotation_at(Car, outer, data)) is not None
        if outer[-1:] == ["sections"]:
            continue  # another table asks for it
        table = data
        for key in outer:
            table = table[key]
        del table[last]
        try:
            car_from(data, load(name).folder, "x", at_rest=False)
        except CarFileError as error:
            (line,) = sentences(error, "x: ")
            assert line.startswith(f"x: {path}")
            assert "is missing" in line or not keys_of(table_at(Car, outer, data))[last].is_required(), line
        else:
            assert named or not keys_of(table_at(Car, outer, data))[last].is_required(), path


@pytest.mark.slow
@pytest.mark.parametrize("name", SWEPT)
def test_each_key_that_is_misspelt(name):
    for path in [*tables(load(name)._data), *(p for p in numbers(name) if not p.split(".")[-1].isdigit())]:
        data = changed_content(load(name)._data, {}, "x")
        *outer, last = path.split(".")
        if set(outer[-1:]) & {"accelerometers", "sections", "gauges", "payload"}:
            continue  # names that the user chooses
        table = data
        for key in outer:
            table = table[key]
        wrong = last[:-1] + last[-1] * 2 if len(last) > 2 else f"{last}x"
        table[wrong] = table.pop(last)
        with pytest.raises(CarFileError) as error:
            car_from(data, load(name).folder, "x", at_rest=False)
        (line,) = sentences(error.value, "x: ")
        assert line == f"x: {'.'.join([*outer, wrong])} is not known; did you mean '{last}'?" or len(last) < 3


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf"), 10**400, True, "1", [], {}, [[1.0]]])
def test_what_is_no_number(value):
    for path in ("front.spring.stiffness", "front.wheel.centre.1", "drive.ratios.0", "vehicle.mass"):
        (line,) = refused({path: value})
        assert line.startswith(path)
        assert "it must be" in line


MIRRORED = {
    "negative y": {"front.suspension.points.lower_ball_joint": [0.005, -0.6, 0.15]},
    "right wheel": {"rear.wheel.centre": [-2.3, -0.66, 0.2623]},
    "both halves of the body": {"chassis.ground_contact.points": [[0.45, 0.28, 0.19], [0.45, -0.28, 0.19]]},
    "right part": {"front.suspension.bodies.upright.com": [-0.005, -0.605, 0.255]},
}


@pytest.mark.parametrize("case", MIRRORED)
def test_points_of_the_right_side(case):
    assert any("left" in line or "y = -" in line for line in refused(MIRRORED[case], lines=None))


P = "front.suspension.points"
GEOMETRY = {  # what cannot move or has no direction, and what the sentence says
    "lower pivots at one place": ({f"{P}.lower_pivot_rear": [0.15, 0.3, 0.165]}, "the axis of the lower wishbone"),
    "a wishbone of no length": ({f"{P}.upper_ball_joint": [0.0, 0.35, 0.372]}, "the upper wishbone is 0.05 m long"),
    "a knuckle in one line": ({f"{P}.tie_rod_outer": [-0.005, 0.5875, 0.2675]}, "the steering arm is 0.02 m long"),
    "a tie rod of no length": ({f"{P}.tie_rod_inner": [-0.125, 0.572, 0.2032]}, "the tie rod is 0.05 m long"),
    "a spring of no length": ({f"{P}.spring_upper": [0.0, 0.5, 0.175]}, "the spring is 0.05 m long"),
    "a spring on the axis": ({f"{P}.spring_lower": [0.0, 0.3, 0.165]}, "the lever of the spring"),
    "a steering axis that lies": ({f"{P}.upper_ball_joint": [-0.4, 0.575, 0.26]}, "caster"),
    "a strut of no length": ({"rear.suspension.points.strut_top": [-2.3, 0.59, 0.17]}, "the strut stands"),
    "an arm of no length": ({"rear.suspension.points.lower_ball_joint": [-2.3, 0.31, 0.19]}, "the lower arm is"),
    "two axles at one place": ({"rear.wheel.centre": [0.0, 0.66, 0.2623]}, "0 m behind front.wheel.centre"),
    "wheels through each other": ({"rear.wheel.centre": [-0.5, 0.66, 0.2623]}, "pass each other"),
    "a smaller tyre": ({"rear.tyre.radius": 0.25}, "a car in equilibrium stands on its tyres"),
    "the body in a wheel": ({"chassis.ground_contact.points.0": [0.1, 0.65, 0.3]}, "lies in the tyre"),
    "a stop that acts as drawn": ({"front.suspension.steering_stop.length": 0.45}, "must be less than the"),
    "another mass": ({"vehicle.mass": 620.0}, "the masses of all parts add up to 597 kg"),
    "another centre of mass": ({"vehicle.reference_point": [-1.6, 0.0, 0.353]}, "which it is"),
    "products too large": ({"chassis.products": [0.0, 0.0, 600.0]}, "principal moments"),
    "a ring of a wheel": ({"front.wheel.spin_inertia": 1.5}, "no wheel has that"),
    "a trail behind the patch": ({"front.tyre.trail": [1.2, 1.2]}, "trail.0 is 1.2; it must be 0 or between"),
    "sliding before the peak": ({"rear.tyre.lateral.slide_slip": [0.1, 0.1]}, "must be larger than"),
    "sliding before the peak without load": (
        {"rear.tyre.lateral.slide_slip": [0.3, 0.9]},
        "rear.tyre.lateral.slide_slip at 0 N is -0.3; it must exceed",
    ),
    "a force that falls with the load": (
        {"front.tyre.max_load_factor": 9.0},
        "N per nominal load; it must be greater than zero; its two numbers are",
    ),
    "gears in the wrong order": (
        {"drive.ratios": [4.0, 5.9, 10.5]},
        "drive.ratios are [4.0, 5.9, 10.5]; they must fall",
    ),
    "a shift longer than its dwell": ({"drive.dwell": 0.1}, "drive.dwell is 0.1 s; it must not be less than ramp"),
    "shifts to and fro": ({"drive.down_open": 530.0}, "drive.up_open is 540 rad/s; it must be more than"),
    "an idle speed above stall": ({"drive.idle_speed": 300.0}, "drive.idle_speed is 300 rad/s, stall_speed 230 and"),
    "no points of the body": ({"chassis.ground_contact.points": []}, "chassis.ground_contact.points is []"),
    "no gears": ({"drive.ratios": []}, "it must be a list of numbers, between 0.3 and 60, not empty"),
    "no such template": ({"front.suspension.kind": "five_link"}, "it must be one of 'double_wishbone'"),
}


@pytest.mark.parametrize("case", GEOMETRY)
def test_invalid_cars_are_refused(case):
    changes, message = GEOMETRY[case]
    assert any(message in line for line in refused(changes, lines=None)), refused(changes, lines=None)


ODD = {
    "tyres without grip": ({"front.tyre.grip": 0.0}, "force over load that the tyre reaches on its road is 0;"),
    "a narrow body": ({"vehicle.width": 0.6}, "width over track is 0.44"),
    "a short body": ({"vehicle.length": 2.4}, "length over wheelbase is 1.043"),
    "springs far too long": ({"front.spring.free_length": 1.9}, "length of the spring at rest over free length is 0."),
    "ice": ({"road.friction": 0.05}, None),
    "a drive that gives nothing": ({"drive.efficiency": 0.0}, None),
    "soft springs": ({"front.spring.stiffness": 9000.0}, "higher in the chassis than front.wheel.centre"),
    "a soft tyre": ({"rear.tyre.stiffness": 40000.0}, "compresses the tyre by"),
    "weak brakes": ({"brakes.torque": 60.0}, "braking at full pedal without slip is 0.08"),
    "a tyre of glue": ({"front.tyre.nominal_load": 300.0}, "in front.tyre.nominal_load"),
    "a small tyre": ({"rear.tyre.nominal_load": 6000.0} | {
        f"rear.tyre.{c}.{k}": [4.0 * v for v in getattr(getattr(load("prototype").rear.tyre, c), k)]
        for c in ("longitudinal", "lateral") for k in ("slope", "max_force", "slide_force")
    }, "deflection at the nominal load over radius is 0.34"),
    "tyres of glue": ({"front.tyre.grip": 5.0}, "on its road is"),
    "a load without forces": (
        {"rear.tyre.max_load_factor": 0.5}, "rear.tyre.max_load_factor: the forces grow with the load up to 750 N, but",
    ),
    "brakes behind only": ({"brakes.balance": 0.0}, "share of the front wheels in the braking force is 0;"),
    "a rack that turns less": ({"steering.rack_travel": 0.02}, "on a steering arm"),
}  # fmt: skip


@pytest.mark.parametrize("case", quick(("tyres without grip", "ice", "soft springs", "brakes behind only"), ODD))
def test_implausible_values_are_reported_and_built(case):
    changes, message = ODD[case]
    lines = warnings_of(changes, "prototype")
    assert (lines == []) if message is None else any(message in line for line in lines)


def test_a_user_is_warned_of_implausible_values(copied):
    file = copied()
    text = file.read_text(encoding="utf-8").replace("stiffness = 12360.0", "stiffness = 9000.0")
    file.write_text(text + '\n[ports]\ntyre = "hub"\n', "utf-8")
    with pytest.warns(CarWarning, match=r"car\.toml: at rest the front wheels stand 0\.\d+ m higher") as caught:
        load(file)
    assert caught[0].filename == __file__


TEXTS = {
    "empty": (b"", "schema is missing"),
    "schema missing": (b"name = 'x'", "schema is missing; a car file says schema = 2"),
    "schema text": (b"schema = '1'", "schema is '1'; it must be the whole number 2"),
    "schema a table": (b"[schema]", "schema is a table or list"),
    "older": (b"schema = 1", "schema is 1; this release reads 2"),
    "newer": (b"schema = 3", "a newer form; this release reads 2. Update ALi3"),
    "a list for a table": (b"schema = 2\nfront = [1, 2]\nchassis = 3", "front is [1, 2]; it must be a table."),
}


@pytest.mark.parametrize("case", TEXTS)
def test_files_that_are_no_car_file(case, tmp_path):
    content, message = TEXTS[case]
    file = tmp_path / "car.toml"
    file.write_bytes(content)
    for door in (file, str(file), tmp_path):
        with pytest.raises(CarFileError) as error:
            load(door)
        assert any(message in line for line in sentences(error.value, str(file))), str(error.value)


def test_a_file_with_a_byte_order_mark_is_read(copied):
    file = copied()
    file.write_bytes(b"\xef\xbb\xbf" + file.read_bytes())
    assert load(file).name == "prototype"


@pytest.mark.parametrize("name", ["", "/nowhere/car.toml", "a\0b", "x" * 5000, "..."])
def test_names_of_no_car(name):
    with pytest.raises(CarFileError, match=r"^There is no car '.*the cars of the package are .*prototype, saloon\.$"):
        load(name)


@pytest.mark.parametrize("thing", [None, 1, ["prototype"], b"prototype", {}])
def test_things_that_are_no_name(thing):
    with pytest.raises(CarFileError, match=r"^A car is the name of one, a folder or a file, not "):
        load(thing)


def test_a_folder_without_a_file_and_a_folder_for_a_file(tmp_path):
    with pytest.raises(CarFileError, match="There is no car"):
        load(tmp_path)
    (tmp_path / "car.toml").mkdir()
    with pytest.raises(CarFileError, match=r"car\.toml is a folder; it must be a file\.$"):
        load(tmp_path)


@pytest.mark.skipif(os.name != "posix" or os.geteuid() == 0, reason="the administrator may read all")
def test_a_file_that_may_not_be_read(copied):
    file = copied()
    file.chmod(0)
    with pytest.raises(CarFileError, match=r"cannot be read: Permission denied\.$"):
        load(file)


PATHS = {
    "front.spring.stifness": "front.spring.stifness is not known; did you mean 'stiffness'?",
    "Front.spring.stiffness": "Front is not known; did you mean 'front'?",
    "front.stiffness": "front.stiffness is not known; 'stiffness' stands at ",
    "front.spring.stiffness.x": "front.spring.stiffness.x is not known; front.spring.stiffness is 12360.0, which has",
    "front.wheel.centre.3": "front.wheel.centre.3 is not known; front.wheel.centre is a list of 3, counted from 0.",
    "front.wheel.centre.w": "front.wheel.centre.w is not known; front.wheel.centre is a list of 3",
    "front..stiffness": "'front..stiffness' is not a key path",
    "": "'' is not a key path",
    7: "7 is not a key path",
    "quite.different": "quite is not known; the keys of the file are schema, name, ",
}


@pytest.mark.parametrize("path", PATHS)
def test_key_paths_that_are_wrong(path):
    (line,) = refused({path: 1.0})
    assert line.startswith(PATHS[path])


def test_changes_that_are_no_mapping():
    with pytest.raises(CarFileError, match="the changes are 3; they must be a mapping"):
        load("prototype").changed(3)


@pytest.mark.parametrize("changes", [{"front.spring.stifness": 1.0}, {"front.tyre.radius": 0.2}])
def test_the_same_through_every_door(changes, copied, capsys):
    """By a file, by `changed` and by the command line."""
    file = copied()
    (path, value), *_ = changes.items()
    (line,) = refused(changes)
    table, _, key = path.rpartition(".")
    before, head, after = file.read_text(encoding="utf-8").partition(f"[{table}]\n")
    rest = [text for text in after.split("\n") if text.partition("#")[0].partition("=")[0].strip() != key]
    if key in after:  # the first of that name stands in this table
        result = next(k for k, text in enumerate(after.split("\n")) if text.startswith(f"{key} ="))
        rest = [text for k, text in enumerate(after.split("\n")) if k != result]
    file.write_text(f"{before}{head}{key} = {value}\n" + "\n".join(rest), encoding="utf-8")
    with pytest.raises(CarFileError) as error:
        load(file)
    assert str(error.value) == f"{file}: {line}"
    assert main(["car", str(file)]) == 2
    assert capsys.readouterr().err == f"error: {file}: {line}\n"


@pytest.mark.parametrize(
    ("part", "rows"), [("spring", [[0.01, 240.0], [0.2, 4800.0]]), ("damper", [[-1.0, -900.0], [1.0, 900.0]])]
)
def test_a_table_passes_through_the_origin(part, rows):
    data = changed_content(load("prototype")._data, {}, "x")
    data["front"][part] = {"table": rows} | ({"free_length": 0.75} if part == "spring" else {})
    with pytest.raises(CarFileError, match=rf"front\.{part}\.table has no row \[0, 0\]"):
        car_from(data, load("prototype").folder, "x", at_rest=False)

"""Axles by their curves: against the links their tables come from, closed forms, and tables that are none."""

import copy
import csv
import shutil
import tracemalloc
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from mbs import Pose, Simulation, System, compile, simulate
from mbs.common.errors import ModelError
from mbs.vehicle import Car, CarFileError, CarWarning
from mbs.vehicle.car import car_from
from mbs.vehicle.kinematics.axle_compliance import compliance
from mbs.vehicle.kinematics.car_kinematics import kinematics
from mbs.vehicle.side import Side
from mbs.vehicle.suspensions.curve_poses import wheel_curves
from mbs.vehicle.suspensions.curve_table import COLUMNS, MAX_INTERVALS, read_curves
from tests.vehicle.curved_car import after_a_turn, curved_content, linked_car

WHEELS = ("FL", "FR", "RL", "RR")
CARS = ("saloon", "hatchback")
SWERVE = {
    "steering": (np.array([0.0, 0.2, 0.5, 0.8, 1.1, 1.5]), np.array([0.0, 0.0, 0.4, -0.4, 0.0, 0.0])),
    "brake": (np.array([0.0, 0.8, 1.1, 1.5]), np.array([0.0, 0.0, 0.3, 0.3])),
}


@cache
def linked(name: str) -> Car:
    return linked_car(name)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("curved")


@pytest.fixture(scope="module")
def content(folder: Path) -> dict[str, dict[str, Any]]:
    """Contents of car files, with their tables in folders of their names."""
    results = {}
    for name in CARS:
        (folder / name).mkdir()
        results[name] = curved_content(linked(name), folder / name)
    return results


def drive(system: System, seconds: float = 1.5) -> Any:
    return simulate(system, seconds, 0.005, inputs=SWERVE, pose=Pose(speed=15.0), estimate_error=False)


@pytest.mark.parametrize(
    ("name", "angle", "way", "load"), [("saloon", 1e-6, 1e-6, 5e-5), ("hatchback", 1e-4, 1e-5, 1e-3)]
)
def test_it_drives_as_the_links_that_its_tables_come_from(name, angle, way, load, content, folder):
    """A swerve with the brakes on; the cross-beam of the hatchback is a bar whose lever does not turn."""
    car = car_from(content[name], folder / name, name)
    system = compile(car.model())
    assert system.meta["report"]["degrees_of_freedom"] == 14
    links, curves = drive(compile(linked(name).model())), drive(system)
    gap = np.hypot(*(curves[f"chassis.{c}"] - links[f"chassis.{c}"] for c in "xy"))
    assert gap.max() < way * links["chassis.x"][-1]
    for wheel in WHEELS:
        change = np.ptp(links[f"wheel_{wheel}.Fz"])
        assert np.abs(curves[f"wheel_{wheel}.Fz"] - links[f"wheel_{wheel}.Fz"]).max() < load * change
        for name_of in ("steer", "inclination"):
            assert np.abs(curves[f"wheel_{wheel}.{name_of}"] - links[f"wheel_{wheel}.{name_of}"]).max() < angle
        force = np.ptp(links[f"spring_{wheel}.force"])
        assert np.abs(curves[f"spring_{wheel}.force"] - links[f"spring_{wheel}.force"]).max() < load * force
    rack = np.abs(links["steering_rack_force"]).max()
    assert np.abs(curves["steering_rack_force"] - links["steering_rack_force"]).max() < 1e-3 * rack


def test_one_axle_may_have_links_and_the_fidelity_of_tables_takes_both(content, folder):
    mixed = content["saloon"] | {"rear": linked("saloon")._data["rear"]}
    mixed["chassis"] = linked("saloon")._data["chassis"]
    car = car_from(mixed, folder / "saloon", "mixed", at_rest=False)
    for fidelity in ("rigid", "table"):
        force = Simulation(compile(car.model(fidelity=fidelity))).sensors["wheel_RL.Fz"]
        assert force == pytest.approx(2437.0, abs=5.0)


def test_compliance_is_that_of_the_forces_in_the_contact(content, folder):
    """u = c_x F_x + c_y F_y + c_m M_z of a wheel that does not steer, of both wheels of a turning car."""
    c_m, c_y, c_x = 8e-5, -3e-6, 2e-6
    data = content["saloon"]
    rear = {"per_moment": c_m, "per_lateral_force": c_y, "per_longitudinal_force": c_x}
    data = _with(data, "rear", compliance=rear)
    data = _with(data, "front", compliance={"per_moment": c_m})
    car = car_from(data, folder / "saloon", "compliant")
    at, out = after_a_turn(car, 20.0, steering=0.1, throttle=0.3)
    for side, sign in (("L", 1.0), ("R", -1.0)):
        Fx, Fy, Mz = (out[f"wheel_R{side}.{name}"] for name in ("Fx", "Fy", "Mz"))
        turn = at[f"compliance steer R{side}"]
        assert abs(turn) > 2e-3
        moved = car.rear.wheel.mass + car.rear.suspension.bodies.carrier.mass  # takes a part of the force to turn
        load = out[f"wheel_R{side}.Fz"] - moved * 9.81  # acts sideways in a chassis that leans
        Fy += load * np.sin(out["chassis.roll"]) - moved * out["chassis.ay"]
        assert turn == pytest.approx(sign * c_x * Fx + c_y * Fy + c_m * Mz, rel=0.03)
    ends = sum(at[f"rack end F{side}"] - at["rack travel"] for side in "LR")
    stiffness = car.front.suspension._steer_rate(car.front.suspension.of(Side("front", "left", 1.0))) ** 2 / c_m
    assert out["steering_rack_force"] == pytest.approx(stiffness * ends, rel=1e-3)


def rows_of(file: Path) -> tuple[list[str], np.ndarray]:
    with file.open(encoding="utf-8") as text:
        heading, *rows = csv.reader(text)
    return heading, np.array(rows, float)


def written(folder: Path, heading: list[str], rows: np.ndarray) -> None:
    with (folder / "rear.csv").open("w", newline="", encoding="utf-8") as text:
        csv.writer(text).writerows([heading, *rows.tolist()])


def _with(data: dict, axle: str, **more: Any) -> dict:
    return data | {axle: data[axle] | {"suspension": data[axle]["suspension"] | more}}


@pytest.fixture
def copied(content: dict, folder: Path, tmp_path: Path) -> Path:
    for file in (folder / "saloon").iterdir():
        shutil.copy(file, tmp_path)
    return tmp_path


def test_columns_in_other_units_names_and_of_both_wheels_are_the_same_car(content, copied):
    """Contact centres for wheel centres, caster for pitch, mm and deg, and a right side that mirrors the left."""
    car = car_from(content["saloon"], copied, "first")
    heading, rows = rows_of(copied / "rear.csv")
    columns = dict(zip([name.split(" ")[0] for name in heading], rows.T, strict=True))
    *_, up = car.rear.alignment.axes(Side("rear", "left", 1.0))
    toe, camber = columns["toe_angle"], columns["camber_angle"]
    leaning = np.stack([np.sin(camber) * np.sin(toe), np.sin(camber) * np.cos(toe), np.cos(camber)], axis=-1)
    contact = np.stack([columns["wheel_centre_x"], columns["wheel_centre_y"]], axis=-1)
    contact = contact - car.rear.wheel.centre[2] / up[2] * leaning[:, :2]
    i = int(np.argmin(np.abs(columns["wheel_travel"])))
    deg = np.degrees
    result = {
        "wheel_travel [mm]": 1e3 * columns["wheel_travel"],
        "wheelbase_change [mm]": -1e3 * (contact[:, 0] - contact[i, 0]),
        "contact_centre_y_left [mm]": 1e3 * contact[:, 1],
        "contact_centre_y_right [mm]": -1e3 * contact[:, 1],
        "steer_angle_left [deg]": -deg(toe),
        "steer_angle_right [deg]": deg(toe),
        "camber_angle [deg]": deg(camber),
        "camber_angle_right [deg]": deg(camber),
        "caster_angle_left [deg]": 5.0 - deg(columns["carrier_pitch_angle"]),
        "caster_angle_right [deg]": 5.0 - deg(columns["carrier_pitch_angle"]),
        "spring_length_left [mm]": 1e3 * columns["spring_length"],
        "spring_length_right [mm]": 1e3 * columns["spring_length"],
        "anti_roll_bar_angle_left [rad]": columns["anti_roll_bar_angle"],
        "anti_roll_bar_angle_right [rad]": columns["anti_roll_bar_angle"],
        "remark [1]": np.zeros(len(toe)),
    }
    result["wheelbase_change_right [mm]"] = result["wheelbase_change [mm]"]
    written(copied, list(result), np.array(list(result.values())).T)
    chassis = content["saloon"]["chassis"] | {"products": [0.0, 0.0, 0.0]}
    with pytest.warns(CarWarning, match="not used are the columns remark"):
        second = car_from(content["saloon"] | {"chassis": chassis}, copied, "second", warn=True)
    for side in (Side("rear", "left", 1.0), Side("rear", "right", -1.0)):
        one, other = (c.rear.suspension.of(side) for c in (car, second))
        np.testing.assert_allclose(other.centres, one.centres, atol=1e-12)
        np.testing.assert_allclose(other.rotations, one.rotations, atol=1e-12)


def test_uneven_points_are_a_smooth_curve_and_two_sweeps_of_a_rack_are_added(content, copied):
    before = car_from(content["saloon"], copied, "first")
    heading, rows = rows_of(copied / "rear.csv")
    written(copied, heading, np.delete(rows, [3, 8, 15], axis=0))
    uneven = car_from(content["saloon"], copied, "second").rear.suspension
    one, other = (c.of(Side("rear", "left", 1.0)) for c in (before.rear.suspension, uneven))
    for values, actual in ((one.centres, other.centres), (one.rotations, other.rotations)):
        smooth = CubicSpline(before.rear.suspension.table.travel, values)(uneven.table.travel)
        np.testing.assert_allclose(actual, smooth, atol=2e-6)
    heading, rows = rows_of(copied / "front.csv")
    cross = rows[(np.abs(rows[:, 0]) < 1e-9) | (np.abs(rows[:, 1]) < 1e-9)]
    written(copied, heading, cross)
    front = read_curves(copied, "rear.csv", "key", 1.0)
    full = before.front.suspension.table
    i, k = (int(np.argmin(np.abs(axis))) for axis in (full.travel, full.second))
    toe, whole = front.columns["toe_angle"], full.columns["toe_angle"]
    np.testing.assert_allclose(toe, whole[:, [k]] + whole[[i]] - whole[i, k], atol=1e-15)


def test_an_invalid_table_is_refused_in_one_sentence(content, copied):
    heading, rows = rows_of(copied / "rear.csv")
    toe = heading.index("toe_angle [rad]")

    def refused(match: str, head: list[str] = heading, values: np.ndarray = rows) -> None:
        written(copied, head, values)
        with pytest.raises(CarFileError, match=match):
            car_from(content["saloon"], copied, "x")

    others = [k for k in range(len(heading)) if k != toe]
    refused(
        r"rear\.csv\) has no column toe_angle or steer_angle; its columns are",
        [heading[k] for k in others],
        rows[:, others],
    )
    refused(r"has no column wheel_travel", [heading[0].replace("wheel", "weel"), *heading[1:]])
    refused(
        r"heading 'toe_angle \[N\]'; it must be 'toe_angle \[UNIT\]' with rad or deg",
        [name.replace("toe_angle [rad]", "toe_angle [N]") for name in heading],
    )
    refused(r"has 3 values of wheel_travel; there must be 4 or more", values=rows[:3])
    refused(r"has a wheel_travel of .* after .*; it must rise", values=rows[::-1])
    refused(r"0, the drawing, must lie between them", values=rows[-5:])
    hardly = np.vstack([rows[rows[:, 0] <= 0.0], rows[-1:]])
    hardly[-1, 0] = 1e-7
    refused(r"from .* to 1e-07 m; .* farther from 0 than a 200th of the range", values=hardly)
    refused(r"ends at .* m of the spring in bump; it must reach to the end of its stop", values=rows[:-4])
    wide = rows.copy()
    wide[2, toe] = 100.0
    refused(r"column toe_angle reaches 100 rad; it must be within 1\.6 rad", values=wide)
    far = rows.copy()
    far[:, heading.index("wheel_centre_y [m]")] *= 1000.0
    refused(r"column wheel_centre_y changes by .* m from its least .*; it must be less than 0\.7\d+ m", values=far)
    for k, name in enumerate(heading):
        if "centre" in name or k == toe:
            jump = rows.copy()
            jump[2, k] += 1.0 if k == toe else 0.5
            refused(rf"column {name.split()[0]} changes by .* per m of wheel_travel near .*; at most 10? ", values=jump)
    written(copied, heading, rows)
    with pytest.raises(CarFileError, match=r"nothing\.csv' cannot be read: there is no such file"):
        car_from(_with(content["saloon"], "rear", file="nothing.csv"), copied, "x")
    with pytest.raises(CarFileError, match="has no column rack_travel; the front axle steers"):
        car_from(_with(content["saloon"], "front", file="rear.csv"), copied, "x")
    heading, rows = rows_of(copied / "front.csv")
    refused("has the column rack_travel; the rear axle does not steer", heading, rows)
    refused(r"rows for .*; there must be one for each pair", heading, rows[:-1])
    refused("twice; there must be one row for each", heading, np.vstack([rows, rows[:1]]))
    alone = [k for k, name in enumerate(heading) if not name.startswith("rack_travel")]
    refused(r"values of wheel_travel twice, and no .*: rack_travel", [heading[k] for k in alone], rows[:, alone])


def test_a_wheel_angle_that_differs_from_that_of_the_file_is_reported(content, copied):
    """As a table in degrees under headings in radians."""
    data = copy.deepcopy(content["saloon"])
    car = car_from(data, copied, "x")
    assert car.front.suspension.steered_angle(0.07) == pytest.approx(0.6012, rel=5e-3)
    suspension, centre = car.front.suspension, car.front.wheel.centre
    assert not [*suspension.steering_oddities(car.steering, centre)]
    data["steering"]["front_wheel_angle_max"] = 0.9
    (sentence,) = suspension.steering_oddities(car_from(data, copied, "x").steering, centre)
    assert "front_wheel_angle_max is 0.9 rad, but at full travel of the rack, 0.07 m, the wheels of front" in sentence
    assert sentence.endswith("(front.csv) are turned by 0.6 rad; are the units of its headings right?")


def test_a_row_of_both_wheels_is_one_place_of_the_axle(content, folder, tmp_path):
    """The left wheel of a twist beam and, of the right one, the image of what the left does with travels exchanged."""
    mirrored = car_from(content["hatchback"], folder / "hatchback", "mirrored").rear.suspension
    heading, rows = rows_of(folder / "hatchback" / "rear.csv")
    exchanged = rows[[int(np.flatnonzero((rows[:, 0] == b) & (rows[:, 1] == a))[0]) for a, b in rows[:, :2]], 2:]
    names = heading[2:]
    exchanged[:, names.index("wheel_centre_y [m]")] *= -1.0
    sides = [name.replace(" [", f"_{side} [") for side in ("left", "right") for name in names]
    both = np.hstack([rows, exchanged])
    lifted = both[both[:, 0] >= -0.04]  # the right wheel keeps its range
    written(tmp_path, ["wheel_travel_left [m]", *heading[1:2], *sides], lifted)
    table, hub = read_curves(tmp_path, "rear.csv", "key", 1.0), mirrored.hub
    short, whole = slice(-len(table.travel), None), slice(None)
    for side, own, second in ((Side("rear", "left", 1.0), short, whole), (Side("rear", "right", -1.0), whole, short)):
        one, other = mirrored.of(side), wheel_curves(table, side, hub)
        np.testing.assert_allclose(other.travel, one.travel[own], atol=1e-12)
        np.testing.assert_allclose(other.second, one.second[second], atol=1e-12)
        np.testing.assert_allclose(other.centres, one.centres[own, second], atol=1e-12)
        np.testing.assert_allclose(other.rotations, one.rotations[own, second], atol=1e-12)
        np.testing.assert_allclose(other.lengths["spring_length"], one.lengths["spring_length"][own, second])


def test_a_column_of_one_wheel_is_asked_of_the_other(tmp_path):
    travel = np.linspace(-0.08, 0.08, 17)
    needed = dict.fromkeys(("wheel_centre_x", "wheel_centre_y", "toe_angle", "camber_angle"), 0.1 * travel)
    needed["carrier_pitch_angle"] = 0.1 * travel
    unit = {name: "rad" if name.endswith("angle") else "m" for name in COLUMNS}

    def table(*names: str) -> None:
        columns = [needed.get(name.removesuffix("_left").removesuffix("_right"), travel + 0.4) for name in names]
        units = [unit[name.removesuffix("_left").removesuffix("_right")] for name in names]
        written(
            tmp_path,
            ["wheel_travel [m]", *(f"{n} [{u}]" for n, u in zip(names, units, strict=True))],
            np.column_stack([travel, *columns]),
        )
        read_curves(tmp_path, "rear.csv", "key", 1.0)

    sides = [f"{name}_{side}" for name in needed for side in ("left", "right")]
    table(*sides)
    table(*sides, "spring_length_left", "spring_length_right")
    with pytest.raises(CarFileError, match="no column toe_angle or steer_angle of the right wheel"):
        table(*(n for n in sides if not n.startswith("toe")), "toe_angle")
    for one_wheel in (
        ["spring_length"],
        ["spring_length_left"],
        ["spring_length_right"],
        ["spring_length", "spring_length_left", "spring_length_right"],
    ):
        match = rf"right wheel and {', '.join(one_wheel)}; there must be spring_length_left and spring_length_right"
        with pytest.raises(CarFileError, match=match):
            table(*sides, *one_wheel)


def test_a_table_of_many_rows_is_thinned_or_refused_with_its_name(content, folder, copied):
    """Noisy pairs take no memory of rows by rows; a travel that ends at the drawing is no range."""
    rng = np.random.default_rng(1)
    noisy = np.column_stack([np.linspace(-0.08, 0.08, 6000), rng.uniform(-0.05, 0.05, 6000), np.zeros((6000, 5))])
    names = ("wheel_centre_x [m]", "wheel_centre_y [m]", "toe_angle [rad]", "camber_angle [rad]", "caster_angle [rad]")
    written(copied, ["wheel_travel [m]", "rack_travel [m]", *names], noisy)
    tracemalloc.start()
    try:
        with pytest.raises(CarFileError, match=r"rear\.csv\) has 6000 rows for 6000 values .* and 599. of rack_travel"):
            read_curves(copied, "rear.csv", "key", 1.0)
        assert tracemalloc.get_traced_memory()[1] < 16e6  # bytes; 6000 by 6000 numbers are 288e6
    finally:
        tracemalloc.stop()
    heading, rows = rows_of(folder / "saloon" / "rear.csv")
    smooth, step = CubicSpline(rows[:, 0], rows), rows[-1, 0] / 2500
    written(copied, heading, smooth(step * np.arange(np.ceil(rows[0, 0] / step), 2501)))
    table = car_from(content["saloon"], copied, "x").rear.suspension.table
    assert len(table.travel) <= MAX_INTERVALS + 1
    np.testing.assert_allclose(
        table.columns["toe_angle"][:, 0], smooth(table.travel)[:, heading.index("toe_angle [rad]")]
    )


def test_a_wheel_beyond_its_table_ends_the_run_with_its_name_and_range(content, copied):
    heading, rows = rows_of(copied / "rear.csv")
    short = _with(content["saloon"], "rear", file="rear.csv")
    short["rear"].pop("stops")
    written(copied, heading, rows[np.abs(rows[:, 0]) < 0.045])
    car = car_from(short, copied, "x")
    with pytest.raises(RuntimeError, match=r"'wheel travel R[LR]' is .*; its table goes from -0\.03"):
        simulate(compile(car.model()), 2.0, 0.005, pose=Pose(z=0.6))


def test_track_change_is_of_both_wheels(content, copied):
    """A swing axle whose wheel goes 0.55 m aside per m of travel: both together have 1.1 m per m."""
    heading, rows = rows_of(copied / "rear.csv")
    y, track = heading.index("wheel_centre_y [m]"), [*heading]
    track[y] = "track_change [m]"
    travel = rows[:, 0]
    values = rows.copy()
    values[:, y] = 1.1 * travel
    written(copied, track, values)
    swing = car_from(content["saloon"], copied, "x").rear.suspension
    contact = rows.copy()
    heading[y] = "contact_centre_y [m]"
    contact[:, y] = 0.55 * travel
    written(copied, heading, contact)
    other = car_from(content["saloon"], copied, "x").rear.suspension
    one, two = (s.of(Side("rear", "left", 1.0)).centres for s in (swing, other))
    np.testing.assert_allclose(one, two, atol=1e-12)
    values[:, y] = 2.2 * travel
    written(copied, track, values)
    with pytest.raises(CarFileError, match=r"track_change changes by 2\.2 m per m of wheel_travel .*; at most 2 m/m"):
        car_from(content["saloon"], copied, "x")


@pytest.mark.slow
def test_the_axle_with_links_has_its_own_curves(content, folder):
    whole = linked("saloon")
    data = content["saloon"] | {"rear": whole._data["rear"], "chassis": whole._data["chassis"]}
    half = car_from(data, folder / "saloon", "half", at_rest=False)
    actual, full = (kinematics(car, points=5) for car in (half, whole))
    assert {axle for axle, _ in actual.curves} == {"rear"}
    assert not actual.drawn("front")
    assert actual.drawn("rear") == pytest.approx(full.drawn("rear"), rel=1e-9)
    gives = compliance(half).values
    assert [*gives] == ["rear"]
    assert gives["rear"] == pytest.approx(compliance(whole, 0).values["rear"], rel=1e-6)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ({"inner": [-2.58, 0.61, 0.20]}, r"points\.outer is 0\.01 m from .*points\.inner; it must be 0\.05 m or more"),
        ({"inner": [-2.33, 0.62, 0.20], "second_inner": [-2.7, 0.62, 0.2]}, "is 0 m from the axis of both inner ends"),
        ({"inner": [-2.58, -0.3, 0.2]}, r"points\.inner has y = -0\.3 m; points are given for the left side"),
    ],
)
def test_an_invalid_link_is_refused_in_one_sentence(points, message, content, copied):
    data = copy.deepcopy(content["saloon"])
    data["rear"]["suspension"]["bodies"]["links"]["lower_wishbone"]["points"] = {"outer": [-2.58, 0.62, 0.20]} | points
    with pytest.raises(CarFileError, match=message):
        car_from(data, copied, "x")


def test_functions_that_need_links_ask_for_them(content, folder):
    car = car_from(content["saloon"], folder / "saloon", "x")
    with pytest.raises(ModelError, match=r"front\.suspension\.kind is 'curves'.*front\.csv has its curves"):
        kinematics(car)
    with pytest.raises(ModelError, match=r"front\.suspension\.kind is 'curves'"):
        compliance(car)
    bar = {"stiffness": 100.0, "part": "carrier", "points": linked("saloon")._data["front"]["anti_roll_bar"]["points"]}
    data = content["saloon"] | {"front": content["saloon"]["front"] | {"anti_roll_bar": bar}}
    with pytest.raises(CarFileError, match="needs links; for an axle by its curves give"):
        car_from(data, folder / "saloon", "x")

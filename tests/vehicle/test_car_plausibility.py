"""Implausible cars and tyres are reported with the probable mistake."""

import json
import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from ali3.plausibility import Mistake, Plausibility, Quantity, Value
from mbs import Pose, compile, simulate
from mbs.model.model import Model
from mbs.tyre_files.tyre_plausibility import tmeasy_plausibility
from mbs.vehicle import built_car, car_names, load
from mbs.vehicle.car import car_from
from mbs.vehicle.car_content import CarContent
from mbs.vehicle.changed_content import changed_content
from mbs.vehicle.checks.equilibrium import Rest, find_equilibrium
from mbs.vehicle.command import main
from mbs.vehicle.errors import CarWarning
from mbs.vehicle.summary import summary
from tests.quick import quick
from tests.vehicle.content import problems_of

DEG = 57.29577951308232


def at(name: str, key: str) -> Any:
    value: Any = load(name)._data
    for part in key.split("."):
        value = value[int(part)] if isinstance(value, list) else value[part]
    return value


def times(name: str, key: str, factor: float) -> dict[str, Any]:
    value = at(name, key)
    return {key: [factor * v for v in value] if isinstance(value, list) else factor * value}


def turned(name: str, key: str) -> dict[str, Any]:
    return {key: [[-v, -force] for v, force in reversed(at(name, key))]}


PLANTED: dict[str, tuple[str, Callable[[], dict[str, Any]], str]] = {
    "half the track": ("hatchback", lambda: times("hatchback", "rear.wheel.centre.1", 0.5), "half the track less half"),
    "toe of one": ("hatchback", lambda: {"front.alignment.toe_left": 0.18}, "radians in front.alignment.toe_left"),
    "camber in degrees": (
        "saloon",
        lambda: {"rear.alignment.camber_left": -0.18, "rear.alignment.camber_right": -0.18},
        "degrees instead of radians in rear.alignment.camber",
    ),
    "bump for rebound": ("hatchback", lambda: turned("hatchback", "front.damper.table"), "bump and rebound exchanged"),
    "no final drive": ("saloon", lambda: times("saloon", "drive.ratios", 0.27), "ratios without a final drive"),
    "final drive twice": ("saloon", lambda: times("saloon", "drive.ratios", 4.0), "twice in drive.ratios"),
    "torque in kgf m": (
        "commonroad_vanagon",
        lambda: times("commonroad_vanagon", "drive.max_torque", 0.102),
        "kilograms instead of newtons in drive",
    ),
    "damping in kgf s/m": (
        "saloon",
        lambda: times("saloon", "rear.damper.damping", 0.102),
        "kilograms instead of newtons in rear.damper",
    ),
    "both wheels": (
        "saloon",
        lambda: times("saloon", "front.wheel.spin_inertia", 2.0)
        | times("saloon", "front.wheel.diametral_inertia", 2.0),
        "both wheels instead of one",
    ),
    "half a wheel": ("saloon", lambda: times("saloon", "front.wheel.spin_inertia", 0.5), "half of the wheel"),
    "x for z": ("saloon", lambda: {"chassis.inertia": at("saloon", "chassis.inertia")[::-1]}, "x and z exchanged"),
    "damping in lbf s/in": (
        "saloon",
        lambda: times("saloon", "front.damper.damping", 1.0 / 20.0),
        "front damping ratio in bump is 0.01",
    ),
    "horsepower": ("saloon", lambda: times("saloon", "drive.max_power", 1.0 / 50.0), "power over mass is 1.7"),
    "share of the rear": ("saloon", lambda: {"brakes.balance": 0.2}, "the share of the rear wheels in brakes.balance"),
    "lock to lock": ("prototype", lambda: times("prototype", "steering.rack_per_turn", 6.0), "steering ratio is 2.8"),
    "a soft wheel": ("saloon", lambda: times("saloon", "front.wheel.spin_inertia", 0.3), "gyration of the wheel about"),
}  # fmt: skip


@pytest.mark.parametrize("case", quick(("no final drive", "share of the rear", "lock to lock"), PLANTED))
def test_a_mistake_of_a_car_is_reported(case):
    name, changes, message = PLANTED[case]
    lines = problems_of(changes(), name)
    assert any(message in line for line in lines), lines


@pytest.mark.parametrize("name", car_names())
def test_cars_of_the_package_lie_inside(name):
    for kind in ("", "racing_car" if name in ("prototype", "ferrari_250_lm") else "passenger_car"):
        for plausibility in load(name).plausibility(name):
            assert replace(plausibility, kind=kind).warnings() == []


@pytest.mark.slow
def test_the_kind_of_a_car_narrows_its_ranges():
    changes = {"front.wheel.centre.1": 0.97, "rear.wheel.centre.1": 0.97, "vehicle.width": 2.1}
    lines = {
        kind: problems_of(changes | {"vehicle.category": kind}, "hatchback") for kind in ("passenger_car", "truck")
    }
    assert any("front track is 1.94 m; usual is 1 to 1.85 m" in line for line in lines["passenger_car"])
    assert not any("track is" in line for line in lines["truck"])


def test_the_command_shows_and_writes_the_table(tmp_path, capsys):
    assert main(["saloon", "--json", str(tmp_path / "saloon.json")]) == 0
    shown = capsys.readouterr().out
    table = json.loads((tmp_path / "saloon.json").read_text(encoding="utf-8"))
    (wheelbase,) = (row for row in table["car"] if row["name"] == "wheelbase")
    assert wheelbase["value"] == pytest.approx(2.5789)
    assert (wheelbase["inside"], wheelbase["unit"]) == (True, "m")
    assert "front.wheel.centre" in wheelbase["keys"]
    assert {"wheelbase", "2.579", "tyres"} <= set(shown.split())


@pytest.mark.slow
def test_tables_of_a_car_with_a_port_in_place_of_its_tyres_are_those_on_its_own(monkeypatch):
    results: list[CarContent] = []

    def counted(model: Model, car: CarContent) -> Rest:
        results.append(car)
        return find_equilibrium(model, car)

    monkeypatch.setattr(built_car, "find_equilibrium", counted)
    messages = {}
    for ports in ({}, {"ports.tyre": "hub"}):
        car = load("hatchback").changed(ports)
        results.clear()
        messages[len(ports)] = [
            summary(car),
            car.summary(),
            [plausibility.to_json() for plausibility in car.plausibility()],
        ]
        assert len(results) == 1, "its rest is found once for all of them"
    assert messages[1] == messages[0]


@pytest.mark.parametrize(
    ("curve", "field", "factor", "message"),
    [
        ("lateral", "slope", 1.0 / DEG, "per degree instead of per slip in lateral.slope"),
        ("longitudinal", "slope", 0.01, "per percent instead of per slip in longitudinal.slope"),
        ("lateral", "max_slip", DEG, "degrees instead of a ratio in lateral.max_slip"),
        ("lateral", "max_force", 0.2, "lateral.max_force = "),
    ],
)
def test_a_mistake_of_tmeasy_is_reported(curve, field, factor, message):
    t = load("hatchback").front.tyre.tyre()
    fields = [field, "slide_slip"] if field == "max_slip" else [field]
    result = {f: tuple(factor * v for v in getattr(getattr(t, curve), f)) for f in fields}
    lines = tmeasy_plausibility("t", replace(t, **{curve: replace(getattr(t, curve), **result)})).warnings()
    assert any(message in line for line in lines), lines


def test_a_mistake_is_named_only_where_undoing_it_mends():
    length = Quantity("length", "l", "m", "", {"small": (0.0, 1.0), "large": (1.0, 10.0)}, "")
    values = [Value(length, 5e3, {"a": 5e3}, "first"), Value(length, 2.0, {"b": 2.0}, "second")]

    def plausibility(undone: list[float] | None) -> Plausibility:
        result = None if undone is None else [replace(v, value=x) for v, x in zip(values, undone, strict=True)]
        return Plausibility("f", values, [Mistake("mm instead of m", frozenset({"a"}), lambda: result)], "")

    assert "mm instead of m would explain it: without that it is 5 m" in plausibility([5.0, 2.0]).warnings()[0]
    for undone in (None, [500.0, 2.0], [5.0, 200.0]):  # none, not enough, another one outside
        (sentence,) = plausibility(undone).warnings()
        assert sentence == "f: first length is 5000 m; usual is 0 to 10 m. It follows from a = 5000."


def test_the_table_is_one_screen_with_a_column_for_each_axle():
    """Places of points are shown where they lie outside alone."""
    table = load("prototype").summary()
    assert len(table.splitlines()) < 50
    (row,) = (line.split() for line in table.splitlines() if line.startswith("bounce frequency"))
    assert (row[3], row[5]) == ("Hz", "Hz")
    plausibility = load("prototype").plausibility()[0]
    values = {v.of: v.value for v in plausibility.values if v.quantity.name == "bounce frequency"}
    assert [f"{values[side]:.4g}" for side in ("front", "rear")] == [row[2], row[4]]
    hidden = next(v for v in plausibility.values if v.quantity.name == "point outside of the outline")
    assert hidden.quantity.name not in table
    far = replace(hidden, value=5.0)
    shown = replace(plausibility, values=[far if v is hidden else v for v in plausibility.values]).text()
    (line,) = (line for line in shown.splitlines() if line.startswith(hidden.quantity.name))
    assert line.endswith("<- outside")


@pytest.mark.parametrize("name", ["hatchback", "ferrari_250_lm"])
def test_the_top_speed_in_gear_is_that_of_a_rolling_wheel(name):
    car = load(name)
    values = [v for v in car.plausibility()[0].values if v.quantity.name == "top speed in gear"]
    overall = [v.value for v in car.plausibility()[0].values if v.quantity.name == "overall ratio"]
    run = simulate(compile(car.model()), 0.5, 0.005, {"selector": 0}, pose=Pose(speed=10.0), estimate_error=False)
    wheel = f"wheel_{car.drive.wheels[0].upper()}L.omega"
    for shown, ratio in zip(values, overall, strict=True):
        expected = 3.6 * car.drive.limit_speed / ratio * run["speed"][-1] / run[wheel][-1]
        assert shown.value == pytest.approx(expected, rel=0.005)


@pytest.mark.slow
def test_a_car_that_lies_on_its_body_has_its_mass():
    """None of it is on the wheels."""
    whole = load("prototype")
    points = at("prototype", "chassis.ground_contact.points")
    low = {f"chassis.ground_contact.points.{k}.2": -0.6 for k, p in enumerate(points) if not isinstance(p, str)}
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", CarWarning)
        car = car_from(changed_content(whole._data, low, "x"), whole.folder, "x", warn=True)
    assert any("ground clearance is -0.6 m" in str(w.message) for w in caught)
    mass, own = (c.plausibility()[0].values[0] for c in (car, whole))
    assert mass.quantity.name == "mass"
    assert mass.value == own.value == pytest.approx(597.0, abs=0.1)
    assert "0 N, 0.0%" in summary(car)

"""The text parameter of a road's file: set, refused, reset, saved and restored; the same bits as in Python."""

import os
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

import mbs
from fmu_src.build.build import build_fmu
from mbs.elements import GridRoad, KerbRoad, PlaneRoad
from mbs.roads import RoadFile, RoadWarning, write_road
from mbs.roads.package_roads import FOLDER
from mbs.scenes import prototype_car
from mbs.scenes.prototype_car import Fidelity
from tests.fmu.calls import ERROR, OK

H = 0.002
FRICTION = 1.2705


@pytest.fixture(scope="module")
def built(made_once: Callable[[str, Callable[[Path], None]], Path]) -> Callable[[str], Path]:
    """The car in two fidelities as an FMU of a kind."""

    def make(kind: str) -> Path:
        def fill(folder: Path) -> None:
            offered = prototype_car.fidelities()
            systems = {k: mbs.compile(offered[k]()) for k in (Fidelity.RIGID, Fidelity.QUASI_STATIC)}
            build_fmu(systems, "prototype_car", folder, [fmpy.platform], kind=kind)

        (path,) = made_once(f"car_with_roads_{kind}", fill).glob("*.fmu")
        return path

    return make


@pytest.fixture
def car(built: Callable[[str], Path]) -> Path:
    return built("native")


@pytest.fixture
def roads(tmp_path: Path) -> Path:
    rng = np.random.default_rng(1)
    write_road(
        GridRoad((-10.0, -4.0), (0.1, 0.1), 0.002 * rng.standard_normal((900, 80)), 0.9), tmp_path / "rough.road"
    )
    write_road(GridRoad((-10.0, -4.0), (0.1, 0.1), np.zeros((3000, 80)), 0.9), tmp_path / "long.road")
    write_road(PlaneRoad(2.0, 0.0, 0.0, FRICTION), tmp_path / "high.road")
    write_road(PlaneRoad(2.0, 0.05, 0.0, FRICTION), tmp_path / "slope.road")
    return tmp_path


def text(host: Any, value: str) -> int:
    return int(host.call("setString", [host.references["road.file"]], [value]))


def get(host: Any) -> str:
    (value,) = host.slave.getString([host.references["road.file"]])
    return str(value.decode() if isinstance(value, bytes) else value)


def on_road(driven: Any, road: object, start: dict[str, float] | None = None) -> Any:
    """An instance that is started on a road."""
    assert text(driven, str(road)) == OK, driven.messages
    return driven.start(start or {})


def heights(host: Any, steps: int = 300, time: float = 0.0) -> list[float]:
    results = []
    for k in range(steps):
        assert host.step(time + k * H, H) == OK
        results.append(host.get("chassis.z"))
    return results


def test_the_description_has_it_after_all_others(car):
    variables = fmpy.read_model_description(str(car)).modelVariables
    v = variables[-1]
    assert (v.name, v.type, v.causality, v.variability, v.initial) == (
        *("road.file", "String", "parameter", "fixed", "exact"),
    )
    assert v.start in ("", None)
    assert v.valueReference not in {w.valueReference for w in variables[:-1]}
    assert "resources" in v.description
    unknowns = {u.variable.name: u for u in fmpy.read_model_description(str(car)).initialUnknowns}
    assert unknowns["chassis.z"].dependencies is None  # all that there are
    assert "road.file" not in {w.name for w in unknowns["used.brake"].dependencies}


def test_a_path_gives_the_same_bits_as_in_python(car, host, roads):
    driven = on_road(host(car), roads / "rough.road", {"initial.speed": 12.0})
    assert get(driven) == str(roads / "rough.road")
    system = mbs.compile(prototype_car.build())
    simulation = mbs.Simulation(system, pose=mbs.Pose(speed=12.0), parameters={"road.file": roads / "rough.road"})
    expected = []
    for _ in range(300):
        simulation.step(H)
        expected.append(simulation.sensors["chassis.z"])
    assert heights(driven) == expected


def test_a_body_that_touches_a_slope_without_force_is_not_spoken_of(car, host, tmp_path):
    road = tmp_path / "steep.road"
    write_road(PlaneRoad(0.0, np.tan(np.radians(30.0)), 0.0, 1.0), road)
    driven = on_road(host(car), road)
    assert 0.0 < driven.get("chassis.ground_force") < 1e-9  # it is put down until a point of it touches
    assert not [m for m in driven.messages if "rests on its body" in m]
    simulation = mbs.Simulation(mbs.compile(prototype_car.build()), parameters={"road.file": road})
    assert simulation.sensors["chassis.ground_force"] == driven.get("chassis.ground_force")
    (notice,) = simulation.run(0.02, 0.002, progress=False).notices
    assert re.search(r"raised by 0\.\d+ m .* Simulation.settle", notice)


def test_the_roads_in_the_resources_are_found_by_name(car, host):
    for path in sorted(FOLDER.glob("*.road")):
        driven = on_road(host(car), path.name, {"initial.speed": 10.0})
        assert np.all(np.isfinite(heights(driven, 20)))


def test_a_road_can_be_put_into_the_resources_without_a_build(car, host, roads):
    driven = host(car)
    (driven.folder / "resources" / "roads" / "mine.road").write_bytes((roads / "high.road").read_bytes())
    assert text(driven, "mine.road") == OK
    driven.start()
    own = host(car).start()
    assert driven.get("chassis.z") == pytest.approx(own.get("chassis.z") + 2.0, abs=1e-9)


def test_a_table_in_the_resources(car, host):
    driven, own = host(car), host(car).start()
    rows = "\n".join(f"{x},1.5,1.5,1.5" for x in range(-20, 80, 20))
    table = driven.folder / "resources" / "roads" / "mine.csv"
    table.write_text(f"heights,-5,0,5\n{rows}\nfrictions,-5,0,5\n{rows.replace('1.5', '0.4')}\n")
    assert text(driven, "mine.csv") == OK
    driven.start({"initial.speed": 10.0})
    assert driven.get("chassis.z") == pytest.approx(own.get("chassis.z") + 1.5, abs=1e-9)
    table.write_text("heights,-5,0,5\n0,1,2\n")
    other = driven.instance()
    with pytest.raises(FMICallException):
        other.setString([driven.references["road.file"]], ["mine.csv"])
    assert "it has 1 x 3 points" in driven.messages[-1]


def test_a_uri_and_letters_of_any_language(car, host, roads):
    place = roads / "straße путь 道.road"
    place.write_bytes((roads / "high.road").read_bytes())
    for value in (str(place), place.as_uri(), place.as_uri().replace("file:", "FILE:")):
        driven = on_road(host(car), value)
        assert driven.get("chassis.z") > 2.0


def test_a_refused_file_changes_nothing_and_is_reported(car, host, roads):
    driven = host(car)
    assert text(driven, str(roads / "high.road")) == OK
    data = (roads / "rough.road").read_bytes()
    (roads / "cut.road").write_bytes(data[: len(data) // 2])
    (roads / "x.csv").write_text("1,2\n3,4\n")
    cases = {
        "nothing.road": "there is no such file",
        str(roads): "not a regular file",
        "..": "not a regular file",
        str(roads / "cut.road"): "it ends too early: it was cut off",
        str(roads / "x.csv"): "ali3 road INPUT OUTPUT.road",
        "x" * 2000: "at most 1023",
        "/" + "x/" * 500: "no such file",
    }
    if sys.platform != "win32":
        os.mkfifo(roads / "pipe")
        cases[str(roads / "pipe")] = "not a regular file"
    for value, sentence in cases.items():
        driven.messages.clear()
        assert text(driven, value) == ERROR
        (messages,) = driven.messages
        assert "'road.file'" in messages
        assert sentence in messages
    driven.start()
    assert get(driven) == str(roads / "high.road")
    assert driven.get("chassis.z") > 2.0


def test_in_initialisation_mode_and_empty_again(car, host, roads):
    driven, own = host(car), host(car).start()
    driven.slave.setupExperiment()
    driven.slave.enterInitializationMode()
    assert driven.get("chassis.z") == own.get("chassis.z")
    assert text(driven, str(roads / "high.road")) == OK
    assert driven.get("chassis.z") > 2.0
    assert text(driven, "") == OK
    assert driven.get("chassis.z") == own.get("chassis.z")
    driven.slave.exitInitializationMode()
    assert heights(driven, 20) == heights(own, 20)


def test_reset_takes_it_away(car, host, roads):
    driven, own = host(car), host(car).start()
    text(driven, str(roads / "high.road"))
    driven.start()
    assert driven.call("reset") == OK
    driven.start()
    assert get(driven) == ""
    assert driven.get("chassis.z") == own.get("chassis.z")


def test_a_state_brings_its_road_with_it(car, host, roads):
    driven = on_road(host(car), roads / "rough.road", {"initial.speed": 12.0})
    heights(driven, 50)
    state = driven.saved()
    later = heights(driven, 100, 50 * H)
    for other in (host(car), host(car).start()):
        assert other.restore(state) == OK, other.messages
        assert get(other) == str(roads / "rough.road")
        assert heights(other, 100, 50 * H) == later
    back = driven.slave.getFMUState()
    fresh = driven.instance()  # the state of an instance that has no road, and back
    fresh.setupExperiment()
    fresh.enterInitializationMode()
    fresh.exitInitializationMode()
    flat = fresh.serializeFMUstate(fresh.getFMUState())
    assert driven.restore(flat) == OK
    assert get(driven) == ""
    assert driven.call("setFMUstate", back) == OK
    assert get(driven) == str(roads / "rough.road")
    (roads / "rough.road").unlink()
    third = host(car).start()
    before = third.outputs()
    assert third.restore(state) == ERROR
    assert "there is no such file" in third.messages[-1]
    assert third.outputs() == before


def test_another_fidelity_has_the_road_too(car, host, roads):
    driven = host(car)
    text(driven, str(roads / "high.road"))
    assert driven.call("setInteger", [driven.references["fidelity"]], [1]) == OK
    driven.start()
    assert driven.get("chassis.z") > 2.0
    assert heights(driven, 20)[-1] > 2.0


def test_a_road_that_is_cut_while_driving_is_a_refused_step(car, host, roads):
    driven = host(car)
    path = roads / "long.road"
    text(driven, str(path))
    driven.start({"initial.speed": 30.0})
    with path.open("r+b") as file:
        file.truncate(path.stat().st_size // 10)
    for k in range(3000):
        before = driven.outputs()
        status = driven.step(k * H, H)
        if status != OK:
            break
    assert status == 2  # fmi2Discard
    assert "Of the road its part beginning at x =" in driven.messages[-1]
    assert "cannot be read" in driven.messages[-1]
    assert driven.outputs() == before


def test_starts_on_a_slope_and_parameters_without_effect_are_reported(car, host, roads):
    driven = on_road(host(car), roads / "slope.road", {"road.friction": 0.5})
    messages = "\n".join(driven.messages)
    assert "The road is not level where this starts: the start is raised by 2 m" in messages
    sinks = float(re.search(r"above its place of rest sinks by (\S+) m\.", messages)[1])
    assert sinks == pytest.approx(0.05 * 2.3, rel=0.1)  # the wheelbase
    assert "'road.friction' is 0.5, without effect" in messages
    assert "With 'initial.settling' of 3 it begins at rest" in messages
    settled = on_road(host(car), roads / "slope.road", {"brake": 1.0, "initial.settling": 3.0})
    assert settled.messages == []
    driven.messages.clear()
    assert driven.set("road.kerb_height", 0.1) == OK
    assert "'road.kerb_height' was set to 0.1 m, without effect" in driven.messages[-1]
    level = host(car).start({"road.friction": 0.5})
    assert level.messages == []


@pytest.mark.slow
def test_a_car_built_on_a_road_file_has_it_as_its_start_value(tmp_path, host):
    write_road(KerbRoad(1.0, 0.05, -0.05, "before", FRICTION), tmp_path / "step.road")
    system = mbs.compile(prototype_car.build(RoadFile(tmp_path / "step.road")))
    fmu = build_fmu(system, "prototype_car", tmp_path / "out", [fmpy.platform])
    (tmp_path / "step.road").unlink()
    driven = host(fmu).start({"initial.speed": 5.0})
    assert get(driven) == "step.road"
    actual = heights(driven, 500)
    assert actual[0] - actual[-1] > 0.04
    assert driven.call("reset") == OK
    driven.start({"initial.speed": 5.0})
    assert heights(driven, 500) == actual


@pytest.mark.slow
def test_fmi_3_gives_the_same(built, host, roads):
    third, driven = (host(built(kind)) for kind in ("fmi3", "native"))
    unknowns = {u.variable.name: u for u in third.description.initialUnknowns}
    assert unknowns["wheel_FL.travel"].dependencies is None  # all that there are
    for each in (third, driven):
        assert text(each, "nothing.road") == ERROR
        assert "there is no such file" in each.messages[-1]
        assert text(each, str(roads / "rough.road")) == OK
        each.start({"initial.speed": 12.0})
        assert text(each, "") == ERROR
    for k in range(50):
        assert third.step(k * H, H) == driven.step(k * H, H) == OK
    assert third.get("speed") == driven.get("speed")


def test_a_wheel_that_is_driven_into_a_wall_is_reported_once(car, host, tmp_path):
    x = np.arange(-10.0, 30.0, 0.05)
    heights = np.repeat(0.35 * np.clip((x - 8.0) / 0.1, 0.0, 1.0)[:, None], 21, axis=1)  # below the body
    with pytest.warns(RoadWarning):
        write_road(GridRoad((-10.0, -5.0), (0.05, 0.5), heights, 1.0), tmp_path / "wall.road")
    driven = on_road(host(car), tmp_path / "wall.road", {"initial.speed": 25.0})
    for k in range(200):
        if driven.step(k * H, H) > 1:
            break
    (line,) = [line for line in driven.messages if "the rim is pressed in by" in line]
    assert "was driven into a face of the road that is too high or too steep" in line


def test_a_car_on_its_roof_is_reported_once(car, host):
    driven = host(car).start({"initial.speed": 30.0, "front.tyre.grip": 3.0, "rear.tyre.grip": 3.0})
    assert driven.messages == []
    rolled = []
    for k in range(2000):
        driven.set("steering", 1.0)
        assert driven.step(k * H, H) <= 1
        rolled.append(abs(driven.get("chassis.roll")) > np.pi / 2.0)
        assert any("has rolled over: chassis.roll is" in line for line in driven.messages) == any(rolled)
    assert any(rolled)
    assert sum("has rolled over" in line for line in driven.messages) == 1


def test_a_car_without_points_on_its_body_that_rolls_over_is_called_wrong_and_no_wall_is_blamed(build, host):
    """It brakes on two frictions; on its side its rims hit level ground harder than they hold."""
    driven = on_road(host(build("van")), FOLDER / "split.road", {"initial.speed": 20.0, "selector": 0})
    load, rolled = 0.0, False
    for k in range(800):
        driven.set("brake", 0.6 * (k > 50))
        driven.step(k * 0.01, 0.01)
        load = max(load, driven.get("wheel_FR.Fz"))
        rolled |= abs(driven.get("chassis.roll")) > np.pi / 2.0
    assert rolled
    assert load > 1e5
    (line,) = [m for m in driven.messages if "has rolled over" in m]
    assert "What follows is wrong: no point of its body touches the ground" in line
    assert not any("rim is pressed in" in m for m in driven.messages)


def test_values_with_which_no_car_works_are_reported_with_those_that_do(car, host):
    driven = host(car).start({})
    works = {}
    for name, bad in {
        "front.tyre.stiffness": (1e4, 2e6),
        "rear.spring.stiffness": (1e3, 9e5),
        "rear.spring.free_length": (0.3, 2.0),
        "front.damper.damping": (0.0, 4e4),
        "brakes.torque": (30.0, 2e4),
    }.items():
        for value in bad:
            assert driven.set(name, value) == OK
            line = driven.messages.pop()
            low, high = (float(v) for v in re.search(r"vehicles work, (\S+) to (\S+) \S+\.", line).groups())
            assert line.startswith(f"'{name}' was set to {value:.10g} ")
            assert not low <= value <= high
            works[name] = low, high
    for name, (low, high) in works.items():
        for value in (1.01 * low, 0.99 * high):
            driven.set(name, value)
            assert driven.messages == []
    for k in range(100):  # the softest spring and tyre
        driven.set("front.tyre.stiffness", 1.01 * works["front.tyre.stiffness"][0])
        assert driven.step(k * H, H) == OK


def test_a_wheel_in_a_face_of_a_road_file_is_refused_with_place_radius_and_spacing(car, host, tmp_path):
    heights = np.repeat(np.where(np.arange(-10.0, 40.0, 0.2) > 10.1, 0.6, 0.0)[:, None], 5, axis=1)
    with pytest.warns(mbs.RoadWarning, match="a face of 0.6 m"):
        write_road(GridRoad((-10.0, -10.0), (0.2, 5.0), heights, 0.9), tmp_path / "wall.road")
    driven = on_road(host(car), tmp_path / "wall.road", {"initial.speed": 60.0})
    status, k = OK, 0
    while status <= 1 and k < 200:
        before = driven.outputs()
        status, k = driven.step(k * H, H), k + 1
    assert status == 2  # fmi2Discard
    assert driven.outputs() == before
    assert re.search(r"Here at x = 10\.\d+ m, y = \S+ m the centre of a wheel of 0.27 m radius", driven.messages[-1])
    assert "points are 0.2 by 5 m apart" in driven.messages[-1]

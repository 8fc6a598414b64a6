"""The road file of the proving ground as the kernel reads it, and what is drawn of it."""

import itertools
import math

import numpy as np
import pytest

import mbs
from ali3.scene.base64_numbers import octets
from ali3.scene.scene import scene_errors
from mbs.roads import RoadFile
from mbs.worlds.make_world import read_world
from mbs.worlds.patches import BOUND
from mbs.worlds.terrain import Terrain
from tests.quick import quick
from tests.roads.worlds.harness import drawn, opened
from tests.roads.worlds.test_proving_ground import FILE

PARTS = {
    "all": (-115.0, -260.0, 705.0, 240.0),
    "kerbs": (79.0, 24.0, 157.0, 36.0),
    "washboards": (219.0, 24.0, 423.0, 36.0),
    "ramp 0.3": (88.0, 57.0, 97.0, 67.0),
    "ramp 0.5": (208.0, 57.0, 218.0, 67.0),
    "ramp 1": (358.0, 57.0, 372.0, 67.0),
    "banked curve": (570.0, -20.0, 690.0, 140.0),
    "hill": (380.0, 90.0, 530.0, 150.0),
}


def places(part, n, seed=1):
    x0, y0, x1, y1 = PARTS[part]
    random = np.random.default_rng(seed)
    return x0 + (x1 - x0) * random.random(n), y0 + (y1 - y0) * random.random(n)


def test_the_files_are_small(proving_ground):
    head = RoadFile(proving_ground.road).header
    assert head.nx * head.ny > 80e6
    assert proving_ground.road.stat().st_size < 70e6  # all points of both maps: 1.3 GB
    assert proving_ground.json.stat().st_size < 5e6


@pytest.mark.slow
@pytest.mark.parametrize("part", quick(("all",), PARTS, "proof"))
def test_the_road_agrees_with_its_drawing_to_5_mm_and_its_description_to_3_mm(proving_ground, part):
    x, y = places(part, 4000)
    with opened(proving_ground.road) as at:
        z, _ = at(x, y)
    low, high = drawn(proving_ground.record["roads"][0], x, y)
    assert np.maximum(np.abs(low - z), np.abs(high - z)).max() < BOUND
    described = Terrain(read_world(FILE), FILE.parent).at(x, y)
    assert np.abs(described - z).max() < 3e-3


@pytest.mark.slow
def test_the_patches_cover_the_world_once_and_have_no_cracks(proving_ground):
    record = proving_ground.record
    x0, y0, x1, y1 = record["bounds"]
    area, edges = 0.0, {}
    for patch in record["roads"][0]["patches"]:
        size = [d * (n - 1) for d, n in zip(patch["spacing"], patch["shape"], strict=True)]
        area += size[0] * size[1]
    assert area == pytest.approx((x1 - x0) * (y1 - y0), rel=1e-9)
    random = np.random.default_rng(3)
    patches = record["roads"][0]["patches"]
    for k in random.integers(0, len(patches), 30):  # heights on both sides of an edge
        patch = patches[k]
        x = patch["origin"][0] + patch["spacing"][0] * 16.0 * random.random(20)
        y = np.full(20, patch["origin"][1])
        if y[0] <= y0:
            continue
        below, above = (drawn({"patches": patches}, x, y + side)[0] for side in (-1e-9, 1e-9))
        edges[int(k)] = float(np.abs(below - above).max())
    assert max(edges.values()) < 1e-5
    assert len(edges) > 20


def test_frictions_and_surfaces_are_the_same_for_wheels_and_eyes(proving_ground):
    surface = proving_ground.record["roads"][0]["surface"]
    classes = octets(surface["classes"]).reshape(surface["shape"])
    frictions = np.array(surface["frictions"])
    assert max(surface["spacing"]) <= 0.55
    i, j = (np.random.default_rng(5).integers(2, n - 2, 4000) for n in surface["shape"])
    inner = [(classes[i + a, j + b] == classes[i, j]) for a in (-1, 0, 1) for b in (-1, 0, 1)]
    kept = np.all(inner, axis=0)  # away from borders, which cells blur
    i, j = i[kept], j[kept]
    x = surface["origin"][0] + surface["spacing"][0] * i
    y = surface["origin"][1] + surface["spacing"][1] * j
    with opened(proving_ground.road) as at:
        _, felt = at(x, y)
    assert np.allclose(felt, frictions[classes[i, j]], rtol=1e-12, atol=0.0)
    assert len(np.unique(frictions[classes[i, j]])) >= 3


def test_the_record_is_a_part_of_a_scene(proving_ground):
    record = proving_ground.record
    scene = {"format": "ALi3 scene", "version": 1, "name": "world", "extent": 1.0, "frames": {}, "shapes": []}
    assert scene_errors(scene | {"roads": record["roads"], "scenery": record["scenery"]}) == []
    assert (record["format"], record["version"], record["road"]) == ("ALi3 world", 1, "proving_ground.road")
    assert record["places"][0]["name"] == "start"
    hill = next(place for place in record["places"] if place["name"] == "hill")
    assert hill["yaw"] == pytest.approx(math.pi)


CROSSED = {  # m/s
    "kerbs": 12.0,
    "washboard": 25.0,
    "ramp_30_cm": 20.0,
    "ramp_1_m": 30.0,
    "hill": 25.0,
    "banked_curve": 25.0,
    "two_frictions": 25.0,
    "gravel_road": 25.0,
}


def driven(car, world, place, speed, seconds, **inputs):
    at = next(p for p in world.record["places"] if p["name"] == place)
    simulation = mbs.Simulation(
        car,
        pose=mbs.Pose(at["x"], at["y"], 0.0, at["yaw"], speed),
        parameters={"road.file": world.road},
        inputs=inputs,
    )
    return simulation.run(seconds, 0.002, estimate_error=False)


@pytest.mark.parametrize("place", CROSSED)
def test_a_car_drives_over_each_feature_without_a_failed_step(proving_ground, car, place):
    run = driven(car, proving_ground, place, CROSSED[place], 4.0)
    assert np.all(np.isfinite(run["chassis.z"]))
    assert np.hypot(np.ptp(run["chassis.x"]), np.ptp(run["chassis.y"])) > 20.0


def test_a_wheel_over_the_kerb_rises_by_80_mm_and_a_jump_leaves_the_ground(proving_ground, car):
    slow = driven(car, proving_ground, "kerbs", 6.0, 8.0, throttle=0.25)
    x = slow["chassis.x"]
    on = slow["chassis.z"][(x > 83.0) & (x < 84.0)]
    before = slow["chassis.z"][(x > 70.0) & (x < 75.0)]
    assert on.mean() - before.mean() == pytest.approx(0.08, abs=0.03)
    jump = driven(car, proving_ground, "ramp_1_m", 22.0, 7.0)
    loads = sum(jump[f"wheel_{w}.Fz"] for w in ("FL", "FR", "RL", "RR"))
    assert (loads == 0.0).sum() * 0.002 > 0.5  # half a second in the air
    assert jump["chassis.z"].max() > 1.4


def test_all_places_are_good_starts(proving_ground, car):
    for place in proving_ground.record["places"]:
        run = driven(car, proving_ground, place["name"], 0.0, 0.2)
        assert abs(run["chassis.z"][-1] - run["chassis.z"][0]) < 0.05, place["name"]


OBSTACLES = [
    *((83.0, 30.0), (123.0, 30.0), (153.0, 30.0), (275.0, 30.0)),
    *((400.0, 30.0), (92.0, 62.0), (213.0, 62.0), (365.0, 62.0)),
]
APPROACHES = (0.0, math.pi, 0.4)
SPEEDS = (2.0, 5.0, 8.0, 15.0, 22.0, 30.0, 40.0)


@pytest.mark.proof
@pytest.mark.filterwarnings("ignore:.*the rim is pressed in:mbs.RoadWarning")  # up to 40 m/s into steep backs
def test_every_obstacle_from_both_sides_and_aslant(proving_ground, car):
    """Also into the steep backs of the ramps."""
    failed = []
    for (x, y), yaw, speed in itertools.product(OBSTACLES, APPROACHES, SPEEDS):
        simulation = mbs.Simulation(
            car,
            pose=mbs.Pose(x - 14.0 * math.cos(yaw), y - 14.0 * math.sin(yaw), 0.0, yaw, speed),
            parameters={"road.file": proving_ground.road},
            inputs={"throttle": 0.3},
        )
        try:
            run = simulation.run(min(8.0, 60.0 / speed), 0.002, estimate_error=False)
        except mbs.SimulationError as error:
            failed.append(f"{x:g} {y:g} m, {yaw:g} rad, {speed:g} m/s: {error}")
        else:
            if not np.all(np.isfinite(run["chassis.z"])):
                failed.append(f"{x:g} {y:g} m, {yaw:g} rad, {speed:g} m/s: not finite")
    assert not failed, "\n".join(failed)

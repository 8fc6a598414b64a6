"""Animations of the scenes for the documentation: the run of each and its camera."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

import mbs
from ali3.scene.recording import Recording
from benchmarks.car import fidelity_runs, manoeuvres
from benchmarks.pictures import driven_worlds
from hosts.driving.course import course_of
from hosts.driving.course_scenery import with_course
from mbs.model.model import Model
from mbs.scenes import (
    bicycle,
    bricard,
    cart_pole,
    double_four_bar,
    flyball,
    pendulum,
    puma,
    slider_crank,
    spatial_chain,
    spatial_slider_crank,
    squeezer,
)
from mbs.vehicle import Fidelity, load
from viewer.video import WrittenFilm, write_mp4

SIZE = (720, 405)
FPS = 15.0


@dataclass(frozen=True)
class Animation:
    """A film of a scene."""

    title: str
    record: Callable[[], Recording]
    """Simulates the scene."""
    begin: float
    """Start of the film in time of the run, s."""
    end: float
    """End of the film in time of the run, s."""
    speed: float = 1.0
    """Speed of the film relative to real time."""
    camera: str | None = None
    """Name of the camera; by default the first."""
    options: Mapping[str, Any] = field(default_factory=dict)


def film(name: str, path: Path) -> WrittenFilm:
    """Simulate a scene and write its film.

    `name`: key of `ANIMATIONS`; `path`: ``.webp``, ``.gif`` or ``.mp4``.
    """
    a = ANIMATIONS[name]
    return write_mp4(
        path,
        a.record(),
        fps=FPS,
        size=SIZE,
        camera=a.camera,
        speed=a.speed,
        begin=a.begin,
        end=a.end,
        options=a.options,
    )


def recording_of(*runs: mbs.Trajectory) -> Recording:
    """A recording of successive runs of one System."""
    parts = [run.recording() for run in runs]
    if len(parts) == 1:
        return parts[0]
    columns = {name: np.concatenate([part.columns[name] for part in parts]) for name in parts[0].columns}
    return Recording(parts[0].scene, np.concatenate([part.t for part in parts]), columns, parts[0].units, parts[0].name)


def _scene(build: Callable[[], Model], end: float, h: float) -> Callable[[], Recording]:
    def record() -> Recording:
        every = max(1, round(0.002 * end / h / 4))
        return recording_of(mbs.simulate(mbs.compile(build()), end, h, every=every, progress=False))

    return record


def _manoeuvre(name: str, car: str = manoeuvres.PROTOTYPE) -> Callable[[], Recording]:
    return lambda: recording_of(manoeuvres.run(name, 0.002, car=car, every=5))


def _lane_change(car: str) -> Callable[[], Recording]:
    """Record the replay of a drive through the lanes of ISO 3888-1, with their cones."""

    def record() -> Recording:
        result = _manoeuvre("double_lane_change_replay", car)()
        assert result.scene is not None
        scene = with_course(result.scene, course_of("iso_3888_1", load(car).vehicle.width))
        return Recording(scene, result.t, result.columns, result.units, result.name)

    return record


def _driven(name: str) -> Callable[[], Recording]:
    return lambda: driven_worlds.drive(name)


def _kerb_test() -> Recording:
    return recording_of(fidelity_runs.run("kerb_test", Fidelity.DYNAMIC, 0.005))


def _puma() -> Recording:
    simulation = mbs.Simulation(mbs.compile(puma.build()))
    return recording_of(*puma.stages(simulation, 0.01))


ANIMATIONS = {
    "double_four_bar": Animation(
        "The double four-bar passes its singular positions", _scene(double_four_bar.build, 5.0, 0.005), 0.0, 5.0
    ),
    "four_bar_40": Animation("Forty windows", _scene(lambda: double_four_bar.build(40), 5.0, 0.005), 0.0, 5.0),
    "slider_crank": Animation("The slider-crank with equal arms", _scene(slider_crank.build, 5.0, 0.001), 0.0, 5.0),
    "spatial_slider_crank": Animation(
        "The spatial slider-crank", _scene(spatial_slider_crank.build, 5.0, 0.001), 0.0, 5.0
    ),
    "bricard": Animation("Bricard's mechanism", _scene(bricard.build, 5.0, 0.005), 0.0, 5.0),
    "bicycle": Animation("The bicycle", _scene(bicycle.build, 5.0, 0.005), 0.0, 3.0),
    "flyball": Animation("The flyball governor", _scene(flyball.build, 5.0, 0.002), 0.0, 5.0),
    "puma": Animation("The PUMA robot, its hand pinned from 2 s to 6 s", _puma, 0.0, 8.0, 1.6),
    "squeezer": Animation("Andrews' squeezer, 100 times slower", _scene(squeezer.build, 0.05, 1e-5), 0.0, 0.05, 0.01),
    "pendulum": Animation("The pendulum", _scene(pendulum.build, 4.0, 0.002), 0.0, 4.0),
    "cart_pole": Animation("The cart-pole with a light cart", _scene(cart_pole.build, 1.0, 2e-5), 0.0, 1.0, 0.25),
    "spatial_chain": Animation("A chain of ten links", _scene(spatial_chain.build, 5.0, 0.005), 0.0, 5.0),
    "double_lane_change": Animation(
        "The prototype car, double lane change", _lane_change(manoeuvres.PROTOTYPE), 1.0, 6.0, camera="chase"
    ),
    "proving_ground": Animation(
        "The proving ground of the simulator: a jump from a metre, a sudden turn", _driven("proving_ground"), 1.4, 5.4
    ),
    "plane": Animation(
        "The world plane: swerves at 22 m/s, then brakes", _driven("plane"), 0.2, 5.2, camera="trackside"
    ),
    "rough": Animation("The world rough: the hatchback at 20 m/s", _driven("rough"), 0.2, 3.8, camera="wheel FL"),
    "washboard": Animation(
        "The world washboard: from 6 m/s on through the resonance of the body", _driven("washboard"), 0.5, 5.5
    ),
    "kerb_test": Animation(
        "The car falls from the kerb; stress in the frame, its deformation 30 times larger",
        _kerb_test,
        7.56,
        8.9,
        0.4,
        options={"stress": True, "deformation": 30.0},
    ),
    "drop": Animation("The car is dropped", _manoeuvre("drop"), 0.0, 1.6, 0.5),
    "hatchback_lane_change": Animation(
        "The hatchback changes lanes and back", _lane_change("hatchback"), 1.0, 6.0, camera="trackside"
    ),
}
"""Films by the name of their file."""

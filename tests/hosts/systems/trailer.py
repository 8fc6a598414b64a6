"""A trailer of one axle: a scene of its own, and on the hitch of the hatchback in one model."""

import atexit
import shutil
import tempfile
from dataclasses import replace
from functools import cache
from pathlib import Path

from fmpy import platform

import mbs
from fmu_src.build.build import build_fmu
from mbs.elements import PlaneRoad, ScalarSpringDamper
from mbs.model import Model
from mbs.model.body import Body
from mbs.vehicle.car import Car
from tests.elements.tyre_data import TYRE
from tests.vehicle.cars_with_ports import hatchback, with_ports

HITCH = (-3.35, 0.0, 0.40)
"""As drawn with the car, m."""
STIFFNESS = 2e5  # N/m, of the ball in its cup, alike along all axes
DAMPING = 4e3  # N s/m, of the same
# assumed
MASS = 440.0  # kg, without wheels
WHEEL = 15.0  # kg, each
RADII = (0.45, 1.1, 1.1)  # m, radii of gyration
LENGTH = 2.6  # m, from hitch to axle
TRACK = 1.4  # m
TYRES = replace(TYRE, stiffness=150e3, damping=800.0)
GRAVITY = 9.81


def add_trailer(m: Model, road: int) -> Body:
    """Add the trailer, standing as its tyres carry it with no force at its hitch. `road`: under its wheels."""
    deflection = 0.5 * (MASS + 2.0 * WHEEL) * GRAVITY / TYRES.stiffness
    height = TYRES.radius - deflection
    x = HITCH[0] - LENGTH
    inertia = [MASS * radius**2 for radius in RADII]
    trailer = m.body("trailer", mass=MASS, com=(x, 0.0, 0.6), inertia=inertia)
    for side, y in (("L", 0.5 * TRACK), ("R", -0.5 * TRACK)):
        spin = m.spin(
            f"trailer wheel {side}",
            carrier=trailer,
            centre=(x, y, height),
            axis=(0.0, 1.0, 0.0),
            mass=WHEEL,
            spin_inertia=0.6,
            diametral_inertia=0.4,
            rolling_radius=(2.0 * TYRES.radius + height) / 3.0,
        )
        tyre = m.add(TYRES.record(f"trailer tyre {side}", spin.centre, spin.axis, spin.coordinate, road))
        m.sense_element(f"load_{side}", tyre, "vertical_force")
    for order, prefix in ((0, "hitch.p"), (1, "hitch.v")):
        for c in "xyz":
            m.sense_position(f"{prefix}{c}", trailer, HITCH, c, order=order)
    for c in "xy":
        m.sense_position(f"trailer.{c}", trailer, None, c)
    return trailer


def trailer() -> Model:
    """The trailer alone, with forces at its hitch as inputs; earth axes."""
    m = mbs.Model("trailer")
    m.floating = True
    m.step = 0.002
    body = add_trailer(m, m.road(PlaneRoad(friction=hatchback().road.friction)))
    m.force("hitch", body, HITCH, inputs=[m.input(f"hitch.F{c}", min=-1e5, max=1e5, unit="N") for c in "xyz"])
    return m


def car_with_hitch() -> Car:
    """The hatchback with forces at its hitch."""
    return with_ports(hatchback(), forces="earth", force_points={"hitch": list(HITCH)})


@cache
def with_trailer() -> mbs.System:
    """Car and trailer in one model.

    Its start is sought without the hitch, as each FMU stands alone.
    """
    m = car_with_hitch().model()
    chassis = next(b for b in m.bodies if b.name == "chassis")
    gap = add_trailer(m, 0).point(HITCH) - chassis.point(HITCH)
    parts = [
        m.add(ScalarSpringDamper(STIFFNESS, DAMPING, unit="N").record(f"hitch {c}", gap[k]))
        for k, c in enumerate("xyz")
    ]
    for real, value in (("stiffness", STIFFNESS), ("damping", DAMPING)):
        targets = [(part, real, 1.0) for part in parts]
        m.parameter(f"hitch.{real}", value, 0.0, 1e6, "1", "of the ball in its cup", targets=targets)
    m.equilibrium_parameters["hitch.stiffness"] = 0.0
    return mbs.compile(m)


def passing_folder() -> Path:
    """A folder that is deleted at the end of the process."""
    folder = tempfile.mkdtemp()
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


@cache
def fmus() -> dict[str, Path]:
    """FMUs of the car and the trailer, built once per process."""
    results = {}
    for name, model in (("car", car_with_hitch().model()), ("trailer", trailer())):
        folder = passing_folder()
        build_fmu(mbs.compile(model), name, folder, [platform])
        results[name] = next(folder.glob("*.fmu"))
    return results

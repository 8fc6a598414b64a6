"""Models without reduction: each body has the coordinates of its frame, each joint equation is a constraint."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np

from benchmarks.shared.pages import Row, table
from mbs import Model, Simulation, System, compile
from mbs.common.checks import direction
from mbs.model.body import Body
from mbs.model.carried_parts import SlidingPoint, Spin, WrittenAxis
from mbs.model.joints.joint import Joint
from mbs.model.perpendicular_vectors import perpendicular
from mbs.scenes import double_four_bar, prototype_car
from mbs.simulation.step_time import step_time
from mbs.vehicle import built_car

ROD_MASS = 0.5  # kg
H = 0.01  # s
DURATION = 3.0  # s


class WholeJoint(Joint):
    """A joint whose equations are all constraints."""

    @property
    def force_equations(self) -> list[int]:
        """Indices of all equations."""
        return list(range(len(self.equations)))


class NaiveModel(Model):
    """A model whose joint equations are all constraints, with rods and wheels as bodies."""

    def _join(self, joint: Joint) -> Joint:
        whole = WholeJoint(joint.name, joint.type, joint.equations, joint.rows_weight)
        whole.as_rows = True
        return super()._join(whole)

    def distance(self, name: str, end_1: Any, end_2: Any, *, length: float | None = None) -> Joint:
        """A rod as a body between two ball joints; with a sliding end it is a distance constraint."""
        if any(isinstance(end, SlidingPoint) for end in (end_1, end_2)):
            return super().distance(name, end_1, end_2, length=length)
        (first, p), (second, q) = end_1, end_2
        axis = np.subtract(q, p)
        inertia = ROD_MASS * (axis @ axis * np.eye(3) - np.outer(axis, axis)) / 12.0 + 1e-4 * np.eye(3)
        rod = self.body(name, mass=ROD_MASS, com=0.5 * np.add(p, q), inertia=inertia)
        self.spherical(f"{name} first end", first, rod, point=p)
        return self.spherical(f"{name} second end", rod, second, point=q)

    def spin(self, name: str, **data: Any) -> Spin:
        """A wheel as a body on a revolute joint, with its angle as a coordinate."""
        carrier, centre, axis = data["carrier"], data["centre"], direction(data["axis"], 3, "the axis of a wheel")
        across = data["diametral_inertia"] * (np.eye(3) - np.outer(axis, axis))
        inertia = across + data["spin_inertia"] * np.outer(axis, axis)
        wheel = self.body(name, mass=data["mass"], com=centre, inertia=inertia)
        self.revolute(f"{name} hinge", carrier, wheel, point=centre, axis=axis)
        angle = self.relative_angle(f"{name} angle", carrier, wheel, axis=axis)
        x, y = perpendicular(axis)
        along, across, aside = (carrier.vector(v) for v in (axis, x, y))
        radius, drawn = data.get("rolling_radius", 0.0), (tuple(x), tuple(y), tuple(axis))
        vectors = (wheel.point(centre), along, across, aside)
        return Spin(angle.name, angle.index, "rad", carrier, *vectors, 0.0, 0.0, radius, drawn)

    def written_axis(self, spin: Spin, *, leaning: float = 0.0) -> WrittenAxis:
        """The axis of a wheel at its initial direction, which parameters do not change."""
        x, y, z = (spin.carrier.vector(axis) for axis in np.eye(3))
        return WrittenAxis(spin.name, spin, (x, y, z), (0.0, 0.0), leaning)

    def parameter(self, *arguments: Any, targets: Any, **more: Any) -> Any:
        """A parameter; those that change the axis of a wheel are left out."""
        if not any(isinstance(target[0], WrittenAxis) for target in targets):
            return super().parameter(*arguments, targets=targets, **more)

    def shape(self, *arguments: Any, **more: Any) -> None:
        """No shapes: this model is not drawn."""


def spatial_four_bars(windows: int) -> Model:
    """The planar chain of four-bars (scene double_four_bar) with spatial bodies."""
    m = NaiveModel("four-bars in space", gravity=(0.0, -9.81, 0.0))
    rods: list[Body] = []

    def rod(name: str, a: tuple[float, ...], b: tuple[float, ...]) -> Body:
        axis = np.subtract(b, a)
        inertia = (axis @ axis * np.eye(3) - np.outer(axis, axis)) / 12.0 + 1e-3 * np.eye(3)
        rods.append(m.body(name, mass=1.0, com=0.5 * np.add(a, b), inertia=inertia))
        return rods[-1]

    z = (0.0, 0.0, 1.0)
    cranks = [rod(f"crank {k}", (k, 0.0, 0.0), (k, 1.0, 0.0)) for k in range(windows + 1)]
    couplers = [rod(f"coupler {k}", (k, 1.0, 0.0), (k + 1, 1.0, 0.0)) for k in range(windows)]
    for k, crank in enumerate(cranks):
        m.revolute(f"foot {k}", m.ground, crank, point=(k, 0.0, 0.0), axis=z)
        m.initial_velocity(crank, (0.5, 0.0, 0.0), (0.0, 0.0, -1.0))
    for k, coupler in enumerate(couplers):
        m.revolute(f"top {k}", cranks[k], coupler, point=(k, 1.0, 0.0), axis=z)
        m.revolute(f"end {k}", coupler, cranks[k + 1], point=(k + 1, 1.0, 0.0), axis=z)
        m.initial_velocity(coupler, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    m.sense_position("B0.position.x", cranks[0], (0.0, 1.0, 0.0), "x")
    return m


@contextmanager
def _with_naive_model(module: Any) -> Iterator[None]:
    """Context in which a module builds its models as `NaiveModel`."""
    before = module.Model
    module.Model = NaiveModel
    try:
        yield
    finally:
        module.Model = before


def naive_car() -> Model:
    """The rigid car with twelve further bodies."""
    with _with_naive_model(built_car):
        m = prototype_car.build()
    m.start_in_equilibrium = False
    return m


SCENES: dict[str, tuple[Callable[[], Model], Callable[[], Model], str]] = {
    "double four-bar": (lambda: double_four_bar.build(2), lambda: spatial_four_bars(2), "B0.position.x"),
    "40 four-bars": (lambda: double_four_bar.build(40), lambda: spatial_four_bars(40), "B0.position.x"),
    "prototype car": (prototype_car.build, naive_car, "chassis.z"),
}


def sizes_of(scene: str) -> tuple[dict[str, Any], list[System]]:
    """Row of the sizes of a scene and of its naive model, and both Systems."""
    models = [build() for build in SCENES[scene][:2]]
    systems = [compile(m) for m in models]
    row: dict[str, Any] = {"scene": scene}
    counts = {"bodies": [len(m.bodies) for m in models]}
    counts |= {"coordinates": [s.nq for s in systems], "rows": [s.nc for s in systems]}
    for name, (reduced, naive) in counts.items():
        row |= {name: reduced, f"naive_{name}": naive}
    return row, systems


def size_table(rows: Sequence[Row]) -> str:
    """Table of the page on the flexible car."""
    return table(rows, {"scene": ""} | dict.fromkeys(("coordinates", "naive_coordinates", "rows", "naive_rows"), "d"))


def measure(scene: str, repeats: int) -> dict[str, Any]:
    """Row of a scene: sizes, times, and the difference of an output at the end."""
    row, systems = sizes_of(scene)
    output = SCENES[scene][2]
    ends = []
    for system in systems:
        simulation = Simulation(system)
        simulation.step(H, round(DURATION / H))
        ends.append(simulation.sensors[output])
    walls = [step_time(s, DURATION, H, repeats, time.perf_counter) * H / DURATION for s in systems]
    return row | {
        "us_per_step": 1e6 * walls[0],
        "naive_us_per_step": 1e6 * walls[1],
        "factor": walls[1] / walls[0],
        "difference": abs(ends[1] - ends[0]),
    }

"""Bicycle models of increasing detail, simulated for many windows at once."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmarks.validation.drive import Drive

Array = NDArray[np.float64]
G = 9.81  # m/s2
AIR = 1.2  # kg/m3
HEIGHT = 0.42  # m, of the centre of mass, as in the car file


@dataclass(frozen=True)
class Body:
    """Known data of the car."""

    mass: float
    """Mass, kg."""
    yaw_inertia: float
    """Moment of inertia about the vertical axis, kg m2."""
    front: float
    """Distance of the front axle from the centre of mass, m."""
    rear: float
    """Distance of the rear axle from the centre of mass, m."""
    drag_area: float = 0.0
    """Drag coefficient times frontal area, m2."""

    @property
    def wheelbase(self) -> float:
        """Wheelbase, m."""
        return self.front + self.rear


@dataclass(frozen=True)
class Unknown:
    """A fitted parameter."""

    name: str
    unit: str
    low: float
    """Lower bound of the parameter and of its start values."""
    high: float
    """Upper bound of the parameter and of its start values."""


@dataclass(frozen=True)
class Model:
    """A model of the yaw rate."""

    name: str
    unknowns: tuple[Unknown, ...]
    forces: Callable[[Body, Array, Array, Array, Mapping[str, Array]], tuple[Array, Array]] | None = None
    """Returns lateral forces of both axles, N, from slip angles (front, rear), rad, ax, m/s2, and the parameters. None:
    a static relation of yaw rate and steering angle, by ``understeer``.
    """
    simulate: Callable[..., tuple[Array, Array]] | None = None
    """Replaces the `simulate` of a bicycle."""
    bank: bool = False
    open: bool = False
    """`bank`, `open`, of a model with its own `simulate`: whether it includes the bank of the road, and whether its
    differential is open."""

    @property
    def moves_across(self) -> bool:
        """Whether the model has a lateral velocity."""
        return self.forces is not None or self.simulate is not None


def _loads(body: Body, ax: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """Loads of both axles, N, with the load transfer by ax at the parameter "height"."""
    transfer = body.mass * ax * p.get("height", np.float64(0.0)) / body.wheelbase
    total = body.mass * G / body.wheelbase
    return total * body.rear - transfer, total * body.front + transfer


def _linear(body: Body, af: Array, ar: Array, ax: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    return -p["front stiffness"] * af, -p["rear stiffness"] * ar


def _saturating(curve: Callable[[Array], Array]) -> Callable[..., tuple[Array, Array]]:
    """Forces up to grip times load, by a curve with initial slope one; stiffness and grip are proportional to the
    load.
    """

    def forces(body: Body, af: Array, ar: Array, ax: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
        results, static_loads = [], _loads(body, np.float64(0.0), {})
        for axle, slip, load, at_rest in zip(
            ("front", "rear"), (af, ar), _loads(body, ax, p), static_loads, strict=True
        ):
            grip = p.get(f"{axle} grip", p.get("grip"))
            results.append(-grip * load * curve(p[f"{axle} stiffness"] / at_rest * slip / grip))
        return results[0], results[1]

    return forces


def _degressive(body: Body, af: Array, ar: Array, ax: Array, p: Mapping[str, Array]) -> tuple[Array, Array]:
    """Forces by the curve `root` with degressive stiffness and grip, and load transfer at the height of the car
    file.
    """
    results = []
    static_loads, loads = _loads(body, np.float64(0.0), {}), _loads(body, ax, {"height": np.float64(HEIGHT)})
    for axle, slip, at_rest, load in zip(("front", "rear"), (af, ar), static_loads, loads, strict=True):
        share = load / at_rest
        max_force = p[f"{axle} grip"] * (1.0 - p["grip lost by load"] * (share - 1.0)) * load
        stiffness = p[f"{axle} stiffness"] * share ** p["exponent of stiffness"]
        results.append(-max_force * root(stiffness * slip / max_force))
    return results[0], results[1]


def root(x: Array) -> Array:
    """Force curve x / sqrt(1 + x^2), with initial slope one and limit one."""
    return x / np.sqrt(1.0 + x * x)


_UNDERSTEER = Unknown("understeer", "s2/m", -0.01, 0.02)
STIFFNESS = Unknown("front stiffness", "N/rad", 2e4, 6e5), Unknown("rear stiffness", "N/rad", 2e4, 2e6)
_LINEAR = Unknown("front stiffness", "N/rad", 2e4, 3e5), Unknown("rear stiffness", "N/rad", 2e4, 4e5)
_GRIP = (Unknown("grip", "1", 0.8, 2.5),)
GRIPS = Unknown("front grip", "1", 0.8, 2.5), Unknown("rear grip", "1", 0.8, 2.5)
_OFFSET = Unknown("steering offset", "rad", -0.02, 0.02)
_HEIGHT = Unknown("height", "m", 0.0, 1.2)
INERTIA = Unknown("yaw inertia factor", "1", 0.3, 2.0)
_PLACE = Unknown("centre of mass to the left", "m", -0.2, 0.2)
_BY_LOAD = Unknown("exponent of stiffness", "1", 0.0, 1.0), Unknown("grip lost by load", "1", 0.0, 0.8)
_FACTOR = Unknown("steering factor", "1", 0.6, 1.3)
_BY_BRAKING = Unknown("steering by ax", "rad s2/m", -0.002, 0.002)

MODELS = (
    Model("kinematic", ()),
    Model("steady understeer", (_UNDERSTEER,)),
    Model("linear bicycle", _LINEAR, _linear),
    Model("saturating bicycle, tanh", (*STIFFNESS, *_GRIP, _OFFSET), _saturating(np.tanh)),
    Model("x/sqrt(1 + x2), two grips, yaw inertia", (*STIFFNESS, *GRIPS, _OFFSET, INERTIA), _saturating(root)),
    Model("tanh, two grips, longitudinal load transfer", (*STIFFNESS, *GRIPS, _OFFSET, _HEIGHT), _saturating(np.tanh)),
    Model(
        "the same and steering factor, steering by ax",
        (*STIFFNESS, *GRIPS, _OFFSET, _HEIGHT, _FACTOR, _BY_BRAKING),
        _saturating(np.tanh),
    ),
    Model(
        "load transfer, centre of mass beside the middle",
        (*STIFFNESS, *GRIPS, _OFFSET, _HEIGHT, _PLACE),
        _saturating(root),
    ),
    Model("the same and yaw inertia", (*STIFFNESS, *GRIPS, _OFFSET, _HEIGHT, _PLACE, INERTIA), _saturating(root)),
    Model(
        "the same with the height of the car file, tyres degressive",
        (*STIFFNESS, *GRIPS, _OFFSET, _PLACE, INERTIA, *_BY_LOAD),
        _degressive,
    ),
)


def simulate(
    model: Model, body: Body, drive: Drive, begins: NDArray[np.intp], steps: int, numbers: Array
) -> tuple[Array, Array]:
    """Simulate a model with the measured steering angle and speed.

    `begins`: first samples of the windows, which start from the measured lateral velocity and yaw rate, shape (w,);
    `steps`: number of steps in a window; `numbers`: k sets of parameters, shape (k, p). Returns `vy`, m/s, and
    `yaw_rate`, rad/s, at the centre of mass, shape (k, w, steps + 1).

    Notes
    -----
    Heun's method with one step per sample. Near the limit of the tyres its largest error in 275 s was 3e-3 rad/s,
    against LSODA with a tolerance of 1e-9.
    """
    rows = begins[:, None] + np.arange(steps + 1)
    steer, vx, ax = drive.steer[rows], drive.vx[rows], drive.ax[rows]
    p = {u.name: numbers[:, k, None] for k, u in enumerate(model.unknowns)}
    if model.forces is None:
        k = p["understeer"][..., None] if p else np.float64(0.0)
        rate = vx * steer / (body.wheelbase + k * vx**2) + np.zeros((len(numbers), 1, 1))
        return np.full(rate.shape, np.nan), rate
    inertia = body.yaw_inertia * p.get("yaw inertia factor", np.float64(1.0))
    forces = model.forces

    def change(k: int, vy: Array, r: Array) -> tuple[Array, Array]:
        angle = p.get("steering factor", np.float64(1.0)) * steer[:, k] + p.get("steering offset", np.float64(0.0))
        angle = angle + p.get("steering by ax", np.float64(0.0)) * ax[:, k]
        af = np.arctan2(vy + body.front * r, vx[:, k]) - angle
        ar = np.arctan2(vy - body.rear * r, vx[:, k])
        front, rear = forces(body, af, ar, ax[:, k], p)
        across = front * np.cos(angle)
        along = (
            body.mass * ax[:, k] + 0.5 * AIR * body.drag_area * vx[:, k] ** 2
        )  # total longitudinal force, in the middle plane
        turning = body.front * across - body.rear * rear + along * p.get("centre of mass to the left", np.float64(0.0))
        return (across + rear) / body.mass - vx[:, k] * r, turning / inertia

    return heun(change, drive, begins, steps, len(numbers))


def heun(
    change: Callable[[int, Array, Array], tuple[Array, Array]],
    drive: Drive,
    begins: NDArray[np.intp],
    steps: int,
    sets: int,
) -> tuple[Array, Array]:
    """Lateral velocity and yaw rate by Heun's method with one step per sample, from measured initial values.

    `change`: their rates, m/s2 and rad/s2, at a sample of the windows; `begins`: first samples of the windows, shape
    (w,). Returns `vy`, m/s, and `yaw_rate`, rad/s, shape (sets, w, steps + 1).
    """
    shape = (sets, len(begins), steps + 1)
    vy, r = np.empty(shape), np.empty(shape)
    vy[..., 0], r[..., 0] = drive.vy[begins], drive.yaw_rate[begins]
    h = drive.interval
    for k in range(steps):
        v0, r0 = vy[..., k], r[..., k]
        a, b = change(k, v0, r0)
        c, d = change(k + 1, v0 + h * a, r0 + h * b)
        vy[..., k + 1], r[..., k + 1] = v0 + 0.5 * h * (a + c), r0 + 0.5 * h * (b + d)
    return vy, r

"""A two-track model: loads of four wheels, different brakes left and right, drive forces by load."""

import numpy as np
from numpy.typing import NDArray

from benchmarks.validation.bicycle import AIR, GRIPS, HEIGHT, INERTIA, STIFFNESS, Body, G, Model, Unknown, heun, root
from benchmarks.validation.drive import Drive

Array = NDArray[np.float64]
TRACK = 1.345  # m, mean of both axles
BALANCE = 0.70  # front fraction of the brake force, as in the car file
_MIN_LOAD = 50.0  # N, load of a wheel that would lift off


def simulate(
    model: Model, body: Body, drive: Drive, begins: NDArray[np.intp], steps: int, numbers: Array
) -> tuple[Array, Array]:
    """Simulate the model with the measured steering angle and speed, as `bicycle.simulate`.

    Notes
    -----
    Load transfer is by ax and by the lateral force, both at the height of the car file, the latter in equal parts front
    and rear. Stiffness is a power of the load, forces follow x/sqrt(1 + x^2). Drive forces are proportional to the
    loads: both wheels of the axle then have equal slip, as with a locked differential.
    """
    rows = begins[:, None] + np.arange(steps + 1)
    steer, vx, ax = drive.steer[rows], drive.vx[rows], drive.ax[rows]
    bank = drive.bank[rows] if model.bank else np.zeros(rows.shape)
    p = {u.name: numbers[:, k, None] for k, u in enumerate(model.unknowns)}
    locked = 0.0 if model.open else 1.0
    static_loads = body.mass * G / body.wheelbase / 2.0 * np.array([body.rear, body.front])

    def change(k: int, vy: Array, r: Array) -> tuple[Array, Array]:
        v, a = vx[:, k], ax[:, k]
        along = body.mass * a + 0.5 * AIR * body.drag_area * v**2
        brake, pull = np.minimum(along, 0.0), np.maximum(along, 0.0)
        longitudinal_transfer = body.mass * a * HEIGHT / body.wheelbase / 2.0
        lateral_transfer = body.mass * (r * v - bank[:, k]) * HEIGHT / TRACK / 2.0
        across, turning = np.zeros_like(vy), np.zeros_like(vy)
        for axle, x, sign in (("front", body.front, -1.0), ("rear", -body.rear, 1.0)):
            at_rest = static_loads[0 if sign < 0.0 else 1]
            loads = [
                np.maximum(at_rest + sign * longitudinal_transfer - side * lateral_transfer, _MIN_LOAD)
                for side in (1.0, -1.0)
            ]
            angle = steer[:, k] if axle == "front" else np.zeros_like(v)
            fraction = BALANCE if axle == "front" else 1.0 - BALANCE
            for side, load in zip((1.0, -1.0), loads, strict=True):
                y = 0.5 * side * TRACK
                slip = np.arctan2(vy + x * r, v - r * y) - angle
                max_force = p[f"{axle} grip"] * load
                stiffness = 0.5 * p[f"{axle} stiffness"] * (load / at_rest) ** p["exponent of stiffness"]
                fy = -max_force * root(stiffness * slip / max_force)
                fx = 0.5 * fraction * brake * (1.0 + side * p["brake side"])
                if axle == "rear":
                    fx = fx + 0.5 * pull * (1.0 + locked * (2.0 * load / (loads[0] + loads[1]) - 1.0))
                to_left, forward = fy * np.cos(angle) + fx * np.sin(angle), fx * np.cos(angle) - fy * np.sin(angle)
                across = across + to_left
                turning = turning + x * to_left - y * forward
        inertia = body.yaw_inertia * p["yaw inertia factor"]
        return across / body.mass - v * r + bank[:, k], turning / inertia

    return heun(change, drive, begins, steps, len(numbers))


_NUMBERS = (
    *STIFFNESS,
    *GRIPS,
    INERTIA,
    Unknown("brake side", "1", -0.5, 0.5),
    Unknown("exponent of stiffness", "1", 0.0, 1.2),
)
MODELS = (
    Model("two tracks, open differential, brakes to the side", _NUMBERS, simulate=simulate, open=True),
    Model("two tracks, drive by load, brakes to the side", _NUMBERS, simulate=simulate),
    Model("the same and bank by place", _NUMBERS, simulate=simulate, bank=True),
)

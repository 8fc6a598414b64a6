"""Named formulas that compute our variables from other variables of an FMU.

Vehicle axes are those of ISO 8855, rotated from the earth axes by yaw, pitch and roll about z, the new y and the new x.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
_MIN_SPEED = 0.1
"""Speed below which the sideslip is zero, m/s, as in our FMUs."""


@dataclass(frozen=True)
class Formula:
    """A formula with named arguments."""

    arguments: tuple[str, ...]
    """Names for messages; the last may end with ``...`` for any number."""
    compute: Callable[..., Array]
    """Function of the time, shape (n,), and the arguments, each of this shape or a number; SI units."""
    needs_past: bool = False
    """Whether it uses other rows than its own."""
    wraps: bool = False
    """Whether it is an angle without jumps by whole turns."""

    def accepts(self, count: int) -> bool:
        """Whether the formula accepts a number of arguments."""
        if self.arguments[-1].endswith("..."):
            return count >= len(self.arguments)
        return count == len(self.arguments)


def _yaw(time: Array, w: Array, x: Array, y: Array, z: Array) -> Array:
    return np.unwrap(np.atleast_1d(np.arctan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))))


def _pitch(time: Array, w: Array, x: Array, y: Array, z: Array) -> Array:
    return np.asarray(np.arcsin(np.clip(2.0 * (w * y - z * x), -1.0, 1.0)))


def _roll(time: Array, w: Array, x: Array, y: Array, z: Array) -> Array:
    return np.asarray(np.arctan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)))


def _axes(roll: Array, pitch: Array, yaw: Array) -> tuple[tuple[Array, Array, Array], ...]:
    """The vehicle axes x, y, z in earth axes."""
    cr, sr, cp, sp, cy, sy = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw)
    return (
        (cy * cp, sy * cp, -sp),
        (cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr),
        (cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr),
    )


def _vehicle_component(axis: int) -> Callable[..., Array]:
    def component(time: Array, x: Array, y: Array, z: Array, roll: Array, pitch: Array, yaw: Array) -> Array:
        a = _axes(roll, pitch, yaw)[axis]
        return a[0] * x + a[1] * y + a[2] * z

    return component


def _point(axis: int) -> Callable[..., Array]:
    def coordinate(
        time: Array, x: Array, y: Array, z: Array, roll: Array, pitch: Array, yaw: Array, *r: Array
    ) -> Array:
        a = _axes(roll, pitch, yaw)
        return (x, y, z)[axis] + sum(a[k][axis] * r[k] for k in range(3))

    return coordinate


def _cross(axis: int, a: tuple[Array, ...], b: tuple[Array, ...]) -> Array:
    j, k = (axis + 1) % 3, (axis + 2) % 3
    return a[j] * b[k] - a[k] * b[j]


def _point_velocity(axis: int) -> Callable[..., Array]:
    def component(time: Array, *v: Array) -> Array:
        return v[axis] + _cross(axis, v[3:6], v[6:9])

    return component


def _point_acceleration(axis: int) -> Callable[..., Array]:
    def component(time: Array, *v: Array) -> Array:
        w, r = v[3:6], v[6:9]
        rates = tuple(_rate(time, x) for x in w)
        w_cross_r = tuple(_cross(k, w, r) for k in range(3))
        return v[axis] + _cross(axis, rates, r) + _cross(axis, w, w_cross_r)

    return component


def _acceleration(axis: int) -> Callable[..., Array]:
    def component(time: Array, *v: Array) -> Array:
        return _rate(time, v[axis]) + _cross(axis, v[3:6], v[:3])

    return component


def _angular_velocity(axis: int) -> Callable[..., Array]:
    def component(time: Array, *q: Array) -> Array:
        w, v, dw, dv = q[0], q[1:4], q[4], q[5:8]
        return 2.0 * (w * dv[axis] - dw * v[axis] - _cross(axis, v, dv))

    return component


def _rate(time: Array, x: Array) -> Array:
    """Rate of change by differences of second order; NaN for a single row."""
    if np.shape(x) != time.shape:
        x = np.broadcast_to(x, time.shape)
    if len(time) < 2:
        return np.full(time.shape, np.nan)
    return np.asarray(np.gradient(x, time, edge_order=2 if len(time) > 2 else 1))


def _sideslip(time: Array, vx: Array, vy: Array) -> Array:
    return np.where(np.hypot(vx, vy) < _MIN_SPEED, 0.0, np.arctan2(vy, vx))


def _length(time: Array, *components: Array) -> Array:
    return np.sqrt(sum((c * c for c in components), np.zeros(())))


def _product(time: Array, *factors: Array) -> Array:
    return np.asarray(np.prod(np.broadcast_arrays(*factors), axis=0))


_Q = ("qw", "qx", "qy", "qz")
_ANGLES = ("roll", "pitch", "yaw")
_R = ("rx", "ry", "rz")
_W = ("wx", "wy", "wz")
_V = ("vx", "vy", "vz")

FORMULAS = {
    "yaw": Formula(_Q, _yaw, wraps=True),
    "pitch": Formula(_Q, _pitch),
    "roll": Formula(_Q, _roll),
    "length": Formula(("x", "y..."), _length),
    "product": Formula(("x", "y..."), _product),
    "sideslip": Formula(("vx", "vy"), _sideslip),
    "rate": Formula(("x",), _rate, needs_past=True),
    "unwrapped": Formula(("angle",), lambda time, x: np.unwrap(np.broadcast_to(x, time.shape)), wraps=True),
}
for _k, _axis in enumerate("xyz"):
    FORMULAS |= {
        f"vehicle_{_axis}": Formula(("x", "y", "z", *_ANGLES), _vehicle_component(_k)),
        f"point_{_axis}": Formula(("x", "y", "z", *_ANGLES, *_R), _point(_k)),
        f"point_v{_axis}": Formula((*_V, *_W, *_R), _point_velocity(_k)),
        f"point_a{_axis}": Formula(("ax", "ay", "az", *_W, *_R), _point_acceleration(_k), needs_past=True),
        f"acceleration_{_axis}": Formula((*_V, *_W), _acceleration(_k), needs_past=True),
        f"angular_velocity_{_axis}": Formula((*_Q, *(f"d{q}" for q in _Q)), _angular_velocity(_k)),
    }
"""By the name that an alias file writes in ``from = "name(argument, ...)"``."""

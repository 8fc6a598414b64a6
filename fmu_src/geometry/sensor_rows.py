"""Sensors of a System as linear functions of its coordinates, by which the sensors of a pose are recognised."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import mbs
from mbs.kernel.header.enumerations import ElementType, SensorType
from mbs.system.drawing import BodyPlace

Array = NDArray[np.float64]
TOLERANCE = 1e-9  # of the largest number, for equal rows
AXES = "xyz"
QUATERNION = "wxyz"


@dataclass(frozen=True)
class Body:
    """Full coordinates of a body as rows."""

    origin: Array
    """Shape (3, nq + 1): components of its position; the last column is the constant."""
    axes: Array | None
    """Shape (3, 3, nq + 1): components of its three axes; None of a particle."""


class SensorRows:
    """Rows of the sensors and bodies of a System."""

    def __init__(self, system: mbs.System) -> None:
        self._arrays = system.arrays
        tables = system.arrays.get("tabled_size", np.zeros(0, int))
        self._dependents = int(np.sum(tables[::3]))  # behind the coordinates, of lookup-table bodies
        self._nq = system.nq + self._dependents
        assert system.drawing is not None, "asked for before"
        self._places = system.drawing.places
        self.names = [str(entry["name"]) for entry in system.meta["sensors"]]
        self._types = [SensorType(kind) for kind in system.arrays["sen_type"]]
        self._linear = {
            name: float(self._reals(k)[0]) * self._signal(self._integers(k)[0])
            for k, (name, kind) in enumerate(zip(self.names, self._types, strict=True))
            if kind == SensorType.SIGNAL
        }

    def body(self, place: BodyPlace) -> Body:
        """A body's position and axes as linear functions of the coordinates, also of a planar body."""
        planar, turns = place.kind.startswith("planar"), not place.kind.endswith("point")
        d = 2 if planar else 3
        origin = np.zeros((3, self._nq + 1))
        origin[:d] = self._full(place.row, d)
        if not turns:
            return Body(origin, None)
        axes = np.zeros((3, 3, self._nq + 1))
        if planar:
            cosine, sine = self._full(place.row + 2, 2)
            axes[0, 0], axes[0, 1], axes[1, 0], axes[1, 1] = cosine, sine, -sine, cosine
            axes[2, 2, -1] = 1.0
        else:
            axes[:] = self._full(place.row + 3, 9).reshape(3, 3, -1)
        return Body(origin, axes)

    def points(self) -> list[tuple[str, ...]]:
        """Names of sensors that may be the three components of a point: alike but for x, y, z."""
        triples = []
        for name in self._linear:
            for ending in (".x", "_x"):
                triple = tuple(name.removesuffix(ending) + ending[0] + c for c in AXES)
                if name.endswith(ending) and all(component in self._linear for component in triple):
                    triples.append(triple)
        return triples

    def place_of(self, names: Sequence[str], body: Body) -> Array | None:
        """The place in a body, from its origin, m, whose components these sensors are; None: none is."""
        offset = np.array([self._linear[name] for name in names]) - body.origin
        if body.axes is None:
            return np.zeros(3) if _is_equal(offset, 0.0 * offset, body.origin) else None
        matrix = body.axes.transpose(1, 2, 0).reshape(-1, 3)
        coordinates: Array = np.asarray(np.linalg.lstsq(matrix, offset.ravel(), rcond=None)[0], float)
        return coordinates if _is_equal(matrix @ coordinates, offset.ravel(), offset) else None

    def quaternions(self) -> list[tuple[tuple[str, ...], Array]]:
        """Names of sensors of a quaternion with the rows of the axes that it orients."""
        groups: dict[tuple[int, ...], dict[int, str]] = {}
        for k, kind in enumerate(self._types):
            if kind == SensorType.QUATERNION:
                component, *signals = self._integers(k)
                groups.setdefault(tuple(signals), {}).setdefault(component, self.names[k])
        return [
            (tuple(components[k] for k in range(4)), np.array([self._signal(s) for s in signals]).reshape(3, 3, -1))
            for signals, components in groups.items()
            if len(components) == len(QUATERNION)
        ]

    def is_identity(self, names: Sequence[str]) -> bool:
        """Whether these sensors are the constants 1, 0, 0, 0."""
        rows = [self._linear.get(name) for name in names]
        return all(row is not None and _is_equal(row, _constant(row, k == 0), row) for k, row in enumerate(rows))

    def angle(self, row: int) -> str | None:
        """The sensor of an angle, from its row among the places."""
        coefficients = self._full(row, 1)[0]
        return next(
            (
                name
                for name, row_of_sensor in self._linear.items()
                if _is_equal(row_of_sensor, coefficients, coefficients)
            ),
            None,
        )

    def spin_angle(self, row: int) -> str | None:
        """The sensor of the angle of a wheel on its carrier, from the row of its spin."""
        coefficients, arrays = self._full(row, 1)[0], self._arrays
        for k, kind in enumerate(self._types):
            if kind != SensorType.ELEMENT_OUTPUT or self._reals(k)[0] != 1.0:
                continue
            element = self._integers(k)[0]
            if ElementType(arrays["el_type"][element]) == ElementType.SPIN_ANGLE:
                spin = self._signal(int(arrays["el_sig"][int(arrays["el_sig_ptr"][element]) + 6]))
                if _is_equal(spin[:-1], coefficients[:-1], coefficients):
                    return self.names[k]
        return None

    def _full(self, first: int, count: int) -> Array:
        selection = slice(first, first + count)
        rows = self._places.matrix[selection].toarray()
        return np.column_stack([rows, np.zeros((count, self._dependents)), self._places.constant[selection]])

    def _signal(self, i: int) -> Array:
        a, row = self._arrays, np.zeros(self._nq + 1)
        selection = slice(int(a["sig_ptr"][i]), int(a["sig_ptr"][i + 1]))
        np.add.at(row, a["sig_col"][selection], a["sig_val"][selection])
        row[-1] = a["sig_const"][i]
        return row

    def _integers(self, sensor: int) -> list[int]:
        a = self._arrays
        return [int(v) for v in a["sen_int"][int(a["sen_int_ptr"][sensor]) : int(a["sen_int_ptr"][sensor + 1])]]

    def _reals(self, sensor: int) -> list[float]:
        a = self._arrays
        return [
            float(v)
            for v in a["sen_parameter"][int(a["sen_parameter_ptr"][sensor]) : int(a["sen_parameter_ptr"][sensor + 1])]
        ]


def _is_equal(a: Array, b: Array, scale: Array) -> bool:
    return bool(np.all(np.abs(a - b) <= TOLERANCE * max(1.0, float(np.max(np.abs(scale), initial=0.0)))))


def _constant(row: Array, value: float) -> Array:
    constant = np.zeros_like(row)
    constant[-1] = value
    return constant

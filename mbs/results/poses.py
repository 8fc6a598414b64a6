"""Poses of all bodies over a run, from the recorded coordinates: columns by name."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.common.checks import shown
from mbs.system.drawing import POSE, POSE_UNITS, BodyPlace, Places, twist

Array = NDArray[np.float64]
MAX_SAMPLES, MAX_COORDINATES = 100_000, 4_000_000
"""Largest numbers of samples and of coordinates (32 MB) of recorded poses."""


def pose_interval(samples: int, nq: int, every: int = 1) -> int:
    """Interval of the samples with poses, a multiple of `every`."""
    max_samples = max(100, min(MAX_SAMPLES, MAX_COORDINATES // max(nq, 1)))
    return every * max(1, math.ceil(samples / every / max_samples))


class Poses(Mapping[str, Array]):
    """Poses over time: ``poses["rod.x"]`` is an array of shape (n,).

    A body has ``BODY.x``, ``.y``, ``.z``, the position of its centre of mass (of a flexible body the origin of its
    floating frame) in earth axes, m, and the quaternion ``BODY.qw``, ``.qx``, ``.qy``, ``.qz`` that turns its axes from
    the drawing, scalar first and ``qw`` not negative. Planar bodies have z = 0 and turn about z, particles do not turn.
    Wheels and other parts that rotate on a body have ``NAME.angle``, rad; flexible bodies have their amplitudes
    ``BODY.MODE``.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Times, s. A run keeps at most 100 000 samples and 4 million coordinates: beyond that one of `every` samples.
    every : int
        One of that many samples of the trajectory has its poses here.
    """

    def __init__(self, t: Array, every: int, q: Array, places: Places) -> None:
        self.t = t
        self.every = every
        self._q, self._places = q, places
        self._computed: dict[str, Array] = {}
        self.bodies = tuple(body.name for body in places.bodies)

    @classmethod
    def of_columns(cls, t: Array, columns: Mapping[str, Array]) -> Poses | None:
        """Poses from named columns, of the bodies with all seven components.

        Parameters
        ----------
        t : ndarray, shape (n,)
            Times, s.
        columns : mapping of str to ndarray, shape (n,)
            By name, such as ``rod.x``.

        Returns
        -------
        Poses or None
            None if no body has all components.
        """
        suffixes = [f".{suffix}" for suffix in POSE]
        names = [n.removesuffix(".qw") for n in columns if n.endswith(".qw")]
        complete = [
            n for n in names if all(n + suffix in columns for suffix in suffixes) and f"{n}.pose.qw" not in columns
        ]
        if not complete:
            return None
        q = np.column_stack([columns[n + suffix] for n in complete for suffix in suffixes])
        bodies = [
            BodyPlace(n.removesuffix(".pose"), "pose", 7 * k, tuple(n + suffix for suffix in suffixes))
            for k, n in enumerate(complete)
        ]
        size = q.shape[1]
        return cls(t, 1, q, Places(sparse.csr_matrix(np.eye(size)), np.zeros(size), tuple(bodies)))

    def __getitem__(self, name: str) -> Array:
        if not isinstance(name, str) or name not in self._columns:
            available = ", ".join(self.bodies) or "none"
            raise KeyError(f"There is no pose {shown(name)}; each body has .x to .qz, the bodies are: {available}.")
        kind, number, column = self._columns[name]
        if kind == "body":
            return self._pose(number)[:, column]
        return self._turn(number) if kind == "turn" else self._amplitudes(number)[:, column]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        thinned = f", one of {self.every} samples" if self.every > 1 else ""
        return f"Poses({len(self.bodies)} bodies, {len(self.t)} samples{thinned})"

    def position(self, body: str) -> Array:
        """Positions of a body, by its name.

        Returns
        -------
        ndarray, shape (n, 3)
            Earth axes, m.
        """
        return self._pose(self._body_index(body))[:, :3]

    def quaternion(self, body: str) -> Array:
        """Quaternions of a body, scalar first and not negative: earth vector = rotation of the vector as drawn.

        Returns
        -------
        ndarray, shape (n, 4)
        """
        return self._pose(self._body_index(body))[:, 3:]

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column."""
        kind_units = {"turn": "rad", "mode": "1"}
        return {
            name: kind_units.get(kind) or POSE_UNITS[component] for name, (kind, _, component) in self._columns.items()
        }

    def recorded(
        self, columns: Mapping[str, Array], units: Mapping[str, str]
    ) -> tuple[dict[str, Array], dict[str, str]]:
        """Columns and units of sensors, followed by the poses under their names in recordings and files."""
        places = self._places
        names = dict(zip(self._columns, [c for b in places.bodies for c in b.columns], strict=False))
        names |= {f"{turn.name}.angle": turn.column for turn in places.turns}
        names |= {f"{a.body}.{m}": c for a in places.amplitudes for m, c in zip(a.modes, a.columns, strict=True)}
        pose_columns = {names[n]: values for n, values in self.items()}
        return {**columns, **pose_columns}, {**units, **{names[n]: unit for n, unit in self.units.items()}}

    def thinned(self, every: int) -> Poses:
        """Poses at every n-th sample of the trajectory.

        Parameters
        ----------
        every : int
            Above zero.

        Returns
        -------
        Poses
            Of those samples that are kept here, too.
        """
        rows = math.lcm(self.every, every) // self.every
        return Poses(self.t[::rows], self.every * rows // every, self._q[::rows], self._places)

    @cached_property
    def _columns(self) -> dict[str, tuple[str, int, int]]:
        places = self._places
        columns = {
            f"{b.name}.{component}": ("body", k, i)
            for k, b in enumerate(places.bodies)
            for i, component in enumerate(POSE)
        }
        columns |= {f"{turn.name}.angle": ("turn", k, 0) for k, turn in enumerate(places.turns)}
        modes = [(k, i, f"{a.body}.{mode}") for k, a in enumerate(places.amplitudes) for i, mode in enumerate(a.modes)]
        return columns | {name: ("mode", k, i) for k, i, name in modes}

    def _body_index(self, body: str) -> int:
        if body not in self.bodies:
            raise KeyError(f"There is no body {shown(body)}; the bodies are: {', '.join(self.bodies) or 'none'}.")
        return self.bodies.index(body)

    def _pose(self, index: int) -> Array:
        body = self._places.bodies[index]
        if body.name not in self._computed:
            self._computed[body.name] = self._places.pose(self._q, body)
        return self._computed[body.name]

    def _turn(self, index: int) -> Array:
        turn = self._places.turns[index]
        angle = self._places.rows(self._q, turn.row, 1)[:, 0]
        if not turn.absolute:
            return angle
        return angle - twist(self.quaternion(turn.carrier), np.array(turn.axis))

    def _amplitudes(self, index: int) -> Array:
        amplitudes = self._places.amplitudes[index]
        return self._places.rows(self._q, amplitudes.row, len(amplitudes.modes))

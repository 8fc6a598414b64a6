"""Arrays of the System for signals, elements, sensors, inputs, driving functions, roads and parameters."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.affine import Affine
from mbs.common.errors import ModelError
from mbs.compiler.armatures import written_armatures
from mbs.compiler.front_arrays import Locate
from mbs.compiler.polynomial import substitute
from mbs.kernel.header.enumerations import SensorType
from mbs.model.body import Body
from mbs.model.joints.joint import Joint
from mbs.model.model import Model
from mbs.model.sensor import MAX_FACTORS, Sensor

Arrays = dict[str, NDArray[Any]]


class Signals:
    """Affine signals of z in elimination order, each stored once.

    `full`: full coordinates as expressions in z; `new`: index of each z in elimination order; `reserved`: coordinates
    that expressions, by identity, have as entries even if they are zero, each as a separate signal.
    """

    def __init__(
        self, full: Sequence[Affine], new: NDArray[np.int64], reserved: Mapping[int, frozenset[int]] | None = None
    ) -> None:
        self._full = full
        self._new = new
        self._reserved = reserved or {}
        self._number_of_row: dict[tuple[Any, ...], int] = {}
        self._numbers: dict[int, tuple[Affine, int]] = {}  # by identity, with the expression, which keeps the identity
        self.rows: list[tuple[list[int], list[float], float]] = []

    def number(self, expression: Affine) -> int:
        """Number of the signal of an expression in full coordinates."""
        entry = self._numbers.get(id(expression))
        if entry is None:
            z, reserved = substitute(expression, self._full), self._reserved.get(id(expression))
            number = self.number_of_z(z) if reserved is None else self._append(z, reserved)
            entry = self._numbers[id(expression)] = expression, number
        return entry[1]

    def number_of_z(self, z: Affine) -> int:
        """Number of the signal of an expression in z."""
        pairs = sorted((int(self._new[j]), v) for j, v in z.terms.items())
        key = (*pairs, z.constant)
        if key not in self._number_of_row:
            self._number_of_row[key] = len(self.rows)
            self.rows.append(([c for c, _ in pairs], [v for _, v in pairs], z.constant))
        return self._number_of_row[key]

    def _append(self, z: Affine, reserved: frozenset[int]) -> int:
        pairs = sorted((int(self._new[j]), z.terms.get(j, 0.0)) for j in reserved | set(z.terms))
        self.rows.append(([c for c, _ in pairs], [v for _, v in pairs], z.constant))
        return len(self.rows) - 1

    def arrays(self) -> Arrays:
        """The `sig_` arrays."""
        return {
            "sig_ptr": pointer([len(r[0]) for r in self.rows]),
            "sig_col": np.array([c for r in self.rows for c in r[0]], dtype=np.int64),
            "sig_val": np.array([v for r in self.rows for v in r[1]], dtype=float),
            "sig_const": np.array([r[2] for r in self.rows], dtype=float),
        }


def pointer(counts: Sequence[int]) -> NDArray[np.int64]:
    """First index of each of consecutive groups, and the total."""
    return np.concatenate([[0], np.cumsum(np.asarray(counts, dtype=np.int64))]).astype(np.int64)


def ragged_arrays(name: str, groups: Sequence[Sequence[float]], dtype: type) -> Arrays:
    """Arrays ``name_ptr`` and ``name`` of a list of lists."""
    flat = [v for g in groups for v in g]
    return {f"{name}_ptr": pointer([len(g) for g in groups]), name: np.array(flat, dtype=dtype)}


def element_cliques(model: Model, full: Sequence[Affine], reserved: Mapping[int, frozenset[int]]) -> list[list[int]]:
    """Coordinates (before ordering) that each element couples in the tangent; `reserved`: see `Signals`."""
    cliques = []
    for element in model.elements:
        if not element.tangent:
            continue
        cliques.append(sorted({j for s in element.signals for j in reserved.get(id(s)) or substitute(s, full).terms}))
    return cliques


def element_arrays(model: Model, signals: Signals, front_of: Locate) -> Arrays:
    """The `el_` arrays and `y0`."""
    numbers, fronts, local_indices = [], [], []
    for element in model.elements:
        element_signals = [signals.number(s) for s in element.signals]
        numbers.append(element_signals)
        entries = [c for n in element_signals for c in signals.rows[n][0]]
        if not element.tangent or not entries:
            fronts.append(-1)
            local_indices.append([0] * len(entries))
        else:
            front, local = front_of(entries)
            fronts.append(front)
            local_indices.append(local)
    e = model.elements
    return {
        "el_type": np.array([int(x.type) for x in e], dtype=np.int64),
        **ragged_arrays("el_sig", numbers, np.int64),
        **ragged_arrays("el_parameter", [x.real for x in e], float),
        **ragged_arrays("el_int", [x.integer for x in e], np.int64),
        "el_state_ptr": pointer([len(x.states) for x in e]),
        "el_out_ptr": pointer([len(x.outputs) for x in e]),
        "el_front": np.array(fronts, dtype=np.int64),
        **ragged_arrays("el_loc", local_indices, np.int64),
        "y0": np.array([v for x in e for v in x.states], dtype=float),
    }


def sensor_arrays(model: Model, signals: Signals, row_of: dict[tuple[int, int], int]) -> Arrays:
    """The `sen_` arrays; `row_of`: number of the row of (joint, equation)."""
    joints = {id(j): k for k, j in enumerate(model.joints)}
    ints = []
    reals: list[Sequence[float]] = []

    def row(sensor: Sensor, joint: Joint | None, equation: int) -> int:
        assert joint is not None
        row_number = row_of.get((joints[id(joint)], equation))
        if row_number is None:
            raise ModelError(
                f"The sensor '{sensor.name}' has no value: an equation of joint '{joint.name}' follows from the others "
                "and was left out, so how the load is shared is not determined. Let a body bend, or loosen a joint."
            )
        return row_number

    for sensor in model.sensors:
        # all bodies of the model are known here
        is_mass = sensor.type == SensorType.MASS
        reals.append(
            [float(sum(b.mass for b in (*model.bodies, *model.lookup_tables) if isinstance(b, Body)))]
            if is_mass
            else sensor.reals
        )
        if sensor.terms:
            ints.append([len(sensor.terms)])
            reals[-1] = [t.weight for t in sensor.terms]
            for t in sensor.terms:
                factors = [signals.number(f) for f in t.factors]
                padding = [-1] * (MAX_FACTORS - len(factors))
                ints[-1] += [row(sensor, t.joint or sensor.joint, t.equation), *factors, *padding, t.guide]
                if sensor.type == SensorType.REACTION_BY_TABLE:
                    ints[-1].append(t.slope)
        elif sensor.joint is not None:
            rows = [row(sensor, sensor.joint, k) for k in sensor.integers]
            ints.append([len(rows), *rows])
        else:
            rows = [row(sensor, j, k) for j in sensor.joints for k in j.force_equations]
            ints.append([*sensor.integers, *(signals.number(s) for s in sensor.signals), *rows])
    return {
        "sen_type": np.array([s.type for s in model.sensors], dtype=np.int64),
        **ragged_arrays("sen_int", ints, np.int64),
        **ragged_arrays("sen_parameter", reals, float),
    }


def channel_arrays(model: Model) -> Arrays:
    """Arrays of inputs, driving functions, roads and parameters."""
    element_start = pointer([len(e.real) for e in model.elements])
    driving_start = pointer([len(g.reals) for g in model.guides])
    road_start = pointer([len(r.real) for r in model.roads])
    written_numbers = written_armatures(model)
    starts = (
        element_start,
        driving_start,
        road_start,
        pointer([1] * len(model.payloads)),
        pointer([1] * len(model.switches)),
        pointer([int(k in written_numbers) for k in range(len(model.armatures))]),
        pointer([len(body.reals) for body in model.written_inertias]),
        pointer([1 if s.type == SensorType.MASS else s.factors for s in model.sensors]),
        pointer([len(axis.reals) for axis in model.written_axes]),
    )
    targets = [[(t, int(starts[t][k]) + i, *line) for t, k, i, *line in p.targets] for p in model.parameters]
    flat = [t for group in targets for t in group]
    return {
        "input_start": np.array([i.start for i in model.inputs], dtype=float),
        "input_min": np.array([i.min for i in model.inputs], dtype=float),
        "input_max": np.array([i.max for i in model.inputs], dtype=float),
        "guide_type": np.array([g.type for g in model.guides], dtype=np.int64),
        "guide_input": np.array([g.input for g in model.guides], dtype=np.int64),
        "guide_second": np.array([g.second for g in model.guides], dtype=np.int64),
        **ragged_arrays("guide_parameter", [g.reals for g in model.guides], float),
        "road_type": np.array([int(r.type) for r in model.roads], dtype=np.int64),
        **ragged_arrays("road_parameter", [r.real for r in model.roads], float),
        "par_value": np.array([p.value for p in model.parameters], dtype=float),
        "par_min": np.array([p.min for p in model.parameters], dtype=float),
        "par_max": np.array([p.max for p in model.parameters], dtype=float),
        "par_ptr": pointer([len(g) for g in targets]),
        "par_target": np.array([t[0] for t in flat], dtype=np.int64),
        "par_index": np.array([t[1] for t in flat], dtype=np.int64),
        "par_scale": np.array([t[2] for t in flat], dtype=float),
        "par_offset": np.array([t[3] for t in flat], dtype=float),
        "par_inverse": np.array([t[4] for t in flat if any(u[4] for u in flat)], dtype=np.int64),
        "par_fixed": np.array([not p.tunable for p in model.parameters], dtype=np.int64),
    }

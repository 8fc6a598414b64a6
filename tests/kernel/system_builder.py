"""Writes System bytes for small systems made by hand, without the compiler of `mbs`: dense, slow, plain."""

import struct
import zlib
from dataclasses import dataclass, field

import numpy as np

from mbs.kernel.header.arrays import ARRAYS
from mbs.kernel.header.limits import SYSTEM_VERSION

INT, REAL, BYTES = 1, 2, 3
REALS = {name for name, (items, _) in ARRAYS.items() if items == "REALS"}
INTS = {name for name, (items, _) in ARRAYS.items() if items == "INTEGERS"}


@dataclass
class Row:
    """constant + lin . q + sum h q_i q_j (+ driving functions); an angle row adds cos(q_theta) S - sin(q_theta) C. A
    velocity row is lin . qd + sum h q_i qd_j alone.
    """

    constant: float
    lin: dict[int, float] = field(default_factory=dict)
    quad: dict[tuple[int, int], float] = field(default_factory=dict)
    theta: int | None = None
    angle: list[tuple[int, int, float, float]] = field(default_factory=list)  # i, j (-1: none), hc, hs
    guided: list[tuple[int, int, int, int, float]] = field(default_factory=list)  # driving function, power, i, j, h
    rates: dict[tuple[int, int], float] = field(default_factory=dict)

    def columns(self) -> list[int]:
        """Coordinates that appear."""
        result = set(self.lin) | {i for pair in (*self.quad, *self.rates) for i in pair}
        result |= {i for a in self.angle for i in a[:2] if i >= 0} | {i for g in self.guided for i in g[2:4] if i >= 0}
        return sorted(result | ({self.theta} if self.theta is not None else set()))


@dataclass
class Element:
    """A force element: its type number, signal numbers and data."""

    type: int
    signals: list[int]
    real: list[float] = field(default_factory=list)
    integer: list[int] = field(default_factory=list)
    states: list[float] = field(default_factory=list)
    outputs: int = 0


def distance_row(p1: tuple[int, int] | tuple[float, float], p2: tuple[int, int], length: float, fixed: bool) -> Row:
    """Half the difference of squares between two planar points; p1 are numbers when `fixed`, else coordinates."""
    row = Row(-0.5 * length**2)
    for a, b in zip(p1, p2, strict=True):
        row.quad[(b, b)] = 0.5
        if fixed:
            row.lin[b] = -float(a)
            row.constant += 0.5 * float(a) ** 2
        else:
            row.quad[(int(a), int(a))] = 0.5
            row.quad[(max(int(a), b), min(int(a), b))] = -1.0
    return row


class SystemBuilder:
    """Arrays of a System from a dense mass matrix and a list of rows.

    Parameters
    ----------
    mass : (nq, nq) array
    q0, qd0, gravity : (nq,) arrays
    rows : list of Row
        Not yet mass-normalised.
    groups : list of int, optional
        Pivots per front; default one front.
    """

    def __init__(self, mass, q0, qd0=None, gravity=None, rows=(), groups=None) -> None:  # type: ignore[no-untyped-def]
        self.mass = np.asarray(mass, float)
        self.q0 = np.asarray(q0, float)
        n = len(self.q0)
        self.qd0 = np.zeros(n) if qd0 is None else np.asarray(qd0, float)
        self.gravity = np.zeros(n) if gravity is None else np.asarray(gravity, float)
        self.gravity_const = 0.0
        self.rows: list[Row] = list(rows)
        self.groups = groups or [n]
        self.signals: list[tuple[dict[int, float], float]] = []
        self.elements: list[Element] = []
        self.inputs: list[tuple[float, float, float]] = []
        self.guides: list[tuple[int, int, list[float]]] = []
        self.roads: list[tuple[int, list[float]]] = []
        self.parameters: list[tuple[float, float, float, list[tuple[int, int, float]]]] = []
        self.sensors: list[tuple[int, list[int], list[float]]] = []
        self.pose: dict[str, np.ndarray] = {}
        self.normalise = True

    def signal(self, terms: dict[int, float], constant: float = 0.0) -> int:
        """Number of a new affine signal."""
        self.signals.append((dict(sorted(terms.items())), constant))
        return len(self.signals) - 1

    def row_scale(self, row: Row) -> float:
        """1 / sqrt(sum Phi_q,i^2 / M_ii) over the coordinates with mass, at q0."""
        J = self.gradient(row, self.q0)
        d = np.diag(self.mass)
        total = sum(J[i] ** 2 / d[i] for i in row.columns() if d[i] > 0)
        return 1.0 / np.sqrt(total) if self.normalise and total > 0 else 1.0

    def gradient(self, row: Row, q: np.ndarray) -> np.ndarray:
        """Gradient of a row by central differences of its polynomial; of a velocity row the factors of the rates."""
        g = np.zeros(len(q))
        if row.rates:
            for j, c in row.lin.items():
                g[j] += c
            for (i, j), h in row.rates.items():
                g[j] += h * q[i]
            return g
        for i in row.columns():
            e = np.zeros(len(q))
            e[i] = 1e-4
            g[i] = (self.value(row, q + e) - self.value(row, q - e)) / 2e-4
        return g

    def value(self, row: Row, q: np.ndarray, s: np.ndarray | None = None) -> float:
        """Value of a row in user units; driving functions are zero unless given."""
        x = np.append(q, 1.0)  # index -1 means 1
        v = (
            row.constant
            + sum(c * q[i] for i, c in row.lin.items())
            + sum(h * q[i] * q[j] for (i, j), h in row.quad.items())
        )
        if row.theta is not None:
            C = sum(hc * x[i] * x[j] for i, j, hc, _ in row.angle)
            S = sum(hs * x[i] * x[j] for i, j, _, hs in row.angle)
            v += np.cos(q[row.theta]) * S - np.sin(q[row.theta]) * C
        if s is not None:
            v += sum(h * s[g] ** p * x[i] * x[j] for g, p, i, j, h in row.guided)
        return float(v)

    def _fronts(self) -> list[list[int]]:
        n = len(self.q0)
        adjacent = [set(np.flatnonzero(self.mass[i])) | {i} for i in range(n)]
        cliques = [row.columns() for row in self.rows]
        for e in self.elements:
            cliques.append(sorted({c for s in e.signals for c in self.signals[s][0]}))
        for clique in cliques:
            for i in clique:
                adjacent[i] |= set(clique)
        first = np.cumsum([0, *self.groups])
        below: list[set[int]] = []
        for f, size in enumerate(self.groups):
            pivots = set(range(first[f], first[f] + size))
            members = pivots | {int(j) for i in pivots for j in adjacent[i] if j >= first[f]}
            for g in range(f):
                outside = [j for j in below[g] if j >= first[g + 1]]
                if outside and first[f] <= min(outside) < first[f + 1]:
                    members |= set(outside)
            below.append(members)
        return [sorted(m) for m in below]

    def arrays(self) -> dict[str, object]:
        """All arrays of the file."""
        a: dict[str, object] = {name: [] for name in (*REALS, *INTS)}
        n = len(self.q0)
        first = np.cumsum([0, *self.groups])
        fronts = self._fronts()
        offset = np.cumsum([0, *(len(f) ** 2 for f in fronts)])
        of = np.searchsorted(first, np.arange(n), side="right") - 1
        a.update(meta=b"{}", q0=self.q0, qd0=self.qd0, gravity_force=self.gravity, gravity_const=[self.gravity_const])
        a["front_col"], a["front_off"] = first, offset
        a["front_ptr"] = np.cumsum([0, *map(len, fronts)])
        a["front_idx"] = [i for f in fronts for i in f]
        parent, mapping = [], []
        for k, f in enumerate(fronts):
            rest = [i for i in f if i >= first[k + 1]]
            parent.append(int(of[rest[0]]) if rest else -1)
            mapping += [-1] * (len(f) - len(rest)) + [fronts[parent[-1]].index(i) for i in rest]
        a["front_parent"], a["front_map"] = parent, mapping
        ptr, col, val, pos = [0], [], [], []
        for i in range(n):
            for j in np.flatnonzero(self.mass[i]):
                f = of[min(i, j)]
                col.append(j)
                val.append(self.mass[i, j])
                local = (fronts[f].index(max(i, j)), fronts[f].index(min(i, j)))
                pos.append(offset[f] + local[1] * len(fronts[f]) + local[0] if i >= j else -1)
            ptr.append(len(col))
        a.update(mass_ptr=ptr, mass_col=col, mass_val=val, mass_pos=pos)
        self._row_arrays(a, fronts, of)
        self._table_arrays(a, fronts, of)
        return a

    def _row_arrays(self, a: dict[str, object], fronts: list[list[int]], of: np.ndarray) -> None:
        own = ("row_", "quad_", "angle_", "gterm_", "velocity_")
        out: dict[str, list] = {k: [] for k in (*INTS, *REALS) if k.startswith(own)}
        out["row_ptr"], out["quad_ptr"], out["angle_ptr"], out["velocity_ptr"] = [0], [0], [0], [0]
        for k, row in enumerate(self.rows):
            columns, scale = row.columns(), self.row_scale(row)
            where = {c: i for i, c in enumerate(columns)} | {-1: -1}
            f = int(of[columns[0]])
            out["row_col"] += columns
            out["row_lin"] += [scale * row.lin.get(c, 0.0) for c in columns]
            out["row_loc"] += [fronts[f].index(c) for c in columns]
            out["row_ptr"].append(len(out["row_col"]))
            out["row_const"].append(scale * row.constant)
            out["row_scale"].append(scale)
            size = np.linalg.norm(scale * self.gradient(row, self.q0))
            out["row_measure"].append(1.0 / size if size > 0 else 1.0)
            out["row_front"].append(f)
            out["row_switch"].append(-1)
            for (i, j), h in row.quad.items():
                out["quad_a"].append(where[max(i, j)])
                out["quad_b"].append(where[min(i, j)])
                out["quad_h"].append(scale * h)
            out["quad_ptr"].append(len(out["quad_a"]))
            for g, p, i, j, h in row.guided:
                parts = (k, g, p, where[max(i, j)], where[min(i, j)], scale * h)
                for name, v in zip(("row", "guide", "power", "a", "b", "h"), parts, strict=True):
                    out[f"gterm_{name}"].append(v)
            if row.rates:
                out["velocity_row"].append(k)
                out["velocity_a"] += [where[i] for i, _ in row.rates]
                out["velocity_b"] += [where[j] for _, j in row.rates]
                out["velocity_h"] += [scale * h for h in row.rates.values()]
                out["velocity_ptr"].append(len(out["velocity_a"]))
            if row.theta is None:
                continue
            out["angle_row"].append(k)
            out["angle_theta"].append(where[row.theta])
            for i, j, hc, hs in row.angle:
                for name, v in zip("ab", (where[max(i, j)], where[min(i, j)]), strict=True):
                    out[f"angle_{name}"].append(v)
                out["angle_hc"].append(scale * hc)
                out["angle_hs"].append(scale * hs)
            out["angle_ptr"].append(len(out["angle_a"]))
        a.update(out)
        a["switch_start"] = []

    def _table_arrays(self, a: dict[str, object], fronts: list[list[int]], of: np.ndarray) -> None:
        def pointers(lengths: list[int]) -> np.ndarray:
            return np.cumsum([0, *lengths])

        a["sig_ptr"] = pointers([len(t) for t, _ in self.signals])
        a["sig_col"] = [c for t, _ in self.signals for c in t]
        a["sig_val"] = [v for t, _ in self.signals for v in t.values()]
        a["sig_const"] = [c for _, c in self.signals]
        e = self.elements
        a["el_type"] = [x.type for x in e]
        for name, part in (("sig", "signals"), ("parameter", "real"), ("int", "integer")):
            a[f"el_{name}_ptr"] = pointers([len(getattr(x, part)) for x in e])
            a[f"el_{name}"] = [v for x in e for v in getattr(x, part)]
        a["el_state_ptr"], a["y0"] = pointers([len(x.states) for x in e]), [v for x in e for v in x.states]
        a["el_out_ptr"] = pointers([x.outputs for x in e])
        front, loc, count = [], [], []
        for x in e:
            columns = [c for s in x.signals for c in self.signals[s][0]]
            f = int(of[min(columns)]) if columns else -1
            front.append(f)
            count.append(len(columns))
            loc += [fronts[f].index(c) for c in columns]
        a["el_front"], a["el_loc"], a["el_loc_ptr"] = front, loc, pointers(count)
        for k, name in enumerate(("start", "min", "max")):
            a[f"input_{name}"] = [i[k] for i in self.inputs]
        a["guide_type"], a["guide_input"] = [g[0] for g in self.guides], [g[1] for g in self.guides]
        a["guide_parameter_ptr"] = pointers([len(g[2]) for g in self.guides])
        a["guide_parameter"] = [v for g in self.guides for v in g[2]]
        a["road_type"] = [r[0] for r in self.roads]
        a["road_parameter_ptr"], a["road_parameter"] = (
            pointers([len(r[1]) for r in self.roads]),
            [v for r in self.roads for v in r[1]],
        )
        for k, name in enumerate(("value", "min", "max")):
            a[f"par_{name}"] = [p[k] for p in self.parameters]
        a["par_ptr"] = pointers([len(p[3]) for p in self.parameters])
        for k, name in enumerate(("target", "index", "scale")):
            a[f"par_{name}"] = [t[k] for p in self.parameters for t in p[3]]
        a["par_offset"] = [t[3] if len(t) > 3 else 0.0 for p in self.parameters for t in p[3]]
        a["par_fixed"] = [int(p[4]) if len(p) > 4 else 0 for p in self.parameters]
        a["sen_type"] = [s[0] for s in self.sensors]
        a["sen_int_ptr"], a["sen_int"] = (
            pointers([len(s[1]) for s in self.sensors]),
            [v for s in self.sensors for v in s[1]],
        )
        a["sen_parameter_ptr"] = pointers([len(s[2]) for s in self.sensors])
        a["sen_parameter"] = [v for s in self.sensors for v in s[2]]
        a.update(self.pose)
        a["flex_mode_ptr"] = [0]

    def to_bytes(self) -> bytes:
        """The System file."""
        return pack(self.arrays())


def pack(arrays: dict[str, object]) -> bytes:
    """System bytes of arrays by name."""
    directory, data = b"", b""
    start = 32 + 64 * len(arrays)
    for name, values in arrays.items():
        if name == "meta":
            raw, kind, count = bytes(values), BYTES, len(values)  # type: ignore[arg-type, call-overload]
        else:
            kind = REAL if name in REALS else INT
            v = np.asarray(values, "<f8" if kind == REAL else "<i4")
            raw, count = v.tobytes(), v.size
        directory += struct.pack("<40sIIQQ", name.encode(), kind, 0, start + len(data), count)
        data += raw + bytes(-len(raw) % 8)
    return seal(b"\0" * 32 + directory + data, len(arrays))


def seal(data: bytes, count: int) -> bytes:
    """Header with size and checksum for what stands behind it."""
    body = data[32:]
    return struct.pack("<8sIIQII", b"ALI3SYS\n", SYSTEM_VERSION, count, len(data), zlib.crc32(body), 0) + body

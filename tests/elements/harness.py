"""Compiles the element sources with the test harness and calls them with plain arrays."""

from __future__ import annotations

import atexit
import ctypes
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import ArrayLike, NDArray

from mbs.common.affine import Affine, AffineVector
from mbs.elements import ElementRecord, PlaneRoad, Road
from mbs.kernel import build

Array = NDArray[np.float64]
KERNEL = Path(__file__).parents[2] / "mbs" / "kernel" / "src"
APART = (
    "forces.c",
    "element_batches.c",
    "element_batches_derive.c",
    "road.c",
)  # these need a System, the last may be replaced
SOURCES = [f for f in sorted((KERNEL / "elements").glob("*.c")) if f.name not in APART]
SOURCES += [
    KERNEL / "algebra" / "elementary.c",
    KERNEL / "algebra" / "finite.c",
    KERNEL / "algebra" / "inverse_tangent.c",
    KERNEL / "algebra" / "parse_number.c",
    *(f for room in ("roads", "files") for f in (KERNEL / room).glob("*.c")),
]


def compiled(road: Path) -> ctypes.CDLL:
    """The elements as a small library of their own, over the roads of a C file."""
    folder = Path(tempfile.mkdtemp(prefix="ali3_elements_"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    target = folder / ("elements.dll" if sys.platform == "win32" else "elements.so")
    files = [str(file) for file in (*SOURCES, road)]
    flags = ["-std=c11", "-O2", "-ffp-contract=off", "-shared", "-fPIC", "-Wall", "-Wextra", "-Werror", f"-I{KERNEL}"]
    command = [build.compiler(), "cc", "-target", build.host_target(), *flags]
    command += [
        *(str(Path(__file__).with_name(name)) for name in ("harness.c", "lane_laws.c")),
        *files,
        "-lm",
        "-o",
        str(target),
    ]
    subprocess.run(command, check=True, capture_output=True, text=True, env=build.compiler_environment())
    lib = ctypes.CDLL(str(target))
    lib.harness_evaluate.restype = ctypes.c_double
    lib.harness_check.restype = ctypes.c_char_p
    lib.harness_road_check.restype = ctypes.c_char_p
    return lib


@cache
def library() -> ctypes.CDLL:
    """With the roads of the kernel, compiled once per process."""
    return compiled(KERNEL / "elements" / "road.c")


def _in_c(array: Array) -> ctypes.Array[ctypes.c_double]:
    """The memory of an array of doubles that is not empty."""
    return (ctypes.c_double * array.size).from_buffer(array)


def _doubles(values: ArrayLike) -> ctypes.Array[ctypes.c_double]:
    return _in_c(np.array(values, float) if np.size(values) else np.zeros(1))


@lru_cache(maxsize=64)
def _constants(values: tuple[float, ...]) -> ctypes.Array[ctypes.c_double]:
    """Of data that stay from call to call; the kernel does not write there."""
    return _doubles(values)


_ROADS: dict[int, tuple[Road, int, ctypes.Array[ctypes.c_double]]] = {}


def _road(road: Road) -> tuple[int, int, ctypes.Array[ctypes.c_double]]:
    """Type, count and numbers of a road, which is kept so that no other one has its identity."""
    if id(road) not in _ROADS:
        real = road.real
        _ROADS[id(road)] = road, len(real), _doubles(real)
    return road.type, *_ROADS[id(road)][1:]


@lru_cache(maxsize=64)
def _ints(values: tuple[int, ...]) -> ctypes.Array[ctypes.c_int32]:
    return (ctypes.c_int32 * max(1, len(values)))(*values)


def signals(n: int) -> tuple[Affine, ...]:
    """Placeholder expressions: one coordinate each."""
    return tuple(Affine({i: 1.0}) for i in range(n))


def vectors(*sizes: int) -> list[AffineVector]:
    """Placeholder vectors of distinct coordinates."""
    every = iter(signals(sum(sizes)))
    return [AffineVector(tuple(next(every) for _ in range(size))) for size in sizes]


@dataclass
class Result:
    """What one evaluation of an element gives."""

    f: Array
    S: Array
    y: Array
    out: dict[str, float]
    potential: float


@dataclass
class Element:
    """A record that can be evaluated in isolation."""

    element: ElementRecord
    road: Road = PlaneRoad()  # noqa: RUF009
    n_inputs: int = 4

    def __post_init__(self) -> None:
        e = self.element
        counts = (len(e.signals), len(e.real), len(e.integer), len(e.states), len(e.outputs))
        self.sizes = _ints(counts)
        assert library().harness_sizes_match(int(e.type), self.sizes, _ints(tuple(e.integer))), (
            f"sizes {counts} of {e.type} are not those of the kernel"
        )
        assert self.check() is None, self.check()

    def check(self, n_inputs: int | None = None, n_roads: int = 1) -> str | None:
        """The kernel's sentence about the data, None if they are good."""
        e = self.element
        n = self.n_inputs if n_inputs is None else n_inputs
        text = library().harness_check(int(e.type), self.sizes, _doubles(e.real), _ints(tuple(e.integer)), n, n_roads)
        return None if text is None else text.decode()

    def with_reals(self, change: Mapping[int | str, float]) -> Element:
        """The same with other numbers, by place or name, as only a damaged file has them."""
        real = list(self.element.real)
        for key, value in change.items():
            real[self.element.real_names.index(key) if isinstance(key, str) else key] = value
        self.element = replace(self.element, real=real)
        return self

    @property
    def conservative(self) -> bool:
        """Whether the kernel says that forces of this element take no energy."""
        e = self.element
        return bool(library().harness_conservative(int(e.type), _doubles(e.real), len(e.real), _ints(tuple(e.integer))))

    @property
    def has_discrete(self) -> bool:
        """Whether it has forces by a discrete gradient of their own."""
        return bool(library().harness_has_discrete(int(self.element.type)))

    def start(self, u: ArrayLike, raised: float = 0.0) -> tuple[float, float] | None:
        """Excess and rise of the element's verdict on a start; None: it has none."""
        e, out = self.element, (ctypes.c_double * 2)()
        numbers = (_doubles(u), ctypes.c_double(raised), _doubles(e.real), _ints(tuple(e.integer)))
        has = library().harness_start(int(e.type), self.sizes, *numbers, *_road(self.road), out)
        return (out[0], out[1]) if has else None

    def __call__(
        self,
        u: ArrayLike,
        ud: ArrayLike,
        y: ArrayLike | None = None,
        h: float = 0.0,
        wC: float = 0.0,
        wK: float = 0.0,
        inputs: ArrayLike = (),
        accept: bool = False,
        discrete: bool = False,
        reach: float = 0.0,
    ) -> Result:
        e = self.element
        n = len(e.signals)
        assert np.size(u) == n == np.size(ud)
        input_values = np.zeros(self.n_inputs)
        input_values[: np.size(inputs)] = inputs
        made = [np.full(max(1, k), np.nan) for k in (len(e.states), n, n * n, len(e.outputs))]
        y_new, f, S, out = made
        potential = library().harness_evaluate(
            int(e.type),
            int(accept),
            int(discrete),
            self.sizes,
            _doubles(u),
            _doubles(ud),
            _doubles(e.states if y is None else y),
            _in_c(y_new),
            *(ctypes.c_double(v) for v in (h, wC, wK, reach)),
            _constants(tuple(e.real)),
            _ints(tuple(e.integer)),
            _in_c(input_values),
            *_road(self.road),
            *(_in_c(part) for part in (f, S, out)),
        )
        names = [o.name for o in e.outputs]
        return Result(
            f, S.reshape(n, n), y_new[: len(e.states)], dict(zip(names, out.tolist(), strict=False)), potential
        )


def tangent_by_differences(
    element: Element,
    u: Array,
    ud: Array,
    y: Array | None,
    h: float,
    wC: float,
    wK: float,
    inputs: ArrayLike,
    step: float = 1e-6,
) -> Array:
    """sym(wC C + wK K) with C = -df/dud, K = -df/du by central differences, shape (nsig, nsig)."""
    n = len(u)
    J = np.zeros((n, n))
    for j in range(n):
        e = np.zeros(n)
        e[j] = step
        up, down = element(u, ud + e, y, h, inputs=inputs), element(u, ud - e, y, h, inputs=inputs)
        J[:, j] -= wC * (up.f - down.f) / (2.0 * step)
        up, down = element(u + e, ud, y, h, inputs=inputs), element(u - e, ud, y, h, inputs=inputs)
        J[:, j] -= wK * (up.f - down.f) / (2.0 * step)
    return 0.5 * (J + J.T)


def contacts(road: Road, centre: ArrayLike, axis: ArrayLike, radius: float) -> list[dict[str, Array]]:
    """Contacts of a disc with a road."""
    out = np.zeros(24)
    disc = _doubles(centre), _doubles(axis), ctypes.c_double(radius)
    count = library().harness_contacts(*_road(road), *disc, _in_c(out))
    values = out.reshape(2, 12)[:count]
    return [
        {"penetration": v[0], "point": v[1:4], "normal": v[4:7], "down": v[7:10], "cosine": v[10], "friction": v[11]}
        for v in values
    ]


def frame(rng: np.random.Generator) -> Array:
    """Random rotation matrix, columns a, b, c."""
    Q, R = np.linalg.qr(rng.normal(size=(3, 3)))
    Q = Q * np.sign(np.diag(R))
    return Q if np.linalg.det(Q) > 0.0 else -Q


def axis_of(yaw: float, camber: float) -> Array:
    """Spin axis (left) of a wheel with heading `yaw` and camber, rad."""
    return np.array([-np.sin(yaw) * np.cos(camber), np.cos(yaw) * np.cos(camber), np.sin(camber)])


def drive_signals(left: float, right: float, omega: Array | None = None, R: Array | None = None) -> tuple[Array, Array]:
    """Signals of a drive and their rates: spins of two wheels, rad/s, and the frame, which turns with omega, rad/s."""
    R = np.eye(3) if R is None else R
    omega = np.zeros(3) if omega is None else omega
    return np.r_[0.0, 0.0, R[:, 0], R[:, 1]], np.r_[left, right, np.cross(omega, R[:, 0]), np.cross(omega, R[:, 1])]


def check_reaction(drive: Element) -> tuple[Result, float]:
    """Torques of both wheels of a drive and the reaction on its carrier; the result, and the mean relative speed."""
    rng = np.random.default_rng(17)
    R, omega = frame(rng), rng.normal(size=3)
    axis = R[:, 2]
    u, ud = drive_signals(20.0, 35.0, omega, R)
    r = drive(u, ud, inputs=[0.7])
    torque = r.out["wheel_torque"]
    assert torque > 0.0
    assert r.f[0] == r.f[1] == torque
    for turn in np.eye(3):
        virtual = np.r_[0.0, 0.0, np.cross(turn, R[:, 0]), np.cross(turn, R[:, 1])]
        assert r.f @ virtual == pytest.approx(-2.0 * torque * (axis @ turn), abs=1e-9)
    relative = 0.5 * (20.0 + 35.0) - omega @ axis
    assert r.f @ ud == pytest.approx(2.0 * torque * relative, rel=1e-12)
    return r, float(relative)

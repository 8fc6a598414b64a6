"""The kernel's own elementary functions against the platform's."""

import ctypes
import math
import random
from collections.abc import Callable

import pytest

from mbs.kernel import build

# Units in the last place; the platform's own have up to one.
ERROR = 2.5
INVERSE_ERROR = 5.0
SAMPLES = 6000
_ONE = ("sin", "cos", "exp", "tanh", "asin")
_BOTH = {"both_sin": "sin", "both_cos": "cos"}


@pytest.fixture(scope="module")
def functions(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Callable[..., float]]:
    folder = tmp_path_factory.mktemp("elementary")
    shown = '#include "algebra/elementary.c"\n#include "algebra/inverse_tangent.c"\n'
    shown += "#if defined(_WIN32)\n#define SHOW __declspec(dllexport)\n#else\n"
    shown += '#define SHOW __attribute__((visibility("default")))\n#endif\n'
    shown += "".join(f"SHOW double show_{f}(double x) {{ return ali3_{f}(x); }}\n" for f in _ONE)
    shown += "SHOW double show_atan2(double y, double x) { return ali3_atan2(y, x); }\n"
    for k, f in enumerate(_BOTH):
        shown += f"SHOW double show_{f}(double x) {{\n  double v[2];\n  ali3_sine_cosine(1, &x, v, v + 1);\n"
        shown += f"  return v[{k}];\n}}\n"
    source = folder / "shown.c"
    source.write_text(shown, encoding="utf-8")
    library = folder / build.library_name(build.host_target())
    build.compile_c([source], build.host_target(), library, include=(build.HERE / "src",), what="the test")
    loaded = ctypes.CDLL(str(library))
    results: dict[str, Callable[..., float]] = {}
    for name in (*_ONE, *_BOTH, "atan2"):
        function = getattr(loaded, f"show_{name}")
        function.restype = ctypes.c_double
        function.argtypes = [ctypes.c_double] * (2 if name == "atan2" else 1)
        results[name] = function
    return results


def distance(value: float, expected: float) -> float:
    return abs(value - expected) / math.ulp(expected)


@pytest.mark.parametrize(
    ("name", "low", "high", "error"),
    [
        ("sin", -1000.0, 1000.0, ERROR),
        ("cos", -1e6, 1e6, ERROR),
        ("both_sin", -4.0, 4.0, ERROR),
        ("both_cos", -1e4, 1e4, ERROR),
        ("exp", -700.0, 700.0, ERROR),
        ("exp", -1.0, 1.0, ERROR),
        ("tanh", -25.0, 25.0, INVERSE_ERROR),
        ("tanh", -0.5, 0.5, INVERSE_ERROR),
        ("asin", -1.0, 1.0, INVERSE_ERROR),
    ],
)
def test_of_one_argument(functions, name, low, high, error):
    rng = random.Random(7)
    worst = 0.0
    for _ in range(SAMPLES):
        x = rng.uniform(low, high)
        worst = max(worst, distance(functions[name](x), getattr(math, _BOTH.get(name, name))(x)))
    assert worst <= error


@pytest.mark.parametrize("name", ["sin", "cos"])
def test_nearly_all_sines_are_the_nearest_numbers(functions, name):
    """The rest of the reduced argument counts, though it is below the last place of it."""
    rng = random.Random(9)
    places = [rng.uniform(-1000.0, 1000.0) for _ in range(SAMPLES)]
    assert sum(distance(functions[name](x), getattr(math, name)(x)) for x in places) < 0.06 * SAMPLES


def test_atan2_in_all_quadrants(functions):
    rng = random.Random(8)
    worst = 0.0
    for _ in range(SAMPLES):
        y, x = (rng.choice([-1.0, 1.0]) * 10.0 ** rng.uniform(-12.0, 12.0) for _ in range(2))
        worst = max(worst, distance(functions["atan2"](y, x), math.atan2(y, x)))
    assert worst <= INVERSE_ERROR


def test_exact_values_and_signs(functions):
    for y, x in ((0.0, 1.0), (-0.0, 1.0), (0.0, -1.0), (-0.0, -1.0), (1.0, 0.0), (-1.0, -0.0), (0.0, 0.0), (1.0, 1.0)):
        value = functions["atan2"](y, x)
        assert value == math.atan2(y, x)
        assert math.copysign(1.0, value) == math.copysign(1.0, math.atan2(y, x))
    assert [functions[f](0.0) for f in ("sin", "cos", "exp", "tanh", "asin")] == [0.0, 1.0, 1.0, 0.0, 0.0]
    assert functions["asin"](1.0) == math.pi / 2.0
    assert math.isnan(functions["sin"](math.nan))
    assert math.isnan(functions["cos"](math.inf))
    assert functions["exp"](1000.0) == math.inf
    assert functions["exp"](-1000.0) == 0.0

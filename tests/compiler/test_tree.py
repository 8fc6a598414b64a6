"""The spanning tree of a model, and what the loader refuses of it."""

import inspect
import sys
from itertools import pairwise

import numpy as np
import pytest

from mbs import Model, compile
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.scenes import bricard, double_four_bar, pendulum, spatial_chain, spatial_slider_crank, spinning_beam
from mbs.settings.settings import METHODS
from mbs.system.system import System
from tests.altered_system import altered, put
from tests.methods.trees import branching

SEED = 5
SAME = 1e-10  # m, of coordinates from frames at a start closed to 1e-12


def signals(system, q):
    a = system.arrays
    return np.array(
        [
            a["sig_const"][i] + a["sig_val"][k] @ q[a["sig_col"][k]]
            for i, k in enumerate(map(slice, a["sig_ptr"][:-1], a["sig_ptr"][1:]))
        ]
    )


@pytest.mark.parametrize(
    "build",
    [spatial_chain.build, bricard.build, double_four_bar.build, lambda: branching(True)],
    ids=["chain", "Bricard", "four-bar", "branching"],
)
def test_frames_from_coordinates_are_right_handed_and_give_the_coordinates_back(build):
    system = compile(build())
    a = system.arrays
    frames = signals(system, a["q0"])[a["tree_frame"]].reshape(-1, 4, 3)
    for _, *axes in frames:
        np.testing.assert_allclose(np.array(axes) @ np.array(axes).T, np.eye(3), atol=SAME)
        assert np.linalg.det(axes) > 0.0
    q = np.full(system.nq, np.nan)
    for body, (o, *local), columns in zip(
        a["tree_out_body"], a["tree_out_local"].reshape(-1, 4), a["tree_out_col"].reshape(-1, 3), strict=True
    ):
        origin, *axes = frames[body - 1]
        v = o * origin + np.array(local) @ np.array(axes)
        q[columns[columns >= 0]] = v[columns >= 0]
    np.testing.assert_allclose(q, a["q0"], atol=SAME)


def test_a_loop_is_cut_where_paths_stay_short():
    a = compile(bricard.build()).arrays
    assert list(a["tree_parent"]) == [0, 1, 2, 0, 4]  # two branches, the longest first
    assert list(a["tree_cut_body"]) == [3, 5]
    assert list(a["tree_cut_rows"]) == [3, 2]
    planar = compile(double_four_bar.build()).arrays
    assert list(planar["tree_cut_rows"]) == [2, 0, 2, 0]


def test_a_prismatic_joint_is_never_the_one_that_is_cut():
    m = Model("crank", dimension=2)
    crank = m.body("crank", mass=1.0, com=(0.1, 0.0), inertia=0.01)
    rod = m.body("rod", mass=1.0, com=(0.4, 0.0), inertia=0.02)
    slider = m.body("slider", mass=1.0, com=(0.6, 0.0), inertia=0.01)
    m.revolute("pivot", m.ground, crank, point=(0.0, 0.0))
    m.revolute("pin", crank, rod, point=(0.2, 0.0))
    m.revolute("wrist", rod, slider, point=(0.6, 0.0))
    m.prismatic("rail", slider, m.ground, axis=(1.0, 0.0))
    system = compile(m)
    assert system.report["no_tree"] == ""
    assert sorted(system.arrays["tree_slides"]) == [0, 0, 1]
    assert len(system.arrays["tree_cut_body"]) == 2


def test_welded_bodies_are_one_with_the_mass_of_both():
    a = compile(branching(False)).arrays
    assert len(a["tree_parent"]) == 4
    np.testing.assert_allclose(sorted(a["tree_mass"]), [0.4, 0.7, 0.9 + 0.3, 2.0])


def floating():
    m = Model("floating", dimension=3)
    first = m.body("first", mass=1.0, com=(0.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))
    second = m.body("second", mass=1.0, com=(1.0, 0.0, 0.0), inertia=(1.0, 1.0, 1.0))
    m.revolute("knee", first, second, point=(0.5, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    return m


def long_chain():
    """Longer than Python's stack is deep in the test."""
    m = Model("long", dimension=2)
    links = [m.ground, *(m.body(f"link {k}", mass=1.0, com=(k + 0.5, 0.0), inertia=0.1) for k in range(350))]
    for k, (one, other) in enumerate(pairwise(links)):
        m.revolute(f"pin {k}", one, other, point=(float(k), 0.0))
    return m


@pytest.mark.parametrize(
    ("build", "reason"),
    [
        (pendulum.build, "body 'bob' is a point mass"),
        (lambda: spinning_beam.build(), "flexible"),
        (spatial_slider_crank.build, "joint 'C' is neither revolute, prismatic, spherical nor a weld"),
        (floating, "no revolute or prismatic joints lead from the ground to body 'first'"),
        (long_chain, "there are 350 joints and 0 rows of loops; at most 64 and 64 are possible"),
    ],
    ids=["point", "flexible", "distance", "floating", "long"],
)
def test_a_model_without_a_tree_reports_why_and_has_empty_arrays(build, reason):
    model, limit = build(), sys.getrecursionlimit()
    sys.setrecursionlimit(len(inspect.stack(0)) + 300)
    try:
        system = compile(model)
    finally:
        sys.setrecursionlimit(limit)
    assert reason in system.report["no_tree"]
    assert all(len(values) == 0 for name, values in system.arrays.items() if name.startswith("tree_"))


BAD = [
    ("tree_parent", put(2, 3), "'tree_parent' is 3, outside 0..2"),
    ("tree_parent", put(0, -1), "'tree_parent'"),
    ("tree_parent", lambda v: np.arange(65), "'tree_slides' has 5 items instead of 65"),
    ("tree_slides", put(0, 2), "'tree_slides'"),
    ("tree_base", lambda v: v[:-1], "'tree_base'"),
    ("tree_base", put(3, np.inf), "is not a finite number"),
    ("tree_mass", lambda v: v[:-1], "'tree_mass'"),
    ("tree_frame", put(0, 10**6), "'tree_frame'"),
    ("tree_out_body", put(0, 0), "'tree_out_body'"),
    ("tree_out_body", put(0, 6), "'tree_out_body'"),
    ("tree_out_col", put(0, 24), "'tree_out_col'"),
    ("tree_out_col", put(0, -1), "name 23 coordinates of 24"),
    ("tree_cut_body", put(0, 6), "'tree_cut_body'"),
    ("tree_cut_rows", put(0, 4), "'tree_cut_rows'"),
    ("tree_cut_rows", put(1, 3), "'tree_cut_rows'"),
]


@pytest.fixture(scope="module")
def loop() -> System:
    return compile(bricard.build())


def test_a_bad_tree_is_refused(loop):
    for name, change, text in BAD:
        with pytest.raises(KernelError) as refusal:
            LoadedSystem(altered(loop, **{name: change}))
        assert text in str(refusal.value)


def test_half_a_tree_is_refused(loop):
    empty = {n: lambda v: v[:0] for n in loop.arrays if n.startswith("tree_") and "cut" not in n}
    with pytest.raises(KernelError, match="'tree_cut_body' has 2 items instead of 0"):
        LoadedSystem(altered(loop, **empty))


def test_altered_numbers_never_crash(loop):
    """Every integer of the tree and some of its reals changed at random: refused, or harmless."""
    rng = np.random.default_rng(SEED)
    accepted = 0
    for name in (n for n in loop.arrays if n.startswith("tree_")):
        for index in range(0, len(loop.arrays[name]), 3):
            integer = loop.arrays[name].dtype == np.int32
            value = int(rng.integers(-2, 8)) if integer else float(rng.choice([0.0, -1.0, 1e150, -1e-150]))
            try:
                instance = Instance(LoadedSystem(altered(loop, **{name: put(index, value)})))
                instance.set_settings(**METHODS["semi_recursive"])
                instance.initialise()
                instance.run(0.01, 2)
                assert np.isfinite(instance.get_state()[0][:]).all()
                accepted += 1
            except KernelError:
                continue
    assert accepted > 3

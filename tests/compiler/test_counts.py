"""compile() finds the coordinates and rows a textbook would choose, stays sparse, and grows linearly."""

import sys

import numpy as np
import pytest

from mbs import Model, compile, vehicle
from mbs.compiler import mobility
from mbs.scenes import bricard, double_four_bar, pendulum


def counts(system):
    r = system.report
    return r["coordinates"], r["rows"], r["rank"], r["degrees_of_freedom"]


def test_pendulum():
    assert counts(compile(pendulum.build())) == (2, 1, 1, 1)


@pytest.mark.parametrize("windows", [1, 5])
def test_four_bar_has_two_coordinates_a_crank_and_one_row_a_link(windows):
    system = compile(double_four_bar.build(windows))
    assert counts(system) == (2 * (windows + 1), 2 * windows + 1, 2 * windows + 1, 1)
    # every rigid link is one row in at most four coordinates
    assert np.max(np.diff(system.arrays["row_ptr"])) <= 4


def test_bricard_is_redundant_everywhere():
    assert counts(compile(bricard.build())) == (24, 24, 23, 1)


def test_a_free_hanging_chain_is_textbook_too():
    """n links, n joints: n freedoms; the mass matrix must not fill (a chain eliminated link by link makes it dense)."""
    m, links = Model("chain", dimension=2), 9
    last = m.ground
    for k in range(links):
        link = m.body(f"link {k}", mass=1.0, com=(k + 0.5, 0.0), inertia=0.1)
        m.revolute(f"joint {k}", last, link, point=(float(k), 0.0))
        last = link
    system = compile(m)
    assert counts(system) == (2 * links, links, links, links)
    assert len(system.arrays["mass_val"]) <= 14 * links


def test_size_grows_linearly():
    small, large = (compile(double_four_bar.build(n)) for n in (40, 80))
    assert counts(large) == (162, 161, 161, 1)
    for name, values in large.arrays.items():
        before = len(small.arrays[name])
        assert len(values) <= 2.1 * before + 20, name
    assert large.report["factor_nonzeros"] <= 2.1 * small.report["factor_nonzeros"]
    assert large.report["largest_front"] <= 16


def test_redundant_joints_and_a_second_equal_joint_change_nothing():
    m = double_four_bar.build(1)
    before = counts(compile(m))
    m.revolute("A0 again", m.ground, m.bodies[0], point=(0.0, 0.0))
    system = compile(m)
    assert counts(system) == before
    assert system.report["redundant_equations"] == 2


def calls(model):
    """How many Python functions compile calls, also those of comprehensions."""
    count = 0

    def profile(frame, event, argument):
        nonlocal count
        count += event in ("call", "c_call")

    sys.setprofile(profile)
    try:
        compile(model)
    finally:
        sys.setprofile(None)
    return count


@pytest.mark.slow
def test_calls_grow_linearly():
    compile(double_four_bar.build(2))  # what is imported late
    small, middle, large = (calls(double_four_bar.build(n)) for n in (50, 100, 200))
    assert large - middle <= 2.1 * (middle - small)


def test_a_wishbone_on_two_ball_joints_is_no_reason_to_search_its_loop(monkeypatch):
    searched = []
    trace_motion = mobility.trace_motion
    monkeypatch.setattr(
        "mbs.compiler.overconstrained.trace_motion", lambda *given: searched.append(given) or trace_motion(*given)
    )
    compile(vehicle.load("prototype").model())
    assert searched == []


def test_reads_of_a_coordinate_do_not_grow_with_their_number(monkeypatch):
    """Of a drawing that reads all coordinates for each body the number of times grows with the bodies."""
    reads = []
    drawn = Model.drawn
    monkeypatch.setattr(Model, "drawn", lambda model: reads.append(model) or drawn(model))
    for windows in (5, 20):
        compile(double_four_bar.build(windows))
    assert len(set(reads)) == 2
    assert reads.count(reads[0]) == reads.count(reads[-1])

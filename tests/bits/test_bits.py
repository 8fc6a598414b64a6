"""The baseline of numbers: that it is held, and that its comparison sees what it must."""

import math

import numpy as np
import pytest

from tests.bits import store
from tests.bits.command import main, make_all
from tests.bits.groups import GROUPS, group_of
from tests.quick import quick

SIGNAL = np.sin(np.arange(300) / 20.0)


@pytest.fixture(scope="module")
def baseline():
    return store.read()[0]


@pytest.mark.parametrize("group", quick(("few mechanisms",), ("few mechanisms", "mechanisms")))
def test_runs_of_mechanisms_are_as_stored(baseline, group):
    """More than half of the entries, which take seconds; the others take minutes."""
    actual, failed = make_all([group], 1)
    assert failed == {}
    stored = {name: entry for name, entry in baseline.items() if group_of(name) == group}
    assert store.compare(stored, actual) == []


@pytest.mark.proof
def test_everything_is_as_stored(capsys):
    assert main(["--jobs", "2"]) == 0, capsys.readouterr().out


def test_each_stored_entry_belongs_to_a_group_and_each_group_has_entries(baseline):
    assert {group_of(name) for name in baseline} == set(GROUPS)


def test_a_difference_is_seen_and_its_size_is_about_right():
    stored, one = {"a": store.entry_of({"s": SIGNAL})}, np.arange(300) == 40
    for changed, distance in (
        (-SIGNAL, 2.0 * np.sqrt(np.mean(SIGNAL**2))),
        (SIGNAL + 1e-9, 1e-9),
        (np.where(one, 0.5, SIGNAL), abs(SIGNAL[40] - 0.5) / math.sqrt(300)),
        (np.where(one, np.nan, SIGNAL), abs(SIGNAL[40]) / math.sqrt(300)),
    ):
        (row,) = store.compare(stored, {"a": store.entry_of({"s": changed})})
        assert (row.entry, row.signal, row.kind) == ("a", "s", "differs")
        assert 0.05 * distance < row.distance < 20.0 * distance
        assert row.relative == pytest.approx(row.distance / np.ptp(SIGNAL), rel=1e-3)


def test_rounding_is_let_pass_only_where_bits_are_not_compared():
    for exact, off, seen in ((True, 1e-13, 1), (False, 1e-13, 0), (False, 1e-7, 1)):
        stored = {"a": store.entry_of({"s": SIGNAL}, exact)}
        assert len(store.compare(stored, {"a": store.entry_of({"s": SIGNAL * (1.0 + off)}, exact)})) == seen
    stored = {"a": store.entry_of({"s": [0.0, 0.0]}, False)}
    assert store.compare(stored, {"a": store.entry_of({"s": [0.0, 0.0, 0.0]}, False)})

"""Settings are checked when they are made, and their defaults are the kernel's."""

from __future__ import annotations

import dataclasses

import pytest

from mbs.kernel.binding import Instance, LoadedSystem
from mbs.settings import Settings


@pytest.mark.parametrize(
    ("field", "value", "sentence"),
    [
        ("alpha", -1.0, "'alpha' is -1.0; it must be positive, or 0"),
        ("alpha", float("nan"), "'alpha' is nan; it must be a finite number"),
        ("eps_rel", 0.0, "'eps_rel' is 0.0; it must be positive"),
        ("tolerance_r", float("inf"), "'tolerance_r' is inf; it must be a finite number"),
        ("tolerance_phi", -1e-9, "'tolerance_phi' is -1e-09; it must be positive"),
        ("max_iterations", 0, "'max_iterations' is 0; it must be a whole number of at least 1"),
        ("max_iterations", 2.5, "'max_iterations' is 2.5; it must be a whole number of at least 1"),
        ("max_halvings", -1, "'max_halvings' is -1; it must be a whole number of at least 0"),
        ("update", "newton", "'update' is 'newton'; it must be one of 'linearised', 'paper'"),
    ],
)
def test_a_wrong_value_is_refused_by_name(field, value, sentence):
    with pytest.raises(ValueError, match=sentence):
        Settings(**{field: value})


def test_settings_do_not_change():
    with pytest.raises(dataclasses.FrozenInstanceError):
        Settings().alpha = 1.0

"""The tests of the catalogue by name."""

import importlib
import importlib.util
from functools import cache

from ali3.near_names import did_you_mean
from hosts.catalogue.definition import make_standard_test
from hosts.catalogue.record import StandardTest
from hosts.common.errors import HostError

_ALL = (
    "steady_circle",
    "step_steer",
    "sine_steer",
    "chirp_steer",
    "sine_with_dwell",
    "double_lane_change",
    "straight_braking",
    "split_braking",
    "braking_in_a_turn",
    "power_off_in_a_turn",
    "kerb",
    "drop",
)
_FOLDER = "hosts.catalogue.standard"

TESTS: tuple[str, ...] = tuple(name for name in _ALL if importlib.util.find_spec(f"{_FOLDER}.{name}") is not None)
"""In the order in which they are done."""


@cache
def standard_test(name: str) -> StandardTest:
    """A test by its name. Raises `HostError` with the known names if there is no such test."""
    if name not in TESTS:
        hint = did_you_mean(name, TESTS, f"they are: {', '.join(TESTS)}")
        raise HostError(f"There is no test '{name}' in the catalogue{hint}")
    return make_standard_test(name, importlib.import_module(f"{_FOLDER}.{name}").drive)

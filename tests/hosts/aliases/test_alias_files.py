"""Alias files: conversion of names and values in both directions, and refusals."""

import numpy as np
import pytest

from hosts.common.errors import HostError
from hosts.fmu.aliases.file import read_aliases

NAMES = ("StrAng", "Acc_ped", "X", "Psi", "brake")
GOOD = """
steering = { name = "StrAng", factor = -540.0, offset = 2.0 }   # degrees, positive to the right
throttle = { name = "Acc_ped", factor = 100.0 }
"chassis.x" = "X"
"chassis.yaw" = { name = "Psi", factor = 57.29577951308232 }
[constants]
"vehicle.wheelbase" = 2.6
"""


@pytest.fixture
def file(tmp_path):
    def write(text):
        path = tmp_path / "names.toml"
        path.write_text(text, encoding="utf-8")
        return path

    return write


def test_names_and_numbers_go_there_and_come_back(file):
    aliases = read_aliases(file(GOOD), NAMES)
    assert aliases.names(NAMES) == ("steering", "throttle", "chassis.x", "chassis.yaw", "brake")
    assert aliases.constants == {"vehicle.wheelbase": 2.6}
    their_inputs = aliases.inputs({"steering": (0.5, 1.6), "throttle": (0.25, 2.5), "brake": (1.0, 4.0)})
    assert their_inputs == {"StrAng": (-268.0, 864.0), "Acc_ped": (25.0, 250.0), "brake": (1.0, 4.0)}
    factors, offsets = aliases.scales(NAMES)
    theirs = np.array([-268.0, 25.0, 7.0, 90.0, 1.0])
    assert (theirs - offsets) / factors == pytest.approx([0.5, 0.25, 7.0, np.pi / 2, 1.0], abs=1e-15)


def test_start_values_keep_their_kind(file):
    aliases = read_aliases(file('"initial.x" = { name = "X", factor = 1000.0 }\n"road.file" = "Psi"'), NAMES)
    assert aliases.fmu_values({"initial.x": 2, "road.file": "my.road", "brake": 1}) == {
        "X": 2000.0,
        "Psi": "my.road",
        "brake": 1,
    }


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('steering = "StrAngle"', "'steering': the FMU has no variable 'StrAngle'; did you mean 'StrAng'?"),
        ("steering = 3", "'steering' must be a name of the FMU"),
        ('chassis.x = "X"', "a name with a dot needs quotation marks"),
        ('steering = { name = "X", factor = 0 }', "factor is 0"),
        ('steering = { name = "X", factor = nan }', "steering.factor is nan; it must be a finite number"),
        ('steering = { name = "X", factor = true }', "factor is True"),
        ('steering = { name = "X", gain = 2 }', "has 'gain'; known are name, factor, offset"),
        ('steering = "X"\nthrottle = "X"', "'X' is named steering and throttle"),
        ('brake = "X"', "the FMU has a variable 'brake' itself"),
        ('[constants]\n"vehicle.wheelbase" = "long"', "constants.vehicle.wheelbase is 'long'"),
        ("constants = 3", "[constants] must be a table"),
    ],
)
def test_each_error_is_one_sentence(file, text, message):
    with pytest.raises(HostError) as refusal:
        read_aliases(file(text), NAMES)
    assert message in str(refusal.value)
    assert "\n" not in str(refusal.value)

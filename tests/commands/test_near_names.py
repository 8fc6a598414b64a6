"""Suggestions for an unknown name."""

import pytest

from ali3.near_names import near_names

KNOWN = ("spring.stiffness", "spring.damping", "Chassis.ay", "chassis.AY", "bob.x")


@pytest.mark.parametrize(
    ("name", "near"),
    [
        ("CHASSIS.AY", ["Chassis.ay", "chassis.AY"]),
        ("spring.stifness", ["spring.stiffness"]),
        ("Spring.Stifness", ["spring.stiffness"]),
        ("gearbox.ratios.damping", ["spring.damping"]),
        ("bob", ["bob.x"]),
        ("b", []),
        ("wheel", []),
        ("", []),
        ("spring.damping" + 100_000 * "g", []),
    ],
)
def test_near_names(name: str, near: list[str]) -> None:
    assert near_names(name, KNOWN) == near


def test_no_more_than_asked_and_the_nearest_first() -> None:
    assert near_names("wheel_F", ["wheel_FLx", "wheel_FL", "wheel_FR"], 2) == ["wheel_FR", "wheel_FL"]


def test_words_of_a_name_in_another_order_are_another_name() -> None:
    assert near_names("torque_map", ["max_torque", "max_power"]) == []
    assert near_names("max_torqe", ["max_torque", "max_power"], 1) == ["max_torque"]

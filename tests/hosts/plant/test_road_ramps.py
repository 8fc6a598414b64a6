"""Answers on the road for the end of a step: within the step the FMU goes there from the last ones (decision 91)."""

import pytest

from tests.vehicle.road_leads import loads_of_fmu
from tests.vehicle.test_road_port import Waves


@pytest.mark.slow
def test_loads_are_those_of_the_closed_car_to_a_quarter_of_a_per_cent_at_40_m_s() -> None:
    """They were 1.5 % off where each answer held over its step."""
    load, messages = loads_of_fmu(Waves("hatchback", 2.0, 0.015), 40.0)
    assert load < 2.5e-3
    assert not messages


@pytest.mark.slow
def test_answers_for_the_wheel_hold_over_their_step_and_are_reported() -> None:
    """They come from no place ahead: from the last one to them would be late by a step, 5.4 % off."""
    load, messages = loads_of_fmu(Waves("hatchback", 2.0, 0.015), 40.0, lead=0.0)
    assert 0.03 < load < 0.045
    assert all("holds for 0.0 steps ahead of its wheel" in text for text in messages)
    assert len(messages) == 4

"""Constants of the steering where a parameter changes its ratio."""

from pathlib import Path

import pytest

from hosts.fmu.fmu import described
from hosts.fmu.settings import Settings
from hosts.fmu.variables import Variables


def test_a_ratio_that_is_set_is_reported_beside_the_constants_of_the_file(prototype_fmu: Path) -> None:
    """Half the travel per turn: twice the angle to full lock and the ratio; without it nothing is told."""
    table = Variables(described(prototype_fmu))
    settings = Settings(table)
    assert not settings.rows()
    drawn = table["steering.rack_per_turn"].start
    assert isinstance(drawn, float)
    settings.add_numbers({"steering.rack_per_turn": 0.5 * drawn}, "--set")
    rows = dict(settings.rows())
    for name in ("vehicle.steering_wheel_angle_max", "vehicle.steering_ratio"):
        constant = table[name].start
        assert isinstance(constant, float)
        assert rows[name].startswith(f"constant {constant:.6g} of the FMU")
        assert float(rows[name].split()[-1]) == pytest.approx(2.0 * constant, rel=1e-5)
        assert "ratio of the car file" in table[name].description

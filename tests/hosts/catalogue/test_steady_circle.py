"""The steady circle with a linear bicycle model, against its closed form."""

import math
from typing import Any

import pytest

from hosts.catalogue.execution import perform
from hosts.catalogue.registry import standard_test
from hosts.catalogue.standard_test import TestRecord
from hosts.common.errors import HostError
from tests.hosts.catalogue.bicycle_car import BicycleCar

RISE = 0.5
QUASI_STATIC = 8e-5 * RISE  # rad s2/m: what the rise of the speed adds to the gradient; it goes to zero with it


def drive(car: Any, **settings: float) -> tuple[dict[str, float], TestRecord]:
    record = perform(standard_test("steady_circle"), car, {"speed_rise": RISE, **settings})
    return {m.name: m.value for m in record.measures}, record


@pytest.fixture(scope="module")
def understeering() -> tuple[dict[str, float], TestRecord]:
    return drive(BicycleCar())


def test_gradients_are_those_of_the_linear_model(understeering: tuple[dict[str, float], TestRecord]) -> None:
    car, (m, record) = BicycleCar(), understeering
    k = car.understeer()
    assert m["understeer_gradient"] == pytest.approx(k, rel=0.02)
    assert m["steering_gradient"] == pytest.approx(car.ratio * k, rel=0.02)
    assert m["steering_ratio"] == pytest.approx(car.ratio, rel=1e-6)
    rear_slip = car.front * car.mass / car.wheelbase / car.rear_stiffness
    assert m["sideslip_gradient"] == pytest.approx(-rear_slip, rel=0.02)
    assert m["roll_gradient"] == pytest.approx(car.roll, rel=2e-3)
    assert m["characteristic_speed"] == pytest.approx(math.sqrt(car.wheelbase / k), rel=0.01)
    assert math.isnan(m["critical_speed"])
    assert math.isnan(m["steering_torque_gradient"])
    # There is no critical speed of such a car; the torque is not told.
    assert [x.name for x in record.measures if x.is_missing] == ["steering_torque_gradient"]
    assert m["understeer_gradient.difference"] == pytest.approx(0.0, abs=1e-3 * k)
    assert set(record.runs) == {"left", "right"}
    assert "Steering on the circle" in [plot.title for plot in record.plots]


@pytest.mark.slow
@pytest.mark.parametrize("method", [2, 3])
def test_all_methods_measure_the_same_gradient(method: int) -> None:
    m, _ = drive(BicycleCar(), method=method)
    assert m["understeer_gradient"] == pytest.approx(BicycleCar().understeer(), rel=0.03)


@pytest.mark.slow
def test_a_car_that_oversteers_has_a_critical_speed() -> None:
    car = BicycleCar(front=1.3, rear=1.2)
    m, record = drive(car)
    k = m["understeer_gradient"]
    assert k < 0.0
    assert [x.name for x in record.measures if x.is_missing] == ["steering_torque_gradient"]
    assert k == pytest.approx(car.understeer(), abs=QUASI_STATIC)
    assert m["critical_speed"] == pytest.approx(math.sqrt(-car.wheelbase / k))
    assert math.isnan(m["characteristic_speed"])


def test_a_difference_of_the_sides_is_seen_on_its_side() -> None:
    car = BicycleCar(excess=0.2)
    m, _ = drive(car)
    assert m["understeer_gradient.left"] == pytest.approx(car.understeer(), abs=QUASI_STATIC)
    assert m["understeer_gradient.right"] == pytest.approx(car.understeer(0.2), abs=QUASI_STATIC)
    assert m["understeer_gradient.difference"] > 0.2 * car.understeer()


def test_a_car_that_is_too_weak_has_no_gradient_but_a_reason() -> None:
    m, record = drive(BicycleCar(push=0.2))
    assert math.isnan(m["understeer_gradient"])
    note = next(x.note for x in record.measures if x.name == "understeer_gradient")
    assert "of the 4 m/s² of the regression" in note
    assert all("the drive ended the run" in message for message in record.notes)
    assert 0.5 < m["lateral_acceleration_max.left"] < 4.0


@pytest.mark.parametrize(
    ("settings", "message"),
    [({"method": 2.5}, "it must be 1, 2 or 3"), ({"fit_from": 3.0, "fit_to": 3.2}, "at least 0.5 m/s² above")],
)
def test_wrong_settings_are_reported(settings: dict[str, float], message: str) -> None:
    with pytest.raises(HostError, match=message):
        perform(standard_test("steady_circle"), BicycleCar(), settings)

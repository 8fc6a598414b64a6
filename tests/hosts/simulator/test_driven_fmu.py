"""An FMU that is rewound, restarted and set upright has the bits of one that never was."""

import math
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from hosts.common.errors import HostError
from hosts.fmu.fmu import StepRefusedError
from hosts.simulator.driven_fmu import DrivenFmu
from tests.hosts.changed_fmu import DESCRIPTION, changed_fmu

H = 0.002
AT_ONCE = math.inf


@pytest.fixture
def sledge(fmu: Callable[[str], Path]) -> Iterator[DrivenFmu]:
    car = DrivenFmu(fmu("sledge"), {"initial.speed": 10.0}, H)
    yield car
    car.close()


class Hands:
    """Wants that depend on the step only, so that they can be repeated."""

    def __init__(self, car: DrivenFmu) -> None:
        self.car, self.request = car, 0

    def drive(self, first: int, last: int) -> list[np.ndarray]:
        """Steps `first` to `last`; values after each."""
        rows = []
        for k in range(first, last + 1):
            if k % 40 == 0:
                self.want(k)
            self.car.advance()
            rows.append(self.car.values.copy())
        return rows

    def want(self, k: int) -> None:
        random = np.random.default_rng(k)
        table = np.zeros((len(self.car.inputs.values), 3))
        table[:, 0], table[:, 1] = random.uniform(0, 1, len(table)), random.uniform(0.5, 5.0, len(table))
        self.request += 1
        table[:, 2] = self.request
        self.car.inputs.want(table.ravel())


@pytest.mark.parametrize("back", [250, 999])
def test_back_and_on_is_as_without(fmu: Callable[[str], Path], sledge: DrivenFmu, back: int) -> None:
    rows = Hands(sledge).drive(0, 1000)
    observation = sledge.rewind(back * H)
    assert (observation.kind, observation.details["back_to"], sledge.epoch, sledge.count) == (
        "rewind",
        1001 - back,
        1,
        1001,
    )
    assert sledge.time == (1001 - back) * H
    assert np.array_equal(sledge.values, rows[1000 - back])
    # The hands are elsewhere by now: the drive goes on with what is wanted now, from the inputs held then.
    hands = Hands(sledge)
    begin = 40 * math.ceil((1001 - back) / 40)
    other = DrivenFmu(fmu("sledge"), {"initial.speed": 10.0}, H)
    again = Hands(other)
    again.drive(0, 1000 - back)
    for driven in (hands, again):
        driven.want(7)
        driven.request += 100
    first = hands.drive(begin, begin + 300)
    second = again.drive(begin, begin + 300)
    other.close()
    assert all(np.array_equal(a, b) for a, b in zip(first, second, strict=True))


def test_a_rewind_beyond_the_kept_states_is_shortened_and_reported(sledge: DrivenFmu) -> None:
    first = sledge.values.copy()
    Hands(sledge).drive(0, 99)
    observation = sledge.rewind(12.0)
    assert "went back by 0.2 s" in observation.text
    assert "12 s were asked for" in observation.text
    assert np.array_equal(sledge.values, first)
    with pytest.raises(HostError, match="nothing to go back to"):
        sledge.rewind(1.0)


def test_a_reset_is_the_start_and_can_be_taken_back(sledge: DrivenFmu) -> None:
    start, hands = sledge.values.copy(), Hands(sledge)
    rows = hands.drive(0, 299)
    observation = sledge.reset(request=hands.request)
    assert observation.details["start"] == {"initial.speed": 10.0}
    assert (sledge.time, sledge.epoch, sledge.count) == (0.0, 1, 300)
    assert np.array_equal(sledge.values, start)
    sledge.advance()  # what was wanted before does not count
    assert sledge.inputs.values.tolist() == [0.0, 0.0, 0.0]
    sledge.rewind(2 * H)
    assert sledge.time == 300 * H
    assert np.array_equal(sledge.values, rows[-1])
    sledge.rewind(100 * H)
    assert np.array_equal(sledge.values, rows[199])
    again = Hands(sledge).drive(200, 299)[39:]  # from the next want on
    assert not np.array_equal(again[-1], rows[-1])  # until then the wants of the reset held
    assert sledge.time == 300 * H


def test_setting_upright_keeps_position_and_time(sledge: DrivenFmu) -> None:
    sledge.restart({"initial.yaw": 1.0, "initial.y": -3.0}, request=0.0)
    Hands(sledge).drive(0, 700)
    places = [sledge.names.index(n) for n in ("chassis.x", "chassis.y", "chassis.yaw")]
    before, time = sledge.values[places], sledge.time
    observation = sledge.upright(request=100.0)
    assert sledge.values[places] == pytest.approx(before, abs=1e-9)
    assert sledge.values[sledge.names.index("speed")] == 0.0
    assert (sledge.time, sledge.epoch) == (time, 2)
    assert observation.details["start"]["initial.speed"] == 0.0
    hands = Hands(sledge)
    hands.request = 100
    hands.drive(0, 20)
    assert sledge.time == pytest.approx(time + 21 * H)
    sledge.rewind(23 * H)
    assert sledge.time == pytest.approx(time - H)


def test_other_start_values_stay_for_later_resets(sledge: DrivenFmu) -> None:
    sledge.restart({"initial.x": 40.0, "throttle": 0.25}, request=0.0)
    x, throttle = sledge.names.index("chassis.x"), sledge.names.index("throttle")
    assert (sledge.values[x], sledge.values[throttle]) == (40.0, 0.25)
    Hands(sledge).drive(0, 50)
    sledge.reset(request=100.0)
    assert (sledge.values[x], sledge.values[throttle]) == (40.0, 0.25)
    assert sledge.start == {"initial.speed": 10.0, "initial.x": 40.0, "throttle": 0.25}


def test_a_start_that_is_refused_changes_nothing(fmu: Callable[[str], Path]) -> None:
    car = DrivenFmu(fmu("reach"), {}, 0.01)
    for _ in range(5):
        car.advance()
    before, time = car.values.copy(), car.time
    with pytest.raises(HostError, match="no parameter or input 'nothing'"):
        car.restart({"nothing": 1.0}, request=0.0)
    assert (car.start, car.time, car.epoch) == ({}, time, 0)
    assert np.array_equal(car.values, before)
    car.advance()
    assert car.time == pytest.approx(time + 0.01)
    with pytest.raises(HostError, match=r"no chassis.x; a reset"):
        car.upright(request=0.0)
    car.close()


def test_a_refused_step_keeps_the_state_and_the_past(fmu: Callable[[str], Path]) -> None:
    car = DrivenFmu(fmu("reach"), {}, 0.2)
    free = DrivenFmu(fmu("reach"), {}, 0.2)
    for driven in (car, free):
        driven.advance()
        driven.advance()
    before = car.values.copy()
    car.inputs.want(np.array([5.0, AT_ONCE, 1.0]))
    with pytest.raises(StepRefusedError, match="step_size"):
        car.advance()
    assert (car.count, car.time, car.refused_inputs) == (2, 0.4, [5.0])
    assert car.inputs.values.tolist() == [0.0]
    assert np.array_equal(car.values, before)
    car.rewind(0.2)
    assert car.time == 0.2
    car.inputs.want(np.array([0.0, AT_ONCE, 2.0]))
    car.advance()
    assert np.array_equal(car.values, free.values)
    car.close()
    free.close()


@pytest.fixture
def forgetful(fmu: Callable[[str], Path], tmp_path: Path) -> Path:
    """The sledge without saved states."""

    def stateless(content: bytes) -> bytes:
        assert b'canGetAndSetFMUstate="true"' in content
        return content.replace(b'canGetAndSetFMUstate="true"', b"").replace(b'canSerializeFMUstate="true"', b"")

    return changed_fmu(fmu("sledge"), tmp_path / "forgetful.fmu", {DESCRIPTION: stateless})


def test_an_fmu_that_saves_no_state_can_be_reset_and_set_upright_but_not_rewound(forgetful: Path) -> None:
    car = DrivenFmu(forgetful, {"initial.speed": 10.0}, H)
    start = car.values.copy()
    rows = Hands(car).drive(0, 100)
    with pytest.raises(HostError, match=r"forgetful.fmu cannot go back: it does not save its state"):
        car.rewind(0.1)
    assert (car.saved, car.epoch) == (0.0, 0)
    assert np.array_equal(car.values, rows[-1])
    car.upright(request=100.0)
    assert car.time == 101 * H
    car.reset(request=100.0)
    assert np.array_equal(car.values, start)
    with pytest.raises(HostError, match="starts again as at first"):
        car.restart({"step_size": 1e-30}, request=100.0)
    assert np.array_equal(car.values, start)
    assert (car.time, car.epoch) == (0.0, 3)
    car.close()

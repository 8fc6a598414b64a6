"""Histograms of the steps: their quantiles are those of the steps, and they say everything that is late."""

import json

import numpy as np
import pytest

from hosts.simulator.step_times import BINS, TIMES_SIZE, StepTimes, TimesRecord, bin_of, edge

BIN_WIDTH = 10.0 ** (1.0 / 40.0)


def record(costs: np.ndarray, lateness: np.ndarray) -> np.ndarray:
    values = np.zeros(TIMES_SIZE)
    times = TimesRecord(values)
    for pair in zip(costs.tolist(), lateness.tolist(), strict=True):
        times.add_step(*pair)
    times.add("steps", len(costs))
    return values


def test_every_time_lies_below_the_edge_of_its_bin() -> None:
    for time in 10.0 ** np.random.default_rng(1).uniform(-7, 2, 2000):
        place = bin_of(float(time))
        assert time <= edge(place) * (1.0 + 1e-12)
        assert place == 0 or time >= edge(place - 1) * (1.0 - 1e-12)
    assert bin_of(1e9) == BINS - 1


def test_quantiles_are_those_of_the_steps_within_a_bin() -> None:
    random = np.random.default_rng(2)
    costs, lateness = random.lognormal(np.log(1e-4), 1.0, 20000), random.exponential(5e-5, 20000)
    times = StepTimes.of(record(costs, lateness), 0.002, True)
    for spread, true in ((times.cost, costs), (times.lateness, lateness)):
        for part in (0.5, 0.99, 0.999):
            exact = np.quantile(true, part, method="inverted_cdf")
            assert exact <= spread.quantile(part) * (1.0 + 1e-12)
            assert spread.quantile(part) <= exact * BIN_WIDTH * (1.0 + 1e-12)
        assert spread.largest == true.max()
    assert times.mean == pytest.approx(costs.mean())


def test_report_is_json_without_infinities() -> None:
    times = StepTimes.of(record(np.array([1e-4, 50.0]), np.array([0.0, 2e-3])), 0.002, True)
    report = json.loads(json.dumps(times.report(), allow_nan=False))
    assert report["cost"]["largest"] == 50.0
    assert report["cost"]["bins"][-1] == [50.0, 1]
    assert sum(count for _, count in report["lateness"]["bins"]) == 2


def test_the_text_has_both_times_and_lost_steps() -> None:
    values = record(np.full(100, 3e-3), np.full(100, 1e-3))
    times = TimesRecord(values)
    for name, amount in {"simulated": 0.2, "scheduled": 0.4, "wall": 0.5, "paused": 7.0}.items():
        times.add(name, amount)
    assert "limit of iterations" not in StepTimes.of(values, 0.002, True).text()
    assert "while the step ran" not in StepTimes.of(values, 0.002, True).text()
    for name, amount in {"missed": 25, "stolen": 20, "others": 5, "skipped": 2, "lost": 0.1, "capped": 7}.items():
        times.add(name, amount)
    times.raise_to("capped_largest", 2e-4)
    times.raise_to("capped_largest", 1e-4)
    text = StepTimes.of(values, 0.002, True).text()
    assert "100 steps of 2 ms: 0.200 s simulated in 0.500 s of wall time" in text
    assert "7.0 s paused" in text
    assert "(slow motion) this takes 0.400 s" in text
    times.add("scheduled", -0.2)
    assert "slow motion" not in StepTimes.of(values, 0.002, True).text()
    assert "missed deadlines: 25 of 125 (20 %)" in text
    assert "took without a word): 0; other programs: 5; the processor stood still, as where" in text
    assert "takes it: 20" in text
    assert StepTimes.of(values, 0.002, True).report()["missed_by"] == {"ran": 0, "others": 5, "stolen": 20}
    assert StepTimes.of(values, 0.002, True).report()["factor"] == pytest.approx(0.4)
    assert "moved on 2 times, by 0.100 s in all; 0.800 of the speed" in text
    assert "at the limit of iterations: 7; the largest residual left was 0.2 mm" in text
    assert "5 ms        100  ####" in text
    assert "deadlines" not in StepTimes.of(values, 0.002, False).text()


def test_before_the_first_step() -> None:
    times = StepTimes.of(np.zeros(TIMES_SIZE), 0.002, True)
    assert times.text().startswith("No step")
    json.dumps(times.report(), allow_nan=False)

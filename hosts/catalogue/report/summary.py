"""The catalogue on one slide: main measures of the cars, and a plot of each of three tests."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from matplotlib.axes import Axes

from hosts.catalogue.record import StandardTest, TestRecord
from hosts.catalogue.report.numbers import NONE, with_unit
from hosts.catalogue.report.pictures import draw_plot
from hosts.run.slide import write_slide

_MAIN = {
    "steady_circle": ("understeer_gradient", "roll_gradient", "lateral_acceleration_max.left"),
    "step_steer": ("level_2.yaw_rate.response_time", "level_2.yaw_rate.overshoot"),
    "chirp_steer": ("yaw_rate.phase_bandwidth", "mode.damping_ratio"),
    "sine_with_dwell": ("yaw_rate_ratio_1_00", "displacement"),
    "double_lane_change": ("iso_3888_1.speed", "iso_3888_2.speed"),
    "straight_braking": ("stopping_distance.corrected", "deceleration.mean_fully_developed"),
    "braking_in_a_turn": ("yaw_rate.ratio", "path.deviation"),
    "drop": ("load.peak_ratio", "settling_time"),
}
"""What people ask for first; of other tests the first two measures."""


def write_summary(
    stem: Path,
    title: str,
    tests: Sequence[StandardTest],
    labels: Sequence[str],
    records: Mapping[str, Mapping[str, TestRecord | str]],
) -> list[Path]:
    """Write the slide. `records`: by name of the test and label of the car."""
    rows: list[list[str]] = []
    draws: list[Callable[[Axes], object]] = []
    broken = judged = 0
    for test in tests:
        done = {n: r for n, r in records.get(test.name, {}).items() if isinstance(r, TestRecord)}
        broken += sum(m.is_kept is False for r in done.values() for m in r.measures)
        judged += sum(m.is_kept is not None for r in done.values() for m in r.measures)
        known = {n: {m.name: m.displayed() for m in r.measures} for n, r in done.items()}
        names = list(dict.fromkeys(name for found in known.values() for name in found))
        main = [name for name in _MAIN.get(test.name, ()) if name in names] or names[:2]
        for name in main:
            cells = [known[n][name] if name in known.get(n, {}) else None for n in labels]
            words = name.replace("_", " ").replace(".", ", ")
            rows.append([f"{test.title}: {words}", *(NONE if m is None else with_unit(m.value, m.unit) for m in cells)])
        titles = [plot.title for r in done.values() for plot in r.plots]
        if titles:
            draws.append(_draw(next((t for t in titles if t.startswith("Yaw rate")), titles[0]), done))
    done_count = sum(isinstance(r, TestRecord) for found in records.values() for r in found.values())
    plural = "measure does not keep its limit" if broken == 1 else "measures do not keep their limits"
    limits = f"; {broken} {plural}" if broken else "; no limit is broken" if judged else ""
    subtitle = f"{done_count} of {len(tests) * len(labels)} tests done{limits}"
    return write_slide(stem, title, subtitle, ["", *labels], rows, draws)


def _draw(title: str, done: Mapping[str, TestRecord]) -> Callable[[Axes], object]:
    return lambda axes: draw_plot(axes, title, {label: record.plots for label, record in done.items()})

"""Speed and moments of the kerb test that is driven by accelerations, beside the smooth one."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.car.fidelity_runs import MOMENTS
from benchmarks.paper import measured_guides as guides
from benchmarks.shared.command import pyplot, save_chart
from mbs import compile, simulate
from mbs.scenes import kerb_test

_SMOOTH, _MEASURED, _SIGNAL = "#0b62c4", "#d55e00", "#b0b0b0"


def draw(file: Path) -> None:
    """One seed with all of its noise; moments after the low-pass."""
    plt = pyplot()
    true, plain = guides.smooth(), simulate(compile(kerb_test.build()), kerb_test.DURATION, kerb_test.STEP)
    signals = guides.measured(true)
    found = guides.motion(signals, float(true["chassis.x"][-1] - true["chassis.x"][0]))
    run = guides.driven(found)
    shown = [k for k, name in enumerate(MOMENTS) if name.endswith(("SG1", "SG3"))]
    figure, parts = plt.subplots(2 + len(shown), 1, figsize=(9.0, 8.4), sharex=True, layout="constrained")
    parts[0].plot(signals.time, signals.force[:, 0, 0], color=_SIGNAL, linewidth=0.6, label="accelerometer FL, along")
    parts[0].plot(signals.time, np.gradient(kerb_test.speed(signals.time), signals.time), color=_SMOOTH, label="smooth")
    parts[0].set_ylabel("m/s²")
    parts[1].plot(found.time, kerb_test.speed(found.time), color=_SMOOTH, label="smooth guide")
    parts[1].plot(found.time, found.speed, color=_MEASURED, linewidth=1.0, label="from accelerations")
    parts[1].set_ylabel("speed, m/s")
    wanted, got = guides.moments(plain), guides.moments(run)
    for axes, k in zip(parts[2:], shown, strict=True):
        axes.plot(plain.t[: len(wanted)], wanted[:, k], color=_SMOOTH, label="smooth guide")
        axes.plot(run.t[: len(got)], got[:, k], color=_MEASURED, linewidth=1.0, label="from accelerations")
        axes.set_ylabel(f"change at {MOMENTS[k].split('.')[-1]}, N m")
    parts[-1].set_xlabel("time, s")
    for axes in parts:
        axes.legend(loc="upper left", frameon=False, ncols=2)
        axes.margins(x=0)
        axes.spines[["top", "right"]].set_visible(False)
    save_chart(figure, file)

"""Chart of measured and predicted yaw rate in seconds that were not fitted."""

from pathlib import Path

import numpy as np

from benchmarks.shared.command import pyplot, save_chart
from benchmarks.validation.drive import JUDGED, Array, Drive

_MEASURED = "#8a8a8a"
_CAR = "#0b62c4"
_BICYCLE = "#d55e00"


def draw(drive: Drive, time: Array, car: Array, bicycle: Array, name: str, file: Path) -> None:
    """Draw the first span of `JUDGED`; each model is simulated without restart from the first second of the drive.

    `time`, `car`: yaw rate of the multibody car, s and rad/s, shape (m,); `bicycle`: yaw rate of a bicycle at the
    samples of the drive, shape (n,).
    """
    plt = pyplot()
    begin, end = JUDGED[0]
    rows = (drive.time >= begin) & (drive.time <= end)
    t = drive.time[rows]
    measured, simulated = np.degrees(drive.yaw_rate[rows]), np.degrees(np.interp(t, time, car))
    plain = np.degrees(bicycle[rows])
    figure, (upper, lower) = plt.subplots(
        2, 1, figsize=(10.0, 5.4), sharex=True, height_ratios=(2.0, 1.0), layout="constrained"
    )
    upper.plot(t, measured, color=_MEASURED, linewidth=3.0, label="measured")
    upper.plot(t, simulated, color=_CAR, linewidth=1.2, label="multibody car")
    upper.set_ylabel("yaw rate, deg/s")
    upper.set_title(
        "Ferrari 250 LM on a race track: seconds that were not fitted, without restart since second 0",
        loc="left",
        fontsize=11,
    )
    upper.legend(ncols=2, loc="upper right", frameon=False)
    lower.plot(t, plain - measured, color=_BICYCLE, linewidth=0.9, label=f"bicycle: {name}")
    lower.plot(t, simulated - measured, color=_CAR, linewidth=0.9, label="multibody car")
    lower.axhline(0.0, color="#444444", linewidth=0.8)
    lower.set_ylabel("error, deg/s")
    lower.set_xlabel("time, s")
    lower.legend(ncols=2, loc="upper right", frameon=False)
    for axes in (upper, lower):
        axes.margins(x=0)
        axes.spines[["top", "right"]].set_visible(False)
        low, high = axes.get_ylim()
        axes.set_ylim(low, high + 0.18 * (high - low))
    save_chart(figure, file)

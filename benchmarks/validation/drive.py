"""A measured drive as equally spaced samples, and the seconds in which models are fitted and compared."""

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.signal import butter, sosfiltfilt

from hosts.common.errors import HostError
from hosts.common.units import unit_definition
from hosts.compare.log_aliases import read_log_aliases
from hosts.compare.log_file import read_log
from hosts.compare.spikes import spikes

Array = NDArray[np.float64]
Spans = tuple[tuple[float, float], ...]

LENGTH = 10.0  # length of a window, s
EVERY = 5.0  # interval between the starts of windows, s
FITTED: Spans = ((0.0, 80.0), (160.0, 240.0))  # s in which models are fitted
JUDGED: Spans = ((80.0, 160.0), (240.0, 275.0))  # s in which predictions are compared
CUT_OFF = 2.0  # Hz, of the acceleration for the load transfer
_UNEVEN = 1e-3  # largest relative difference of sample intervals


@dataclass(frozen=True)
class Drive:
    """A measured drive."""

    time: Array
    """Equally spaced times, s, shape (n,)."""
    steer: Array
    """Mean steering angle of the front wheels, positive to the left, rad, shape (n,)."""
    vx: Array
    """Longitudinal velocity of the centre of mass in vehicle axes, m/s, shape (n,)."""
    vy: Array
    """Lateral velocity of the centre of mass in vehicle axes, positive to the left, m/s, shape (n,)."""
    yaw_rate: Array
    """Yaw rate, rad/s, shape (n,)."""
    ay: Array = field(default_factory=lambda: np.zeros(0))
    """Signal of the lateral accelerometer, m/s2, shape (n,); empty if the log has none."""
    bank: Array = field(default_factory=lambda: np.zeros(0))
    """Lateral acceleration by the weight on a banked road, positive to the left, m/s2, shape (n,); empty if unknown."""

    @property
    def interval(self) -> float:
        """Interval between samples, s."""
        return float(self.time[1] - self.time[0])

    @property
    def ax(self) -> Array:
        """Longitudinal acceleration of the centre of mass, vx' - yaw_rate vy, below `CUT_OFF`, m/s2, shape (n,)."""
        raw = np.gradient(self.vx, self.interval) - self.yaw_rate * self.vy
        return np.asarray(sosfiltfilt(butter(2, CUT_OFF, fs=1.0 / self.interval, output="sos"), raw))

    def inside(self, spans: Spans) -> NDArray[np.bool_]:
        """Whether each sample is in one of the spans, ends included, shape (n,)."""
        edge = 0.5 * self.interval
        return np.any([(self.time >= a - edge) & (self.time <= b + edge) for a, b in spans], axis=0)


def text_of(spans: Spans) -> str:
    """Spans as the argument of ``ali3 compare --seconds``."""
    return ",".join(f"{a:g}:{b:g}" for a, b in spans)


def read_drive(file: Path, aliases: Path) -> Drive:
    """Read a log; single outliers are replaced by linear interpolation.

    `file`: CSV, or packed (.csv.gz); `aliases`: its alias file, with the angles of both front wheels, the speeds and
    the yaw rate. Raises `HostError` if a column is missing, or its samples are not equally spaced.
    """
    log_aliases = read_log_aliases(aliases)
    raw = read_log(file, log_aliases.dialect)

    def column(name: str, unit: str) -> Array:
        if name not in log_aliases.columns:
            raise HostError(f"{aliases} has no '{name}', which this needs.")
        c = log_aliases.columns[name]
        factor = unit_definition(c.unit or unit, c.name).factor
        values = (raw.numbers(c.name) - c.offset) / c.factor * factor
        outliers = spikes(time, values)
        values[outliers] = np.interp(time[outliers], time[~outliers], values[~outliers])
        return np.asarray(values)

    time = raw.numbers(log_aliases.clock.name or "time")
    if np.ptp(np.diff(time)) > 2.0 * _UNEVEN * float(np.median(np.diff(time))) + 1e-9:
        raise HostError(f"The samples of {file} are not equally spaced.")
    steer = 0.5 * (column("wheel_FL.steer", "rad") + column("wheel_FR.steer", "rad"))
    return Drive(
        time - time[0],
        steer,
        column("chassis.vx", "m/s"),
        column("chassis.vy", "m/s"),
        column("chassis.wz", "rad/s"),
        column("chassis.ay", "m/s2") if "chassis.ay" in log_aliases.columns else np.zeros(0),
    )

"""A measured drive as equally spaced samples, and the seconds that models are fitted and judged on."""

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
EVERY = 5.0  # from one window to the next, s
FITTED: Spans = ((0.0, 80.0), (160.0, 240.0))  # s that models are fitted on
JUDGED: Spans = ((80.0, 160.0), (240.0, 275.0))  # s that tell what they predict
CUT_OFF = 2.0  # Hz, of the accelerations that move load between the axles
_UNEVEN = 1e-3  # of the interval between samples


@dataclass(frozen=True)
class Drive:
    """A measured drive."""

    time: Array
    """Shape (n,): equally spaced, s."""
    steer: Array
    """Shape (n,): mean angle of both front wheels on the road, positive to the left, rad."""
    vx: Array
    vy: Array
    """`vx`, `vy`, shape (n,): of the centre of mass in axes of the car, y to the left, m/s."""
    yaw_rate: Array
    """Shape (n,): rad/s."""
    ay: Array = field(default_factory=lambda: np.zeros(0))
    """Shape (n,): as the accelerometer shows it, m/s2; empty where it is not needed."""
    bank: Array = field(default_factory=lambda: np.zeros(0))
    """Shape (n,): lateral acceleration by the weight on a banked road, positive to the left, m/s2; empty where it is
    not known."""

    @property
    def interval(self) -> float:
        """Between samples, s."""
        return float(self.time[1] - self.time[0])

    @property
    def ax(self) -> Array:
        """Acceleration of the centre of mass along x, vx' - yaw_rate vy, below 2 Hz, m/s2, of shape (n,)."""
        raw = np.gradient(self.vx, self.interval) - self.yaw_rate * self.vy
        return np.asarray(sosfiltfilt(butter(2, CUT_OFF, fs=1.0 / self.interval, output="sos"), raw))

    def inside(self, spans: Spans) -> NDArray[np.bool_]:
        """Which samples lie in spans of time, ends included; of shape (n,)."""
        edge = 0.5 * self.interval
        return np.any([(self.time >= a - edge) & (self.time <= b + edge) for a, b in spans], axis=0)


def text_of(spans: Spans) -> str:
    """Spans as ``ali3 compare --seconds`` takes them."""
    return ",".join(f"{a:g}:{b:g}" for a, b in spans)


def read_drive(file: Path, aliases: Path) -> Drive:
    """Read a log; single samples that no neighbour supports are bridged by a straight line.

    `file`: CSV, perhaps packed (.gz); `aliases`: its alias file, with the angles of both front wheels, the speeds and
    the yaw rate. Raises `HostError`: a column is missing, or its samples are not equally spaced.
    """
    written = read_log_aliases(aliases)
    raw = read_log(file, written.dialect)

    def column(name: str, unit: str) -> Array:
        if name not in written.columns:
            raise HostError(f"{aliases} has no '{name}', which this needs.")
        c = written.columns[name]
        factor = unit_definition(c.unit or unit, c.name).factor
        values = (raw.numbers(c.name) - c.offset) / c.factor * factor
        wrong = spikes(time, values)
        values[wrong] = np.interp(time[wrong], time[~wrong], values[~wrong])
        return np.asarray(values)

    time = raw.numbers(written.clock.name or "time")
    if np.ptp(np.diff(time)) > 2.0 * _UNEVEN * float(np.median(np.diff(time))) + 1e-9:
        raise HostError(f"The samples of {file} are not equally spaced.")
    steer = 0.5 * (column("wheel_FL.steer", "rad") + column("wheel_FR.steer", "rad"))
    return Drive(
        time - time[0],
        steer,
        column("chassis.vx", "m/s"),
        column("chassis.vy", "m/s"),
        column("chassis.wz", "rad/s"),
        column("chassis.ay", "m/s2") if "chassis.ay" in written.columns else np.zeros(0),
    )

"""Pacing by absolute deadlines: begin and lateness of steps, and recovery from lateness."""

from collections import deque

from hosts.simulator.clock import Clock
from hosts.simulator.step_times import LateCauses, TimesRecord

MAX_LATENESS = 0.25
"""Lateness, s, above which the schedule is moved to now and the lost time is reported."""
_LATE = 0.05
_RECOVERY = 1.0
_REPORT_PERIOD = 5.0
_WINDOW = 1.0
_MAX_SLEEP = 0.02
_PAUSE = 0.001


class RealTimeClock:
    """The schedule of the steps.

    Each step has a scheduled begin and a deadline, at which the next one begins. After a late step the next ones follow
    without a pause until the schedule is met. Above `MAX_LATENESS` the schedule is moved to now, and the deadlines in
    between count as missed and the time as lost.

    `step`: communication step, s; `paced`: if not, a step begins at the end of the one before, and none is late.
    `speed`: requested ratio of simulated to wall time; `lateness`, `cost`: lateness and wall time of the last step, s;
    `behind`: whether the car is late or was late within the last second.
    """

    def __init__(self, clock: Clock, step: float, times: TimesRecord, paced: bool = True) -> None:
        self._clock, self._step, self._times, self._paced = clock, step, times, paced
        self.speed = 1.0
        self.lateness = self.cost = 0.0
        self._watch, self._causes = _LagWatch(), LateCauses(clock)
        self._began = clock.now()
        self.restart()

    @property
    def period(self) -> float:
        """Wall time of a step, s."""
        return self._step / self.speed

    @property
    def behind(self) -> bool:
        return self._watch.behind

    def restart(self) -> None:
        """The next step begins now."""
        self._due = self._ended = self._clock.now()
        self._watch.restart(self._due)
        self._causes.restart()

    def wait(self) -> bool:
        """Sleep towards the start of the next step, for at most 20 ms; whether it is reached."""
        now = self._clock.now()
        if not self._paced:
            self._began = now
            return True
        if self._due > now:
            self._clock.sleep_until(min(self._due, now + _MAX_SLEEP))
            now = self._clock.now()
        if self._due > now:
            return False
        self._began, self.lateness = now, now - self._due
        return True

    def done(self) -> str:
        """Count a step that was made, and schedule the next.

        Returns a message if the car begins or ends to be behind, otherwise an empty text.
        """
        now, times, period = self._clock.now(), self._times, self.period
        self.cost = now - self._began
        times.add_step(self.cost, self.lateness)
        times.add("steps", 1.0)
        times.add("simulated", self._step)
        if not self._paced:
            return ""
        times.add("scheduled", period)
        elapsed = now - max(self._due, self._ended)
        self._due, self._ended = self._due + period, now
        late, missed, lost = now - self._due, 0, 0.0
        cause = self._causes.of_step(elapsed, period, late > 0.0)
        if late > 0.0:
            missed = 1
        if late > MAX_LATENESS:
            # A pause for threads of the same priority, because steps that are always late never sleep.
            self._due, lost = now + _PAUSE, late + _PAUSE
            missed += int(late / period)
            times.add("skipped", 1.0)
            times.add("lost", lost)
        if missed:
            times.add("missed", missed)
            if cause:
                times.add(cause, missed)
        return self._watch.step(now, period, late, missed, lost)


class _LagWatch:
    """Watches whether the car keeps up, with a message on changes and every 5 s while it is behind."""

    behind = False
    _is_reported = False  # whether the car was late and has not yet kept up for a while

    def restart(self, now: float) -> None:
        self.behind, self._scheduled = False, 0.0
        self._reference = (now, 0.0)  # wall and scheduled time at the last message
        self._history: deque[tuple[float, float]] = deque([self._reference])

    def step(self, now: float, period: float, late: float, missed: int, lost: float) -> str:
        """Take a step into account; a message, or empty."""
        self._scheduled += period
        if now - self._history[-1][0] >= 0.1 * _WINDOW:
            self._history.append((now, self._scheduled))
            while len(self._history) > 2 and self._history[1][0] < now - _WINDOW:
                self._history.popleft()
        if late > _LATE:
            if not self._is_reported:
                self._is_reported, self._since, self._missed, self._lost, self._last_report = (
                    True,
                    now,
                    0,
                    0.0,
                    now - _REPORT_PERIOD,
                )
                self._reference = self._history[0]
            self.behind, self._latest = True, now
        if not self._is_reported:
            return ""
        self._missed += missed
        self._lost += lost
        self.behind = self.behind and now - self._latest <= _RECOVERY
        if now - self._last_report < _REPORT_PERIOD:
            return ""
        (begin, scheduled), self._reference = self._reference, (now, self._scheduled)
        self._last_report = now
        if not self.behind:
            self._is_reported = False
            return f"The car keeps up again; it was behind within {self._latest - self._since:.2f} s, {self._losses()}."
        reached = f"{(self._scheduled - scheduled) / max(now - begin, period):.2f} of the speed asked for"
        return f"The car is behind by {max(late, 0.0):.2f} s: it reaches {reached}; {self._losses()}."

    def _losses(self) -> str:
        plural = "" if self._missed == 1 else "s"
        return f"{self._missed} deadline{plural} missed, {self._lost:.2f} s of wall time left out"

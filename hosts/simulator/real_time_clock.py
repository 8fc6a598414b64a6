"""Pacing by absolute deadlines: when the next step begins, how late it is, and how lateness is made up."""

from collections import deque

from hosts.simulator.clock import Clock
from hosts.simulator.late_causes import LateCauses
from hosts.simulator.step_times import TimesRecord

MOST_LATE = 0.25
"""A car that is later than this, s, is not hurried on: its schedule is moved to now, and the lost time is reported."""
_LATE = 0.05
_AGAIN = 1.0
_SAID_EVERY = 5.0
_WINDOW = 1.0
_CHUNK = 0.02
_PAUSE = 0.001


class RealTimeClock:
    """The schedule of the steps.

    Each step has a time at which it begins and a deadline, at which the next begins. A step that ends too late does not
    move the schedule: the next ones follow without a pause until it is caught up. Later than `MOST_LATE`, the schedule
    is moved to now; the deadlines in between count as missed and the time as lost.

    `step`: communication step, s; `paced`: without, a step begins as soon as the one before is done, and none is late.
    `speed`: simulated over wall seconds that are asked for; `lateness`, `cost`: of the last step, s; `behind`: whether
    the car is late now or was within the last second.
    """

    def __init__(self, clock: Clock, step: float, times: TimesRecord, paced: bool = True) -> None:
        self._clock, self._step, self._times, self._paced = clock, step, times, paced
        self.speed = 1.0
        self.lateness = self.cost = 0.0
        self._words, self._causes = _Behind(), LateCauses(clock)
        self._began = clock.now()
        self.restart()

    @property
    def period(self) -> float:
        """Wall time of a step, s."""
        return self._step / self.speed

    @property
    def behind(self) -> bool:
        return self._words.behind

    def restart(self) -> None:
        """The next step begins now."""
        self._due = self._ended = self._clock.now()
        self._words.restart(self._due)
        self._causes.restart()

    def wait(self) -> bool:
        """Sleep until the next step begins, at most for a short while; whether it is time."""
        now = self._clock.now()
        if not self._paced:
            self._began = now
            return True
        if self._due > now:
            self._clock.sleep_until(min(self._due, now + _CHUNK))
            now = self._clock.now()
        if self._due > now:
            return False
        self._began, self.lateness = now, now - self._due
        return True

    def done(self) -> str:
        """The step has been made: count it, and set when the next begins.

        Returns what is to be said of a car that does not keep up; mostly empty.
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
        if late > MOST_LATE:
            # Others of the same priority get a turn too: a step that always takes too long never sleeps.
            self._due, lost = now + _PAUSE, late + _PAUSE
            missed += int(late / period)
            times.add("skipped", 1.0)
            times.add("lost", lost)
        if missed:
            times.add("missed", missed)
            if cause:
                times.add(cause, missed)
        return self._words.step(now, period, late, missed, lost)


class _Behind:
    """Whether the car keeps up, and the sentences when that changes or lasts."""

    behind = False
    _told_of = False  # from the first late step until it has kept up for a while

    def restart(self, now: float) -> None:
        self.behind, self._scheduled = False, 0.0
        self._from = (now, 0.0)  # of the factor that is said
        self._past: deque[tuple[float, float]] = deque([self._from])

    def step(self, now: float, period: float, late: float, missed: int, lost: float) -> str:
        """Take a step into account; what is to be said, mostly nothing."""
        self._scheduled += period
        if now - self._past[-1][0] >= 0.1 * _WINDOW:
            self._past.append((now, self._scheduled))
            while len(self._past) > 2 and self._past[1][0] < now - _WINDOW:
                self._past.popleft()
        if late > _LATE:
            if not self._told_of:
                self._told_of, self._since, self._missed, self._lost, self._said = True, now, 0, 0.0, now - _SAID_EVERY
                self._from = self._past[0]
            self.behind, self._last = True, now
        if not self._told_of:
            return ""
        self._missed += missed
        self._lost += lost
        self.behind = self.behind and now - self._last <= _AGAIN
        if now - self._said < _SAID_EVERY:
            return ""
        (begin, scheduled), self._from = self._from, (now, self._scheduled)
        self._said = now
        if not self.behind:
            self._told_of = False
            return f"The car keeps up again; it was behind within {self._last - self._since:.2f} s, {self._sum()}."
        reached = f"{(self._scheduled - scheduled) / max(now - begin, period):.2f} of the speed asked for"
        return f"The car is behind by {max(late, 0.0):.2f} s: it reaches {reached}; {self._sum()}."

    def _sum(self) -> str:
        plural = "" if self._missed == 1 else "s"
        return f"{self._missed} deadline{plural} missed, {self._lost:.2f} s of wall time left out"

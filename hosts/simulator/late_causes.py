"""Causes of late steps: a long step, other programs on the processor, or a stalled processor.

A virtual machine's host takes processors away from it ("steal"); no priority within the machine prevents that. Linux
tells what a thread ran, with interrupts and what a host takes untold, and how long it was ready while others ran.
"""

from hosts.simulator.clock import Clock

CAUSES = ("ran", "others", "stolen")
"""The step ran; programs ran while it was ready; the processor stood still or woke the thread late."""


class LateCauses:
    """Tells which cause took the longest. `clock`: its `spent` is what the system reports of the calling thread."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self.restart()

    def restart(self) -> None:
        """Start counting again: earlier work of the thread belongs to no step."""
        self._before, self._cause = self._clock.spent(), ""

    def of_step(self, elapsed: float, period: float, late: bool) -> str:
        """Take a step into account.

        `elapsed`: from its scheduled begin, or from the end of the step before where that was later, to its end, s;
        `period`: what it had been given, s; `late`: whether it missed its deadline. Returns one of `CAUSES`; empty
        where it was not late or the system does not report it. A step that is late only because the one before was has
        the cause of that one.
        """
        spent = self._clock.spent()
        if spent is None or self._before is None:
            return ""
        ran, waited = (now - before for now, before in zip(spent, self._before, strict=True))
        self._before = spent
        if not late:
            self._cause = ""
        elif elapsed > period or not self._cause:
            durations = dict(zip(CAUSES, (ran, waited, elapsed - ran - waited), strict=True))
            self._cause = max(durations, key=lambda name: durations[name])
        return self._cause

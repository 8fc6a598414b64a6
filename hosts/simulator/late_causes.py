"""Causes of late steps: a long step, other programs on the processor, or a stalled processor.

The host of a virtual machine may withdraw processors ("steal"), which no priority within the machine prevents. Linux
reports the run time of a thread, including interrupts and unreported steal, and its wait time while others ran.
"""

from hosts.simulator.clock import Clock

CAUSES = ("ran", "others", "stolen")
"""``ran``: the step itself; ``others``: other programs while it was ready; ``stolen``: a stalled processor."""


class LateCauses:
    """Determines the cause with the longest time. `clock`: clock of the calling thread."""

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self.restart()

    def restart(self) -> None:
        """Start counting again, so that earlier work of the thread belongs to no step."""
        self._before, self._cause = self._clock.spent(), ""

    def of_step(self, elapsed: float, period: float, late: bool) -> str:
        """Take a step into account.

        `elapsed`: time from its scheduled start, or a later end of the step before, to its end, s; `period`: its
        scheduled length, s; `late`: whether it missed its deadline. Returns one of `CAUSES`, or an empty text if the
        step was not late or the cause is not known. A step that is late only because of the one before has the same
        cause.
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

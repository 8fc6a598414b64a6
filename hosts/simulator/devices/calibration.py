"""The ends and the rest of axes, found while a person moves everything once."""

from dataclasses import dataclass, replace

from hosts.simulator.devices.defaults import PEDAL_DEAD_ZONE
from hosts.simulator.devices.mapping import CENTRED, PEDALS, DeviceMapping, InputMapping
from hosts.simulator.devices.reading import Reading, Source

REST_TIME = 1.0
"""Seconds for which nothing may move, so that it counts as let go."""
STILL = 0.05
"""Movement within which an axis counts as still."""
LEAST_WAY = 0.3
"""An axis that moved by less was not meant."""
FIRST_WAY = 0.2
"""Movement that shows the first direction of the steering."""
MARGIN = 0.02
"""Share of the way before its ends where the ends of the mapping are, so that they are surely reached."""
_NEAR_END = 0.25
LET_GO = "Let go of everything, the steering wheel straight ahead."
MOVE = (
    "Turn the steering wheel fully to the left, then fully to the right; press each pedal down once and let it go. "
    "Then finish."
)


class Calibration:
    """Two stages: at first everything is let go, then moved. `mapping`: which axis drives which input."""

    def __init__(self, mapping: DeviceMapping) -> None:
        self._mapping = mapping
        self._since: float | None = None
        self._span: list[list[float]] = []
        self._rest: list[float] = []
        self._known: tuple[bool, ...] = ()
        self._first: list[float] = []

    @property
    def stage(self) -> str:
        """``rest`` or ``move``."""
        return "move" if self._first else "rest"

    @property
    def words(self) -> str:
        """Instruction for the person."""
        return MOVE if self._first else LET_GO

    def ends(self) -> list[list[float]]:
        """Lowest and highest value of each axis since everything was let go."""
        return [[round(low, 4), round(high, 4)] for low, high in self._span] if self._first else []

    def feed(self, time: float, reading: Reading) -> None:
        """Take the next values. `time`: in s, of any clock that does not go back."""
        axes = reading.axes
        if not self._first:
            still = self._since is not None and all(
                max(high, at) - min(low, at) <= STILL for (low, high), at in zip(self._span, axes, strict=True)
            )
            if not still:
                self._since, self._span = time, [[at, at] for at in axes]
            self._widen(reading)
            if self._since is not None and time - self._since >= REST_TIME:
                self._rest = [0.5 * (low + high) for low, high in self._span]
                self._span, self._first, self._known = [[at, at] for at in axes], [0.0] * len(axes), reading.known
            return
        if reading.known != self._known:  # an axis that read 0 until it was touched begins here
            for k, (before, now) in enumerate(zip(self._known, reading.known, strict=True)):
                if now and not before:
                    self._span[k], self._rest[k] = [axes[k], axes[k]], axes[k]
            self._known = reading.known
        self._widen(reading)
        for k, at in enumerate(axes):
            if not self._first[k] and abs(at - self._rest[k]) > FIRST_WAY:
                self._first[k] = at - self._rest[k]

    def result(self) -> tuple[DeviceMapping, list[str], list[str]]:
        """The mapping with the ends that were found.

        Returns
        -------
        mapping : DeviceMapping
        found : list of str
            Inputs whose ends are new.
        still : list of str
            Inputs whose axis was not moved far enough; they are as before.
        """
        inputs, results, still = dict(self._mapping.inputs), [], []
        for name, old in self._mapping.inputs.items():
            source = Source.read(old.source)
            if source.kind != "axis" or name not in (*CENTRED, *PEDALS):
                continue
            k = source.number
            if not self._first or k >= len(self._span) or self._span[k][1] - self._span[k][0] < LEAST_WAY:
                still.append(name)
                continue
            inputs[name] = self._steering(old, k) if name in CENTRED else self._pedal(old, k)
            results.append(name)
        return replace(self._mapping, inputs=inputs), results, still

    def _widen(self, reading: Reading) -> None:
        for span, at in zip(self._span, reading.axes, strict=True):
            span[0], span[1] = min(span[0], at), max(span[1], at)

    def _steering(self, old: InputMapping, k: int) -> InputMapping:
        low, high = self._span[k]
        at_rest = (self._rest[k] - low) / (high - low)
        centre = self._rest[k] if _NEAR_END < at_rest < 1.0 - _NEAR_END else 0.5 * (low + high)
        # The first way was to the left, where the input is positive.
        return replace(old, inverted=self._first[k] < 0.0, low=low, high=high, centre=centre)

    def _pedal(self, old: InputMapping, k: int) -> InputMapping:
        low, high = self._span[k]
        rest, margin = self._rest[k], MARGIN * (high - low)
        at_rest = (rest - low) / (high - low)
        zone = max(old.dead_zone, PEDAL_DEAD_ZONE)
        if at_rest <= _NEAR_END:
            return replace(old, inverted=False, low=rest, high=high - margin, dead_zone=zone, centre=None)
        if at_rest >= 1.0 - _NEAR_END:
            return replace(old, inverted=True, low=low + margin, high=rest, dead_zone=zone, centre=None)
        # Two pedals share the axis: each keeps its half.
        if old.inverted:
            return replace(old, low=low + margin, high=rest, dead_zone=zone, centre=None)
        return replace(old, low=rest, high=high - margin, dead_zone=zone, centre=None)


@dataclass
class Assignment:
    """An input waits for the axis or button that a person moves for it."""

    name: str
    base: Reading
    """When it began."""
    until: float
    """s, when it gives up."""

    WAY = 0.5
    """Movement of an axis that is meant."""

    def feed(self, reading: Reading) -> InputMapping | None:
        """Take the next values; the mapping when something was moved far enough.

        An axis of the steering counts as moved to the left.
        """
        base = list(self.base.axes)
        for k, known in enumerate(self.base.known):
            if reading.known[k] and not known:
                base[k] = reading.axes[k]
        self.base = replace(self.base, axes=tuple(base), known=reading.known)
        pressed = sorted(reading.pressed() - self.base.pressed())
        if pressed and self.name not in CENTRED:
            return InputMapping(pressed[0])
        if self.name not in (*CENTRED, *PEDALS) or not base:
            return None
        k = max(range(len(base)), key=lambda i: abs(reading.axes[i] - base[i]))
        travel = reading.axes[k] - base[k]
        if abs(travel) < self.WAY:
            return None
        if self.name in CENTRED:
            return InputMapping(f"axis {k}", inverted=travel < 0.0)
        low, high = (-1.0, 1.0) if abs(base[k]) > self.WAY else (0.0, 1.0) if travel > 0.0 else (-1.0, 0.0)
        return InputMapping(f"axis {k}", travel < 0.0, low, high, PEDAL_DEAD_ZONE)

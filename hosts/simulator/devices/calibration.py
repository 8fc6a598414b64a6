"""Calibration and assignment of the axes of a device while a person moves them."""

from dataclasses import dataclass, replace

from hosts.simulator.devices.defaults import PEDAL_DEAD_ZONE
from hosts.simulator.devices.mapping import CENTRED, PEDALS, DeviceMapping, InputMapping
from hosts.simulator.devices.reading import Reading, Source

REST_TIME = 1.0
"""Time without movement, s, after which the device counts as released."""
STILL = 0.05
"""Largest movement of an axis at rest."""
MIN_MOVEMENT = 0.3
"""Least movement of an axis that is calibrated."""
FIRST_MOVEMENT = 0.2
"""Movement that determines the first direction of the steering."""
MARGIN = 0.02
"""Fraction of the range by which the ends of the mapping lie before the ends of the axis, so that they are reached."""
_NEAR_END = 0.25
LET_GO = "Let go of everything, the steering wheel straight ahead."
MOVE = (
    "Turn the steering wheel fully to the left, then fully to the right; press each pedal down once and let it go. "
    "Then finish."
)


class Calibration:
    """A calibration in two stages: the device at rest, then moved. `mapping`: mapping of axes to inputs."""

    def __init__(self, mapping: DeviceMapping) -> None:
        self._mapping = mapping
        self._still_since: float | None = None
        self._span: list[list[float]] = []
        self._rest: list[float] = []
        self._known: tuple[bool, ...] = ()
        self._first_movement: list[float] = []

    @property
    def stage(self) -> str:
        """``rest`` or ``move``."""
        return "move" if self._first_movement else "rest"

    @property
    def words(self) -> str:
        """Instruction for the person."""
        return MOVE if self._first_movement else LET_GO

    def ends(self) -> list[list[float]]:
        """Lowest and highest value of each axis since the rest."""
        return [[round(low, 4), round(high, 4)] for low, high in self._span] if self._first_movement else []

    def feed(self, time: float, reading: Reading) -> None:
        """Take the next values. `time`: time of a monotonic clock, s."""
        axes = reading.axes
        if not self._first_movement:
            is_still = self._still_since is not None and all(
                max(high, position) - min(low, position) <= STILL
                for (low, high), position in zip(self._span, axes, strict=True)
            )
            if not is_still:
                self._still_since, self._span = time, [[position, position] for position in axes]
            self._extend_spans(reading)
            if self._still_since is not None and time - self._still_since >= REST_TIME:
                self._rest = [0.5 * (low + high) for low, high in self._span]
                self._span, self._first_movement, self._known = (
                    [[position, position] for position in axes],
                    [0.0] * len(axes),
                    reading.known,
                )
            return
        if reading.known != self._known:  # an axis reads 0 until it is first moved
            for k, (before, now) in enumerate(zip(self._known, reading.known, strict=True)):
                if now and not before:
                    self._span[k], self._rest[k] = [axes[k], axes[k]], axes[k]
            self._known = reading.known
        self._extend_spans(reading)
        for k, position in enumerate(axes):
            if not self._first_movement[k] and abs(position - self._rest[k]) > FIRST_MOVEMENT:
                self._first_movement[k] = position - self._rest[k]

    def result(self) -> tuple[DeviceMapping, list[str], list[str]]:
        """The mapping with calibrated ends.

        Returns
        -------
        mapping : DeviceMapping
        calibrated : list of str
            Inputs with new ends.
        unmoved : list of str
            Inputs whose axis was not moved far enough; they are unchanged.
        """
        inputs, calibrated, unmoved = dict(self._mapping.inputs), [], []
        for name, old in self._mapping.inputs.items():
            source = Source.read(old.source)
            if source.kind != "axis" or name not in (*CENTRED, *PEDALS):
                continue
            k = source.number
            if not self._first_movement or k >= len(self._span) or self._span[k][1] - self._span[k][0] < MIN_MOVEMENT:
                unmoved.append(name)
                continue
            inputs[name] = self._steering(old, k) if name in CENTRED else self._pedal(old, k)
            calibrated.append(name)
        return replace(self._mapping, inputs=inputs), calibrated, unmoved

    def _extend_spans(self, reading: Reading) -> None:
        for span, position in zip(self._span, reading.axes, strict=True):
            span[0], span[1] = min(span[0], position), max(span[1], position)

    def _steering(self, old: InputMapping, k: int) -> InputMapping:
        low, high = self._span[k]
        at_rest = (self._rest[k] - low) / (high - low)
        centre = self._rest[k] if _NEAR_END < at_rest < 1.0 - _NEAR_END else 0.5 * (low + high)
        # The first movement was to the left, where the input is positive.
        return replace(old, inverted=self._first_movement[k] < 0.0, low=low, high=high, centre=centre)

    def _pedal(self, old: InputMapping, k: int) -> InputMapping:
        low, high = self._span[k]
        rest, margin = self._rest[k], MARGIN * (high - low)
        at_rest = (rest - low) / (high - low)
        zone = max(old.dead_zone, PEDAL_DEAD_ZONE)
        if at_rest <= _NEAR_END:
            return replace(old, inverted=False, low=rest, high=high - margin, dead_zone=zone, centre=None)
        if at_rest >= 1.0 - _NEAR_END:
            return replace(old, inverted=True, low=low + margin, high=rest, dead_zone=zone, centre=None)
        # Two pedals share the axis; each keeps its half.
        if old.inverted:
            return replace(old, low=low + margin, high=rest, dead_zone=zone, centre=None)
        return replace(old, low=rest, high=high - margin, dead_zone=zone, centre=None)


@dataclass
class Assignment:
    """The assignment of the next axis or button that is moved to an input."""

    name: str
    base: Reading
    """Reading at the start."""
    until: float
    """Time at which the assignment ends without a result, s."""

    MIN_MOVEMENT = 0.5
    """Least movement of an axis that is assigned."""

    def feed(self, reading: Reading) -> InputMapping | None:
        """Take the next values; the mapping once an axis or button was moved far enough, otherwise None.

        An axis for the steering must be moved to the left.
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
        movement = reading.axes[k] - base[k]
        if abs(movement) < self.MIN_MOVEMENT:
            return None
        if self.name in CENTRED:
            return InputMapping(f"axis {k}", inverted=movement < 0.0)
        low, high = (-1.0, 1.0) if abs(base[k]) > self.MIN_MOVEMENT else (0.0, 1.0) if movement > 0.0 else (-1.0, 0.0)
        return InputMapping(f"axis {k}", movement < 0.0, low, high, PEDAL_DEAD_ZONE)

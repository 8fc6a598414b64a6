"""Substitutes for SDL's haptic functions: virtual devices have no motor."""

from __future__ import annotations

from dataclasses import dataclass, field
from threading import Event
from typing import Any

import pytest

from tests.hosts.simulator.devices.virtual import sdl2

CONSTANT, DAMPER, SPRING = sdl2.SDL_HAPTIC_CONSTANT, sdl2.SDL_HAPTIC_DAMPER, sdl2.SDL_HAPTIC_SPRING
HANDLE = 77


@dataclass
class Haptics:
    """Calls to the motor of a device."""

    can: int = CONSTANT | DAMPER | SPRING | sdl2.SDL_HAPTIC_GAIN | sdl2.SDL_HAPTIC_AUTOCENTER
    """Bits of the supported effects."""
    calls: list[str] = field(default_factory=list)
    """Names of the calls, without ``SDL_Haptic``."""
    effects: dict[int, dict[str, Any]] = field(default_factory=dict)
    running: set[int] = field(default_factory=set)
    """Effects that run, by number: `type`, `direction`, `length`, and `level` or `coefficient`."""
    levels: list[int] = field(default_factory=list)
    """Levels of the constant force, in order."""
    refuse: set[str] = field(default_factory=set)
    """Calls that fail."""
    open: bool = False
    hang: Event | None = None
    """Event for which updates wait."""

    def install(self, monkeypatch: pytest.MonkeyPatch) -> Haptics:
        for name in (n for n in dir(self) if n.startswith("on_")):
            call = name.removeprefix("on_")
            monkeypatch.setattr(sdl2, f"SDL_Haptic{call}", self._recorded(call, getattr(self, name)))
        monkeypatch.setattr(sdl2, "SDL_JoystickIsHaptic", lambda joystick: 1)
        return self

    def of(self, kind: int) -> list[dict[str, Any]]:
        """Effects of a type that run."""
        return [e for n, e in self.effects.items() if e["type"] == kind and n in self.running]

    def coefficient(self, kind: int) -> int:
        return sum(e["coefficient"] for e in self.of(kind))

    def _recorded(self, call: str, answer: Any) -> Any:
        def recorded(*arguments: Any) -> Any:
            self.calls.append(call)
            if call in self.refuse:
                return None if call == "OpenFromJoystick" else -1
            assert call == "OpenFromJoystick" or (arguments[0] == HANDLE and self.open)
            return answer(*arguments[1:])

        return recorded

    def on_OpenFromJoystick(self) -> int:
        self.open = True
        return HANDLE

    def on_Query(self) -> int:
        return self.can

    def on_SetGain(self, gain: int) -> int:
        assert gain == 100
        return 0

    def on_SetAutocenter(self, share: int) -> int:
        assert share == 0
        return 0

    def on_NewEffect(self, effect: Any) -> int:
        number = len(self.effects)
        self.effects[number] = self._copy(effect)
        return number

    def on_UpdateEffect(self, number: int, effect: Any) -> int:
        if self.hang is not None:
            self.hang.wait(60.0)
        copy = self._copy(effect)
        assert copy["type"] == self.effects[number]["type"]
        self.effects[number] = copy
        return 0

    def on_RunEffect(self, number: int, times: int) -> int:
        assert times == 1
        self.running.add(number)
        return 0

    def on_StopEffect(self, number: int) -> int:
        self.running.discard(number)
        return 0

    def on_DestroyEffect(self, number: int) -> None:
        del self.effects[number]
        self.running.discard(number)

    def on_StopAll(self) -> int:
        self.running.clear()
        return 0

    def on_Close(self) -> None:
        self.open = False

    def _copy(self, pointer: Any) -> dict[str, Any]:
        effect = pointer._obj
        if effect.type == CONSTANT:
            self.levels.append(effect.constant.level)
            part, own = effect.constant, {"level": effect.constant.level}
        else:
            part, own = effect.condition, {"coefficient": effect.condition.right_coeff[0]}
            assert list(part.right_coeff) == list(part.left_coeff)
            assert set(part.right_sat) | set(part.left_sat) == {0xFFFF}
        return {"type": effect.type, "direction": part.direction.type, "length": part.length, **own}

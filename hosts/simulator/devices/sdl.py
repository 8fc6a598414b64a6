"""Loads and starts SDL, the library that reads wheels, pedals and gamepads and moves their motors."""

import warnings
from typing import Any

from hosts.common.errors import HostError

_HINTS = {
    "SDL_NO_SIGNAL_HANDLERS": "1",  # else SDL handles Ctrl+C and SIGTERM
    "SDL_JOYSTICK_ALLOW_BACKGROUND_EVENTS": "1",  # there is no window with the focus
    "SDL_JOYSTICK_THREAD": "1",  # on Windows device messages need no window
}
_ALTERNATIVE = "the keyboard, and gamepads in the page, still drive"


def load() -> Any:
    """The module `sdl2`, not initialised. Raises `HostError` if SDL is not installed or cannot be loaded."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # PySDL2 warns of the library that it loads
            import sdl2
    except ModuleNotFoundError:
        raise HostError(
            "Wheels, pedals and gamepads of this computer are not read, because PySDL2 is not installed: "
            f"pip install 'ali3[simulator]' brings it; {_ALTERNATIVE}."
        ) from None
    except (ImportError, OSError, RuntimeError) as error:
        raise HostError(
            "Wheels, pedals and gamepads of this computer are not read, because SDL cannot be loaded "
            f"({_error_line(error)}); {_ALTERNATIVE}."
        ) from None
    for name, value in _HINTS.items():
        sdl2.SDL_SetHint(name.encode(), value.encode())
    return sdl2


def start(sdl: Any) -> None:
    """Start the search for devices, without video, in the thread that reads them.

    Raises `HostError` if SDL cannot start.
    """
    # Game controllers only give the mapping strings of gamepads; values are read from joysticks.
    if sdl.SDL_InitSubSystem(sdl.SDL_INIT_JOYSTICK | sdl.SDL_INIT_GAMECONTROLLER) != 0:
        raise HostError(
            f"Wheels, pedals and gamepads of this computer are not read: SDL says “{last_error(sdl)}”; {_ALTERNATIVE}."
        )
    # Devices can be read without haptics.
    sdl.SDL_InitSubSystem(sdl.SDL_INIT_HAPTIC)


def stop(sdl: Any) -> None:
    """Stop SDL, in the thread that has started it."""
    if sdl.SDL_WasInit(sdl.SDL_INIT_HAPTIC):
        sdl.SDL_QuitSubSystem(sdl.SDL_INIT_HAPTIC)
    sdl.SDL_QuitSubSystem(sdl.SDL_INIT_JOYSTICK | sdl.SDL_INIT_GAMECONTROLLER)


def last_error(sdl: Any) -> str:
    """The error message of SDL for the last failed call of this thread."""
    return text(sdl.SDL_GetError()) or "no reason given"


def text(value: bytes | None) -> str:
    """A text of SDL; empty for a null pointer."""
    return (value or b"").decode("utf-8", "replace").strip()


def _error_line(error: Exception) -> str:
    lines = str(error).strip().splitlines()
    return lines[0].rstrip(".") if lines else type(error).__name__

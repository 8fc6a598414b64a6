"""SDL, which reads wheels, pedals and gamepads and moves their motors."""

import warnings
from typing import Any

from hosts.common.errors import HostError

_HINTS = {
    "SDL_NO_SIGNAL_HANDLERS": "1",  # else SDL takes Ctrl+C and SIGTERM away from the program
    "SDL_JOYSTICK_ALLOW_BACKGROUND_EVENTS": "1",  # there is no window that could have the focus
    "SDL_JOYSTICK_THREAD": "1",  # Windows: messages about devices come without a window
}
_INSTEAD = "the keyboard, and gamepads in the page, still drive"


def load() -> Any:
    """The module `sdl2`, not yet initialised. Raises `HostError`: SDL is not installed or cannot be loaded."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # PySDL2 says which library it takes
            import sdl2
    except ModuleNotFoundError:
        raise HostError(
            "Wheels, pedals and gamepads of this computer are not read, because PySDL2 is not installed: "
            f"pip install 'ali3[simulator]' brings it; {_INSTEAD}."
        ) from None
    except (ImportError, OSError, RuntimeError) as error:
        raise HostError(
            "Wheels, pedals and gamepads of this computer are not read, because SDL cannot be loaded "
            f"({_line(error)}); {_INSTEAD}."
        ) from None
    for name, value in _HINTS.items():
        sdl2.SDL_SetHint(name.encode(), value.encode())
    return sdl2


def start(sdl: Any) -> None:
    """Begin to look for devices, without video; to be called by the thread that reads them.

    Raises `HostError`: SDL cannot look for devices.
    """
    # The layer of game controllers is there for its table of triggers and sticks only; values are read from joysticks.
    if sdl.SDL_InitSubSystem(sdl.SDL_INIT_JOYSTICK | sdl.SDL_INIT_GAMECONTROLLER) != 0:
        raise HostError(
            f"Wheels, pedals and gamepads of this computer are not read: SDL says “{last_error(sdl)}”; {_INSTEAD}."
        )
    # Without haptics devices are still read.
    sdl.SDL_InitSubSystem(sdl.SDL_INIT_HAPTIC)


def stop(sdl: Any) -> None:
    """End what `start` began, by the same thread."""
    if sdl.SDL_WasInit(sdl.SDL_INIT_HAPTIC):
        sdl.SDL_QuitSubSystem(sdl.SDL_INIT_HAPTIC)
    sdl.SDL_QuitSubSystem(sdl.SDL_INIT_JOYSTICK | sdl.SDL_INIT_GAMECONTROLLER)


def last_error(sdl: Any) -> str:
    """The error message of SDL for the last failed call of this thread."""
    return text(sdl.SDL_GetError()) or "no reason given"


def text(value: bytes | None) -> str:
    """A text of SDL, empty where it has none."""
    return (value or b"").decode("utf-8", "replace").strip()


def _line(error: Exception) -> str:
    words = str(error).strip().splitlines()
    return words[0].rstrip(".") if words else type(error).__name__

"""Finds a scene by its name in `mbs.scenes`, or a function in a file of the user, and compiles it."""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import pkgutil
import sys
import traceback
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, cast

import mbs
import mbs.scenes
from ali3.reading import is_file, missing_file_text
from fmu_src.geometry.system_with_poses import PosesError, posed_systems

if TYPE_CHECKING:
    from mbs.vehicle import Car

_ENGINE = Path(mbs.__file__).parent


class SceneError(ValueError):
    """A scene that cannot be found or does not give a model; the message is for the user."""


def scene_names() -> list[str]:
    """Names of the scenes that come with the package: modules of `mbs.scenes` with a function `build`."""
    names = []
    for info in pkgutil.iter_modules(mbs.scenes.__path__):
        if not info.name.startswith("_") and callable(getattr(_scene_module(info.name), "build", None)):
            names.append(info.name)
    return sorted(names)


def load_scene(scene: str) -> tuple[str, mbs.System]:
    """Build and compile a scene. `scene`: name of a scene of the package, or ``path/to/file.py:function``.

    Raises `SceneError` if there is no such scene, it asks for arguments or returns something else than a Model or
    System.

    Returns
    -------
    name : str
        Short name, for file names.
    system : mbs.System
    """
    with _scene(scene) as (name, build):
        return name, _system(scene, build)


def load_fidelities(
    scene: str, poses: str | None = None, tell: Callable[[str], object] = str
) -> tuple[str, dict[int, mbs.System], int]:
    """Build and compile a scene in all the fidelities it offers.

    A scene offers them by a function `fidelities` beside its `build`: it returns functions that make a model by number,
    0 and on; the numbers may be members of an enumeration, whose names are then in the FMU. The one of `build` is the
    default of its argument `fidelity`. `scene`: as for `load_scene`; `poses`, `tell`: as
    `fmu_src.geometry.system_with_poses.posed_systems` takes them.

    Returns
    -------
    name : str
    systems : dict of int to mbs.System
        By fidelity, ascending; one if there is no choice.
    default : int
        The fidelity of `build`.
    """
    with _scene(scene) as (name, build):
        module = sys.modules[build.__module__]
        fidelities = getattr(module, "fidelities", None)
        if not callable(fidelities) or build.__name__ != "build":
            return name, posed_systems({0: lambda: _model(scene, build)}, 0, poses, tell), 0
        makers = fidelities()
        numbers = sorted(makers)
        if numbers != list(range(len(makers))):
            raise SceneError(
                f"The fidelities of scene '{scene}' are numbered {[int(k) for k in numbers]}; they must be 0, 1, 2 and "
                "on."
            )
        default = inspect.signature(build).parameters["fidelity"].default
        systems = posed_systems({k: makers[k] for k in numbers}, int(default), poses, tell)
        return name, systems, int(default)


def car_of_scene(scene: str) -> Car | None:
    """The car that a scene of the package is; None of another. `scene`: as for `load_scene`."""
    make_car = None if _is_path(scene) else getattr(_scene_module(scene), "car", None)
    return None if make_car is None else cast("Car", make_car())


def _system(scene: str, build: Callable[..., Any]) -> mbs.System:
    model = _model(scene, build)
    return mbs.compile(model) if isinstance(model, mbs.Model) else model


def _model(scene: str, build: Callable[..., Any]) -> mbs.Model | mbs.System:
    missing = [
        p.name
        for p in inspect.signature(build).parameters.values()
        if p.default is p.empty and p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)
    ]
    if missing:
        raise SceneError(
            f"The function of scene '{scene}' needs arguments ({', '.join(missing)}); give it defaults, "
            "or write a function without arguments that calls it."
        )
    result: Any = build()
    if not isinstance(result, (mbs.Model, mbs.System)):
        raise SceneError(
            f"Scene '{scene}' returned a {type(result).__name__}; it must return an mbs.Model or mbs.System."
        )
    model: mbs.Model | mbs.System = result
    return model


@contextmanager
def _scene(scene: str) -> Iterator[tuple[str, Callable[..., Any]]]:
    """Name and function of a scene, in a context in which a file finds its neighbours and its errors are reported."""
    if not _is_path(scene):
        yield _from_package(scene)
        return
    file, separator, function = scene.rpartition(":")
    if not separator or not file.endswith(".py"):
        file, function = scene, "build"
    path = Path(file)
    if not is_file(path):
        raise SceneError(missing_file_text(path, " A scene of your own is given as path/to/file.py:function."))
    path = path.resolve()
    with _neighbours(path.parent):
        try:
            yield _from_file(path, function)
        except (SceneError, PosesError):
            raise
        except Exception as error:
            raise _error_in_scene(error, path) from error


class _Neighbours(MetaPathFinder):
    """Finds the files beside a scene before installed packages, but not in place of the standard library.

    What is imported already, this package and the engine with all they need among them, is not looked for again: a
    file that is called numpy.py by chance does no harm.
    """

    def __init__(self, folder: Path) -> None:
        self._folder = str(folder)

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if path is not None or fullname in sys.stdlib_module_names:
            return None
        return PathFinder.find_spec(fullname, [self._folder], target)


@contextmanager
def _neighbours(folder: Path) -> Iterator[None]:
    """Let a scene import the files beside it."""
    finder = _Neighbours(folder)
    sys.meta_path.insert(0, finder)
    try:
        yield
    finally:
        sys.meta_path.remove(finder)


def _error_in_scene(error: Exception, path: Path) -> Exception:
    """An error of the engine as it is, which is a sentence; another one with its place in the files of the user."""
    if isinstance(error, SyntaxError):
        return SceneError(f"{error.filename}, line {error.lineno}: {error.msg}.")
    frames = traceback.extract_tb(error.__traceback__)
    if isinstance(error, (ValueError, RuntimeError)) and _ENGINE in Path(frames[-1].filename).parents:
        return error
    own_frames = [frame for frame in frames if Path(frame.filename).parent == path.parent]
    fault_frame = own_frames[-1] if own_frames else frames[-1]
    return SceneError(f"{fault_frame.filename}, line {fault_frame.lineno}: {type(error).__name__}: {error}")


def _is_path(scene: str) -> bool:
    return ".py" in scene or "/" in scene or "\\" in scene


def _scene_module(name: str) -> ModuleType:
    return importlib.import_module(f"mbs.scenes.{name}")


def _from_package(scene: str) -> tuple[str, Callable[..., Any]]:
    names = scene_names()
    if scene not in names:
        raise SceneError(
            f"There is no scene '{scene}'. The scenes are: {', '.join(names)}. "
            "A scene of your own is given as path/to/file.py:function."
        )
    return scene, _scene_module(scene).build


def _from_file(path: Path, function: str) -> tuple[str, Callable[..., Any]]:
    spec = importlib.util.spec_from_file_location(f"_ali3_scene_{path.stem}", path)
    if spec is None or spec.loader is None:
        raise SceneError(f"{path} is not a Python file.")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    build = getattr(module, function, None)
    if not callable(build):
        raise SceneError(f"{path} has no function '{function}'.")
    return (path.stem if function == "build" else function), build

"""All calls of the product for the stored results, so that only this module depends on its names."""

import importlib
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import mbs
from tests.modules import module_of

ROOT = Path(__file__).parents[2]
KINDS = {"fmi2": ("native", ""), "fmi3": ("fmi3", "FMI3"), "python": ("python", "Python")}
"""Kinds of FMU: name for `build`, and suffix of the file name."""
MODEL = {"prototype": "Prototype", "hatchback": "Hatchback"}


def scene(name: str, **arguments: Any) -> mbs.Model:
    """A scene of the package."""
    return importlib.import_module(f"mbs.scenes.{name}").build(**arguments)


def example(script: str, function: str, *arguments: Any) -> mbs.Model:
    """The model of a script in the folder of examples."""
    return getattr(module_of(ROOT / "examples" / f"{script}.py"), function)(*arguments)


def car(name: str, fidelity: int = 0, road: Any = None) -> mbs.Model:
    """A car of the package, or of a file."""
    return importlib.import_module("mbs.vehicle").load(name).model(road, fidelity)


def ali3(*arguments: object, good: Sequence[int] = (0,)) -> str:
    """Output of a command. Raises `RuntimeError` for an exit code that is not in `good`."""
    process = subprocess.run(
        [sys.executable, "-m", "ali3", *map(str, arguments)], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if process.returncode not in good:
        raise RuntimeError(
            f"ali3 {' '.join(map(str, arguments))} ended with {process.returncode}: {process.stdout}{process.stderr}"
        )
    return process.stdout


def build(name: str, folder: Path, kinds: Sequence[str] = tuple(KINDS)) -> None:
    """FMUs of a car for this machine."""
    names = ",".join(KINDS[kind][0] for kind in kinds)
    ali3("build", "--car", name, "--platforms", "this", "--kind", names, "--out", folder)


def fmu_file(name: str, kind: str, folder: Path) -> Path:
    """File of an FMU after `build`."""
    return folder / f"{MODEL[name]}{KINDS[kind][1]}.fmu"


def drive(fmu: Path, manoeuvre: str, folder: Path, *options: object) -> Path:
    """Simulate an FMU in a manoeuvre; returns the file of the result."""
    ali3("run", fmu, "--manoeuvre", manoeuvre, "--out", folder, *options)
    return next(folder.glob("*.csv"))


def catalogue(fmu: Path, tests: str, folder: Path, settings: Sequence[str]) -> Path:
    """Run standard tests; returns the file of the measures. The exit code 1 means that a car exceeds a limit."""
    options = [text for setting in settings for text in ("--test-setting", setting)]
    ali3("catalogue", fmu, "--tests", tests, "--jobs", 1, "--no-runs", "--out", folder, *options, good=(0, 1))
    return folder / "measures.json"


def study(file: Path, folder: Path) -> Path:
    """Run a study; returns the folder of its rows."""
    ali3("study", file, "--jobs", 1, "--no-report", "--out", folder)
    return folder / "runs"


def compare(fmu: Path, log: Path, folder: Path, *options: str) -> Path:
    """Compare an FMU with a log; returns the file of all numbers."""
    ali3("compare", fmu, log, "--out", folder, "--json", folder.parent / "compare.json", *options)
    return folder.parent / "compare.json"


def kinematics(name: str, folder: Path, points: int) -> tuple[Path, list[Path]]:
    """Kinematics of a car; returns the file of all numbers and the tables of the curves."""
    file = folder / "kinematics.json"
    ali3("car", name, "--kinematics", "--points", points, "--out", folder / "curves", "--json", file)
    return file, sorted((folder / "curves").glob("*.csv"))


def road(source: Path, folder: Path) -> tuple[Path, Path]:
    """A road file and the file of its drawing."""
    road_file, part = folder / f"{source.stem}.road", folder / f"{source.stem}.json"
    ali3("road", source, road_file, "--part", part)
    return road_file, part


def world(name: str, folder: Path) -> tuple[Path, Path]:
    """The road file and the file of the drawing of a world, both computed."""
    ali3("road", "--world", name, "--out", folder)
    return folder / f"{name}.road", folder / f"{name}.json"


def page(result: Path, fmu: Path, folder: Path) -> tuple[Path, Path]:
    """The files of the page and the glTF of a result."""
    page, gltf = folder / f"{result.stem}.html", folder / "page.glb"
    ali3("view", result, "--geometry", fmu, "--no-open", "--most", 200, "--out", folder, "--gltf", gltf)
    return page, gltf

"""Makes pages of `docs/driving.md`: ``python docs/_site/make_live_page.py NAME... OUT``."""

import csv
import sys
import tempfile
from collections.abc import Callable, Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path

import mbs
from ali3.command_run import run_command
from ali3.scene.recording import Recording
from fmu_src.build.command import main as build
from hosts.view.command import main as view
from hosts.view.page_parts import FmuParts, fmu_parts, page_text
from mbs.scenes import double_four_bar

_FAILS = "ali3p_no_projection"


@cache
def built(folder: Path, *what: str) -> FmuParts:
    """An FMU for pages, once for all that show it."""
    if build([*what, "--kind", "native", "--platforms", "wasm32", "--out", str(folder)], "ali3 build"):
        raise SystemExit(f"ali3 build {' '.join(what)} failed")
    return fmu_parts(next(folder.glob("*.fmu")))


def written(fmu: FmuParts, folder: Path, *more: str) -> str:
    """The page that ``ali3 view --live`` writes."""
    if view([str(fmu.path), "--live", "--no-open", "--out", str(folder), *more], "ali3 view"):
        raise SystemExit(f"ali3 view --live {fmu.path.name} failed")
    return (folder / f"{fmu.path.stem}_live.html").read_text(encoding="utf-8")


def prototype(folder: Path) -> str:
    """The paper's car."""
    return written(built(folder, "--car", "prototype"), folder, "--title", "The prototype car")


def proving_ground(folder: Path) -> str:
    """The paper's car in the world of the simulator."""
    options = ("--world", "proving_ground", "--title", "The proving ground")
    return written(built(folder, "--car", "prototype"), folder, *options)


def hatchback(folder: Path) -> str:
    """The other car of the package, its frame coloured by stress, which is computed quasi-statically."""
    fmu = built(folder, "--car", "hatchback", "--poses", "all")
    return written(fmu, folder, "--title", "The hatchback", "--set", "fidelity=1")


def double_four_bar_beside(folder: Path) -> str:
    """The mechanism of the IFToMM benchmark A02, beside the run of a method that its singular positions stop."""
    fmu = built(folder, "--scene", "double_four_bar")
    system = mbs.compile(double_four_bar.build())
    try:
        mbs.simulate(system, 10.0, h=0.01, settings=mbs.Settings(method=_FAILS), progress=False)
    except mbs.SimulationError as error:
        trajectory, reason = error.trajectory, str(error).split(". Worst")[0]
    else:
        raise SystemExit(f"the double four-bar passes its singular positions with {_FAILS}")
    recording = Recording(
        system.scene, trajectory.poses.t, dict(trajectory.poses.items()), name="the same without projections"
    )
    return page_text(
        "The double four-bar through its singular positions",
        [("ALi3 with projections: it runs on", fmu)],
        {"name": "double_four_bar", "run": True, "step": 0.01, "plots": ["energy.total", "B0.position.y"]},
        recordings=[recording],
        ends=[f"{reason}."],
    )


def puma(folder: Path) -> str:
    """The robot: the first two seconds of the paper's manoeuvre, backwards, and again."""
    fmu = built(folder, "--scene", "puma")
    text = files("mbs.scenes.puma").joinpath("manoeuvre.csv").read_text(encoding="utf-8")
    rows = [[float(x) for x in row] for row in csv.reader(text.splitlines()[1:])]
    torque_rows = [row[1:8] for row in rows if row[0] == 1]
    table = folder / "manoeuvre.csv"
    table.write_text("\n".join(["time," + ",".join(f"torque_{k}" for k in range(1, 7)), *_to_and_fro(torque_rows, 1)]))
    step_options = ["--set", "step_size=0.002", "--step", "0.002"]
    return written(
        fmu, folder, "--title", "The PUMA robot", "--manoeuvre", str(table), "--plot", "angle_2", *step_options
    )


def _to_and_fro(rows: Sequence[Sequence[float]], times: int) -> list[str]:
    """A motion without friction, and the same backwards: torques in the opposite order lead back to its start."""
    length = rows[-1][0]
    reversed_rows = [[2.0 * length - row[0], *row[1:]] for row in reversed(rows[:-1])]
    round_trip = [*rows, *reversed_rows]
    all_rows = [
        [row[0] + 2.0 * length * k, *row[1:]]
        for k in range(times)
        for row in (round_trip if k == 0 else round_trip[1:])
    ]
    return [",".join(repr(x) for x in row) for row in all_rows]


MAKERS: dict[str, Callable[[Path], str]] = {
    "proving_ground": proving_ground,
    "prototype": prototype,
    "hatchback": hatchback,
    "double_four_bar": double_four_bar_beside,
    "puma": puma,
}


def main(names: Sequence[str], out: Path) -> int:
    """Make pages and put them into a folder; 0."""
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            (out / f"{name}.html").write_text(MAKERS[name](Path(folder)), encoding="utf-8", newline="\n")
    return 0


if __name__ == "__main__":
    sys.exit(run_command(lambda: main(sys.argv[1:-1], Path(sys.argv[-1])), (RuntimeError, ValueError)))

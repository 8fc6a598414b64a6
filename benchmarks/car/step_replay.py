"""Repeats the worst steps of a drive from C: their processor time without what disturbed it, and their instructions."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

import fmpy
import numpy as np

from benchmarks.car.step_costs import Costs, Stretch, Worst
from benchmarks.shared.instructions import counter, instructions
from fmu_src.native.sources import HERE as FMI_HEADERS
from mbs.kernel import build

SOURCE = Path(__file__).parent / "c" / "replay_fmu.c"
REPEATS = 50


class Replay:
    """A program that repeats steps of an FMU. `folder`: to unpack and compile in."""

    def __init__(self, fmu: Path, folder: Path) -> None:
        with zipfile.ZipFile(fmu) as archive:
            archive.extractall(folder)
        description = fmpy.read_model_description(str(folder))
        name = description.coSimulation.modelIdentifier + fmpy.sharedLibraryExtension
        self.folder = folder
        self.program = folder / ("replay_fmu.exe" if sys.platform == "win32" else "replay_fmu")
        build.compile_c(
            [SOURCE],
            build.host_target(),
            self.program,
            include=(FMI_HEADERS,),
            what="the program that repeats steps",
            shared=False,
        )
        library = folder / "binaries" / fmpy.platform / name
        self._command = [str(self.program), str(library), folder.joinpath("resources").as_uri(), description.guid]

    def _arguments(self, worst: Worst, kinds: str, step: float, repeats: int) -> list[str]:
        state, inputs = self.folder / "worst.state", self.folder / "worst.inputs"
        state.write_bytes(worst.stretch.state)
        inputs.write_bytes(np.array(worst.stretch.inputs[: worst.steps], dtype="<f8").tobytes())
        numbers = (worst.stretch.time, step, worst.steps, repeats)
        return [*self._command, str(state), str(inputs), kinds, *map(repr, numbers)]

    def time(self, worst: Worst, kinds: str, step: float) -> float:
        """Least processor time of the step, us, of `REPEATS` repetitions; NaN where the system tells none."""
        arguments = self._arguments(worst, kinds, step, REPEATS)
        done = subprocess.run(arguments, capture_output=True, text=True, check=True)
        return 1e-3 * min(map(int, done.stdout.split())) or float("nan")

    def instructions(self, worst: Worst, kinds: str, step: float) -> int | None:
        """Instructions of the step, counted by valgrind; None where it is not installed."""
        if counter() is None:
            return None
        worst = self._last_two(worst, kinds, step)
        whole = instructions(self._arguments(worst, kinds, step, 1), "fmi2DoStep")
        if whole is None or worst.steps == 1:
            return whole
        shorter = Worst(worst.cost, worst.iterations, worst.stretch, 1)
        before = instructions(self._arguments(shorter, kinds, step, 1), "fmi2DoStep")
        return None if before is None else whole - before

    def _last_two(self, worst: Worst, kinds: str, step: float) -> Worst:
        """The same step with one before it: valgrind is slow, and need not make the others."""
        skipped = worst.steps - 2
        if skipped < 1:
            return worst
        later = self.folder / "later.state"
        subprocess.run([*self._arguments(worst, kinds, step, 1), str(later)], capture_output=True, check=True)
        inputs = worst.stretch.inputs[skipped : worst.steps]
        stretch = Stretch(worst.stretch.time + skipped * step, later.read_bytes(), inputs)
        return Worst(worst.cost, worst.iterations, stretch, 2)

    def measure(self, costs: Costs, step: float) -> dict[str, float | int | None]:
        """The worst of the kept steps: least time, us, of the slowest; instructions of that with most iterations."""
        times = [self.time(worst, costs.kinds, step) for worst in costs.worst]
        most = max(costs.worst, key=lambda worst: worst.iterations)
        return {"replayed_us": max(times), "instructions": self.instructions(most, costs.kinds, step)}

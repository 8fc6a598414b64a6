"""A run that a person waits for and looks at."""

from __future__ import annotations

from ali3.bars import bar as bar_of
from hosts.driving.co_simulation import run
from hosts.driving.ground_marks import marked
from hosts.driving.manoeuvre import Manoeuvre
from hosts.driving.pilots.pilot import Pilot
from hosts.driving.result import Result
from hosts.driving.simulated_fmu import SimulatedFmu


def run_with_bar(
    fmu: SimulatedFmu, manoeuvre: Manoeuvre, step: float, driver: Pilot | None = None, every: int = 1
) -> Result:
    """`run` with a progress bar on the terminal, and with marks on the ground; its last step always has a row."""
    steps, what = max(1, round(manoeuvre.stop_time / step)), f"{fmu.path.stem}, {manoeuvre.name}"
    with bar_of(total=steps, desc=what, unit="step") as bar:
        result = run(fmu, manoeuvre, step, driver, lambda done: bar.update(done - bar.n), every=every, last=True)
    return marked(result, driver)

"""Tyre marks of a run whose columns have the names of another program."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ali3.scene.recording import Recording
from hosts.fmu.fmu import Fmu
from hosts.fmu.geometry import scene_of
from viewer.page_file import write_page

STEP = 0.002  # s
STEPS = 600


def braked(fmu: Path, names: str) -> Recording:
    """Full braking from 20 m/s."""
    with Fmu(fmu) as car:
        inputs, outputs = car.names("input"), car.names("output")
        car.initialise({"initial.speed": 20.0})
        input_values = car.start_values(inputs)
        input_values[inputs.index({"carmaker": "DM.Brake"}.get(names, "brake"))] = 1.0
        car.setter(inputs)(input_values.tolist())
        read = car.getter(outputs)
        rows = [list(read())]
        for k in range(STEPS):
            car.step(STEP * k, STEP)
            rows.append(list(read()))
    values = np.array(rows)
    columns = {name: values[:, k] for k, name in enumerate(outputs)}
    return Recording(scene_of(fmu), STEP * np.arange(STEPS + 1), columns, name=names)


@pytest.mark.proof  # an FMU tells the names (`test_built_names.py`), the page reads them (`effects.test.js`)
def test_a_run_with_the_names_of_carmaker_leaves_the_marks_of_ours(
    chromium: Any, prototype_fmu: Path, renamed_fmu: Callable[[str], Path], tmp_path: Path
) -> None:
    counts = []
    for names, fmu in (("ours", prototype_fmu), ("carmaker", renamed_fmu("carmaker"))):
        file = tmp_path / f"{names}.html"
        write_page(file, braked(fmu, names), options={"time": 1.0})
        page = chromium.new_page(viewport={"width": 320, "height": 180})
        page.goto(file.as_uri())
        page.evaluate("async () => { await player.ready; }")
        assert page.evaluate("player.drawnRuns[0].traces.marks.problem") == ""
        counts.append(page.evaluate("player.drawnRuns[0].traces.marks.count"))
        page.close()
    assert counts[0] == counts[1] > 50

"""Reference results of the default experiment in the layered standard fmi-ls-ref: an importer can check itself."""

from __future__ import annotations

from dataclasses import dataclass
from xml.etree import ElementTree

import numpy as np
from numpy.typing import NDArray

import mbs
from fmu_src.description.description import number, to_bytes

FOLDER = "extra/org.fmi-standard.fmi-ls-ref"
_NAMESPACE = "http://fmi-standard.org/fmi-ls-manifest"
_ROWS = 100


@dataclass(frozen=True)
class ReferenceRun:
    """The default experiment: no input touched.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Times, s.
    columns : dict of str to ndarray, shape (n,)
        Outputs by name.
    """

    t: NDArray[np.float64]
    columns: dict[str, NDArray[np.float64]]


def reference_run(system: mbs.System) -> ReferenceRun:
    """Run the default experiment; about a hundred rows.

    Raises
    ------
    SimulationError
        When it does not run; the sentence names what of the scene sets it.
    """
    experiment = system.meta["experiment"]
    step = float(experiment["step_s"])
    steps = max(1, round(float(experiment["stop_time_s"]) / step))
    every = max(1, steps // _ROWS)
    try:
        run = mbs.simulate(system, steps * step, step, every=every, progress=False)
    except mbs.SimulationError as error:
        raise mbs.SimulationError(
            f"The default experiment, {steps * step:g} s in steps of {step:g} s as `m.stop_time` and `m.step` of the "
            f"scene say, does not run: {error}",
            error.time,
            error.status,
            error.trajectory,
        ) from None
    return ReferenceRun(np.asarray(run.t), {name: np.asarray(run[name]) for name in run})


def reference_files(name: str, run: ReferenceRun, stop_time: float, step: float) -> dict[str, bytes]:
    """Manifest, experiment and results.

    Parameters
    ----------
    name : str
        Of the model.
    run : ReferenceRun
    stop_time, step : float
        Default experiment, s.

    Returns
    -------
    dict of str to bytes
        By path in the FMU.
    """
    result = f"{name}_out.csv"
    head = ",".join(['"time"', *(f'"{column}"' for column in run.columns)])
    rows = np.column_stack([run.t, *run.columns.values()])
    text = "\n".join([head, *(",".join(number(v) for v in row) for row in rows)]) + "\n"
    ElementTree.register_namespace("fmi-ls", _NAMESPACE)
    manifest = ElementTree.Element(
        "fmiReferences",
        {
            f"{{{_NAMESPACE}}}fmi-ls-name": "org.fmi-standard.fmi-ls-ref",
            f"{{{_NAMESPACE}}}fmi-ls-version": "1.0.0-alpha.1",
            f"{{{_NAMESPACE}}}fmi-ls-description": "Layered Standard providing information on related files included "
            "in an FMU.",
        },
    )
    for source, kind, role, words in (
        ("experiments.xml", "application/xml", "experiment/smoke-test", "The default experiment"),
        (result, "text/csv", "result", "Outputs of the default experiment, no input touched"),
    ):
        ElementTree.SubElement(manifest, "Related", source=source, type=kind, role=role, description=words)
    experiments = ElementTree.Element("Experiments")
    experiment = ElementTree.SubElement(
        experiments,
        "Experiment",
        name="default",
        description="Default experiment, no input touched",
        startTime="0.0",
        stopTime=number(stop_time),
        stepSize=number(step),
    )
    ElementTree.SubElement(experiment, "References", source=result)
    return {
        f"{FOLDER}/fmi-ls-manifest.xml": to_bytes(manifest),
        f"{FOLDER}/experiments.xml": to_bytes(experiments),
        f"{FOLDER}/{result}": text.encode(),
    }

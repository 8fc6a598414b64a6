"""Newton iterations of ALi3-P with the paper's start value of a step, and with extrapolation from past steps."""

from typing import Any

from benchmarks.car import manoeuvres
from benchmarks.shared.pages import table
from mbs import Settings, compile, simulate
from mbs.scenes import double_four_bar, flyball, spatial_chain

END = 2.0  # s
CAR_STEP = 0.01  # s
SCENES = (
    ("double four-bar", double_four_bar, 0.01),
    ("chain of ten links", spatial_chain, 0.005),
    ("governor with stiff dampers", flyball, 0.01),
)
PREDICTORS = {"paper's start value": "acceleration", "extrapolation": "parabola"}


def start_value_table() -> str:
    """Table of mean iterations per step over `END`; for the car the least and the largest mean of its manoeuvres."""
    rows: list[dict[str, Any]] = []
    for name, scene, h in SCENES:
        system, row = compile(scene.build()), {"scene": name, "h, s": f"{h:g}"}
        for title, predictor in PREDICTORS.items():
            run = simulate(system, END, h, settings=Settings(predictor=predictor), estimate_error=False)
            row[title] = f"{run.report.mean_iterations:.2f}"
        rows.append(row)
    car = {"scene": "car, by manoeuvre", "h, s": f"{CAR_STEP:g}"}
    for title, predictor in PREDICTORS.items():
        runs = (manoeuvres.run(name, CAR_STEP, settings=Settings(predictor=predictor)) for name in manoeuvres.NAMES)
        means = sorted(run.report.mean_iterations for run in runs if run.report is not None)
        car[title] = f"{means[0]:.1f} to {means[-1]:.1f}"
    return table([*rows, car], dict.fromkeys(car, ""))

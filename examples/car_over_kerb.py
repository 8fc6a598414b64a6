"""A car with a flexible frame rolls down a kerb, the paper's test: python examples/car_over_kerb.py [PICTURE]"""

import sys

import numpy as np
from matplotlib.figure import Figure

import mbs
from mbs.scenes import kerb_test
from mbs.vehicle import Fidelity

WHEELS, GAUGES = ("FL", "RL"), ("SG1", "SG3")  # front and rear


def main(picture: str = "car_over_kerb.png") -> float:
    """Largest difference of the bending moments of a rigid and a flexible frame, over their largest change."""
    figure = Figure(figsize=(9.0, 5.4), layout="constrained")
    panels = figure.subplots(2, 2, sharex=True)
    moments = []
    for fidelity in (Fidelity.DYNAMIC, Fidelity.QUASI_STATIC):
        system = mbs.compile(kerb_test.build(fidelity))
        run = mbs.simulate(system, t_end=kerb_test.DURATION, h=kerb_test.STEP, progress=False)
        moments.append(np.array([run[f"bending_moment.{gauge}"] for gauge in GAUGES]))
        weight = sum(run[f"wheel_{wheel}.Fz"] for wheel in ("FL", "FR", "RL", "RR"))
        fall = run["chassis.z"][0] - run["chassis.z"][-1]
        print(f"{fidelity.description}: {system.nq} coordinates, {run.report.mean_iterations:.2f} iterations a step")
        print(
            f"  falls by {fall:.4f} m of {kerb_test.HEIGHT} m; loads {weight[0]:.1f} N before, {weight[-1]:.1f} N after"
        )
        print(f"  half-bridge SG1: largest stress {np.abs(run['stress.SG1']).max() / 1e6:.2f} MPa")
        for panel, wheel in zip(panels[0], WHEELS, strict=True):
            panel.plot(run.t, run[f"wheel_{wheel}.Fz"])
            panel.set(ylabel=f"load of wheel {wheel}, N", xlim=(7.5, 9.5))
        for panel, gauge, moment in zip(panels[1], GAUGES, moments[-1], strict=True):
            panel.plot(run.t, moment, label=fidelity.name.lower() if gauge == GAUGES[0] else None)
            panel.set(xlabel="time, s", ylabel=f"bending moment {gauge}, N m")
    change = np.abs(moments[0] - moments[0][:, :1]).max()
    difference = float(np.abs(moments[1] - moments[0]).max() / change)
    print(f"moments differ by up to {difference:.1%} of their change: vibration of the frame")
    figure.legend(loc="outside upper left", ncols=2)
    figure.savefig(picture, dpi=90)
    return difference


if __name__ == "__main__":
    main(*sys.argv[1:])

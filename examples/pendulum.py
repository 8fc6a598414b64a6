"""A pendulum from 120 degrees against its closed form: python examples/pendulum.py [PICTURE]"""

import sys

import numpy as np
from matplotlib.figure import Figure
from scipy.special import ellipj, ellipk

import mbs

LENGTH, GRAVITY, START = 1.0, 9.81, np.radians(120.0)  # m, m/s2, rad from hanging


def pendulum() -> mbs.Model:
    """A uniform rod on a hinge."""
    m = mbs.Model("pendulum", dimension=2, gravity=(0.0, -GRAVITY))
    centre = (0.5 * LENGTH * np.sin(START), -0.5 * LENGTH * np.cos(START))
    rod = m.body("rod", mass=1.0, com=centre, inertia=LENGTH**2 / 12.0)
    m.revolute("hinge", m.ground, rod, point=(0.0, 0.0))
    angle = m.relative_angle("angle", m.ground, rod)
    m.sense_coordinate("swing", angle, description="Angle from the start")
    return m


def closed_form(t: np.ndarray) -> np.ndarray:
    """Angle from hanging, rad: theta'' = -(3 g / 2 L) sin(theta), released at START."""
    k = np.sin(0.5 * START)
    sn, _, _, _ = ellipj(ellipk(k**2) - np.sqrt(1.5 * GRAVITY / LENGTH) * t, k**2)
    return 2.0 * np.arcsin(k * sn)


def main(picture: str = "pendulum.png") -> float:
    """Order of convergence of the default method, which is two."""
    system = mbs.compile(pendulum())
    steps, errors = [0.008, 0.004, 0.002, 0.001], []
    for h in steps:
        run = mbs.simulate(system, t_end=5.0, h=h, estimate_error=False)
        errors.append(np.abs(START + run["swing"] - closed_form(run.t)).max())
        print(f"steps of {h:g} s: largest error {errors[-1]:.1e} rad")
    order = float(np.polyfit(np.log(steps), np.log(errors), 1)[0])
    print(f"order of convergence: {order:.3f}")
    figure = Figure(figsize=(9.0, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.plot(run.t, np.degrees(closed_form(run.t)), label="closed form")
    left.plot(run.t[::50], np.degrees(START + run["swing"][::50]), ".", label="ALi3-P")
    left.set(xlabel="time, s", ylabel="angle from hanging, deg")
    figure.legend(loc="outside upper left", ncols=2)
    right.loglog(1e3 * np.array(steps), errors, "o-", base=2)
    right.set(xlabel="step, ms", ylabel="largest error, rad")
    right.xaxis.set_major_formatter("{x:g}")
    right.yaxis.set_major_formatter("{x:.1e}")
    figure.savefig(picture, dpi=90)
    return order


if __name__ == "__main__":
    main(*sys.argv[1:])

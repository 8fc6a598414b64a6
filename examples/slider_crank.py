"""A crank that turns 120 times: a warning, and a tolerance: python examples/slider_crank.py [PICTURE]"""

import sys
import warnings

import numpy as np
from matplotlib.figure import Figure

import mbs

TORQUE, CRANK, ROD = 4.0, 0.1, 0.3  # N m, m, m


def slider_crank() -> mbs.Model:
    """A crank with a motor, a rod, and a piston on a horizontal line, without gravity."""
    m = mbs.Model("slider-crank", dimension=2, gravity=(0.0, 0.0))
    crank = m.body("crank", mass=1.0, com=(0.05, 0.0), inertia=0.001)
    rod = m.body("rod", mass=0.5, com=(0.25, 0.0), inertia=0.004)
    piston = m.point_mass("piston", mass=0.8, position=(CRANK + ROD, 0.0))
    m.revolute("main bearing", m.ground, crank, point=(0.0, 0.0))
    m.revolute("big end", crank, rod, point=(CRANK, 0.0))
    m.spherical("small end", rod, piston, point=(CRANK + ROD, 0.0))
    m.point_on_line("bore", (piston, None), (m.ground, (0.0, 0.0)), axis=(1.0, 0.0))
    angle = m.relative_angle("crank angle", m.ground, crank)
    m.torque_on("motor", angle, input=m.input("torque", start=TORQUE, unit="N.m"))
    m.sense_coordinate("angle", angle)
    m.sense_coordinate("speed", angle, order=1)
    return m


def exact_speed(angle: np.ndarray) -> np.ndarray:
    """Angular velocity of the crank, rad/s: the work of the torque is the kinetic energy."""
    s, c = CRANK * np.sin(angle), CRANK * np.cos(angle)
    turn = c / np.sqrt(ROD**2 - s**2)  # of the rod, per angular velocity of the crank
    inertia = 0.0035 + 0.5 * (s**2 * (1.0 + 0.5 * turn) ** 2 + 0.25 * c**2) + 0.004 * turn**2
    return np.sqrt(2.0 * TORQUE * angle / (inertia + 0.8 * s**2 * (1.0 + turn) ** 2))


def main(picture: str = "slider_crank.png") -> float:
    """Largest relative error of the speed in the run with a tolerance."""
    system = mbs.compile(slider_crank())
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        coarse = mbs.simulate(system, t_end=2.0, h=0.001)
    fine = mbs.simulate(system, t_end=2.0, tolerance=1e-3, times=coarse.t)
    print(f"with h = 1 ms: {caught[0].message}\n\nwith a tolerance: {fine}\n")
    errors = [np.abs(run["speed"][1:] / exact_speed(run["angle"][1:]) - 1.0) for run in (coarse, fine)]
    print(f"error of the speed: {errors[0].max():.1e} with h = 1 ms, {errors[1].max():.1e} with the tolerance")
    figure = Figure(figsize=(9.0, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2, subplot_kw={"xlabel": "time, s"})
    left.plot(coarse.t, coarse["speed"], fine.t, fine["speed"])
    right.semilogy(fine.t[1:], np.transpose(errors))
    left.set_ylabel("crank, rad/s")
    right.set_ylabel("relative error; blue: h = 1 ms")
    figure.savefig(picture, dpi=90)
    return float(errors[1].max())


if __name__ == "__main__":
    main(*sys.argv[1:])

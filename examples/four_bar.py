"""Three cranks and two couplers through ten singular positions: python examples/four_bar.py [PICTURE]

Where the cranks lie along the ground all links are in line: the constraint equations lose rank there, and the motion
could branch.
"""

import sys

import numpy as np
from matplotlib.figure import Figure
from scipy.integrate import solve_ivp

import mbs

LENGTH, MASS, GRAVITY, SPEED = 1.0, 1.0, 9.81, 1.0  # m, kg, m/s2, rad/s clockwise at the top


def double_four_bar() -> mbs.Model:
    """Uniform links; the cranks stand upright on the ground, the couplers join their tips."""
    m = mbs.Model("double four-bar", dimension=2, gravity=(0.0, -GRAVITY))
    inertia = MASS * LENGTH**2 / 12.0
    cranks = [m.body(f"crank {i}", mass=MASS, com=(i * LENGTH, 0.5 * LENGTH), inertia=inertia) for i in range(3)]
    for i, crank in enumerate(cranks):
        m.revolute(f"A{i}", m.ground, crank, point=(i * LENGTH, 0.0))
    for i in range(2):
        coupler = m.body(f"coupler {i}", mass=MASS, com=((i + 0.5) * LENGTH, LENGTH), inertia=inertia)
        m.revolute(f"B{i} left", cranks[i], coupler, point=(i * LENGTH, LENGTH))
        m.revolute(f"B{i} right", cranks[i + 1], coupler, point=((i + 1) * LENGTH, LENGTH))
    m.initial_velocity(cranks[0], angular=-SPEED)
    for component in "xy":
        m.sense_position(f"tip.{component}", cranks[0], (0.0, LENGTH), component)
    m.sense_energy("energy")
    return m


def one_angle(t: np.ndarray) -> np.ndarray:
    """The cranks stay parallel: (3/3 + 2) L theta'' = (3/2 + 2) g sin(theta), theta clockwise from the top."""
    factor, start = 3.5 / 3.0 * GRAVITY / LENGTH, [0.0, SPEED]
    return solve_ivp(lambda _, x: [x[1], factor * np.sin(x[0])], (0.0, t[-1]), start, "DOP853", t, rtol=1e-11).y[0]


def main(picture: str = "four_bar.png") -> float:
    """Largest error of the tip of the first crank in 10 s, m."""
    run = mbs.simulate(mbs.compile(double_four_bar()), t_end=10.0, h=0.005)
    angle = one_angle(run.t)
    error = float(np.hypot(run["tip.x"] - LENGTH * np.sin(angle), run["tip.y"] - LENGTH * np.cos(angle)).max())
    print(f"{np.sum(np.diff(np.sign(run['tip.y'])) != 0)} singular positions, largest error {error:.1e} m")
    figure = Figure(figsize=(9.0, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.plot(run.t, run["tip.y"], run.t[::40], LENGTH * np.cos(angle[::40]), ".")
    left.set(xlabel="time, s", ylabel="height of the tip, m; dots: one angle")
    right.semilogy(run.t[1:], np.abs(run["energy"] - run["energy"][0])[1:])
    right.set(xlabel="time, s", ylabel="change of the energy, J")
    figure.savefig(picture, dpi=90)
    return error


if __name__ == "__main__":
    main(*sys.argv[1:])

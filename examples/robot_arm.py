"""Torques of the motors of an arm on a given path, inverse dynamics: python examples/robot_arm.py [PICTURE]"""

import sys

import numpy as np
from matplotlib.figure import Figure
from scipy.interpolate import BPoly, PPoly

import mbs

MASS, LENGTH, GRAVITY = (4.0, 2.0), (0.5, 0.4), 9.81  # kg, m, m/s2; uniform links
TIMES, ANGLES = (0.0, 1.0, 2.0, 3.0), np.radians([[0.0, 40.0, 100.0, 90.0], [0.0, 60.0, -30.0, 20.0]])  # s, rad
PATH = [PPoly.from_bernstein_basis(BPoly.from_derivatives(TIMES, [[a, 0.0, 0.0] for a in row])) for row in ANGLES]


def robot_arm() -> mbs.Model:
    """Two links in a vertical plane, drawn stretched out; each hinge follows its path."""
    m = mbs.Model("robot arm", dimension=2, gravity=(0.0, -GRAVITY))
    previous, hinge_x = m.ground, 0.0
    for k, (mass, length) in enumerate(zip(MASS, LENGTH, strict=True)):
        link = m.body(f"link {k}", mass=mass, com=(hinge_x + 0.5 * length, 0.0), inertia=mass * length**2 / 12.0)
        m.revolute(f"hinge {k}", previous, link, point=(hinge_x, 0.0))
        angle = m.relative_angle(f"angle {k}", previous, link)
        motor = m.drive(f"motor {k}", angle, m.guide_time(f"path {k}", PATH[k], unit="rad"))
        m.sense_joint(f"torque {k}", motor, "drive")
        previous, hinge_x = link, hinge_x + length
        for component in "xy":
            m.sense_position(f"end {k} {component}", link, (hinge_x, 0.0), component)
    return m


def closed_form(t: np.ndarray) -> np.ndarray:
    """Both torques, N m, from Lagrange's equations of the two angles."""
    (m1, m2), (l1, l2) = MASS, LENGTH
    (a, b), (ad, bd), (add, bdd) = ([p(t, k) for p in PATH] for k in range(3))
    inertia, coupling, centrifugal = m2 * l2**2 / 3.0, 0.5 * m2 * l1 * l2 * np.cos(b), 0.5 * m2 * l1 * l2 * np.sin(b)
    second = (inertia + coupling) * add + inertia * bdd + centrifugal * ad**2 + 0.5 * m2 * l2 * GRAVITY * np.cos(a + b)
    first = (m1 / 3.0 + m2) * l1**2 * add + coupling * (add + bdd) - centrifugal * (ad + bd) ** 2
    return np.array([first + (0.5 * m1 + m2) * l1 * GRAVITY * np.cos(a) + second, second])


def main(picture: str = "robot_arm.png") -> float:
    """Largest difference of the torques from the closed form, divided by the largest torque."""
    run = mbs.simulate(mbs.compile(robot_arm()), t_end=TIMES[-1], h=0.002)
    results, expected = np.array([run["torque 0"], run["torque 1"]]), closed_form(run.t)
    difference = float(np.abs(results - expected).max() / np.abs(expected).max())
    print(f"torques up to {np.abs(results).max():.1f} N m, {difference:.1e} of that from the closed form")
    figure = Figure(figsize=(9.0, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.6))
    x, y = (np.array([0.0 * run.t, run[f"end 0 {c}"], run[f"end 1 {c}"]]) for c in "xy")
    left.plot(x[:, ::125], y[:, ::125], "k-o", x[2], y[2], lw=0.7, ms=2)
    left.set(xlabel="m", ylabel="m", aspect="equal")
    right.plot(run.t, results.T, run.t[::50], expected.T[::50], "k.")
    right.set(xlabel="time, s", ylabel="torques, N m; dots: closed form")
    figure.savefig(picture, dpi=90)
    return difference


if __name__ == "__main__":
    main(*sys.argv[1:])

"""A disc that rolls in a circle, and one that wobbles: python examples/rolling_disc.py [PICTURE]"""

import sys

import numpy as np
from matplotlib.figure import Figure

import mbs

MASS, RADIUS, GRAVITY = 2.0, 0.3, 9.81  # kg, m, m/s2
LEAN, TURN = np.radians(20.0), -1.5  # rad from upright, rad/s about the vertical


def steady_spin() -> float:
    """Angular velocity about the axis, rad/s, with which the disc keeps its lean: moments about its centre."""
    gyroscopic = 0.25 * RADIUS * TURN**2 * np.cos(LEAN) * np.sin(LEAN)
    return float((gyroscopic - GRAVITY * np.sin(LEAN)) / (1.5 * RADIUS * TURN * np.cos(LEAN)))


def disc(spin: float) -> mbs.Model:
    """A thin disc that leans and rolls without slip on the plane z = 0."""
    m = mbs.Model("disc", gravity=(0.0, 0.0, -GRAVITY))
    axis, up = np.array([0.0, np.cos(LEAN), np.sin(LEAN)]), np.array([0.0, -np.sin(LEAN), np.cos(LEAN)])
    inertia = 0.25 * MASS * RADIUS**2 * (np.eye(3) + np.outer(axis, axis))
    wheel = m.body("wheel", mass=MASS, com=RADIUS * up, inertia=inertia)
    m.rolling("ground", wheel, radius=RADIUS, centre=RADIUS * up, axis=axis)
    angular_velocity = TURN * np.cos(LEAN) * up + spin * axis
    m.initial_velocity(wheel, linear=np.cross(angular_velocity, RADIUS * up), angular=angular_velocity)
    for component in "xyz":
        m.sense_position(f"centre.{component}", wheel, None, component)
    m.sense_energy("energy")
    return m


def main(picture: str = "rolling_disc.png") -> float:
    """Largest distance of the centre from its circle, m, in steady rolling."""
    spin = steady_spin()
    figure = Figure(figsize=(9.0, 3.6), layout="constrained")
    left, right = figure.subplots(1, 2)
    for name, factor in (("spin 20 % slower", 0.8), ("steady", 1.0)):
        run = mbs.simulate(mbs.compile(disc(factor * spin)), t_end=8.0, h=0.005)
        left.plot(run["centre.x"], run["centre.y"], label=name)
        right.plot(run.t, run["centre.z"])
        print(f"{name}: energy changes by {np.ptp(run['energy']):.1e} J of {run['energy'][0]:.1f} J")
    radius = spin * RADIUS / TURN  # signed: the middle of the circle is beside the centre as drawn
    radial_error = np.hypot(run["centre.x"], run["centre.y"] - run["centre.y"][0] - radius) - abs(radius)
    error = float(np.hypot(radial_error, run["centre.z"] - RADIUS * np.cos(LEAN)).max())
    print(f"in steady rolling the centre stays within {error:.1e} m of its circle of {abs(radius):.3f} m radius")
    left.set(xlabel="x of the centre, m", ylabel="y, m", aspect="equal")
    right.set(xlabel="time, s", ylabel="height of the centre, m")
    figure.legend(loc="outside upper left", ncols=2)
    figure.savefig(picture, dpi=90)
    return error


if __name__ == "__main__":
    main(*sys.argv[1:])

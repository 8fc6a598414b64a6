"""A beam that bends under its weight while it turns once: python examples/flexible_beam.py [PICTURE]"""

import sys

import numpy as np
from matplotlib.figure import Figure
from scipy.interpolate import BPoly, PPoly

import mbs
from mbs.flexible import Beam, Frame, Interface, Material, craig_bampton
from mbs.flexible.section import tube

LENGTH, ELEMENTS, TURN, GRAVITY = 2.5, 8, 60.0, 9.81  # m, one, s, m/s2
ALUMINIUM, SECTION = Material(E=70e9, nu=0.33, rho=2700.0), tube(outer_diameter=0.03, wall=0.002)
ANGLE = PPoly.from_bernstein_basis(BPoly.from_derivatives([0.0, TURN], [[0.0, 0.0, 0.0], [2.0 * np.pi, 0.0, 0.0]]))


def flexible_beam() -> mbs.Model:
    """A tube on a hub that turns about the horizontal y axis; finite elements, reduced to modes."""
    nodes = np.column_stack([np.linspace(0.0, LENGTH, ELEMENTS + 1), np.zeros((ELEMENTS + 1, 2))])
    frame = Frame(nodes, [Beam(i, i + 1, SECTION, ALUMINIUM) for i in range(ELEMENTS)])
    interfaces = [Interface(ELEMENTS, rotations=True)]
    reduced = craig_bampton(frame.finite_element_model(), reference=0, interfaces=interfaces, inertia_modes=True)
    m = mbs.Model("flexible beam", gravity=(0.0, 0.0, -GRAVITY))
    m.start_in_equilibrium = True
    beam = m.flexible_body("beam", reduced)
    root, tip = beam.interface(0), beam.interface(ELEMENTS)
    m.revolute("hub", m.ground, root, point=(0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0))
    angle = m.relative_angle("angle", m.ground, root, axis=(0.0, 1.0, 0.0))
    motor = m.drive("motor", angle, m.guide_time("turn", ANGLE, unit="rad"))
    m.sense_joint("torque", motor, "drive")
    for component in "xz":
        m.sense_position(f"tip.{component}", tip, (LENGTH, 0.0, 0.0), component)
    return m


def main(picture: str = "flexible_beam.png") -> float:
    """Largest difference from the deflection of a slowly turned cantilever, divided by the largest deflection."""
    run = mbs.simulate(mbs.compile(flexible_beam()), t_end=TURN, h=0.02)
    angle, load = ANGLE(run.t), ALUMINIUM.rho * SECTION.area * GRAVITY
    deflection = np.sin(angle) * run["tip.x"] + np.cos(angle) * run["tip.z"]
    closed_form = -load * LENGTH**4 / (8.0 * ALUMINIUM.E * SECTION.Iy) * np.cos(angle)
    difference = float(np.abs(deflection - closed_form).max() / np.abs(closed_form).max())
    print(f"deflection up to {1e3 * np.abs(deflection).max():.2f} mm, {difference:.1e} of that from the closed form")
    figure = Figure(figsize=(9.0, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.6))
    left.plot(run["tip.x"], run["tip.z"])
    for i in range(0, len(run.t), 300):
        left.plot([0.0, run["tip.x"][i]], [0.0, run["tip.z"][i]], "k-", lw=0.4)
    left.set(xlabel="x of the free end, m", ylabel="z, m", aspect="equal")
    right.plot(np.degrees(angle), 1e3 * deflection)
    right.plot(np.degrees(angle[::150]), 1e3 * closed_form[::150], "k.")
    right.set(xlabel="angle of the hub, deg", ylabel="deflection, mm; dots: closed form")
    figure.savefig(picture, dpi=90)
    return difference


if __name__ == "__main__":
    main(*sys.argv[1:])

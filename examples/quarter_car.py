"""Natural frequencies and damping of a quarter car with a tunable damper: python examples/quarter_car.py [PICTURE]"""

import sys

import numpy as np
from matplotlib.figure import Figure

import mbs

BODY, WHEEL, SPRING, TYRE, LOAD = 250.0, 35.0, 18e3, 180e3, 500.0  # kg, kg, N/m, N/m, N


def quarter_car() -> mbs.Model:
    """Two masses on a vertical line, in equilibrium, with the weight left out."""
    m = mbs.Model("quarter car", dimension=2, gravity=(0.0, 0.0))
    wheel = m.point_mass("wheel", mass=WHEEL, position=(0.0, 0.3))
    body = m.point_mass("body", mass=BODY, position=(0.0, 0.7))
    for part in (wheel, body):
        m.point_on_line(f"guide of the {part.name}", (part, None), (m.ground, (0.0, 0.0)), axis=(0.0, 1.0))
    m.spring_damper("tyre", (m.ground, (0.0, 0.0)), wheel, stiffness=TYRE)
    m.spring_damper("strut", wheel, body, stiffness=SPRING, damping=1500.0)
    m.parameter("damping", 1500.0, 0.0, 1e4, "N.s/m", targets=[("strut", "damping", 1.0)])
    m.force("load", body, inputs=[None, m.input("load", unit="N")])
    m.sense_position("body.height", body, None, "y")
    return m


def closed_form(damping: float) -> np.ndarray:
    """Eigenvalues with positive imaginary part, 1/s, from the matrices of the two masses."""
    coupling = np.array([[1.0, -1.0], [-1.0, 1.0]])
    K, M = SPRING * coupling + np.diag([TYRE, 0.0]), np.diag([WHEEL, BODY])
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(M, K), -np.linalg.solve(M, damping * coupling)]])
    return np.sort_complex([v for v in np.linalg.eigvals(A) if v.imag > 0.0])


def main(picture: str = "quarter_car.png") -> float:
    """Largest relative difference from the eigenvalues of the matrices."""
    system, dampings, results, runs = mbs.compile(quarter_car()), (200.0, 700.0, 1200.0, 1700.0), [], []
    for damping in dampings:
        model = mbs.linearise(mbs.Simulation(system, parameters={"damping": damping}))
        results.append(np.sort_complex([mode.eigenvalue for mode in model.oscillating_modes()]))
        runs.append(mbs.simulate(system, 2.0, 0.002, inputs={"load": -LOAD}, parameters={"damping": damping}))
        modes = ", ".join(f"{m.frequency_hz:.3f} Hz with {m.damping_ratio:.3f}" for m in model.oscillating_modes())
        print(f"damping {damping:g} N s/m: {modes} of the critical damping")
    difference = max(float(np.abs(f / closed_form(d) - 1.0).max()) for f, d in zip(results, dampings, strict=True))
    print(f"largest difference from the two-by-two matrices: {difference:.1e}")
    figure = Figure(figsize=(9.0, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2)
    left.plot(np.real(results), np.imag(results), "o")
    left.set(xlabel="real part of the eigenvalue, 1/s", ylabel="imaginary part, 1/s")
    for damping, run in zip(dampings, runs, strict=True):
        right.plot(run.t, 1e3 * (run["body.height"] - run["body.height"][0]), label=f"{damping:g} N s/m")
    right.set(xlabel=f"time after a load of {LOAD:g} N, s", ylabel="body, mm")
    figure.legend(loc="outside upper right", ncols=4)
    figure.savefig(picture, dpi=90)
    return difference


if __name__ == "__main__":
    main(*sys.argv[1:])

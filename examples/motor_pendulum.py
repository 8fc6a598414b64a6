"""A model of your own, its FMU, a run in FMPy: python examples/motor_pendulum.py [PICTURE]"""

import sys
from pathlib import Path

import fmpy

import mbs
from fmu_src.build.build import build_fmu

TORQUE = 4.0  # N m


def motor_pendulum() -> mbs.Model:
    """A rod that hangs on a hinge with a motor."""
    m = mbs.Model("motor pendulum", dimension=2)
    rod = m.body("rod", mass=2.0, com=(0.0, -0.5), inertia=0.17)
    m.revolute("hinge", m.ground, rod, point=(0.0, 0.0))
    angle = m.relative_angle("angle", m.ground, rod)
    torque = m.input("torque", min=-20.0, max=20.0, unit="N.m", description="Torque of the motor")
    m.torque_on("motor", angle, input=torque)
    m.sense_coordinate("rod.angle", angle, description="Angle of the rod, zero when it hangs")
    m.sense_position("rod.tip_x", rod, (0.0, -1.0), "x", description="Free end, horizontal")
    m.sense_energy("energy.total", description="Kinetic and potential energy")
    return m


def main(picture: str = "motor_pendulum.png") -> float:
    """Build and run; the largest angle, rad: there the work of the motor equals the work of the weight."""
    from matplotlib.figure import Figure  # the model needs none

    fmu = build_fmu(mbs.compile(motor_pendulum()), "motor_pendulum", Path("dist"), [fmpy.platform])
    result = fmpy.simulate_fmu(str(fmu), stop_time=5.0, output_interval=0.01, start_values={"torque": TORQUE})
    largest = float(max(result["rod.angle"]))
    print(f"{fmu}: the rod swings out to {largest:.3f} rad")
    figure = Figure(figsize=(9.0, 3.2), layout="constrained")
    left, right = figure.subplots(1, 2, subplot_kw={"xlabel": "time, s"})
    left.plot(result["time"], result["rod.angle"])
    left.set_ylabel("angle of the rod, rad")
    energy, work = result["energy.total"] - result["energy.total"][0], TORQUE * result["rod.angle"]
    right.plot(result["time"], energy, result["time"], work, "--")
    right.set_ylabel("change of energy, work of the motor, J")
    figure.savefig(picture, dpi=90)
    return largest


if __name__ == "__main__":
    main(*sys.argv[1:])

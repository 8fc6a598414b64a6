"""Simulates CommonRoad's own multi-body model and stores the references of `benchmarks.validation.commonroad`.

    python -m venv scratch && scratch/bin/pip install commonroad-vehicle-models==3.0.2
    scratch/bin/python benchmarks/validation/commonroad_reference.py

Classical Runge-Kutta method of order four with steps of 0.5 ms; every 20 ms is stored.
"""

import csv
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parents[2] / "tests" / "data" / "commonroad"
CARS = {"commonroad_escort": 1, "commonroad_320i": 2, "commonroad_vanagon": 3}
STEP = 0.0005  # s
STORED = 40  # steps between stored instants
STEER = 0.02  # rad
STEER_SPEED = 0.2  # rad/s
BEGIN = 3.0  # s: before, the model sinks by 2 cm to its equilibrium
BRAKING = 4.0  # m/s2
MANOEUVRES = {"step_steer": 20.0, "consistent_step_steer": 20.0, "braking": 25.0}
"""Initial speed, m/s; the second has the parameters of `consistent`."""
SECONDS = 6.0  # s, duration
COLUMNS = ("time", "x", "y", "vx", "yaw_rate", "roll", "pitch", "Fz_FL", "Fz_FR", "Fz_RL", "Fz_RR")


def inputs(manoeuvre: str, t: float) -> tuple[float, float]:
    """Rate of the steering angle, rad/s, and demanded acceleration, m/s2, at a time, s."""
    if manoeuvre != "braking":
        return (STEER_SPEED if BEGIN <= t < BEGIN + STEER / STEER_SPEED else 0.0), 0.0
    return 0.0, -BRAKING if t >= BEGIN else 0.0


def consistent(p: Any) -> None:
    """Change parameters so that inconsistencies of the model have no effect.

    Its moments for the whole car are about the centre of mass of the body, so both centres must coincide; its camber
    forces have the wrong sign; its tyre shifts change sign with the camber; its lateral tyre compliance affects the
    load only.
    """
    unsprung = p.m_uf + p.m_ur
    p.m_uf, p.m_ur = unsprung * p.b / (p.a + p.b), unsprung * p.a / (p.a + p.b)
    p.tire.p_hy3, p.tire.p_vy3, p.tire.r_vy3 = -p.tire.p_hy3, -p.tire.p_vy3, -p.tire.r_vy3
    p.tire.p_hy1 = p.tire.p_vy1 = p.K_lt = 0.0


def loads(x: list[float], p: Any) -> list[float]:
    """Loads of the wheels FL, FR, RL, RR, N: the axles roll by x[13] and x[18], rad, and compress by x[16] and x[21],
    m.

    The axes of that model point forward, right and down: a right turn of the model is stored as a left turn.
    """
    results = []
    for roll, z, track in ((x[13], x[16], p.T_f), (x[18], x[21], p.T_r)):
        mean = z + p.R_w * (math.cos(roll) - 1.0)
        results += [p.K_zt * (mean + 0.5 * track * math.sin(roll)), p.K_zt * (mean - 0.5 * track * math.sin(roll))]
    return results


def run(number: int, manoeuvre: str) -> list[list[float]]:
    """Rows of `COLUMNS` with the signs of ISO 8855: roll positive left side up, pitch positive nose down."""
    from vehiclemodels import parameters_vehicle1, parameters_vehicle2, parameters_vehicle3
    from vehiclemodels.init_mb import init_mb
    from vehiclemodels.vehicle_dynamics_mb import vehicle_dynamics_mb

    parameters_of: Callable[[], Any] = (
        parameters_vehicle1.parameters_vehicle1,
        parameters_vehicle2.parameters_vehicle2,
        parameters_vehicle3.parameters_vehicle3,
    )[number - 1]
    p = parameters_of()
    if manoeuvre.startswith("consistent"):
        consistent(p)
    x: list[float] = init_mb([0.0, 0.0, 0.0, MANOEUVRES[manoeuvre], 0.0, 0.0, 0.0], p)

    def rate(state: list[float], u: tuple[float, float]) -> list[float]:
        return list(vehicle_dynamics_mb(list(state), list(u), p))

    def advanced(state: list[float], slope: list[float], h: float) -> list[float]:
        return [a + h * b for a, b in zip(state, slope, strict=True)]

    rows = []
    for k in range(round(SECONDS / STEP) + 1):
        t = k * STEP
        if k % STORED == 0:
            rows.append([t, x[0], x[1], x[3], x[5], -x[6], -x[8], *loads(x, p)])
        u = inputs(manoeuvre, t)
        k1 = rate(x, u)
        k2 = rate(advanced(x, k1, 0.5 * STEP), u)
        k3 = rate(advanced(x, k2, 0.5 * STEP), u)
        k4 = rate(advanced(x, k3, STEP), u)
        x = [a + STEP / 6.0 * (b + 2.0 * c + 2.0 * d + e) for a, b, c, d, e in zip(x, k1, k2, k3, k4, strict=True)]
    return rows


def main() -> None:
    """Write a file for each car and manoeuvre."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, number in CARS.items():
        for manoeuvre in MANOEUVRES:
            file = FOLDER / f"{name}_{manoeuvre}.csv"
            with file.open("w", newline="", encoding="utf-8") as out:
                writer = csv.writer(out, lineterminator="\n")
                writer.writerow(COLUMNS)
                writer.writerows([[f"{value:.6g}" for value in row] for row in run(number, manoeuvre)])
            print(file)


if __name__ == "__main__":
    main()

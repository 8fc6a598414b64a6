"""Errors by steps in a period and by speed over a kerb, and the sentences of the page on trust from them."""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

import mbs
from benchmarks.car import accuracy, manoeuvres, trajectories
from benchmarks.shared.command import watched
from benchmarks.shared.figures import RemadeTable, between, read, rows_of
from benchmarks.shared.pages import Row, table

PERIODS = 20
STEPS_IN_A_PERIOD = (100, 50, 20, 10)
SPEEDS = (5.0, 10.0, 20.0, 30.0)  # m/s
STEPS = (0.001, 0.002, 0.005, 0.01)  # s
FINE_STEP = 2e-4  # s
BEFORE = 0.2  # s of the run before the kerb
AFTER = 1.0  # s of the run after the kerb
HARD_MANOEUVRES = {  # manoeuvres, with the direction of their largest acceleration
    "launch_and_brake": "vx",
    "step_steer_given_throttle": "vy",
    "double_lane_change_replay": "vy",
    "full_lock": "vy",
}
COLUMNS = {
    "frequency": {"steps_in_a_period": "d", "frequency_error": ".3g", "closed_form": ".3g"},
    "kerb": {"speed_m_s": "g"} | {f"{1e3 * h:g} ms": ".2g" for h in STEPS},
}


def frequency(steps: int) -> dict[str, Any]:
    """Frequency error of a mass on a spring, from its phase after `PERIODS`, beside (omega h)^2 / 12."""
    m = mbs.Model("oscillator", dimension=2, gravity=(0.0, 0.0))
    bob = m.point_mass("bob", mass=1.0, position=(1.0, 0.0))
    m.spring_damper("x", (m.ground, (-1e4, 0.0)), bob, stiffness=(2.0 * np.pi) ** 2, free_length=1e4)
    m.sense_position("x", bob, component="x")
    system = mbs.compile(m)
    h = 1.0 / steps
    run = mbs.simulate(system, float(PERIODS), h, progress=False, estimate_error=False)
    x = run["x"]
    crossings = np.flatnonzero((x[:-1] > 0.0) & (x[1:] <= 0.0))  # a quarter, five quarters ... of a period
    last_crossing = crossings[-1]
    periods = len(crossings) - 0.75
    time = run.t[last_crossing] + h * x[last_crossing] / (x[last_crossing] - x[last_crossing + 1])
    return {
        "steps_in_a_period": steps,
        "frequency_error": 1.0 - periods / time,
        "closed_form": (2.0 * np.pi * h) ** 2 / 12.0,
    }


def kerb(speed: float) -> dict[str, Any]:
    """Errors of the wheel loads, over their peak, straight down a kerb of 8 cm. `speed`: m/s."""
    system, file = manoeuvres.system_of("kerb_drop"), manoeuvres.load("kerb_drop")
    edge = BEFORE * speed
    base = system.meta["constants"]
    wheelbase = next(c["value"] for c in base if c["name"] == "vehicle.wheelbase")
    end = round(BEFORE + AFTER + wheelbase / speed, 1)
    start = file.start | {"initial.speed": speed, "road.kerb_x": edge}
    manoeuvre = replace(file, start=start, stop_time=end)

    def loads(h: float) -> np.ndarray:
        run = manoeuvres.run_on(system, manoeuvre, h, every=round(0.01 / h))
        return np.array([run[name] for name in trajectories.LOADS])

    exact = loads(FINE_STEP)
    errors = {f"{1e3 * h:g} ms": float(np.abs(loads(h) - exact).max() / exact.max()) for h in STEPS}
    return {"speed_m_s": speed} | errors


def largest_acceleration(name: str) -> float:
    """Largest horizontal acceleration in a manoeuvre of `HARD_MANOEUVRES`, from its stored reference, m/s2."""
    t, values, _ = trajectories.read(name)
    accelerations = values["chassis.ay"] if HARD_MANOEUVRES[name] == "vy" else np.gradient(values["speed"], t)
    return float(np.abs(accelerations).max())


def measure() -> list[dict[str, Any]]:
    """Rows of all tables, each with the name of its table."""
    cases: list[tuple[str, Any, tuple[Any, ...]]] = [("frequency", frequency, (n,)) for n in STEPS_IN_A_PERIOD]
    cases += [("kerb", kerb, (v,)) for v in SPEEDS]
    return [{"table": name} | work(*arguments) for name, work, arguments in watched(cases)]


def trust_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables of the page."""
    names = dict.fromkeys(row["table"] for row in rows)
    return {f"trust {name}": table([r for r in rows if r["table"] == name], COLUMNS[name]) for name in names}


def trust_sentences() -> list[RemadeTable]:
    """Sentences of the page on trust, from its tables and tables of other pages."""
    sentences = [*_trust_table_sentences(), *_car_error_sentences(), *_fidelity_sentences(), *_held_input_sentences()]
    return [RemadeTable("docs/trust.md", sentence.replace("%", " %").replace("  %", " %")) for sentence in sentences]


def _worst(cells: Iterable[str]) -> str:
    """The cell with the largest number, which is its first word."""
    return max(cells, key=lambda cell: float(cell.split()[0]))


def _trust_table_sentences() -> list[str]:
    """Errors at kerbs and of a frequency, from the tables of the page on trust."""
    kerb, period = (rows_of(between(read("docs/trust.md"), f"trust {name}")) for name in ("kerb", "frequency"))
    frequency_error = next(float(row["frequency error"]) for row in period if row["steps in a period"] == "20")
    largest = max(float(row["10 ms"]) for row in kerb)
    return [
        f"wheel loads to {largest:.1%} at 10 ms up to {kerb[-1]['speed m s']} m/s",
        f"20 steps in a period: {frequency_error:.1%} of the frequency",
    ]


def _car_error_sentences() -> list[str]:
    """Errors of the car at 10 ms, from the page on speed."""
    car_rows = {(r["manoeuvre"], r["h, ms"]): r for r in rows_of(between(read("docs/speed.md"), "car"))}
    errors = {name: row[accuracy.ERROR_COLUMN].split(", ") for (name, h), row in car_rows.items() if h == "10"}
    hard = [errors[accuracy.TITLES[name]] for name in HARD_MANOEUVRES]
    path, load = (_worst(cells[k] for cells in hard) for k in (0, 1))
    fastest = max(map(largest_acceleration, HARD_MANOEUVRES))
    return [
        f"path to {path} of its length, loads to {load} at 10 ms, up to {fastest:.0f} m/s²",
        f"wheel loads to {errors[accuracy.TITLES['drop']][1]} at 10 ms, a fall of 0.5 m",
    ]


def _fidelity_sentences() -> list[str]:
    """Errors of the chosen fidelities, from the page on the flexible car."""
    chosen = rows_of(between(read("docs/flexible_car.md"), "cheapest"))[1:]
    moments = [(r["error"], *r["cheapest fidelity, step"].split(", ")) for r in chosen]
    return [", ".join(f"{error} at fidelity {fidelity} ({step})" for error, fidelity, step in moments)]


def _held_input_sentences() -> list[str]:
    """Errors of an FMU with held inputs at 10 ms, from the page on FMUs; its last row is the hardest manoeuvre."""
    held = [r for r in rows_of(between(read("docs/fmu.md"), "held inputs")) if r["h, ms"] == "10"]
    *smooth, hardest = (row["FMU, inputs held"].split(", ") for row in held)
    path, load = (_worst(cells[k] for cells in smooth) for k in (0, 1))
    return [
        f"at 10 ms the path to {path}, loads to {load}",
        f"kerb, full lock and brake at once: {hardest[1]} of the load",
    ]

"""Sentences of the page on trust, made from tables of the pages."""

from collections.abc import Iterable

from benchmarks.car import accuracy, error_limits
from benchmarks.shared.figures import RemadeTable, between, read, rows_of


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
    hard = [errors[accuracy.TITLES[name]] for name in error_limits.HARD]
    path, load = (_worst(cells[k] for cells in hard) for k in (0, 1))
    fastest = max(map(error_limits.largest_acceleration, error_limits.HARD))
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

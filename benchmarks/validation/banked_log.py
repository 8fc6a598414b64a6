"""A log with the bank of the road as a force on the car, for an FMU with the ports ``forces=vehicle``."""

from __future__ import annotations

import gzip
from pathlib import Path

from benchmarks.validation.drive import Array

PORT = "point_reference.Fy"


def write_banked(folder: Path, log: Path, aliases: Path, bank: Array, mass: float) -> tuple[Path, Path]:
    """Write log and alias file once more, with mass times bank across the car at its reference point.

    `bank`: of each row of the log, m/s2, positive to the left, shape (n,); `mass`: of the car, kg. The loads of the
    wheels on a banked road are not in this force.
    """
    packed = log.suffix == ".gz"
    text = gzip.decompress(log.read_bytes()).decode() if packed else log.read_text(encoding="utf-8")
    head, *rows = text.splitlines()
    told = [f"{row},{mass * a!r}" for row, a in zip(rows, bank.tolist(), strict=True)]
    file, names = folder / "banked.csv", folder / "banked.toml"
    file.write_text("\n".join([f"{head},bank_force [N]", *told, ""]), encoding="utf-8")
    line = f'"{PORT}" = {{ name = "bank_force", unit = "N" }}\n'
    names.write_text(aliases.read_text(encoding="utf-8") + line, encoding="utf-8")
    return file, names

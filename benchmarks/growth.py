"""How cost grows: ``python -m benchmarks.growth [--json FILE] [--chart FILE] [--quick]``.

Time per step, memory and non-zeros of the factor of the N-four-bar for N = 1 to 1000 and of the car's frame with 5 to
200 dynamic modes, with fitted exponents; and the arithmetic of a step against what this machine could do in its time.
"""

from __future__ import annotations

import importlib.util
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

import mbs
from benchmarks.command import parser_of, pyplot, save_chart, save_rows, watched
from benchmarks.common import describe, machine, print_table
from mbs.flexible import craig_bampton
from mbs.kernel.build import FLAGS, cache_directory
from mbs.scenes import double_four_bar
from mbs.scenes.prototype_car.frame import DAMPING, INTERFACES, REFERENCE, prototype_frame

STEP, END = 0.01, 0.6  # s: up to before the first singular position
WINDOWS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)
ROUNDS = 9
MODES = (5, 10, 20, 50, 100, 200)  # dynamic ones of the chassis, beside 60 static and 6 inertia modes
CHASSIS_STEP, CHASSIS_STEPS, CHASSIS_ROUNDS = 0.005, 100, 5  # s
FITTED_FROM = 10  # N: below it the fixed cost of a step shows
METHODS = ("ali3p", "energy_momentum")
EXPONENTS = ("us_per_step", "us_per_iteration", "system_bytes", "factor_nonzeros", "operations_per_step")
TABLE = {
    "N": "d",
    "method": "",
    "coordinates": "d",
    "rows": "d",
    "factor_nonzeros": "d",
    "system_bytes": "d",
    "state_bytes": "d",
    "resident_bytes": "d",
    "iterations": ".2f",
    "us_per_step": ".2f",
    "us_per_iteration": ".3f",
    "operations_per_step": ".0f",
    "gflops": ".3f",
    "of_compiled_loop": ".1%",
    "of_dgemm": ".1%",
}
CHASSIS_TABLE = {
    "dynamic_modes": "d",
    "modes": "d",
    "coordinates": "d",
    "factor_nonzeros": "d",
    "system_bytes": "d",
    "state_bytes": "d",
    "iterations": ".2f",
    "us_per_step": ".1f",
    "us_per_iteration": ".1f",
}
CHASSIS_EXPONENTS = ("us_per_step", "us_per_iteration", "system_bytes", "factor_nonzeros")
LOOP = """
#include <stdio.h>
#include <time.h>
int main(void) {
  double a[64], b[64], best = 0.0;
  for (int turn = 0; turn < 5; turn++) {
    struct timespec s, e;
    for (int i = 0; i < 64; i++) { a[i] = 1.0 + 1e-9 * i; b[i] = 1.0 - 1e-9 * i; }
    clock_gettime(CLOCK_MONOTONIC, &s);
    for (long k = 0; k < 3000000; k++)
      for (int i = 0; i < 16; i++) a[i] = a[i] * b[i] + 1e-12;
    clock_gettime(CLOCK_MONOTONIC, &e);
    double t = (double)(e.tv_sec - s.tv_sec) + 1e-9 * (double)(e.tv_nsec - s.tv_nsec);
    double sum = 0.0;
    for (int i = 0; i < 64; i++) sum += a[i];
    double rate = sum > 0.0 ? 2.0 * 16.0 * 3000000.0 / t : 0.0;
    if (rate > best) best = rate;
  }
  printf("%.17g\\n", best);
  return 0;
}
"""
"""Independent multiply-adds on numbers that stay in registers."""
DGEMM = """
import time
import numpy as np
a = np.random.default_rng(0).random((384, 384))
best = 0.0
for _ in range(12):
    begin = time.perf_counter()
    a @ a
    best = max(best, 2.0 * 384.0**3 / (time.perf_counter() - begin))
print(best)
"""


def compiled_loop_peak() -> float | None:
    """Arithmetic operations per second of a small loop with the compiler and flags of the kernel (no fused
    operations, no instruction set beyond the platform's baseline); None without the compiler.
    """
    if importlib.util.find_spec("ziglang") is None:
        return None
    flags = [f for f in FLAGS if f not in ("-shared", "-fPIC", "-fvisibility=hidden")]
    cache = str(cache_directory())
    environment = os.environ | {"ZIG_GLOBAL_CACHE_DIR": cache, "ZIG_LOCAL_CACHE_DIR": cache}
    with tempfile.TemporaryDirectory() as folder:
        source, program = Path(folder) / "loop.c", Path(folder) / "loop.exe"
        source.write_text(LOOP, encoding="utf-8")
        command = [sys.executable, "-m", "ziglang", "cc", *flags, "-D_GNU_SOURCE", "-o", str(program), str(source)]
        subprocess.run(command, check=True, env=environment)
        return float(subprocess.run([str(program)], check=True, capture_output=True, text=True).stdout)


def dgemm_peak() -> float:
    """Operations per second of NumPy's matrix product in one thread: all vector instructions of the processor."""
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    result = subprocess.run(
        [sys.executable, "-c", DGEMM], check=True, capture_output=True, text=True, env=os.environ | threads
    )
    return float(result.stdout)


def operations(system: mbs.System, iterations: float, factorizations: float, solves: float) -> float:
    """Additions and multiplications of one step, from the patterns.

    Factorization of a front of m coordinates with p pivots: rank-one updates of lower triangles; a solve: two per
    non-zero of the factor, forward and back; rows: their terms, Phi_q and Phi_q' Phi_q; products with the mass matrix.
    """
    a = system.arrays
    sizes, pivots = np.diff(a["front_ptr"]), np.diff(a["front_col"])
    factor = factor_entries = 0.0
    for m, p in zip(sizes.tolist(), pivots.tolist(), strict=True):
        left = m - 1 - np.arange(p)
        factor += float(np.sum(left * (left + 1) + left + 1))
        factor_entries += float(np.sum(left + 1))
    in_row = np.diff(a["row_ptr"])
    terms = 5.0 * len(a["quad_h"]) + 2.0 * len(a["row_lin"])
    assemble = float(np.sum(in_row * (in_row + 1))) + 3.0 * len(a["quad_h"])
    mass = 2.0 * len(a["mass_val"])
    residual = terms + mass + 4.0 * len(a["row_lin"]) + 10.0 * system.nq
    solve = 4.0 * factor_entries
    return (iterations + 1.0) * residual + factorizations * (factor + assemble) + solves * solve


def resident() -> int:
    """Resident memory of this process, bytes; 0 where the system does not tell."""
    statm = Path("/proc/self/statm")
    return int(statm.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") if statm.is_file() else 0


def measure(windows: Sequence[int], rounds: int) -> list[dict[str, Any]]:
    """All rows; times are medians over rounds through all of them."""
    loop, dgemm = compiled_loop_peak(), dgemm_peak()
    steps = round(END / STEP)
    rows: list[dict[str, Any]] = []
    systems: dict[int, mbs.System] = {}
    for n in watched(windows):
        begin = time.perf_counter()
        system = systems[n] = mbs.compile(double_four_bar.build(n))
        compiled = time.perf_counter() - begin
        for method in METHODS:
            before = resident()
            simulation = mbs.Simulation(system, settings=mbs.Settings(method=method))
            after = resident()
            first = simulation.report
            simulation.step(STEP, n=steps)
            report = simulation.report
            rows.append(
                {
                    "N": n,
                    "method": method,
                    "coordinates": system.nq,
                    "rows": system.nc,
                    "factor_nonzeros": system.report["factor_nonzeros"],
                    "system_bytes": len(system.to_bytes()),
                    "state_bytes": simulation.instance.system.state_size,
                    "resident_bytes": max(after - before, 0),
                    "compile_s": compiled,
                    "iterations": report.iterations / steps,
                    "operations_per_step": operations(
                        system,
                        report.iterations / steps,
                        (report.factorizations - first.factorizations) / steps,
                        (report.solves - first.solves) / steps,
                    ),
                }
            )
    walls: list[list[float]] = [[] for _ in rows]
    for turn, k in watched([(turn, k) for turn in range(rounds + 1) for k in range(len(rows))]):
        system, settings = systems[rows[k]["N"]], mbs.Settings(method=rows[k]["method"])
        run = mbs.simulate(system, END, STEP, settings=settings, every=steps, progress=False, estimate_error=False)
        if turn:
            walls[k].append(run.wall_s / steps)
    for row, times in zip(rows, walls, strict=True):
        wall = statistics.median(times)
        rate = row["operations_per_step"] / wall
        row |= {
            "us_per_step": 1e6 * wall,
            "us_per_iteration": 1e6 * wall / row["iterations"],
            "gflops": 1e-9 * rate,
            "of_compiled_loop": rate / loop if loop else None,
            "of_dgemm": rate / dgemm,
            "compiled_loop_gflops": 1e-9 * loop if loop else None,
            "dgemm_gflops": 1e-9 * dgemm,
        }
    return rows


def chassis(modes: Sequence[int], rounds: int) -> list[dict[str, Any]]:
    """Rows of the car's frame alone, thrown and spinning: what its modes cost without the suspension."""
    frame, _ = prototype_frame()
    model = frame.finite_element_model()
    rows: list[dict[str, Any]] = []
    systems = []
    for count in watched(modes):
        m = mbs.Model("thrown chassis", gravity=(0.0, 0.0, -9.81))
        reduced = craig_bampton(model, REFERENCE, INTERFACES, count, inertia_modes=True, damping=DAMPING)
        body = m.flexible_body("chassis", reduced)
        m.initial_velocity(body, (5.0, 0.0, 3.0), (0.3, 0.5, 2.0))
        m.sense_energy("energy.total", "total")
        system = mbs.compile(m)
        simulation = mbs.Simulation(system)
        simulation.step(CHASSIS_STEP, n=CHASSIS_STEPS)
        systems.append(system)
        rows.append(
            {
                "dynamic_modes": count,
                "modes": len(system.arrays["flex_mode"]),
                "coordinates": system.nq,
                "factor_nonzeros": system.report["factor_nonzeros"],
                "system_bytes": len(system.to_bytes()),
                "state_bytes": simulation.instance.system.state_size,
                "iterations": simulation.report.mean_iterations,
            }
        )
    walls: list[list[float]] = [[] for _ in rows]
    for turn, k in watched([(turn, k) for turn in range(rounds + 1) for k in range(len(systems))]):
        end = CHASSIS_STEPS * CHASSIS_STEP
        run = mbs.simulate(systems[k], end, CHASSIS_STEP, every=CHASSIS_STEPS, progress=False, estimate_error=False)
        if turn:
            walls[k].append(run.wall_s / CHASSIS_STEPS)
    for row, times in zip(rows, walls, strict=True):
        wall = 1e6 * statistics.median(times)
        row |= {"us_per_step": wall, "us_per_iteration": wall / row["iterations"]}
    return rows


def chassis_exponents(rows: Sequence[dict[str, Any]]) -> dict[str, float]:
    """Fitted b of ``cost = a n^b`` over all modes n, static ones included."""
    x = np.log([r["modes"] for r in rows])
    return {key: float(np.polyfit(x, np.log([r[key] for r in rows]), 1)[0]) for key in CHASSIS_EXPONENTS}


def exponents(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Fitted b of ``cost = a N^b`` from `FITTED_FROM` on."""
    lines = []
    for method in METHODS:
        part = [r for r in rows if r["method"] == method and r["N"] >= FITTED_FROM]
        if len(part) > 1:
            x = np.log([r["N"] for r in part])
            lines.append(
                {"method": method}
                | {key: float(np.polyfit(x, np.log([r[key] for r in part]), 1)[0]) for key in EXPONENTS}
            )
    return lines


def draw(rows: Sequence[dict[str, Any]], file: Path) -> None:
    """Time per step and non-zeros against N, log-log, with a line of slope one."""
    plt = pyplot()
    figure, ax = plt.subplots(figsize=(6.2, 4.4), layout="constrained")
    for method, colour, marker in zip(METHODS, ("#0072B2", "#CC79A7"), "ov", strict=True):
        part = [r for r in rows if r["method"] == method]
        x = [r["N"] for r in part]
        ax.loglog(x, [r["us_per_step"] for r in part], f"{marker}-", color=colour, label=f"{method}: µs per step")
    part = [r for r in rows if r["method"] == METHODS[0]]
    x = np.array([r["N"] for r in part], dtype=float)
    ax.loglog(x, [r["factor_nonzeros"] for r in part], "s--", color="#009E73", label="non-zeros of the factor")
    ax.loglog(x, part[-1]["us_per_step"] * x / x[-1], ":", color="black", label="slope 1")
    ax.set_xlabel(f"N of the N-four-bar ({machine()['processor']})")
    ax.grid(True, which="major", alpha=0.35)
    ax.legend(fontsize=8)
    save_chart(figure, file)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = parser_of("growth", __doc__, chart="the growth")
    parser.add_argument("--quick", action="store_true", help="N up to 20, one round")
    options = parser.parse_args(arguments)
    rows = measure(WINDOWS[:5] if options.quick else WINDOWS, 1 if options.quick else ROUNDS)
    print_table(rows, TABLE)
    fitted = exponents(rows)
    print(f"\nExponents b of cost = a N^b from N = {FITTED_FROM}")
    print_table(fitted, {"method": ""} | dict.fromkeys(EXPONENTS, ".3f"))
    flexible = chassis(MODES[:2] if options.quick else MODES, 1 if options.quick else CHASSIS_ROUNDS)
    flexible_fitted = chassis_exponents(flexible)
    print("\nThe car's frame alone, thrown and spinning, ALi3-P")
    print_table(flexible, CHASSIS_TABLE)
    print("Exponents b of cost = a n^b in all its modes n")
    print_table([flexible_fitted], dict.fromkeys(CHASSIS_EXPONENTS, ".3f"))
    first = rows[0]
    print(
        f"\nThis machine in one thread: {first['dgemm_gflops']:.1f} Gflop/s in NumPy's matrix product"
        + (
            f", {first['compiled_loop_gflops']:.1f} in a loop with the kernel's flags"
            if first["of_compiled_loop"]
            else ""
        )
    )
    about = {"step_s": CHASSIS_STEP, "rows": flexible, "exponents": flexible_fitted}
    meta = describe("growth", mbs.Settings(), rounds=ROUNDS, step_s=STEP, end_s=END, exponents=fitted, chassis=about)
    save_rows(options.json, meta, rows)
    if options.chart is not None:
        draw(rows, options.chart)
    return 0


if __name__ == "__main__":
    sys.exit(main())

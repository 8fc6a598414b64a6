"""Arithmetic of a step, and what this machine could do in its time."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import mbs
from mbs.kernel.build import FLAGS, cache_directory

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
    """Resident memory of this process, bytes; 0 where the system does not give it."""
    statm = Path("/proc/self/statm")
    return int(statm.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") if statm.is_file() else 0

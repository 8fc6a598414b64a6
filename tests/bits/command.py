"""Comparison of the results of the product with stored results.

    python -m tests.bits [--only TEXT] [--jobs N] [--update] [--list]

Each group runs in its own process, with the code of the working tree; the exit code is 1 if a number differs.
"""

import argparse
import os
import platform
import subprocess
import sys
import tempfile
import traceback
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from importlib.metadata import version
from pathlib import Path

from tests.bits import doors, store
from tests.bits.groups import GROUPS, group_of


def main(arguments: Sequence[str] | None = None) -> int:
    """Command line; returns 1 where something differs from the baseline or cannot be made."""
    parser = argparse.ArgumentParser(prog="python -m tests.bits", description=__doc__.splitlines()[0])
    parser.add_argument("--only", metavar="TEXT", default="", help="entries with this text in their name or group")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="groups at a time (default 1)")
    parser.add_argument("--update", action="store_true", help="store what is found, told first, as the baseline")
    parser.add_argument("--list", action="store_true", help="print the names of the stored entries and stop")
    parser.add_argument("--most", type=int, default=40, metavar="N", help="rows of differences (default 40)")
    parser.add_argument("--make", nargs=3, metavar=("GROUP", "FMUS", "FILE"), help=argparse.SUPPRESS)
    options = parser.parse_args(arguments)
    if options.make:
        return make(options.make[0], Path(options.make[1]), Path(options.make[2]))
    stored, taken = store.read() if store.BASELINE.is_file() else ({}, {})
    if options.list:
        for name, (exact, signals) in sorted(stored.items()):
            if _asked(name, options.only):
                print(f"{name}: {len(signals)} signals, {'bits' if exact else f'to {store.RELATIVE:g}'}")
        return 0
    chosen = [n for n in GROUPS if options.only in n or any(options.only in e and group_of(e) == n for e in stored)]
    if not chosen:
        parser.error(f"no group or stored entry has {options.only!r} in its name; --list prints those there are")
    result, failed = make_all(chosen, max(1, options.jobs))
    for name, message in failed.items():
        print(f"\n{name} cannot be made:\n{message}", file=sys.stderr)
    completed = {*chosen, *(() if options.only else ("",))} - failed.keys()  # "": entries without a group
    kept = {name: entry for name, entry in stored.items() if group_of(name) in completed}
    rows = [row for row in store.compare(kept, result) if _asked(row.entry, options.only)]
    report(rows, result, taken, options.most)
    if options.update:
        new = {name: entry for name, entry in result.items() if _asked(name, options.only)}
        unaffected = {
            name: entry for name, entry in stored.items() if name not in kept or not _asked(name, options.only)
        }
        store.write(unaffected | new, platform_versions())
        print(f"written: {store.BASELINE}")
        return 1 if failed else 0
    return 1 if rows or failed else 0


def make(name: str, fmus: Path, file: Path) -> int:
    """Write the entries of a group to a file and end the process."""
    with tempfile.TemporaryDirectory(prefix="bits-") as scratch:
        entries = list(GROUPS[name].make(fmus, Path(scratch)))
    file.write_text(store.to_json(entries), encoding="utf-8")
    sys.stdout.flush()
    os._exit(0)  # hosts of FMUs have nothing to tidy up


def make_all(names: Sequence[str], jobs: int) -> tuple[dict[str, store.Entry], dict[str, str]]:
    """Entries of groups, and the messages of those that failed; FMUs are built if a group needs them.

    `names`: of groups; `jobs`: number of processes.
    """
    from tqdm import tqdm

    entries: dict[str, store.Entry] = {}
    failed: dict[str, str] = {}
    builds = {need for name in names for need in GROUPS[name].needs}
    waiting = {name: {f"build {need}" for need in GROUPS[name].needs} for name in names}
    waiting = {f"build {need}": set() for need in sorted(builds)} | waiting
    os.environ |= plain_processor()
    with (
        tempfile.TemporaryDirectory(prefix="bits-") as folder,
        ThreadPoolExecutor(jobs) as pool,
        tqdm(total=len(waiting), unit="group", dynamic_ncols=True, smoothing=0.0) as bar,
    ):
        fmus, running = Path(folder, "fmus"), {}
        while waiting or running:
            for name in [name for name, needs in waiting.items() if not needs]:
                del waiting[name]
                running[pool.submit(_in_a_process, name, fmus, Path(folder))] = name
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                name = running.pop(future)
                group_entries, message = future.result()
                bar.update()
                bar.set_postfix_str(name)
                entries |= group_entries
                if message:
                    failed[name] = message
                for other in [other for other, needs in waiting.items() if name in needs]:
                    waiting[other].discard(name)
                    if message:
                        failed[other] = f"needs what {name} gives"
                        del waiting[other]
                        bar.update()
    return entries, failed


def plain_processor() -> dict[str, str]:
    """Environment in which programs round alike on every x86-64 processor: what is chosen by processor is switched off.

    BLAS and LAPACK of OpenBLAS, the functions of NumPy and those of the C library have variants that differ in the last
    bits; the compiler of models uses them.
    """
    from numpy._core import _multiarray_umath as core

    chosen = [name for name in core.__cpu_dispatch__ if core.__cpu_features__.get(name)]
    vectors = ",".join(f"-{name}{end}" for name in ("AVX512F", "AVX2", "FMA", "FMA4") for end in ("", "_Usable"))
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    return threads | {
        "OPENBLAS_CORETYPE": "Nehalem",
        "NPY_DISABLE_CPU_FEATURES": " ".join(chosen),
        "GLIBC_TUNABLES": f"glibc.cpu.hwcaps={vectors}",
    }


def report(rows: Sequence[store.Difference], entries: dict[str, store.Entry], taken: dict[str, str], most: int) -> None:
    """Print the differences in descending order."""
    count = sum(len(signals) for _, signals in entries.values())
    print(
        f"{len(entries)} entries, {count} signals; differences: {len(rows)}, in {len({r.entry for r in rows})} entries"
    )
    here = platform_versions()
    if other := [
        f"{k} {taken[k]}, here {here.get(k, 'none')}" for k in taken if here.get(k) != taken[k] and k != "date"
    ]:
        print(f"taken with {'; '.join(other)}")
    if not rows:
        return
    print(f"{'absolute':>10} {'of range':>10}  entry: signal")
    order = sorted(rows, key=lambda r: -r.relative if r.kind == "differs" else -float("inf"))
    for row in order[:most]:
        size = f"{row.distance:10.2e} {row.relative:10.2e}" if row.kind == "differs" else f"{row.kind:>10} {'':>10}"
        print(f"{size}  {row.entry}{': ' if row.signal else ''}{row.signal}")
    if len(rows) > most:
        print(f"... and {len(rows) - most} more (--most)")
        counts = Counter(group_of(row.entry) or row.entry for row in rows)
        print("by group: " + ", ".join(f"{name} {count}" for name, count in counts.most_common()))


def platform_versions() -> dict[str, str]:
    """Versions of platform and packages on which results may depend."""
    results = {"python": platform.python_version(), "platform": f"{platform.system()} {platform.machine()}"}
    return results | {name: version(name) for name in ("numpy", "scipy", "fmpy", "pandas", "SALib")}


def _asked(entry: str, text: str) -> bool:
    return text in entry or text in group_of(entry)


def _in_a_process(name: str, fmus: Path, folder: Path) -> tuple[dict[str, store.Entry], str]:
    if name.startswith("build "):
        try:
            doors.build(name.removeprefix("build "), fmus)
        except Exception:
            return {}, traceback.format_exc(limit=-1)
        return {}, ""
    file = folder / f"{name.replace('/', '-')}.json"
    command = [sys.executable, "-m", "tests.bits", "--make", name, str(fmus), str(file)]
    completed = subprocess.run(command, cwd=doors.ROOT, capture_output=True, text=True, check=False)
    if file.is_file():
        return store.from_json(file.read_text(encoding="utf-8")), ""
    return {}, f"{completed.stdout[-2000:]}{completed.stderr[-4000:]}\nexit code {completed.returncode}"

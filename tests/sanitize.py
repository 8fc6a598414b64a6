"""Tests of the kernel with a kernel that is compiled with sanitizers.

    python -m tests.sanitize [arguments for pytest]

With gcc or clang: addresses (access beside a block of memory) and undefined behaviour (overflow, an index outside an
array, a null pointer). Without them: undefined behaviour alone, with the compiler of `ziglang`. An error ends the
process of the test and names the line of the kernel.
"""

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from ali3.cores import available_cores
from mbs.kernel import build

ROOT = Path(__file__).resolve().parents[1]
TESTS = [
    *sorted(str(path.relative_to(ROOT)) for path in (ROOT / "tests" / "kernel").glob("test_*.py")),
    "tests/flexible_engine/test_loader.py",
    "tests/model/test_payloads.py",
    "tests/model/test_parametric_axes.py",
    "tests/roads/test_road_file.py",
    "tests/roads/test_road_table.py",
    "tests/roads/test_shared_tiles.py",
    "tests/scenes/test_prototype_car_rest.py::test_braked_from_15_m_s_to_a_stop_that_lasts",  # others repeat its steps
    "tests/simulation/test_assembly_modes.py",
]
LEFT_OUT = {"tests/kernel/test_elementary.py", "tests/kernel/test_without_avx2.py"}  # compile libraries of their own
REPEATED = [
    f"tests/roads/test_shared_tiles.py::test_the_same_road_in_both_versions[{few}]" for few in ("some", "two", "one")
]
"""Slow tests of bits whose C is run here by others of that file."""
FLAGS = ["-g1", "-O1", "-std=c11", "-fPIC", "-fvisibility=hidden", "-ffp-contract=off", "-Wall", "-Wextra", "-Werror"]
ADDRESSES = ["-fsanitize=address", "-DALI3_GAPS"]
OBJECTS = "ALI3_SANITIZED_OBJECTS"
"""Names a folder in which objects are kept, so that the kernel and an FMU are compiled once for both."""
UNDEFINED = ["-fsanitize=undefined", "-fno-sanitize-recover=all"]
OPTIONS = {
    "ASAN_OPTIONS": "detect_leaks=0:allocator_may_return_null=1",  # Python itself leaks; files may ask for too much
    "UBSAN_OPTIONS": "print_stacktrace=1",
}


def runtimes(compiler: str) -> list[str]:
    """Libraries to preload before Python; empty if the compiler has no address sanitizer."""
    names = ["libasan.so", "libubsan.so"] if "gcc" in compiler else [f"libclang_rt.asan-{os.uname().machine}.so"]
    results = []
    for name in names:
        result = subprocess.run([compiler, f"-print-file-name={name}"], capture_output=True, text=True, check=False)
        results.append(result.stdout.strip())
    return results if all(Path(path).is_file() for path in results) else []


def objects(command: Sequence[str], sources: Sequence[Path], folder: Path) -> list[str]:
    """Object files of C sources in a folder, compiled if there is none for the same command and preprocessed text.

    Raises `subprocess.CalledProcessError`: the compiler refuses a source.
    """
    folder.mkdir(parents=True, exist_ok=True)
    version = subprocess.run([command[0], "--version"], capture_output=True, check=True).stdout
    message = version + " ".join(part for part in command if "-I" not in part).encode()

    def object_of(source: Path) -> str:
        text = subprocess.run([*command, "-E", "-P", source], capture_output=True, check=True).stdout
        file = folder / f"{hashlib.sha256(message + text).hexdigest()}.o"
        if not file.is_file():
            part = file.with_suffix(f".{os.getpid()}")  # whole at once: other processes look for it too
            subprocess.run([*command, "-c", source, "-o", part], check=True)
            part.replace(file)
        return str(file)

    with ThreadPoolExecutor(available_cores()) as pool:
        return list(pool.map(object_of, sources))


def compiled(library: Path) -> tuple[str, dict[str, str]]:
    """Compile the kernel as a library; returns what is checked, as text, and the environment variables for it."""
    for compiler in filter(shutil.which, ("gcc", "clang") if sys.platform == "linux" else ()):
        preload = runtimes(compiler)
        if not preload:
            continue
        shared = [] if "gcc" in compiler else ["-shared-libsan"]
        command = [compiler, *FLAGS, *ADDRESSES, *UNDEFINED]
        object_files = objects(command, build.sources(), Path(os.environ.get(OBJECTS, library.parent / "objects")))
        subprocess.run([*command, *shared, "-shared", "-o", library, *object_files, "-lm"], check=True)
        return f"addresses and undefined behaviour ({compiler})", OPTIONS | {"LD_PRELOAD": ":".join(preload)}
    flags = [*FLAGS, "-shared", *UNDEFINED, "-fsanitize-trap=undefined"]
    subprocess.run(
        [sys.executable, "-m", "ziglang", "cc", "-target", build.host_target(), *flags, "-o", library, *build.sources()]
        + (["-lm"] if sys.platform != "win32" else []),
        check=True,
    )
    return "undefined behaviour alone: no gcc or clang with checks of addresses was found", {}


def main(arguments: list[str]) -> int:
    """Run pytest with the compiled kernel; returns 0 if all tests pass, otherwise 1."""
    with tempfile.TemporaryDirectory(prefix="ali3-sanitize-") as folder:
        library = Path(folder) / build.library_name(build.host_target())
        checks, environment = compiled(library)
        print(f"Checked: {checks}.", flush=True)
        chosen = ["-n", "auto", "-m", "not proof", *(f"--deselect={test}" for test in REPEATED)]
        chosen += (test for test in TESTS if test not in LEFT_OUT)
        command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *(arguments or chosen)]
        environment["ALI3_KERNEL_LIBRARY"] = str(library)
        code = subprocess.run(command, cwd=ROOT, env=os.environ | environment, check=False).returncode
    if code < 0:
        print(f"A check ended the process (signal {-code}).")
    return 1 if code else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))

"""The C files of the shell: which face needs which, and where they lie in an FMU."""

from collections.abc import Mapping
from pathlib import Path

from mbs.kernel import build

HERE = Path(__file__).parent / "src"
PYTHON_SLAVE = Path(__file__).parents[1] / "python_slave"
KERNEL_INCLUDE = build.HERE / "include"
_OTHER = {"fmi2": "fmi3", "fmi3": "fmi2"}


def shell_files(face: str) -> list[Path]:
    """C files of the shell for a face, sorted by name.

    `face`: ``fmi2`` or ``fmi3``; or ``python``, FMI 2.0 with the way of its calls through Python.
    """
    if face == "python":
        return sorted([*(f for f in shell_files("fmi2") if f.name != "fmi2_direct.c"), *PYTHON_SLAVE.glob("*.c")])
    return sorted(f for f in HERE.glob("*.c") if not f.name.startswith(_OTHER[face]))


def packed_sources(face: str, table_c: str, generated: Mapping[str, str] | None = None) -> dict[str, bytes]:
    """All sources as they lie in the FMU's folder ``sources``, headers too. Result: by path with forward slashes.

    `generated`: C that was generated for Systems, by name.
    """
    files = {f.name: f.read_bytes() for f in shell_files(face)}
    files |= {f.name: f.read_bytes() for f in HERE.glob("*.h") if not f.name.startswith(_OTHER[face])}
    kernel_files = [*(build.HERE / "src").rglob("*.h"), *build.sources(lanes=False)]
    kernel_files = [f for f in kernel_files if f.parent.name not in build.LANES]
    files |= {f"kernel/{f.relative_to(build.HERE).as_posix()}": f.read_bytes() for f in kernel_files}
    header = (KERNEL_INCLUDE / "ali3.h").read_bytes()
    # every compiler of source FMUs looks beside the shell's files only
    files |= {"kernel/include/ali3.h": header, "ali3.h": b'#include "kernel/include/ali3.h"\n'}
    if generated:
        files["generated.h"] = b'#include "kernel/src/generated.h"\n'
        files |= {f"{name}.c": text.encode() for name, text in generated.items()}
    files["table.c"] = table_c.encode()
    return dict(sorted(files.items()))

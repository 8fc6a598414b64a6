"""Library of the generated code of a System, compiled once for equal content."""

import hashlib
from pathlib import Path

from ali3.temporary_folder import temporary_folder
from mbs.common.errors import ModelError
from mbs.compiler.generated.source import TABLE, source
from mbs.kernel import build
from mbs.kernel.binding import LoadedSystem
from mbs.system.system import System

HEADERS = build.HERE / "src"


def code_of(system: System, avx2: bool | None = None) -> str:
    """C source of the algebra of a System; `avx2`: see `source`, by default whether this processor has it."""
    loaded = LoadedSystem(system.kernel_bytes(modes=False))
    return source(system.arrays, loaded.structure, avx2=loaded.has_avx2 if avx2 is None else avx2)


def named_code_of(system: System) -> tuple[str, str]:
    """Name of the table of functions, unique to the code, and C source that compiles for any processor."""
    text = code_of(system, avx2=True)
    name = f"{TABLE}_{hashlib.sha256(text.encode()).hexdigest()[:16]}"
    return name, text.replace(TABLE, name)


def library_of(system: System) -> Path:
    """Path of the library of the generated code of a System, compiled or from the cache.

    Raises
    ------
    ModelError
        There is no compiler.
    RuntimeError
        The compiler refuses the code; the message is the compiler's.
    """
    text, target = code_of(system), build.host_target()
    name = build.library_name(target)
    try:
        command = build.compiler_command([], target, Path(name))
    except ModuleNotFoundError:
        raise ModelError(
            "compile(..., native=True) needs a C compiler, and the package ziglang is not installed; "
            "the extra 'fmu' brings it: python -m pip install 'ali3[fmu]'."
        ) from None
    digest = hashlib.sha256(build.digest_of(command).encode())
    for content in (text.encode(), (HEADERS / "generated.h").read_bytes()):
        digest.update(f"\n{len(content)}\n".encode() + content)
    library = build.cache_directory() / "generated" / digest.hexdigest() / name
    if not library.is_file():
        with temporary_folder() as folder:
            file = Path(folder, "algebra.c")
            file.write_text(text, encoding="utf-8")
            build.compile_c([file], target, library, include=(HEADERS,), what="the generated code")
    return library

"""Packs a System, the slave in C, its class in Python and PythonFMU into an FMU: the same content, the same bytes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pythonfmu

from fmu_src.description.description import model_description
from fmu_src.native.archive import identity_of, licence, write_zip
from fmu_src.native.package import NativeContents, StageReport, compiled_libraries
from fmu_src.native.platforms import PYTHON_PLATFORMS, SUFFIXES, TARGETS
from fmu_src.native.sources import shell_files

_HERE = Path(__file__).parent
_PYTHONFMU = Path(pythonfmu.__file__).parent
_PYTHONFMU_MODULES = ("_version", "default_experiment", "enums", "fmi2slave", "logmsg", "variables")
_PARAGRAPH = (
    "FMI 2.0 co-simulation through Python: the host's machine needs Python 3.10 or newer, and no package. "
    "The calls pass a class in Python; the slave in C answers them as it does in the native FMU."
)
_PYTHONFMU_LIBRARY = {"linux64": "libpythonfmu-export.so", "win64": "pythonfmu-export.dll"}


def pack_python(
    contents: NativeContents,
    platforms: Sequence[str],
    file: Path,
    report_stage: StageReport,
    libraries: dict[tuple[str, str], bytes],
) -> None:
    """Compile and write the FMU.

    Parameters
    ----------
    contents : NativeContents
        The same as for the native kinds.
    platforms : sequence of str
        ``linux64``, ``win64`` or both.
    file : Path
        Where to; an older file is replaced only when the new one is whole.
    report_stage : callable
        ``report_stage(what, note)`` makes a context in which `what` is done.
    libraries : dict
        As for `fmu_src.native.package.compiled_libraries`.
    """
    name = contents.model_name
    package = _package()
    template = (_HERE / "main_template.py").read_text(encoding="utf-8")
    # all that any platform has; sources stand for the slave's libraries, which carry the identity
    sources = {f"sources/{f.name}": f.read_bytes() for f in shell_files("python")}
    identity, guid = identity_of(
        package | _pythonfmu_libraries(name, PYTHON_PLATFORMS) | sources | {"main": template.encode()},
        [contents.identity("fmi2")[0]],
    )
    # Names of their own per build: a host's Python keeps one module per name, whatever FMU it came from.
    main_module, package_name = f"main_{identity[:12]}", f"ali3_{identity[:12]}"
    script = template.replace("ModelName", name).replace("PackageName", package_name)
    files = {f"resources/{package_name}/{path}": data for path, data in package.items()}
    files |= contents.resources | _pythonfmu_libraries(name, platforms)
    files |= {
        f"resources/{main_module}.py": script.encode(),
        "resources/slavemodule.txt": main_module.encode(),
        "documentation/licenses/license.txt": licence("ali3"),
        "documentation/licenses/PythonFMU.txt": licence("pythonfmu"),
        "documentation/index.html": contents.documentation([_PARAGRAPH]),
        "modelDescription.xml": model_description(
            contents.description_head(
                guid, tool=f"ALi3 {contents.version}, PythonFMU {pythonfmu.__version__}", needs_execution_tool=True
            ),
            contents.table,
            contents.reach,
        ),
    }
    binaries = {platform: {platform: TARGETS[platform]} for platform in platforms}
    files |= compiled_libraries(contents, "python", contents.table_c(identity, guid), binaries, report_stage, libraries)
    with report_stage("python: packing"):
        write_zip(files, file)


def _package() -> dict[str, bytes]:
    """The package in Python: the slave's class and the parts of PythonFMU that it needs."""
    modules = {f"pythonfmu/{module}.py": (_PYTHONFMU / f"{module}.py").read_bytes() for module in _PYTHONFMU_MODULES}
    return modules | {
        "__init__.py": b"",
        "pythonfmu/__init__.py": b"",
        "slave.py": (_HERE / "slave.py").read_bytes(),
    }


def _pythonfmu_libraries(name: str, platforms: Sequence[str]) -> dict[str, bytes]:
    """PythonFMU's export libraries as they lie beside those of the slave."""
    folder = _PYTHONFMU / "resources" / "binaries"
    return {
        f"binaries/{p}/{name}-pythonfmu{SUFFIXES[p]}": (folder / p / _PYTHONFMU_LIBRARY[p]).read_bytes()
        for p in platforms
    }

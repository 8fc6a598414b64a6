"""Packs a System, its table, the shell's libraries and sources into a native FMU of FMI 3.0."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path

from fmu_src.archive import write_zip
from fmu_src.arrays import arrays
from fmu_src.description import Description
from fmu_src.description_fmi3 import build_description, model_description_fmi3, terminals
from fmu_src.native.compile import compile_target
from fmu_src.native.package import NativeContents, Telling, common_files, page
from fmu_src.native.sources import packed_sources
from fmu_src.native.table import c_arrays, c_table
from fmu_src.platforms import FMI3_FOLDERS, SUFFIXES, TARGETS

_WORDS = (
    "FMI 3.0 co-simulation in C: it needs nothing but the C library of its platform, and can be compiled from its "
    "folder sources. Components of a vector are one array variable, in the order its description says.",
    "Outputs that are positions, angles or velocities have first time derivatives. Directional and adjoint "
    "derivatives of outputs by inputs are those over the last inner step, the state before it held; in initialisation "
    "mode those of the initial state.",
)


def pack_fmi3(contents: NativeContents, platforms: Sequence[str], file: Path, told: Telling) -> str:
    """Compile and write the FMU.

    Parameters
    ----------
    contents : NativeContents
    platforms : sequence of str
        Out of ``linux64``, ``win64`` and ``darwin64``.
    file : Path
        Where to.
    told : callable
        ``told(what, note)`` makes a context in which `what` is done.

    Returns
    -------
    str
        The instantiation token, a hash of all the content.
    """
    name = contents.model_name
    identity, token = contents.identity("fmi3")
    groups = arrays(contents.table)
    table_c = c_table(contents.table, contents.rows, identity, token) + c_arrays(groups)
    sources = packed_sources("fmi3", table_c)
    files = {f"sources/{path}": data for path, data in sources.items()} | common_files(contents, told)
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder, "table.c")
        table.write_text(table_c, encoding="utf-8")
        for platform in platforms:
            for target in TARGETS[platform]:
                with told(f"compiling for {FMI3_FOLDERS[target]}", "the first time takes up to two minutes"):
                    library = Path(folder, target, name + SUFFIXES[platform])
                    compile_target(target, "fmi3", table, library)
                files[f"binaries/{FMI3_FOLDERS[target]}/{library.name}"] = library.read_bytes()
    head = Description(
        name,
        name,
        token,
        contents.description,
        f"ALi3 {contents.version}",
        contents.version,
        contents.stop_time,
        contents.step_size,
        needs_execution_tool=False,
        capable=True,
    )
    files["modelDescription.xml"] = model_description_fmi3(head, contents.table, groups)
    files["sources/buildDescription.xml"] = build_description(name, [p for p in sources if p.endswith(".c")])
    files["documentation/index.html"] = page(contents, _WORDS)
    files["terminalsAndIcons/icon.png"] = files.pop("model.png")
    buses = terminals(groups)
    if buses is not None:
        files["terminalsAndIcons/terminalsAndIcons.xml"] = buses
    with told("packing"):
        write_zip(files, file)
    return token

"""Packs a System, its table, the shell's libraries and sources into a native FMU of FMI 2.0."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path

import mbs
from fmu_src.archive import identity_of, licence, write_zip
from fmu_src.description import Description, model_description
from fmu_src.documentation import documentation
from fmu_src.native.compile import compile_platform
from fmu_src.native.reference import ReferenceRun, reference_files, reference_run
from fmu_src.native.sources import packed_sources
from fmu_src.native.table import c_table
from fmu_src.picture import curves_png
from fmu_src.platforms import SUFFIXES
from fmu_src.variables import Variable, table_records

Telling = Callable[..., AbstractContextManager[None]]
_WORDS = (
    "FMI 2.0 co-simulation in C: it needs nothing but the C library of its platform, and can be compiled from its "
    "folder sources (compilers other than the one used here may change the last bits unless they are kept from "
    "fusing multiplications and additions: -ffp-contract=off).",
    "Derivatives of inputs up to the third order are followed inside a communication step and forgotten after it. "
    "Outputs that are positions, angles or velocities have first time derivatives. Directional derivatives of "
    "outputs by inputs are those over the last inner step, the state before it held; in initialisation mode those of "
    "the initial state.",
)


@dataclass(frozen=True)
class NativeContents:
    """What goes into a native FMU.

    Parameters
    ----------
    model_name : str
        A C identifier, also the model identifier.
    description, version : str
    systems : sequence of mbs.System
        One per fidelity.
    table : sequence of Variable
    fidelity : int
        The default one.
    """

    model_name: str
    description: str
    version: str
    systems: Sequence[mbs.System]
    table: Sequence[Variable]
    fidelity: int = 0

    @property
    def system(self) -> mbs.System:
        """The default System."""
        return self.systems[self.fidelity]

    @property
    def rows(self) -> list[list[str]]:
        """Names of the constraint rows of each System."""
        return [[row["name"] for row in system.meta["rows"]] for system in self.systems]

    @property
    def system_files(self) -> dict[str, bytes]:
        """System files as they lie in the FMU."""
        return {f"resources/system_{k}.ali3": system.to_bytes() for k, system in enumerate(self.systems)}

    @property
    def stop_time(self) -> float:
        """Default experiment, s."""
        return float(self.system.meta["experiment"]["stop_time_s"])

    @property
    def step_size(self) -> float:
        """Default step, s."""
        return float(self.system.meta["experiment"]["step_s"])

    def identity(self, face: str) -> tuple[str, str]:
        """Hash of the content, and the GUID made from it."""
        return identity_of(
            packed_sources(face, c_table(self.table, self.rows, "0" * 32, "")) | self.system_files,
            [self.model_name, self.description, self.version, self.stop_time, table_records(self.table)],
        )


def pack_native(contents: NativeContents, platforms: Sequence[str], file: Path, told: Telling) -> str:
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
        The GUID, a hash of all the content.
    """
    name = contents.model_name
    identity, guid = contents.identity("fmi2")
    table_c = c_table(contents.table, contents.rows, identity, guid)
    sources = packed_sources("fmi2", table_c)
    files = {f"sources/{path}": data for path, data in sources.items()} | common_files(contents, told)
    with tempfile.TemporaryDirectory() as folder:
        table = Path(folder, "table.c")
        table.write_text(table_c, encoding="utf-8")
        for platform in platforms:
            with told(f"compiling for {platform}", "the first time takes up to two minutes"):
                library = compile_platform(platform, "fmi2", table, Path(folder), name)
            files[f"binaries/{platform}/{name}{SUFFIXES[platform]}"] = library
    head = Description(
        name,
        name,
        guid,
        contents.description,
        f"ALi3 {contents.version}",
        contents.version,
        contents.stop_time,
        contents.step_size,
        needs_execution_tool=False,
        capable=True,
        sources=[path for path in sources if path.endswith(".c")],
    )
    files["modelDescription.xml"] = model_description(head, contents.table)
    files["documentation/index.html"] = page(contents, _WORDS)
    with told("packing"):
        write_zip(files, file)
    return guid


def common_files(contents: NativeContents, told: Telling) -> dict[str, bytes]:
    """What native FMUs of both versions of FMI carry alike, by path."""
    with told("running the default experiment"):
        run = reference_run(contents.system)
    return {
        **contents.system_files,
        "documentation/licenses/ALi3.txt": licence("ali3"),
        "model.png": _picture(run),
    } | reference_files(contents.model_name, run, contents.stop_time, contents.step_size)


def page(contents: NativeContents, words: Sequence[str]) -> bytes:
    """documentation/index.html."""
    text = documentation(
        contents.model_name, contents.description, contents.version, contents.step_size, contents.table, words
    )
    return text.encode()


def _picture(run: ReferenceRun) -> bytes:
    moving = [column for column in run.columns.values() if float(column.max()) > float(column.min())]
    return curves_png(run.t, moving[:3])

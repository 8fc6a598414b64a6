"""Packs a System, its table, the shell's libraries and sources into a native FMU of any version of FMI."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mbs
from ali3.parameter_set import ParameterSet
from ali3.temporary_folder import temporary_folder
from fmu_src.description.description import Description
from fmu_src.description.documentation import documentation
from fmu_src.description.probe import Dependencies
from fmu_src.native.archive import identity_of, licence, write_zip
from fmu_src.native.compilation import compile_library
from fmu_src.native.picture import curves_png
from fmu_src.native.platforms import SUFFIXES
from fmu_src.native.reference_files import reference_files
from fmu_src.native.reference_runs import ReferenceRun
from fmu_src.native.sources import packed_sources
from fmu_src.native.table import c_table
from fmu_src.variables.parameter_file import parameter_set
from fmu_src.variables.text_variables import TextVariable, road_resources, text_table
from fmu_src.variables.variables import Variable, table_records
from mbs.results.comparison import compared_sensors
from mbs.simulation.prepared_system import length_of
from mbs.system.text import model_notices

GEOMETRY = "resources/geometry.json"
"""Where the scene lies in an FMU."""
StageReport = Callable[..., AbstractContextManager[None]]


@dataclass(frozen=True)
class NativeContents:
    """Content of an FMU that does not depend on the version of FMI."""

    model_name: str
    """A C identifier, also the model identifier."""
    description: str
    version: str
    systems: Sequence[mbs.System]
    """One per fidelity."""
    table: Sequence[Variable]
    reach: Dependencies
    """What reaches which outputs."""
    fidelity: int = 0
    """Number of the default System."""
    followers: Sequence[int] = (-1,)
    """Per System the number of the one that computes what it leaves out; -1: none."""
    author: str = ""
    """Author of the model; empty: the solver's."""
    copyright: str = ""
    """Copyright of the model; empty: the solver's."""
    licence: str = ""
    """Licence of the model; empty: the solver's."""
    origin: Mapping[str, bytes] = field(default_factory=dict)
    """Files that the model was made from, by their paths in the FMU."""
    code: Sequence[tuple[str, str]] = ()
    """Per System the name of the C that was generated for it, and that C; empty: there is none."""
    geometry: bytes = b""
    """The scene of the FMU, JSON; empty: none."""

    def description_head(self, guid: str, **more: Any) -> Description:
        """Attributes of modelDescription.xml; what is not given of the rights is the solver's."""
        text = licence("ali3").decode()
        line = next((line for line in text.splitlines() if line.startswith("Copyright")), "")
        return Description(
            self.model_name,
            self.model_name,
            guid,
            self.description,
            version=self.version,
            stop_time=self.stop_time,
            step_size=self.step_size,
            author=self.author or "ALi3 contributors (solver)",
            copyright=self.copyright or f"{line} (solver)",
            licence=self.licence or "BSD-3-Clause (solver)",
            texts=self.texts,
            **more,
        )

    @property
    def system(self) -> mbs.System:
        """The default System."""
        return self.systems[self.fidelity]

    @property
    def follower(self) -> mbs.System | None:
        """The System that computes what the default one leaves out."""
        number = self.followers[self.fidelity]
        return self.systems[number] if number >= 0 else None

    @property
    def names(self) -> dict[str, list[list[str]]]:
        """Names of the constraint rows, force elements and coordinates of tables of each System, its notices; see
        `c_table`."""
        names = {
            what: [[item["name"] for item in system.meta[f"{what}s"]] for system in self.systems]
            for what in ("row", "element")
        }
        notices = [model_notices(system.meta) for system in self.systems]
        return names | {"coordinate": [_over_tables(system) for system in self.systems], "notice": notices}

    @property
    def texts(self) -> tuple[TextVariable, ...]:
        """Variables that are text."""
        return text_table(self.system.meta, self.table)

    def table_c(self, identity: str, token: str) -> str:
        """The table of the shell in C, with 32 hexadecimal digits and the GUID or instantiation token."""
        sensors = [sensor["name"] for sensor in self.system.meta["sensors"]]
        judged = compared_sensors(self.system)
        judged_sensors = {number: judged[name] for number, name in enumerate(sensors) if name in judged}
        length = length_of(self.system)
        code = [name for name, _ in self.code]
        return c_table(
            self.table, self.names, identity, token, self.texts, self.followers, judged_sensors, length, code
        )

    @property
    def generated(self) -> dict[str, str]:
        """C that was generated for Systems, by its name; Systems of one structure share it."""
        return dict(self.code)

    @property
    def parameters(self) -> ParameterSet:
        """All parameters with their defaults."""
        return parameter_set(self.model_name, self.table, self.texts)

    @property
    def resources(self) -> dict[str, bytes]:
        """Systems and roads as they lie in the FMU, and what they were made from."""
        contents = [system.kernel_bytes() for system in self.systems]
        systems = {f"resources/system_{k}.ali3": content for k, content in enumerate(contents)}
        scene = {GEOMETRY: self.geometry} if self.geometry else {}
        return systems | road_resources(self.system.meta) | dict(self.origin) | scene

    def documentation(self, paragraphs: Sequence[str]) -> bytes:
        """The page of documentation; before the paragraphs of its kind of FMU one about `origin`, if there is any."""
        origin = [f"Made from the files that lie in it as {', '.join(sorted(self.origin))}."] if self.origin else []
        head = self.model_name, self.description, self.version, self.step_size, self.table
        return documentation(*head, [*origin, *paragraphs]).encode()

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
            packed_sources(face, self.table_c("0" * 32, ""), self.generated) | self.resources,
            [
                *(self.model_name, self.description, self.version, self.stop_time, table_records(self.table)),
                *(self.author, self.copyright, self.licence),
            ],
        )


@dataclass(frozen=True)
class Face:
    """Content of an FMU that depends on the version of FMI."""

    name: str
    """``fmi2`` or ``fmi3``; its C files begin with it."""
    words: Sequence[str]
    """Paragraphs of the documentation."""
    binaries: Mapping[str, Mapping[str, Sequence[str]]]
    """Per platform its folders in ``binaries`` and the compiler's targets of the library there."""
    picture: str
    """Where the picture of the model lies."""
    tables: Callable[[NativeContents, str, str], str]
    """C table of the contents with identity and GUID."""
    documents: Callable[[Description, NativeContents], dict[str, bytes]]
    """XML documents by path, from the attributes and the contents."""


def pack_native(
    contents: NativeContents,
    face: Face,
    runs: Sequence[ReferenceRun],
    platforms: Sequence[str],
    file: Path,
    report_stage: StageReport,
    libraries: dict[tuple[str, str], bytes],
) -> None:
    """Compile and write the FMU.

    Parameters
    ----------
    runs : sequence of ReferenceRun
        The default experiment, then others.
    platforms : sequence of str
        Out of `fmu_src.native.platforms.TARGETS`.
    report_stage : callable
        ``report_stage(what, note)`` makes a context in which `what` is done.
    libraries : dict
        As for `compiled_libraries`.
    """
    identity, guid = contents.identity(face.name)
    table_c = face.tables(contents, identity, guid)
    sources = packed_sources(face.name, table_c, contents.generated)
    files = {
        **{f"sources/{path}": data for path, data in sources.items()},
        **contents.resources,
        "documentation/licenses/license.txt": licence("ali3"),
        "documentation/index.html": contents.documentation(face.words),
        face.picture: _picture(runs[0]),
    } | reference_files(contents.model_name, runs, contents.stop_time, contents.step_size, contents.parameters)
    binaries = {platform: face.binaries[platform] for platform in platforms}
    files |= compiled_libraries(contents, face.name, table_c, binaries, report_stage, libraries)
    head = contents.description_head(
        guid,
        tool=f"ALi3 {contents.version}",
        needs_execution_tool=False,
        sources=[path for path in sources if path.endswith(".c")],
    )
    with report_stage(f"{face.name}: packing"):
        write_zip(files | face.documents(head, contents), file)


def compiled_libraries(
    contents: NativeContents,
    face: str,
    table_c: str,
    binaries: Mapping[str, Mapping[str, Sequence[str]]],
    report_stage: StageReport,
    libraries: dict[tuple[str, str], bytes],
) -> dict[str, bytes]:
    """Libraries of an FMU by their paths in it.

    `binaries`: as in `Face`; `report_stage`: as in `pack_native`; `libraries`: by model and folder those that
    were compiled before; those compiled here are added.
    """
    files, name = {}, contents.model_name
    with temporary_folder() as temporary:
        table = Path(temporary, "table.c")
        table.write_text(table_c, encoding="utf-8")
        for platform, targets_by_folder in binaries.items():
            library = name + SUFFIXES[platform]
            for folder, targets in targets_by_folder.items():
                if (name, folder) not in libraries:
                    with report_stage(f"{face}: compiling for {folder}", first_time(platform)):
                        binary = compile_library(targets, face, table, contents.generated, Path(temporary), library)
                    libraries[name, folder] = binary
                files[f"binaries/{folder}/{library}"] = libraries[name, folder]
    return files


def first_time(platform: str) -> str:
    """Message about the time that the first compilation takes."""
    return "the first time, Windows' C runtime is compiled too: some minutes" if platform == "win64" else ""


def _picture(run: ReferenceRun) -> bytes:
    moving = [column for column in run.columns.values() if float(column.max()) > float(column.min())]
    return curves_png(run.t, moving[:3])


def _over_tables(system: mbs.System) -> list[str]:
    """Names of coordinates up to the last that a table is over, empty those that none is."""
    indices = {int(k) for k in system.arrays["tabled_param"]}
    return [system.meta["coordinates"][k] if k in indices else "" for k in range(max(indices, default=-1) + 1)]

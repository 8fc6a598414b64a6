"""From a System to an FMU file."""

import functools
import importlib.metadata
import re
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from enum import Enum
from os import PathLike
from pathlib import Path

from ali3.alias_file import Content
from ali3.files import check_writable
from ali3.parameter_set import ParameterSet
from fmu_src.build.arguments import Systems, known_platforms, systems_by_number
from fmu_src.build.progress_line import watched
from fmu_src.description.nominal_values import drive_sizes, with_nominal
from fmu_src.description.probe import probe
from fmu_src.geometry.geometry import geometry, geometry_file
from fmu_src.native.early_compilation import compiled_ahead
from fmu_src.native.fmi_versions import FMI2, FMI3, FMI3_SCALAR
from fmu_src.native.package import NativeContents, StageReport, pack_native
from fmu_src.native.platforms import able_platforms
from fmu_src.native.reference_runs import ReferenceRun, reference_runs, with_other_names
from fmu_src.variables.renamed_variables import Renamed, renamed
from fmu_src.variables.texts import check_texts
from fmu_src.variables.variables import by_name_in_system, check_fidelities, variable_table, with_uncomputed
from mbs.common.checks import instance_of, whole
from mbs.compiler.generated.library import named_code_of
from mbs.compiler.ports import map_followers

Say = Callable[[str], None]
_REPEATED = 10.0  # s

KINDS = {
    "native": "FMI 2.0 in C, for every tool",
    "fmi3": "FMI 3.0 in C, with arrays",
    "fmi3_scalar": "FMI 3.0 in C, without arrays, for hosts that do not read them",
    "python": "FMI 2.0 in Python, for hosts with a Python of their own",
}
"""Kinds of FMU."""

_FACES = {"native": FMI2, "fmi3": FMI3, "fmi3_scalar": FMI3_SCALAR}
_NAME_SUFFIX = {"native": "", "fmi3": "FMI3", "fmi3_scalar": "FMI3Scalar", "python": "Python"}


def fmu_name(scene: str, kind: str = "native") -> str:
    """Name of the FMU of a scene: ``prototype_car`` -> ``PrototypeCar``."""
    words = [w for w in re.split(r"[^A-Za-z0-9]+", scene) if w]
    name = "".join(w[0].upper() + w[1:] for w in words)
    if not name or not name[0].isalpha() or not name.isascii():
        raise ValueError(f"'{scene}' gives no name for an FMU; a scene's name begins with a letter from a to z.")
    return name + _NAME_SUFFIX[kind]


def face_name(kind: str) -> str:
    """Name of the face of a kind of FMU, as `fmu_src.native.compilation.compile_library` takes it."""
    return _FACES[kind].name if kind in _FACES else kind


def build_fmu(
    system: Systems,
    name: str,
    out: str | PathLike[str],
    platforms: Sequence[str] | None = None,
    say: Say = lambda text: None,
    kind: str = "native",
    fidelity: int = 0,
    author: str = "",
    copyright: str = "",
    licence: str = "",
    names: Content | None = None,
    plain: bool = False,
) -> Path:
    """Build the FMU of a System.

    Parameters
    ----------
    system : mbs.System, sequence of them or mapping of int to mbs.System
        Several are the choices of the parameter `fidelity`, by number from 0 on or by members of an enumeration, with
        the same inputs, parameters and sensors.
    name : str
        Of the scene, such as ``prototype_car``.
    out : str or path-like
        Folder; made if it is not there.
    platforms : sequence of str, optional
        Out of ``linux64``, ``win64``, ``darwin64``, ``aarch64-linux`` and, for pages, ``wasm32`` (native only); by
        default all but the last that the kind can have.
    say : callable
        Called with one line of progress at a time.
    kind : str
        One of `KINDS`.
    fidelity : int
        The default among several Systems.
    author, copyright, licence : str
        Of the model, for its description; empty: the solver's.
    names : Content, optional
        An alias file, as `ali3.alias_file.read_content` reads it: names, and units, of another program.
    plain : bool
        Without code that is generated for the Systems; the same bits.

    Raises
    ------
    ValueError
        An argument is not what it must be; the message says what would be. Nothing is written.
    ali3.errors.UserError
        The names cannot be those of the variables.
    ali3.errors.FileError
        The file cannot be written.
    """
    if not isinstance(kind, str) or kind not in KINDS:
        raise ValueError(f"There is no FMU kind '{kind}'; the kinds are {', '.join(KINDS)}.")
    platform_names = known_platforms(platforms, able_platforms(kind), kind)
    instance_of((str, PathLike), out, "the folder of an FMU", "a path")
    file = Path(out) / f"{fmu_name(instance_of(str, name, 'the name of an FMU', 'text'), kind)}.fmu"
    check_writable(file)
    # one library is there soon enough
    with compiled_ahead(
        [(face_name(kind), platform) for platform in platform_names] if len(platform_names) > 1 else []
    ):
        builder = FmuBuilder(
            system,
            name,
            fidelity,
            (author, copyright, licence),
            functools.partial(_report_stage, say),
            names=names,
            plain=plain,
        )
        return builder.build(kind, platform_names, file)


class FmuBuilder:
    """Builds the kinds of FMU of one scene, whose common parts are made once.

    Parameters
    ----------
    system : mbs.System, sequence of them or mapping of int to mbs.System
        As for `build_fmu`.
    fidelity : int
        The default among several Systems.
    rights : tuple of str
        Author, copyright and licence of the model; empty: the solver's.
    report_stage : callable
        ``report_stage(what, note)`` makes a context in which `what` is done.
    description : str
        Of the model; empty: that of the System.
    origin : mapping of str to bytes, optional
        Files that the model was made from, by their paths in the FMU.
    names : Content, optional
        As for `build_fmu`.
    plain : bool
        As for `build_fmu`.
    """

    def __init__(
        self,
        system: Systems,
        name: str,
        fidelity: int,
        rights: tuple[str, str, str],
        report_stage: StageReport,
        description: str = "",
        origin: Mapping[str, bytes] | None = None,
        names: Content | None = None,
        plain: bool = False,
    ) -> None:
        systems_by_fidelity = systems_by_number(system)
        systems, followers = map_followers(list(systems_by_fidelity.values()))
        fidelity = whole(fidelity, "the default fidelity of an FMU", 0, len(systems) - 1, ValueError)
        metas = [s.meta for s in systems]
        check_fidelities(metas)
        meta = metas[fidelity]
        table = variable_table(
            meta,
            pose=bool(meta["floating"]),
            step_size=float(meta["experiment"]["step_s"]),
            fidelities=[_label(k) for k in systems_by_fidelity],
            fidelity=fidelity,
        )
        table = with_uncomputed(table, metas)
        description = description or meta.get("description") or ""
        description = description or f"{name.replace('_', ' ')}, a multibody system solved by ALi3"
        check_texts(description, rights, table)
        self._name, self._report_stage = name, report_stage
        with report_stage("finding what depends on what"):
            reach = probe(systems, table)
        table = with_nominal(table, drive_sizes(systems, table), reach.size)
        version = importlib.metadata.version("ali3")
        with report_stage("writing C for the model"):
            code = [] if plain else [named_code_of(s) for s in systems]
        self.renamed = Renamed(table, {}) if names is None else renamed(table, names)
        table = self.renamed.table
        self._contents = NativeContents(
            "", description, version, systems, table, reach, fidelity, followers, *rights, origin or {}, code
        )
        self._scene = geometry(systems[fidelity], table, fmu_name(name), description)
        self._libraries: dict[tuple[str, str], bytes] = {}
        self._runs: tuple[ReferenceRun, ...] = ()

    @property
    def parameters(self) -> ParameterSet:
        """All parameters with their defaults."""
        return replace(self._contents, model_name=fmu_name(self._name)).parameters

    def pieces(self, work: Mapping[str, Sequence[str]]) -> int:
        """Number of pieces of work that `build` will report for these kinds and platforms."""
        run = not self._runs and any(kind in _FACES for kind in work)
        return run + sum(1 + self._libraries_to_make(kind, platforms) for kind, platforms in work.items())

    def _libraries_to_make(self, kind: str, platforms: Sequence[str]) -> int:
        compiled = {folder for name, folder in self._libraries if name == fmu_name(self._name, kind)}
        face = _FACES.get(kind)
        folders = [f for platform in platforms for f in (face.binaries[platform] if face is not None else [platform])]
        return len([folder for folder in folders if folder not in compiled])

    def build(self, kind: str, platforms: Sequence[str], file: Path) -> Path:
        """Build the FMU of a kind.

        `kind`: one of `KINDS`; `file`: replaced at once when all is done.
        """
        geometry = geometry_file(self._scene) if self._scene is not None else b""
        contents = replace(self._contents, model_name=fmu_name(self._name, kind), geometry=geometry)
        if kind == "python":
            from fmu_src.python_slave.package import pack_python  # PythonFMU is needed for this kind only

            pack_python(contents, platforms, file, self._report_stage, self._libraries)
        else:
            if not self._runs:
                with self._report_stage("running the default experiment"):
                    runs = reference_runs(contents.system, contents.follower)
                variables_by_name = by_name_in_system(contents.table, contents.system.meta)
                self._runs = tuple(with_other_names(run, variables_by_name) for run in runs)
            pack_native(contents, _FACES[kind], self._runs, platforms, file, self._report_stage, self._libraries)
        return file


def _label(number: int) -> str:
    """Name of a fidelity that is a member of an enumeration, with its description where it has one."""
    if not isinstance(number, Enum):
        return ""
    text = getattr(number, "description", "")
    return f"{number.name.lower()} ({text})" if text else str(number.name.lower())


@contextmanager
def _report_stage(say: Say, what: str, note: str = "") -> Iterator[None]:
    """A context for work that is reported when it takes long, repeatedly, and at its end."""
    begin = time.perf_counter()
    with watched(lambda lasted: say(f"{what}: {lasted:.0f} s{f' ({note})' if note else ''} ..."), _REPEATED):
        yield
    say(f"{what}: done in {time.perf_counter() - begin:.1f} s")

"""Files that others wrote are opened by a few functions only, which hold them to bounds; the product is walked for
others.
"""

import ast
from collections.abc import Iterator

import pytest

from tests.house.test_import_directions import ROOT

ROOMS = ("ali3", "mbs", "fmu_src", "hosts", "viewer")
DOORS = {
    "ali3/reading.py": "regular files of a limited size",
    "ali3/unpacked_size.py": "packed texts, within bounds of memory",
    "ali3/archives.py": "zip archives",
    "hosts/common/parquet.py": "Parquet, measured unpacked",
}
BEHIND = {
    # Libraries that read what a door has opened, measured or checked.
    ("hosts/compare/log_file.py", "read_csv"),
    ("hosts/fmu/description_file.py", "read_model_description"),
    ("mbs/flexible/calculix.py", "loadtxt"),
    ("mbs/flexible/calculix.py", "meshio.read"),
    ("mbs/flexible/matrix_market.py", "loadtxt"),
    ("mbs/roads/grid_files.py", "Image.open"),
    ("mbs/roads/open_crg.py", "pyopencrg.read"),
    ("ali3/scene/mesh_file.py", "load_mesh"),
}
OWN = {
    # What this program wrote a moment before, or what is installed with it.
    "ali3/call_mark.py",
    "ali3/chart_description.py",
    "ali3/plausibility/quantity.py",
    "ali3/process_supervisor.py",
    "hosts/driving/recorded_rows.py",
    "ali3/isolated_processes.py",
    "fmu_src/native/archive.py",
    "fmu_src/native/compilation.py",
    "fmu_src/native/sources.py",
    "fmu_src/python_slave/package.py",
    "hosts/check/documents.py",
    "hosts/check/instance.py",
    "hosts/check/portability.py",
    "hosts/check/process_settings.py",
    "hosts/check/process_state.py",
    "hosts/common/program.py",
    "mbs/compiler/generated/library.py",
    "mbs/kernel/build.py",
    "mbs/kernel/read_headers.py",
    "mbs/vehicle/copy_car.py",
    "viewer/bundle.py",
    "viewer/gltf.py",
    "viewer/html_document.py",
    "viewer/looks.py",
    "viewer/page_build.py",
    "viewer/video.py",
}
METHODS = {"read_text", "read_bytes"}
FUNCTIONS = {
    *("mmread", "mminfo", "load_npz", "loadtxt", "genfromtxt", "fromfile", "memmap", "loadmat", "fmpy.extract"),
    *("ZipFile", "is_zipfile", "PyZipFile", "unpack_archive", "extractall", "TarFile", "tarfile.open", "gzip.open"),
    *("bz2.open", "lzma.open", "GzipFile", "ParquetFile", "pq.read_table", "parquet.read_table", "read_parquet"),
    *("read_csv", "read_excel", "read_hdf", "h5py.File", "MDF", "Image.open", "load_mesh", "trimesh.load"),
    *("meshio.read", "pyopencrg.read", "np.load", "numpy.load", "etree.parse", "ElementTree.parse", "ET.parse"),
    *("read_model_description", "validate_fmu", "io.open", "codecs.open", "fileinput.input", "linecache.getlines"),
}


def readers(tree: ast.AST) -> Iterator[str]:
    """Calls that open a file to read it, by their names."""
    for call in ast.walk(tree):
        if not isinstance(call, ast.Call):
            continue
        name = ast.unparse(call.func)
        last = name.rpartition(".")[2]
        short = {full for full in FUNCTIONS if name == full or name.endswith("." + full)}
        if last in METHODS:
            if not name.startswith(("files(", "archive")) and isinstance(call.func, ast.Attribute):
                yield last
        elif short and not any(isinstance(a, ast.Constant) and str(a.value)[:1] in "wxa" for a in call.args[1:2]):
            yield max(short, key=len)
        elif last == "open":
            mode_arguments = [*call.args[name == "open" :], *(k.value for k in call.keywords if k.arg == "mode")][:1]
            mode = mode_arguments[0].value if mode_arguments and isinstance(mode_arguments[0], ast.Constant) else None
            bare = not call.args and (not call.keywords or {k.arg for k in call.keywords} & {"mode", "encoding"})
            reads = not isinstance(mode, str) or ("r" in mode and "+" not in mode)
            if reads and (name == "open" or bare or isinstance(mode, str)):
                yield "open"


@pytest.mark.slow
def test_files_are_opened_by_the_doors_alone() -> None:
    results, used = [], set[str]()
    for room in ROOMS:
        for file in sorted((ROOT / room).rglob("*.py")):
            place = file.relative_to(ROOT).as_posix()
            for name in readers(ast.parse(file.read_text(encoding="utf-8"))):
                used |= {place}
                if place not in DOORS and place not in OWN and (place, name) not in BEHIND:
                    results.append(f"{place}: {name}")
    assert not results, "read through a door of this list, or say why it is behind one:\n" + "\n".join(results)
    assert sorted({*DOORS, *OWN, *(place for place, _ in BEHIND)} - used) == []

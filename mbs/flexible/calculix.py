"""Models written by CalculiX with ``*FREQUENCY, SOLVER=MATRIXSTORAGE`` (mesh reader: meshio, extra `fem`)."""

from functools import partial
from io import StringIO
from pathlib import Path

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import spsolve

from ali3.extras import missing_module
from ali3.message_text import brief
from ali3.reading import is_file, missing_file_text, open_file, read_bytes
from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel
from mbs.flexible.foreign_file import MAX_BYTES, read_foreign
from mbs.flexible.matrix_files import external_model


def read_calculix(deck: str | Path, *, total_mass: float | None = None) -> FiniteElementModel:
    """Model of solid elements from ``name.inp`` and the files ``name.sti``, ``.mas`` and ``.dof`` beside it.

    The deck must have no supports and SI units; nodes keep their numbers as names and have three translations.

    Parameters
    ----------
    total_mass : float, optional
        As in `external_model`.

    Returns
    -------
    FiniteElementModel
        Of the nodes that have freedoms; checked, with a `summary`, as by `external_model`.

    Raises
    ------
    ModelError
        meshio is not installed, a file is missing, or the deck has supports.
    """
    K, M, positions, numbers = calculix_matrices(deck)
    names = [str(number) for number in numbers]
    return external_model(K, M, positions, names, total_mass=total_mass, what=Path(deck).name)


def calculix_matrices(deck: str | Path) -> tuple[sp.csc_array, sp.csc_array, np.ndarray, list[int]]:
    """Read stiffness and mass (3 n, 3 n), with x, y, z of one node after the other, positions (n, 3) and node numbers.

    Raises `ModelError` as `read_calculix` does.
    """
    try:
        import meshio
    except ModuleNotFoundError as error:
        raise ModelError(f"CalculiX decks are read with meshio. {missing_module(error, 'fem')}") from error
    deck = Path(deck)
    files = [deck, *(deck.with_suffix(suffix) for suffix in (".sti", ".mas", ".dof"))]
    for path in files:
        if not is_file(path):
            raise ModelError(missing_file_text(path, " *FREQUENCY, SOLVER=MATRIXSTORAGE writes it."))
    nodes = read_foreign(deck, _node_lines)
    text = StringIO("\n".join(["*NODE", *nodes]))
    points = read_foreign(deck, lambda path: np.asarray(meshio.read(text, file_format="abaqus").points, float))
    numbers = [int(line.partition(",")[0]) for line in nodes]
    if not numbers:
        raise ModelError(f"{deck.name} has no nodes.")
    freedoms = read_foreign(files[3], _read_freedoms)
    table = _row_table(numbers, freedoms)
    complete = (table >= 0).all(axis=1)
    entries = [read_foreign(path, _read_entries) for path in files[1:3]]
    _check_entries(files[1:3], entries, table[complete])
    K, M = (
        read_foreign(path, partial(_symmetric_matrix, size=len(freedoms), entries=e))
        for path, e in zip(files[1:3], entries, strict=True)
    )
    K, M = _condense(K, M, table[complete].ravel())
    return K, M, points[complete], [numbers[int(i)] for i in np.flatnonzero(complete)]


def _row_table(numbers: list[int], freedoms: list[tuple[int, int]]) -> np.ndarray:
    """Row of the matrices by node and axis, -1: none, shape (n, 3). Raises `ModelError` if the deck has supports."""
    row = {number: i for i, number in enumerate(numbers)}
    table = np.full((len(numbers), 3), -1)
    for k, (node, axis) in enumerate(freedoms):
        if node in row and axis < 3:
            table[row[node], axis] = k
    complete = (table >= 0).all(axis=1)
    supported = np.flatnonzero(~complete & (table >= 0).any(axis=1))
    if supported.size or not complete.any():
        node = numbers[int(supported[0])] if supported.size else numbers[0]
        raise ModelError(f"Node {node} has a supported direction; give the free model, without supports.")
    return table


def _check_entries(paths: list[Path], entries: list[np.ndarray], rows: np.ndarray) -> None:
    """Raise `ModelError` if stiffness or mass lack a diagonal entry, or differ in number where the mass is not lumped.

    `rows`: rows of the freedoms of the nodes, from 0.
    """
    for path, triangle in zip(paths, entries, strict=True):
        if len(triangle) != 3 or not np.isin(rows + 1, triangle[0][triangle[0] == triangle[1]]).all():
            raise ModelError(f"{path.name} must have a diagonal entry for each freedom; it is damaged.")
    stiffness, mass = entries
    is_lumped = np.array_equal(mass[0], mass[1])
    if stiffness.shape != mass.shape and not is_lumped:
        raise ModelError(f"{paths[0].name} and {paths[1].name} must have as many entries; one of them is damaged.")


def _read_freedoms(path: Path) -> list[tuple[int, int]]:
    """Node number and axis, from 0, of each row of the matrices."""
    return [(int(node), int(axis) - 1) for node, axis in (f.split(".") for f in _read_text(path).split())]


def _read_entries(path: Path) -> np.ndarray:
    """Rows, columns and values of one triangle, shape (3, entries)."""
    with open_file(path, MAX_BYTES, ModelError, path.name) as file:
        return np.loadtxt(file, unpack=True, ndmin=2, encoding="latin-1")


def _condense(K: sp.csc_array, M: sp.csc_array, retained: np.ndarray) -> tuple[sp.csc_array, sp.csc_array]:
    """Condense statically to the freedoms `retained`; the others are internal to elements (incompatible modes)."""
    dropped = np.setdiff1d(np.arange(K.shape[0]), retained)
    if not dropped.size:
        return K[retained][:, retained], M[retained][:, retained]
    transmission = -sp.csc_array(spsolve(sp.csc_matrix(K[dropped][:, dropped]), sp.csc_matrix(K[dropped][:, retained])))
    T = sp.csc_array(sp.vstack([sp.identity(retained.size), transmission]))
    order = np.concatenate([retained, dropped])
    K, M = (sp.csc_array(T.T @ X[order][:, order] @ T) for X in (K, M))
    return K, M


def _symmetric_matrix(_: Path, entries: np.ndarray, size: int) -> sp.csc_array:
    """Symmetric matrix from rows, columns (from 1) and values of one triangle."""
    i, j, value = entries
    triangle = sp.coo_array((value, (i.astype(int) - 1, j.astype(int) - 1)), shape=(size, size)).tocsc()
    return sp.csc_array(triangle + triangle.T - sp.diags(triangle.diagonal()))


def _node_lines(deck: Path) -> list[str]:
    """Lines of the nodes of a deck; its reader gets no others, because they may name files or endless sets."""
    lines, inside = [], False
    for line in _read_text(deck).splitlines():
        if line.startswith("**"):
            continue
        if line.startswith("*"):
            keyword = line.split(",")[0].strip().upper()
            inside = keyword == "*NODE"
            if keyword == "*INCLUDE":
                raise ModelError(f"{deck.name} includes another file ({brief(line)}); give the whole deck.")
        elif inside and line.strip():
            int(line.partition(",")[0])
            lines.append(line)
    return lines


def _read_text(path: Path) -> str:
    return read_bytes(path, MAX_BYTES, ModelError, path.name).decode("latin-1")

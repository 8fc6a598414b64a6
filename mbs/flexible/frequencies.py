"""Natural frequencies and mode shapes of large sparse models, free or held."""

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike
from scipy.linalg import eigh
from scipy.sparse.linalg import ArpackError, eigsh

from mbs.common.checks import instance_of, whole
from mbs.common.errors import ModelError
from mbs.flexible.fe_model import FiniteElementModel

DENSE = 300  # below this size all modes are computed at once


def natural_modes(model: FiniteElementModel, count: int, held: ArrayLike = ()) -> tuple[np.ndarray, np.ndarray]:
    """The lowest `count` modes; the first six of a free model are its rigid motions (0 Hz).

    Parameters
    ----------
    held : array_like of int, shape (n,)
        Degrees of freedom held to zero.

    Returns
    -------
    frequencies : ndarray, shape (count,)
        Hz, ascending.
    shapes : ndarray, shape (n_dof, count)
        Mass-normalised; the largest entry of each is positive.

    Raises
    ------
    ModelError
        More modes are asked for than there are, or a motion has neither stiffness nor mass.
    """
    instance_of(FiniteElementModel, model, "The model", "a FiniteElementModel")
    count = whole(count, "The count of modes", 0, 10**6)
    free = np.setdiff1d(np.arange(model.n_dof), np.asarray(held, int))
    K = sp.csc_array(model.K[free][:, free])
    M = sp.csc_array(model.mass_matrix()[free][:, free])
    mass_freedoms = np.flatnonzero(M.diagonal() > 0).size
    if count > mass_freedoms:
        raise ModelError(f"{count} modes were asked for; the model has mass for at most {mass_freedoms}.")
    if count == 0:
        return np.zeros(0), np.zeros((model.n_dof, 0))
    # a shift below zero keeps the factorisation regular for free models; small against the lowest elastic mode
    shift = -1e-3 * float(np.min(K.diagonal() / np.maximum(M.diagonal(), 1e-6 * M.diagonal().max())))
    try:
        if free.size <= DENSE or count >= free.size - 1:
            shifted = (K - shift * M).toarray()
            values, V = eigh(M.toarray(), shifted, subset_by_index=[free.size - count, free.size - 1])
            if values.size < count:  # LAPACK may find none where the subset divides modes of one frequency
                values, V = eigh(M.toarray(), shifted)
            squares, V = shift + 1 / values[: -count - 1 : -1], V[:, : -count - 1 : -1]
        else:
            squares, V = eigsh(K, k=count, M=M, sigma=shift, which="LM", v0=np.ones(free.size))
            order = np.argsort(squares)
            squares, V = squares[order], V[:, order]
    except (np.linalg.LinAlgError, RuntimeError, ArpackError) as error:
        raise ModelError(
            "The modes cannot be computed: a motion has neither stiffness nor mass (a straight beam needs its rotary "
            "inertia to resist a twist)."
        ) from error
    V = V / np.sqrt(np.einsum("ij,ij->j", V, M @ V))
    shapes = np.zeros((model.n_dof, count))
    shapes[free] = V
    largest_entries = shapes[np.abs(shapes).argmax(axis=0), np.arange(count)]
    return np.sqrt(np.maximum(squares, 0.0)) / (2 * np.pi), shapes * np.sign(largest_entries)

"""Drawing data of a System: its scene, and the frames as functions of its coordinates."""

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from mbs.model.model import Model
from mbs.shapes.frames import FrameNames, places_of
from mbs.shapes.scene import drawing_of
from mbs.system.drawing import Drawing


def drawing(model: Model, T: sparse.csr_matrix, constant: NDArray[np.float64], q: NDArray[np.float64]) -> Drawing:
    """Scene and places of a model whose full coordinates are ``T q + constant`` and which starts at `q` (nq,)."""
    names = FrameNames.of(model)
    return drawing_of(model, places_of(model, T.tocsr(), constant, names), names, q)

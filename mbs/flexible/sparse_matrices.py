"""Type of sparse matrices that are accepted."""

from typing import Any, TypeAlias

import scipy.sparse as sp

Sparse: TypeAlias = "sp.csc_array[Any] | sp.csr_array[Any] | sp.coo_array[Any]"

"""Payloads as the `payload_` arrays of the System, and their entries in its mass matrix."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy import sparse

from mbs.common.affine import Affine
from mbs.common.errors import ModelError
from mbs.common.vectors import in_space
from mbs.compiler.polynomial import substitute
from mbs.compiler.tables import Signals
from mbs.kernel.header.enumerations import SensorType
from mbs.model.model import Model


def payload_cliques(model: Model, full: Sequence[Affine]) -> list[list[int]]:
    """Coordinates of z (before ordering) that each component of a payload couples in the mass matrix."""
    return [sorted(substitute(s, full).terms) for p in model.payloads for s in p.point.components]


def add_entries(mass: sparse.csr_matrix, cliques: Sequence[Sequence[int]]) -> sparse.csr_matrix:
    """The mass matrix with entries between all coordinates of each clique, new ones zero."""
    old = mass.tocoo()
    rows = np.array([i for c in cliques for i in c for _ in c], dtype=np.int64)
    columns = np.array([j for c in cliques for _ in c for j in c], dtype=np.int64)
    entries = (np.concatenate([old.row, rows]), np.concatenate([old.col, columns]))
    return sparse.coo_matrix((np.concatenate([old.data, np.zeros(len(rows))]), entries), shape=mass.shape).tocsr()


def payload_arrays(model: Model, signals: Signals) -> dict[str, Any]:
    """The `payload_` arrays; in the plane the third component is 0."""
    _check_ports(model)
    numbers = []
    for payload in model.payloads:
        components = [*payload.point.components, *[Affine({}, 0.0)] * (3 - model.dimension)]
        numbers += [signals.number(component) for component in components]
    return {
        "payload_mass": [p.mass for p in model.payloads],
        "payload_signal": numbers,
        "payload_gravity": in_space(model.gravity) if model.payloads else [],
    }


def _check_ports(model: Model) -> None:
    """Refuse payloads beside the ports of a body, because quasi-static outputs contain forces at ports alone."""
    for sensor in model.sensors:
        if sensor.type != SensorType.QUASI_STATIC:
            continue
        rotation_coordinates: set[int] = {i for s in sensor.signals[3:12] for i in s.terms}
        for payload in model.payloads:
            body_coordinates = set(range(payload.body.start, payload.body.start + payload.body.size))
            on_body = {i for s in payload.point.components for i in s.terms} <= body_coordinates
            if on_body and rotation_coordinates <= body_coordinates:
                body = payload.body.name.removesuffix(" with ports")
                raise ModelError(
                    f"The sensor '{sensor.name}' follows the forces at the ports of body '{body}', where the payload "
                    f"'{payload.name}' has none: add a port at {payload.position.tolist()} and put the payload on the "
                    "body with ports."
                )

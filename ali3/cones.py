"""Positions of the cones beside the lanes of a track."""

from collections.abc import Sequence

from ali3.iso_3888 import Gate

_APART = 5.0  # m, about


def cone_places(gates: Sequence[Gate]) -> list[tuple[float, float]]:
    """Positions (x, y) in m of cones along both edges of lanes: at their ends and about every 5 m."""
    places = []
    for gate in gates:
        length = gate.x_end - gate.x_start
        parts = max(1, round(length / _APART))
        for k in range(parts + 1):
            x = gate.x_start + length * k / parts
            places += [(x, gate.y_right), (x, gate.y_left)]
    return places

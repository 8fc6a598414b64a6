"""Positions of the cones beside the lanes of a track."""

from collections.abc import Sequence

from ali3.iso_3888 import Gate

_SPACING = 5.0  # m, approximate


def cone_places(gates: Sequence[Gate]) -> list[tuple[float, float]]:
    """Positions (x, y) in m of cones along both edges of lanes: at their ends and about every 5 m."""
    positions = []
    for gate in gates:
        length = gate.x_end - gate.x_start
        n_intervals = max(1, round(length / _SPACING))
        for k in range(n_intervals + 1):
            x = gate.x_start + length * k / n_intervals
            positions += [(x, gate.y_right), (x, gate.y_left)]
    return positions

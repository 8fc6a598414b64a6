"""What a pilot is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol


class Pilot(Protocol):
    """Who drives: from what the car senses to its inputs."""

    def act(self, time: float, senses: Mapping[str, float]) -> dict[str, float]:
        """Inputs for the coming communication step; `senses` are all outputs by our names, until that step is made."""
        ...

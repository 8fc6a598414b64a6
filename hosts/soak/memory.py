"""Memory of this process over a drive."""

from statistics import median

import psutil

LARGEST_GROWTH = 2.0
"""MB from a quarter of a drive to its end: Python's own varies by less, a leak of a state in each run is more."""


class Memory:
    """Samples of the resident memory."""

    def __init__(self) -> None:
        self._process = psutil.Process()
        self._samples: list[float] = []

    def sample(self) -> None:
        """Take a sample of the memory."""
        self._samples.append(1e-6 * self._process.memory_info().rss)

    def growth(self) -> tuple[float, float, float]:
        """Memory after the first quarter and at the end, and its growth, MB; medians of a tenth of the samples."""
        count = len(self._samples)
        if count < 8:
            return 0.0, 0.0, 0.0
        some = max(count // 10, 1)
        first, last = median(self._samples[count // 4 : count // 4 + some]), median(self._samples[-some:])
        return first, last, last - first

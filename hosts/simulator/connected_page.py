"""A connected page: frames in flight, queued texts, and the limit of its message rate."""

import time
from collections import deque
from collections.abc import Callable

from websockets.asyncio.server import ServerConnection

from hosts.common.errors import HostError

IN_FLIGHT = 2
"""Frames that a page has not acknowledged; it gets no further one before it has."""
MOST_TEXTS = 200
MESSAGES_PER_SECOND = 400.0
BURST = 800.0
MOST_MALFORMED = 20
STALLED = 2.0
"""A page that has frames and says nothing for so long, s, has its inputs let go."""


class ConnectedPage:
    """What the server keeps of a page.

    `number`: from 1, for names of its sources; `now`: seconds of a clock that never goes back.
    """

    def __init__(self, number: int, connection: ServerConnection, now: Callable[[], float] = time.monotonic) -> None:
        self.number = number
        self.connection = connection
        self.sources: set[str] = set()
        self.watches_devices = False
        self.stalled = False
        self.watched = False  # has had a frame
        self.texts: deque[str] = deque(maxlen=MOST_TEXTS)  # of a page that stalls the oldest are lost
        self._now = now
        self._unseen: deque[tuple[float, float]] = deque()
        self._heard = now()
        self._may_say = BURST
        self._malformed = 0

    def source(self, kind: str) -> str:
        """The name of one of its sources of inputs, which it has from now on."""
        name = f"page {self.number} {kind}"
        self.sources.add(name)
        return name

    def heard(self) -> None:
        """It has said something. Raises `HostError`: it says too much."""
        now = self._now()
        self._may_say = min(BURST, self._may_say + (now - self._heard) * MESSAGES_PER_SECOND) - 1.0
        self._heard = now
        self.stalled = False
        if self._may_say < 0.0:
            raise HostError(f"A page may send {MESSAGES_PER_SECOND:g} messages a second; this one sent more.")

    def malformed(self) -> None:
        """It has said something wrong. Raises `HostError`: too often."""
        self._malformed += 1
        if self._malformed > MOST_MALFORMED:
            raise HostError(f"More than {MOST_MALFORMED} messages of this page were wrong.")

    def sent(self, count: float) -> None:
        """A frame of this count is on its way."""
        self._unseen.append((count, self._now()))

    def saw(self, count: float) -> None:
        """It has the frames up to this count."""
        self.watched = True
        while self._unseen and self._unseen[0][0] <= count:
            self._unseen.popleft()

    @property
    def takes_more(self) -> bool:
        """Whether another frame may be sent."""
        return len(self._unseen) < IN_FLIGHT

    def stalls(self) -> bool:
        """Whether it stalls since now: it has frames, and neither acknowledges them nor says anything else."""
        now = self._now()
        still = bool(self._unseen) and now - self._unseen[0][1] > STALLED and now - self._heard > STALLED
        begins = still and not self.stalled
        self.stalled = self.stalled or still
        return begins

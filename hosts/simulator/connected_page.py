"""A connected page: frames in flight, queued texts, and the limit of its message rate."""

import time
from collections import deque
from collections.abc import Callable

from websockets.asyncio.server import ServerConnection

from hosts.common.errors import HostError

IN_FLIGHT = 2
"""Largest number of frames that a page has not acknowledged."""
MAX_TEXTS = 200
MESSAGES_PER_SECOND = 400.0
BURST = 800.0
MAX_MALFORMED = 20
STALLED = 2.0
"""Time without a message from a page with frames, s, after which its inputs are released."""


class ConnectedPage:
    """The state of a connected page.

    `number`: number of the page, from 1, for names of its sources; `now`: a monotonic clock, s.
    """

    def __init__(self, number: int, connection: ServerConnection, now: Callable[[], float] = time.monotonic) -> None:
        self.number = number
        self.connection = connection
        self.sources: set[str] = set()
        self.watches_devices = False
        self.stalled = False
        self.watched = False  # has acknowledged a frame
        self.texts: deque[str] = deque(maxlen=MAX_TEXTS)  # when full, the oldest is dropped
        self._now = now
        self._unacknowledged: deque[tuple[float, float]] = deque()
        self._last_message = now()
        self._message_allowance = BURST
        self._malformed = 0

    def source(self, kind: str) -> str:
        """Add a source of inputs of the page; its name."""
        name = f"page {self.number} {kind}"
        self.sources.add(name)
        return name

    def heard(self) -> None:
        """Note a received message. Raises `HostError` if the page sends too many."""
        now = self._now()
        self._message_allowance = (
            min(BURST, self._message_allowance + (now - self._last_message) * MESSAGES_PER_SECOND) - 1.0
        )
        self._last_message = now
        self.stalled = False
        if self._message_allowance < 0.0:
            raise HostError(f"A page may send {MESSAGES_PER_SECOND:g} messages a second; this one sent more.")

    def malformed(self) -> None:
        """Note a malformed message. Raises `HostError` if the page has sent too many."""
        self._malformed += 1
        if self._malformed > MAX_MALFORMED:
            raise HostError(f"More than {MAX_MALFORMED} messages of this page were wrong.")

    def sent(self, count: float) -> None:
        """Note that the frame of this count was sent."""
        self._unacknowledged.append((count, self._now()))

    def saw(self, count: float) -> None:
        """Note that the page acknowledges frames up to this count."""
        self.watched = True
        while self._unacknowledged and self._unacknowledged[0][0] <= count:
            self._unacknowledged.popleft()

    @property
    def takes_more(self) -> bool:
        """Whether another frame may be sent."""
        return len(self._unacknowledged) < IN_FLIGHT

    def stalls(self) -> bool:
        """Whether the page begins to stall: it has frames, and neither acknowledges them nor sends other messages."""
        now = self._now()
        is_stalled = (
            bool(self._unacknowledged)
            and now - self._unacknowledged[0][1] > STALLED
            and now - self._last_message > STALLED
        )
        begins = is_stalled and not self.stalled
        self.stalled = self.stalled or is_stalled
        return begins

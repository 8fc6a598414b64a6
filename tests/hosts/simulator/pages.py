"""What a page receives from the server."""

import json
import struct
import time

HEADER = "<4I10d"


def frames(page, count):
    """The next frames, each acknowledged."""
    results = []
    while len(results) < count:
        data = page.recv(timeout=10)
        if isinstance(data, bytes):
            results.append(data)
            page.send(json.dumps({"type": "seen", "count": struct.unpack_from(HEADER, data)[4]}))
    return results


def texts(page, kind):
    """The next text of a kind; frames are acknowledged."""
    deadline = time.monotonic() + 20
    while time.monotonic() < deadline:
        data = page.recv(timeout=10)
        if isinstance(data, bytes):
            page.send(json.dumps({"type": "seen", "count": struct.unpack_from(HEADER, data)[4]}))
        elif (message := json.loads(data))["type"] == kind:
            return message
    raise AssertionError(f"no {kind} came")


def until(condition):
    deadline = time.monotonic() + 10
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def read_to_the_end(page):
    while True:
        page.recv(timeout=10)

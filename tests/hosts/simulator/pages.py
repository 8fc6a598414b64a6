"""What a page receives from the server."""

import json
import struct
import time

HEADER = "<4I10d"
PATIENCE = 60.0  # s, of a machine that does much else


def frames(page, count):
    """The next frames, each acknowledged."""
    results = []
    while len(results) < count:
        data = page.recv(timeout=PATIENCE)
        if isinstance(data, bytes):
            results.append(data)
            page.send(json.dumps({"type": "seen", "count": struct.unpack_from(HEADER, data)[4]}))
    return results


def texts(page, kind):
    """The next text of a kind; frames are acknowledged."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        data = page.recv(timeout=PATIENCE)
        if isinstance(data, bytes):
            page.send(json.dumps({"type": "seen", "count": struct.unpack_from(HEADER, data)[4]}))
        elif (message := json.loads(data))["type"] == kind:
            return message
    raise AssertionError(f"no {kind} came")


def until(condition):
    deadline = time.monotonic() + PATIENCE
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


def read_to_the_end(page):
    while True:
        page.recv(timeout=PATIENCE)

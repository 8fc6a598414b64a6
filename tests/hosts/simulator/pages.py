"""What a page receives from the server."""

import json
import struct
import time

HEADER = "<4I10d"
PATIENCE = 120.0  # s, of a machine that does much else


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


def until(what):
    """Wait until the value of a function is true; returns it."""
    deadline = time.monotonic() + PATIENCE
    while not (value := what()):
        assert time.monotonic() < deadline, "it did not happen in time"
        time.sleep(0.002)
    return value


def read_to_the_end(page):
    while True:
        page.recv(timeout=PATIENCE)

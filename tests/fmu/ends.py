"""A host in bare Python that ends in one of many ways: ends.py END FOLDER..., with the folders of unpacked FMUs."""

import atexit
import ctypes
import os
import sys
import threading
import time
from ctypes import (
    CDLL,
    CFUNCTYPE,
    POINTER,
    PyDLL,
    Structure,
    byref,
    c_char_p,
    c_double,
    c_int,
    c_uint,
    c_ulong,
    c_void_p,
)
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

LIBC = CDLL(None)
LOGGER = CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p)
messages: list[bytes] = []


def address(function: Any) -> int:
    return ctypes.cast(function, c_void_p).value or 0


class Callbacks(Structure):
    _fields_ = (
        ("logger", LOGGER),
        ("allocate", c_void_p),
        ("release", c_void_p),
        ("finished", c_void_p),
        ("environment", c_void_p),
    )


CALLBACKS = Callbacks(
    LOGGER(lambda e, n, s, c, text: messages.append(text)), address(LIBC.calloc), address(LIBC.free), None, None
)


class Instance:
    """An instance after its first step, with a saved state that nobody frees."""

    def __init__(self, folder: Path) -> None:
        head = ElementTree.parse(folder / "modelDescription.xml").getroot()
        name = head[0].attrib["modelIdentifier"]
        self.library = CDLL(str(folder / "binaries" / "linux64" / f"{name}.so"))
        self.library.fmi2Instantiate.restype = c_void_p
        guid, uri = head.attrib["guid"].encode(), (folder / "resources").as_uri().encode()
        self.component = c_void_p(self.library.fmi2Instantiate(b"ends", 1, guid, uri, byref(CALLBACKS), 0, 0))
        assert self.component.value, messages
        self.call("SetupExperiment", 0, c_double(0.0), c_double(0.0), 0, c_double(0.0))
        self.call("EnterInitializationMode")
        self.call("ExitInitializationMode")
        self.time = 0.0
        self.step()
        self.call("GetFMUstate", byref(c_void_p()))

    def call(self, function: str, *arguments: Any) -> None:
        status = getattr(self.library, f"fmi2{function}")(self.component, *arguments)
        assert status == 0, (function, status, messages)

    def step(self) -> None:
        self.call("DoStep", c_double(self.time), c_double(0.01), 1)
        self.time += 0.01
        self.call("GetReal", (c_uint * 1)(4), 1, (c_double * 1)())

    def free(self) -> None:
        self.step()
        self.library.fmi2FreeInstance(self.component)

    def unload(self) -> None:
        LIBC.dlclose(c_void_p(self.library._handle))


class Last:
    """What is done while the interpreter takes its modules apart."""

    def __init__(self, done: Any) -> None:
        self.done = done

    def __del__(self) -> None:
        self.done()


def in_threads(act: Any) -> None:
    """In six threads, until the process ends."""
    sys.stderr = None  # of threads that the end breaks off

    def again(folder: Path) -> None:
        while True:
            act(folder)

    for folder in 3 * FOLDERS:
        threading.Thread(target=again, args=(folder,), daemon=True).start()
    time.sleep(0.2)


def threads_wait_to_free() -> None:
    """Threads of the system wait for the interpreter's lock in fmi2FreeInstance when the interpreter ends."""
    locked = PyDLL(None)  # its calls keep the lock
    sys.setswitchinterval(0.05)
    sys.last = Last(lambda: locked.usleep(200_000))  # type: ignore[attr-defined]
    locked.pthread_create.argtypes = [POINTER(c_ulong), c_void_p, c_void_p, c_void_p]
    for instance in instances:
        locked.pthread_create(byref(c_ulong()), None, address(instance.library.fmi2FreeInstance), instance.component)


def in_a_child() -> None:
    child = os.fork()
    if child and os.waitpid(child, 0)[1]:
        os.abort()


def live_and_die(folder: Path) -> None:
    Instance(folder).free()


def free() -> None:
    for instance in instances:
        instance.free()


def unload() -> None:
    for instance in instances:
        instance.unload()


def many() -> None:
    more = [Instance(folder) for folder in 20 * FOLDERS]
    for instance in more[::2]:
        instance.free()


ENDS: dict[str, Any] = {
    "nothing freed": lambda: None,
    "unloaded": unload,
    "freed and unloaded": lambda: (free(), unload()),
    "many": many,
    "handler before": lambda: None,
    "handler after": lambda: atexit.register(free),
    "fork": in_a_child,
    "threads step": lambda: in_threads(lambda folder: [i.step() for i in [Instance(folder)] for _ in range(50)]),
    "threads make and free": lambda: in_threads(live_and_die),
    "threads wait to free": threads_wait_to_free,
    "freed by the last destructor": lambda: setattr(sys, "last", Last(free)),
    "made by the last destructor": lambda: setattr(sys, "last", Last(lambda: live_and_die(FOLDERS[0]))),
}

if __name__ == "__main__":
    END, FOLDERS = sys.argv[1], [Path(folder) for folder in sys.argv[2:]]
    instances: list[Instance] = []
    if END == "handler before":
        atexit.register(free)
    instances += [Instance(folder) for folder in FOLDERS]
    ENDS[END]()

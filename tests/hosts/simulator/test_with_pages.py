"""The command with pages, from the terminal to the car's process: a drive, hostile clients, Ctrl-C, and the report."""

import json
import re
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

import numpy as np
import psutil
import pytest
from websockets.exceptions import WebSocketException
from websockets.sync.client import connect

from tests.hosts.simulator.pages import HEADER, PATIENCE
from tests.hosts.simulator.raw_client import RawClient, request
from viewer import bundle

ROOT = Path(__file__).parents[3]
STEP = 0.005
HOSTILE_STEPS = 300
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Ctrl-C of another process is sent by a signal")


@pytest.fixture(scope="module")
def sledge(scene_fmu):
    try:
        bundle.bundle()
    except RuntimeError as error:
        pytest.skip(str(error))
    return scene_fmu(f"{ROOT / 'tests' / 'hosts' / 'scenes.py'}:sledge")


class Program:
    """The command as a user runs it."""

    def __init__(self, *arguments):
        command = [sys.executable, "-m", "ali3", "simulator", *map(str, arguments), "--no-open", "--no-devices"]
        self.process = subprocess.Popen(
            command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, encoding="utf-8"
        )
        self.lines = []
        for line in self.process.stdout:
            self.lines.append(line)
            if match := re.search(r"Drive at (http://\S+:(\d+)/\S*)", line):
                self.address, self.port = match[1], int(match[2])
                self.url = self.address.replace("http", "ws").replace("/?", "/drive?")
                self.key = f"?{self.address.partition('?')[2]}"
                return
        raise AssertionError("".join(self.lines))

    def end(self):
        """Ctrl-C; the exit code."""
        self.process.send_signal(signal.SIGINT)
        self.lines.extend(self.process.stdout)  # communicate() would pass over lines that are read ahead
        return self.process.wait(timeout=PATIENCE)

    @property
    def said(self):
        return "".join(self.lines)


@contextmanager
def program(*arguments):
    running = Program(*arguments)
    try:
        yield running
    finally:
        if running.process.poll() is None:
            running.process.kill()
            running.process.wait()
        running.process.stdout.close()


class Page:
    """What a page does: acknowledge, keep the columns and the newest frame."""

    def __init__(self, connection):
        self.connection = connection
        self.hello = json.loads(connection.recv(timeout=PATIENCE))
        self.texts = []
        self.next()

    def next(self):
        """Read until the next frame."""
        while isinstance(data := self.connection.recv(timeout=PATIENCE), str):
            self.texts.append(json.loads(data))
        head = struct.unpack_from(HEADER, data)
        self.epoch, self.flags, self.count, self.time = head[1], head[2], head[4], head[5]
        values = np.frombuffer(data, "<f8", offset=96)
        self.values = dict(zip(self.hello["columns"], values, strict=True))
        self.say("seen", count=self.count)

    def say(self, kind, **content):
        self.connection.send(json.dumps({"type": kind, **content}))

    def until(self, condition):
        deadline = time.monotonic() + PATIENCE
        while not condition(self):
            assert time.monotonic() < deadline
            self.next()


@pytest.mark.slow
def test_a_drive_from_a_page_and_the_report_at_ctrl_c(sledge, tmp_path):
    with program(sledge, "--port", 0, "--step", STEP, "--json", tmp_path / "r.json", "--listen", "0.0.0.0") as running:
        assert request(running.port, "/", {})[0] == 403
        assert request(running.port, "/drive", {}, upgrade=True)[0] == 403
        status, _, page = request(running.port, f"/{running.key}", {})
        assert status == 200
        assert b"ALi3Viewer.Simulator" in page
        world = json.loads(request(running.port, f"/world{running.key}", {})[2])
        assert (world["name"], world["scenery"], world["places"]) == ("", [], [])
        with connect(f"ws://127.0.0.1:{running.port}/drive{running.key}") as connection:
            page = Page(connection)
            assert page.hello["scene"]["roads"] == []
            page.until(lambda p: p.count > 20)
            assert page.values["speed"] == 0.0
            page.say("want", source="keys", values={"throttle": [1.0, 2.5]})
            page.until(lambda p: p.values["throttle"] == 1.0 and p.values["speed"] > 0.0)
            page.say("command", name="pause")
            page.until(lambda p: not p.flags & 1)
            before = page.time
            page.say("command", name="run")
            page.until(lambda p: p.time > before + 0.5)
            page.say("command", name="rewind", value=0.3)
            epoch = page.epoch
            page.until(lambda p: p.epoch > epoch)
            page.until(lambda p: any(text.get("kind") == "rewind" for text in p.texts))
            page.say("report")
            page.until(lambda p: any(text["type"] == "report" for text in p.texts))
        assert running.end() == 0
    assert "speed" in page.values
    for message in ("Ready ", "First frame sent to a page ", "simulated in ", "histogram", "rewind 1", "not encrypted"):
        assert message in running.said
    assert "Traceback" not in running.said
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["steps"]["steps"] > 100
    assert set(report["seconds since the start"]) == {"prepared", "ready", "first frame"}


def hostile(port, url, enough, faults):
    """Everything at once, again and again."""
    rng = np.random.default_rng(1)
    with ExitStack() as opened:
        for _ in range(15):
            opened.enter_context(RawClient.silent(port))
        deaf = opened.enter_context(RawClient(port, f"/drive?{url.partition('?')[2]}"))  # reads nothing
        deaf.send(json.dumps({"type": "want", "source": "keys", "values": {"brake": [1.0, None]}}))
        while not enough.is_set():
            with suppress(WebSocketException, EOFError, OSError), connect(url, close_timeout=1) as one:
                attack(one, rng, int(rng.integers(5)))
            with suppress(OSError):
                faults.append(request(port, "/", {"Host": "evil.example"})[0])
                faults.append(request(port, "/drive", {"Origin": "http://evil.example"}, upgrade=True)[0])
            with suppress(OSError), socket.create_connection(("127.0.0.1", port), timeout=5) as line:
                line.sendall(rng.bytes(5000) if rng.random() < 0.5 else b"GET / HTTP/1.1\r\n" + b"A: b\r\n" * 5000)


def attack(page, rng, kind):
    """What a page must not do, of one kind."""
    if kind == 0:
        page.send("x" * 100_000)
    for k in range(1000):
        if kind == 1:
            page.send(rng.bytes(200))
        elif kind == 2:
            page.send(json.dumps({"type": "command", "name": "rewind", "value": 0.01}))
        elif kind == 3:
            page.send(json.dumps({"type": "want", "source": "touch", "values": {"steering": [k % 2, None]}}))
        elif kind == 4:
            page.send('{"type":"seen","count":1e15}')


@pytest.mark.slow
def test_hostile_clients_do_not_stop_the_car(sledge):
    with program(sledge, "--port", 0, "--step", STEP) as running:
        with connect(running.url) as connection:
            page, enough, faults = Page(connection), threading.Event(), []
            page.until(lambda p: p.count > 20)
            first, rest = page.count, (running.port, running.url, enough, faults)
            attackers = [threading.Thread(target=hostile, args=rest) for _ in range(2)]
            for attacker in attackers:
                attacker.start()
            try:
                page.until(lambda p: p.count > first + HOSTILE_STEPS and faults)
            finally:
                enough.set()
                for attacker in attackers:
                    attacker.join(PATIENCE)
            page.until(lambda p: p.flags & 1)
            assert set(faults) == {403}
            page.say("want", source="keys", values={"throttle": [1.0, None], "brake": [0.0, None]})
            page.until(lambda p: p.values["throttle"] == 1.0)
            page.until(lambda p: p.values["brake"] == 0.0)  # the deaf one was let go
        assert running.end() == 0
    assert "Traceback" not in running.said
    assert "not encrypted" not in running.said


@pytest.mark.slow
def test_a_car_that_dies_ends_the_command_with_a_sentence_and_the_report(sledge):
    with program(sledge, "--port", 0, "--step", STEP) as running, connect(running.url) as connection:
        page = Page(connection)
        page.until(lambda p: p.count > 20)
        below = psutil.Process(running.process.pid).children(recursive=True)
        car = [process for process in below if "ali3.worker" in " ".join(process.cmdline())][-1]  # below its guard
        car.kill()
        out = running.process.communicate(timeout=PATIENCE)[0]
    assert running.process.returncode == 1
    assert re.search(r"error: The car.s process was killed \(SIGKILL\)[^,]*, by a user", out)
    assert "simulated in " in out

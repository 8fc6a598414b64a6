"""What the server says to pages and takes from them, by two independent clients, and whom it refuses."""

import errno
import gzip
import json
import os
import select
import socket
import struct
import time
import urllib.request
from contextlib import ExitStack, suppress
from types import SimpleNamespace

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from hosts.common.errors import HostError
from hosts.simulator import connected_page, web
from hosts.simulator.connected_page import ConnectedPage
from hosts.simulator.guard import Guard
from tests.hosts.simulator.raw_client import RawClient, request
from tests.hosts.simulator.served import PLACES, WORLD, FakeCar, serving

HEADER = "<4I10d"


@pytest.fixture
def car():
    return FakeCar()


@pytest.fixture
def served(car):
    with serving(car) as found:
        yield found


def frames(page, count):
    """The next frames, each acknowledged."""
    found = []
    while len(found) < count:
        data = page.recv(timeout=10)
        if isinstance(data, bytes):
            found.append(data)
            page.send(json.dumps({"type": "seen", "count": struct.unpack_from(HEADER, data)[4]}))
    return found


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


def test_a_page_gets_words_first_and_then_frames_with_every_number(served, car):
    with connect(served.url) as page:
        hello = json.loads(page.recv(timeout=10))
        assert hello["type"] == "hello"
        assert hello["version"] == 1
        assert hello["columns"][-1] == "speed"
        data = frames(page, 3)[-1]
    magic, epoch, flags, n, count, seconds, *numbers = struct.unpack_from(HEADER, data)
    assert data[:4] == b"A3F1"
    assert (magic, epoch, flags, n) == (0x31463341, 3, 5, 5)
    assert seconds == count * car.step
    #                  speed, wall, cost, worst, lateness, missed, deadline, saved
    assert numbers == [0.5, 12.5, 1e-4, 2e-4, 3e-4, 2.0, 0.004, 30.0]
    assert len(data) == 96 + 8 * n
    assert np.frombuffer(data, "<f8", offset=96).tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]


def test_the_same_by_a_client_of_raw_bytes(served):
    with RawClient(served.port, f"/drive{served.key}") as page:
        assert json.loads(page.receive())["type"] == "hello"
        first = page.receive()
        assert struct.unpack_from("<I", first) == (0x31463341,)
        page.send(json.dumps({"type": "want", "source": "keys", "values": {"throttle": [0.7, 2.5]}}))
        page.send(json.dumps({"type": "report"}))
        while not isinstance(answer := page.receive(), str):
            pass
        assert json.loads(answer) == {"type": "report", "steps": 11, "median": 1e-4}


def test_a_page_that_acknowledges_nothing_gets_two_frames_and_the_newest_when_it_wakes(served):
    with connect(served.url) as page:
        page.recv(timeout=10)
        last = [struct.unpack_from(HEADER, page.recv(timeout=10))[4] for _ in range(2)][-1]
        with pytest.raises(TimeoutError):
            page.recv(timeout=0.3)
        page.send(json.dumps({"type": "seen", "count": last}))
        woken = struct.unpack_from(HEADER, page.recv(timeout=10))[4]
        assert woken > last + 1  # nothing old waited for it


def test_a_car_that_stands_still_sends_no_frames(car, served):
    car.running = False
    with connect(served.url) as page:
        texts(page, "hello")
        frames(page, 1)
        with pytest.raises(TimeoutError):
            page.recv(timeout=0.3)


def test_wishes_and_commands_reach_the_car(car, served):
    with connect(served.url) as page:
        page.send(
            json.dumps({"type": "want", "source": "keys", "values": {"steering": [0.3, 1.6], "throttle": [1, None]}})
        )
        page.send(json.dumps({"type": "command", "name": "speed", "value": 0.5}))
        page.send(json.dumps({"type": "command", "name": "speed", "value": 7}))
        assert "must be from 0.05 to 1" in texts(page, "refused")["text"]
        page.send(json.dumps({"type": "place", "name": "start"}))
        page.send(json.dumps({"type": "place", "name": "moon"}))
        assert texts(page, "refused")["text"] == "The world has no place 'moon'; it has start."
    assert car.wanted["steering"] in ((0.3, 1.6), (0.0, 3.0))
    assert car.orders[:2] == [("speed", 0.5), ("restart", PLACES["start"])]  # then a pause: the last page has gone


def test_events_go_to_every_page_and_the_terminal(car, served):
    with connect(served.url) as one, connect(served.url) as two:
        for page in (one, two):
            texts(page, "hello")
        car.told.append(SimpleNamespace(time=1.5, kind="behind", text="The car is late."))
        for page in (one, two):
            assert texts(page, "event") == {"type": "event", "kind": "behind", "time": 1.5, "text": "The car is late."}
    assert "The car is late." in served.told


class Devices:
    def __init__(self):
        self.axis, self.messages = 0.0, []

    def state(self):
        return [{"id": "wheel", "axes": [self.axis]}]

    def message(self, content):
        if content["type"] == "calibrate":
            raise HostError("The wheel is not there.")
        self.messages.append(content)


def test_devices_are_shown_to_pages_that_watch_and_get_their_messages(car, served):
    served.server.devices = devices = Devices()
    with connect(served.url) as page:
        page.send('{"type":"watch devices","on":true}')
        assert texts(page, "devices")["devices"] == [{"id": "wheel", "axes": [0.0]}]
        devices.axis = 0.5
        while texts(page, "devices")["devices"][0]["axes"] != [0.5]:
            pass
        page.send('{"type":"assign","device":"wheel","input":"brake"}')
        page.send('{"type":"calibrate","device":"wheel"}')
        assert texts(page, "refused")["text"] == "The wheel is not there."
        assert devices.messages == [{"type": "assign", "device": "wheel", "input": "brake"}]
        served.server.say("The wheel was pulled out.")
        assert texts(page, "event")["text"] == "The wheel was pulled out."
    assert "The wheel was pulled out." in served.told


def test_every_page_is_told_of_a_device_that_comes(car, served):
    served.server.devices = devices = Devices()
    with connect(served.url) as page:
        for _ in range(2):  # with the hello, and as devices that are new to all pages
            assert texts(page, "devices")["devices"][0]["axes"] == [0.0]
        devices.axis = 0.5  # of no interest to a page that does not watch
        time.sleep(0.2)
        devices.state = lambda: [{"id": "wheel"}, {"id": "pedals"}]
        while len(shown := texts(page, "devices")["devices"]) == 1:
            assert shown[0]["axes"] == [0.0]
        assert [device["id"] for device in shown] == ["wheel", "pedals"]


def test_a_page_that_closes_lets_its_inputs_go(car, served):
    with connect(served.url) as page:
        page.send(
            json.dumps({"type": "want", "source": "keys", "values": {"throttle": [1.0, 2.5], "steering": [0.4, 1.6]}})
        )
        until(lambda: car.wanted.get("throttle") == (1.0, 2.5))
    until(lambda: car.wanted["throttle"] == (0.0, 5.0) and car.wanted["steering"] == (0.0, 3.0))
    assert any("Page 1 was closed: steering, throttle let go." in text for text in served.told)


def test_the_car_stands_when_its_last_page_goes_and_drives_on_when_one_comes_back(car, served):
    with connect(served.url) as one:
        frames(one, 1)
        with connect(served.url) as other:
            frames(other, 1)
        until(lambda: len(served.server._pages) == 1)
        assert car.orders == []
    until(lambda: car.orders == [("pause", 0.0)])
    assert any("the last page is gone" in text for text in served.told)
    with connect(served.url) as back:
        frames(back, 1)
        assert car.orders == [("pause", 0.0), ("run", 0.0)]
        car.running = False
    until(lambda: not served.server._pages)
    with connect(served.url) as again:
        texts(again, "hello")
        assert len(car.orders) == 2, "who has paused it finds it paused"


def test_a_page_that_stalls_lets_its_inputs_go_and_has_the_word_again_when_it_wakes(car, served, monkeypatch):
    monkeypatch.setattr(connected_page, "STALLED", 0.2)
    want = json.dumps({"type": "want", "source": "keys", "values": {"throttle": [1.0, 2.5]}})
    with connect(served.url) as page:
        page.send(want)
        until(lambda: car.wanted.get("throttle") == (1.0, 2.5))
        until(lambda: car.wanted["throttle"] == (0.0, 5.0))
        assert any("no longer sends messages: throttle let go." in text for text in served.told)
        page.send(want)
        until(lambda: car.wanted["throttle"] == (1.0, 2.5))


def test_a_second_page_may_drive_too(car, served):
    with connect(served.url) as one, connect(served.url) as two:
        one.send(json.dumps({"type": "want", "source": "keys", "values": {"throttle": [1.0, 2.5]}}))
        until(lambda: car.wanted.get("throttle") == (1.0, 2.5))
        two.send(json.dumps({"type": "want", "source": "keys", "values": {"brake": [1.0, 4.0]}}))
        until(lambda: car.wanted.get("brake") == (1.0, 4.0))
        one.close()
        until(lambda: car.wanted["throttle"] == (0.0, 5.0))
        assert car.wanted["brake"] == (1.0, 4.0)


def test_page_and_world_are_handed_out_packed_where_the_client_can(served):
    with urllib.request.urlopen(f"http://127.0.0.1:{served.port}/{served.key}", timeout=10) as answer:
        assert answer.read() == b"<!DOCTYPE html><title>page</title>"
        assert answer.headers["Content-Type"] == "text/html; charset=utf-8"
    status, headers, body = request(served.port, f"/world{served.key}", {"Accept-Encoding": "gzip, br"})
    assert status == 200
    assert headers["content-encoding"] == "gzip"
    assert json.loads(gzip.decompress(body)) == WORLD


@pytest.mark.parametrize(
    ("headers", "words"),
    [
        ({"Host": "evil.example"}, "by its own address"),
        ({"Host": "evil.example:{port}"}, "by its own address"),
        ({"Host": "127.0.0.1.evil.example"}, "by its own address"),
        ({"Host": "192.168.1.5:{port}"}, "by its own address"),
        ({"Host": "[::1"}, "by its own address"),
        ({"Origin": "http://evil.example"}, "Only pages of this server"),
        ({"Origin": "null"}, "Only pages of this server"),
        ({"Origin": "http://127.0.0.1:1"}, "Only pages of this server"),
        ({"Origin": "https://127.0.0.1:{port}"}, "Only pages of this server"),
    ],
)
@pytest.mark.parametrize("path", ["/", "/drive"])
def test_foreign_pages_and_names_are_refused(served, path, headers, words):
    sent = {name: value.format(port=served.port) for name, value in headers.items()}
    status, _, body = request(served.port, path + served.key, sent, upgrade=path == "/drive")
    assert status == 403
    assert words in body.decode()


def test_a_header_that_stands_twice_is_refused(served):
    status, _, body = request(served.port, f"/{served.key}", {}, more=[("Host", "127.0.0.1")])
    assert (status, body) == (403, b"The request says Host several times.\n")


@pytest.mark.parametrize("name", ["127.0.0.1", "localhost", "LOCALHOST"])
def test_its_own_page_is_taken(served, name):
    headers = {"Host": f"{name}:{served.port}", "Origin": f"http://{name.lower()}:{served.port}"}
    assert request(served.port, f"/drive{served.key}", headers, upgrade=True)[0] == 101


def test_what_is_not_there_and_what_is_no_websocket(served):
    assert request(served.port, f"/etc/passwd{served.key}", {})[0] == 404
    assert request(served.port, f"/../world{served.key}", {})[0] == 404
    assert request(served.port, f"/drive{served.key}", {})[0] == 426


@pytest.mark.parametrize("address", ["127.0.0.1", "0.0.0.0"])
def test_nobody_is_answered_without_the_token(address):
    """Other users of this machine reach 127.0.0.1 too."""
    guard = Guard.of(address)
    assert len(guard.token) >= 32
    assert Guard.of(address).token != guard.token
    with serving(FakeCar(), guard) as served:
        for path in (
            "/",
            "/world",
            "/drive",
            "/?token=",
            f"/?token={guard.token}x",
            "/?token=%C3%A9",
            f"/?x={guard.token}",
        ):
            status, _, body = request(served.port, path, {}, upgrade=path == "/drive")
            assert status == 403
            assert b"guarded" in body
        for path in ("/drive", "/drive?token=", f"/drive?token={guard.token[:-1]}"):
            with pytest.raises(InvalidStatus, match="403"):
                connect(f"ws://127.0.0.1:{served.port}{path}")
        assert request(served.port, f"/{served.key}", {})[0] == 200
        elsewhere = 403 if guard.is_local else 200
        assert request(served.port, f"/{served.key}", {"Host": "192.168.1.5:80"})[0] == elsewhere
        assert request(served.port, f"/{served.key}", {"Host": "evil.example"})[0] == 403
        with connect(served.url) as page:
            assert json.loads(page.recv(timeout=10))["type"] == "hello"


def test_addresses_that_only_this_machine_reaches():
    assert all(Guard.of(name).is_local for name in ("127.0.0.1", "::1", "localhost", "127.3.2.1"))
    assert not any(Guard.of(name).is_local for name in ("0.0.0.0", "::", "192.168.0.2", "carbox"))


@pytest.mark.parametrize(
    ("message", "words"),
    [
        ("{", "cannot be read"),
        ("[" * 4000, "cannot be read"),
        ("[]", "this one is none"),
        (b"\x00\x01", "this one is binary"),
        ('{"type":"sing"}', "known are want, command"),
        ('{"type":["want"]}', "known are want, command"),
        ('{"type":"want","source":"keys","values":{"throttle":[NaN,1]}}', "cannot be read"),
        ('{"type":"want","source":"keys","values":{"throttle":[1e999,1]}}', "cannot be read"),
        ('{"type":"want","source":"keys","values":{"throttle":[true,1]}}', "must be a number"),
        ('{"type":"want","source":"keys","values":{"throttle":[1,-1]}}', "must be positive"),
        ('{"type":"want","source":"keys","values":{"throttle":1}}', "must be [value, rate]"),
        ('{"type":"want","source":"keys","values":{"sail":[1,1]}}', "no input 'sail'; it has steering"),
        ('{"type":"want","source":"mind","values":{}}', "must be keys, gamepad, touch"),
        ('{"type":"want","source":["keys"],"values":[]}', "must be keys, gamepad, touch"),
        ('{"type":"command","name":"explode"}', "known are run, pause"),
        ('{"type":"command","name":"rewind","value":"x"}', "must be a number"),
        ('{"type":"seen"}', "must be a number"),
        ('{"type":"place","name":7}', "must be a text"),
        ('{"type":"watch devices","on":1}', "true or false"),
        ('{"type":"watch devices","on":true}', "started without devices"),
        ('{"type":"assign","device":"1"}', "started without devices"),
    ],
)  # fmt: skip
def test_a_message_that_is_wrong_is_one_sentence_and_the_page_stays(car, served, message, words):
    with connect(served.url) as page:
        page.send(message)
        text = texts(page, "refused")["text"]
        assert words in text
        assert text.endswith(".")
        assert "\n" not in text
        frames(page, 3)
    assert set(car.orders) <= {("pause", 0.0)}, "the last page is gone"


def read_to_the_end(page):
    while True:
        page.recv(timeout=10)


def refused_with(page):
    """The words that a connection is closed with."""
    with pytest.raises(ConnectionClosed) as caught:
        read_to_the_end(page)
    return caught.value.rcvd.code, caught.value.rcvd.reason


def test_a_large_message_ends_the_connection(served):
    with connect(served.url) as page:
        page.send("x" * 4097)
        assert refused_with(page)[0] == 1009


def test_too_many_wrong_messages_end_the_connection(served):
    with connect(served.url) as page:
        for _ in range(connected_page.MOST_MALFORMED + 1):
            page.send("{")
        assert refused_with(page) == (1008, "More than 20 messages of this page were wrong.")


def test_too_many_messages_end_the_connection(served):
    with connect(served.url) as page:
        code = None
        try:
            for _ in range(5000):
                page.send('{"type":"seen","count":0}')
        except ConnectionClosed as closed:
            code = closed.rcvd.code
        assert (code or refused_with(page)[0]) == 1008
    assert any("may send 400 messages a second" in text for text in served.told)


@pytest.mark.slow
def test_new_starts_are_taken_now_and_then_only(car, served):
    with connect(served.url) as page:
        for _ in range(20):
            page.send(json.dumps({"type": "command", "name": "reset"}))
        assert "passed over" in texts(page, "refused")["text"]
        page.send(json.dumps({"type": "command", "name": "pause"}))
        until(lambda: ("pause", 0.0) in car.orders)
    assert car.orders.count(("reset", 0.0)) == 1


def test_one_page_too_many_is_refused_with_a_sentence(served):
    with ExitStack() as opened:
        pages = [opened.enter_context(connect(served.url)) for _ in range(web.MOST_PAGES)]
        for page in pages:
            texts(page, "hello")
        status, _, body = request(served.port, f"/drive{served.key}", {}, upgrade=True)
        assert status == 503
        assert b"8 pages are connected" in body
        pages[3].close()
        until(lambda: request(served.port, f"/drive{served.key}", {}, upgrade=True)[0] == 101)


@pytest.mark.parametrize("said", [b"", b"GET / HTTP/1.1\r\n"])
def test_connections_that_say_nothing_are_bounded_and_keep_nobody_away(served, said):
    """The oldest are ended; who has the token is served at once, and stays."""
    most = web.MOST_STRANGERS
    with RawClient(served.port, f"/drive{served.key}") as page, ExitStack() as opened:
        silent = [opened.enter_context(RawClient.silent(served.port)) for _ in range(2 * most)]
        for line in silent:
            with suppress(OSError):
                line.sendall(said)
        until(lambda: len(select.select(silent, [], [], 0)[0]) >= most)  # closed ones can be read
        assert set(select.select(silent, [], [], 0)[0]) == set(silent[:most]) or not said
        assert request(served.port, f"/{served.key}", {})[0] == 200
        with connect(served.url) as another:
            texts(another, "hello")
        assert len(select.select(silent, [], [], 0)[0]) <= most + 2  # the others were not waited for
        page.send('{"type":"report"}')
        while not (isinstance(data := page.receive(), str) and '"report"' in data):
            pass


def test_connections_that_say_nothing_do_not_hold_the_end(car):
    """A server that closes would wait for their handshakes as long as one may take, 10 s."""
    with ExitStack() as opened:
        with serving(car) as served:
            for _ in range(70):
                line = opened.enter_context(RawClient.silent(served.port))
                line.sendall(b"GET / HTTP/1.1\r\n")
            assert request(served.port, f"/{served.key}", {})[0] == 200  # the last ones are connected too
            begin = time.monotonic()
        assert time.monotonic() - begin < 5.0


def test_a_car_that_has_ended_ends_the_server(car):
    def ended():
        raise HostError("The process of the car has ended.")

    with serving(car) as served, connect(served.url) as page:
        texts(page, "hello")
        car.events = ended
        with pytest.raises(ConnectionClosed) as closed:
            read_to_the_end(page)
        assert closed.value.rcvd.reason == "The process of the car has ended."
        until(lambda: served.error)
        assert str(served.error[0]) == "The process of the car has ended."


def test_a_page_may_say_so_much_a_second():
    now = [0.0]
    page = ConnectedPage(1, None, lambda: now[0])

    def say(times):
        for _ in range(times):
            page.heard()

    for _ in range(5 * 400):
        now[0] += 1 / 400
        say(1)
    say(int(connected_page.BURST) - 2)
    with pytest.raises(HostError, match="400 messages a second"):
        say(3)


def test_a_port_that_is_taken_names_the_next_free_one():
    with web.listening_socket("127.0.0.1", 0) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(
            HostError, match=rf"The port {port} of 127.0.0.1 is taken .*; the port (\d+) is free"
        ) as told:
            web.listening_socket("127.0.0.1", port)
        free = int(str(told.value).rsplit(" ", 1)[1].rstrip("."))
        web.listening_socket("127.0.0.1", free).close()
    with pytest.raises(HostError, match=r"The port is 70000; it must be"):
        web.listening_socket("127.0.0.1", 70000)
    with pytest.raises(HostError, match=r"The server cannot listen on 203.0.113.1: "):
        web.listening_socket("203.0.113.1", 0)


def test_a_port_that_the_user_may_not_have(monkeypatch):
    def refuse(*_, **__):
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr(web.socket, "create_server", refuse)
    with pytest.raises(HostError, match=r"The port 80 may not be used by you; ports from 1024 on may\."):
        web.listening_socket("127.0.0.1", 80)


def first_line(port, text):
    """The first line of the answer to bytes."""
    with RawClient.silent(port) as line:
        line.sendall(text)
        return line.recv(4096).split(b"\r\n")[0].decode()


def test_what_is_no_request_for_a_page(served):
    host = f"Host: 127.0.0.1:{served.port}\r\n"
    for path in ("//[", "*", "x", "http://[/"):
        assert first_line(served.port, f"GET {path} HTTP/1.1\r\n{host}\r\n".encode()).startswith("HTTP/1.1 400 ")
    for method, body in (("POST", "Content-Length: 3\r\n"), ("PUT", ""), ("DELETE", ""), ("OPTIONS", ""), ("get", "")):
        for path in ("/", f"/{served.key}"):
            text = f"{method} {path} HTTP/1.1\r\n{host}{body}\r\nabc".encode()
            assert first_line(served.port, text) == "HTTP/1.1 405 Method Not Allowed"
    with RawClient.silent(served.port) as line:
        line.sendall(f"HEAD /world{served.key} HTTP/1.1\r\n{host}\r\n".encode())
        said = b"".join(iter(lambda: line.recv(4096), b""))
        head, _, body = said.partition(b"\r\n\r\n")
        assert head.startswith(b"HTTP/1.1 200 OK")
        assert f"Content-Length: {len(json.dumps(WORLD))}".encode() in head
        assert body == b""


def test_answers_that_nobody_reads_are_few_and_end(car, monkeypatch):
    """Those that wait hold a piece of the body each; a page that reads is served as soon as they are gone."""
    monkeypatch.setattr(web, "READ_WITHIN", 1.0)
    monkeypatch.setattr("tests.hosts.simulator.served.WORLD", {"name": os.urandom(3_000_000).hex()})
    with serving(car) as served, ExitStack() as opened:
        asked = f"GET /world{served.key} HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\n\r\n".encode()
        lines = [opened.enter_context(RawClient.silent(served.port)) for _ in range(2 * web.MOST_ANSWERS)]
        for line in lines:
            line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            line.sendall(asked)
        until(lambda: all(select.select([line], [], [], 0)[0] for line in lines))
        heads = [line.recv(20).split(b" ")[1] for line in lines]
        assert (heads.count(b"200"), heads.count(b"503")) == (web.MOST_ANSWERS, web.MOST_ANSWERS)
        until(lambda: request(served.port, f"/{served.key}", {})[0] == 200)
        assert request(served.port, f"/world{served.key}", {})[2].endswith(b'"}')


def test_empty_fragments_count(served):
    with RawClient(served.port, f"/drive{served.key}") as page:
        page.fragments(4000)
        until(lambda: any("may send 400 messages a second" in text for text in served.told))


def test_every_address_serves_what_is_printed():
    """The name of this machine may be one of IPv4 alone."""
    with web.listening_socket("::", 0) as listening:
        port = listening.getsockname()[1]
        for address in ("127.0.0.1", "::1"):
            with socket.create_connection((address, port), timeout=5):
                pass


def test_a_flood_of_strangers_keeps_no_page_away(car, monkeypatch):
    """Of those without the token so many a second are taken; who has it is served."""
    monkeypatch.setattr(web, "STRANGERS_PER_SECOND", 1)
    with serving(car) as served:
        asked = f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\n\r\n".encode()
        ended = 0
        for _ in range(100):
            with RawClient.silent(served.port) as line, suppress(OSError):
                line.sendall(asked)
                ended += line.recv(1) == b""
        assert ended < 100
        with connect(served.url) as page:
            texts(page, "hello")

"""Requests that the server of the simulator refuses, and its limits."""

import json
import os
import select
import socket
from contextlib import ExitStack, suppress

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from hosts.common.errors import HostError
from hosts.simulator import connected_page, web
from hosts.simulator.access_control import AccessControl
from hosts.simulator.connected_page import ConnectedPage
from tests.hosts.simulator.pages import read_to_the_end, texts, until
from tests.hosts.simulator.raw_client import RawClient, request
from tests.hosts.simulator.served import WORLD, FakeCar, serving

NEVER = 3600.0  # s


@pytest.mark.parametrize(
    ("headers", "message"),
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
def test_foreign_pages_and_names_are_refused(served, path, headers, message):
    sent = {name: value.format(port=served.port) for name, value in headers.items()}
    status, _, body = request(served.port, path + served.key, sent, upgrade=path == "/drive")
    assert status == 403
    assert message in body.decode()


def test_a_header_that_stands_twice_is_refused(served):
    status, _, body = request(served.port, f"/{served.key}", {}, more=[("Host", "127.0.0.1")])
    assert (status, body) == (403, b"The request says Host several times.\n")


@pytest.mark.parametrize("name", ["127.0.0.1", "localhost", "LOCALHOST"])
def test_its_own_page_is_taken(served, name):
    headers = {"Host": f"{name}:{served.port}", "Origin": f"http://{name.lower()}:{served.port}"}
    assert request(served.port, f"/drive{served.key}", headers, upgrade=True)[0] == 101


def test_missing_files_and_other_requests_than_websocket_are_refused(served):
    assert request(served.port, f"/etc/passwd{served.key}", {})[0] == 404
    assert request(served.port, f"/../world{served.key}", {})[0] == 404
    assert request(served.port, f"/drive{served.key}", {})[0] == 426


@pytest.mark.parametrize("address", ["127.0.0.1", "0.0.0.0"])
def test_nobody_is_answered_without_the_token(address):
    """Other users of this machine reach 127.0.0.1 too."""
    access = AccessControl.of(address)
    assert len(access.token) >= 32
    assert AccessControl.of(address).token != access.token
    with serving(FakeCar(), access) as served:
        for path in (
            "/",
            "/world",
            "/drive",
            "/?token=",
            f"/?token={access.token}x",
            "/?token=%C3%A9",
            f"/?x={access.token}",
        ):
            status, _, body = request(served.port, path, {}, upgrade=path == "/drive")
            assert status == 403
            assert b"guarded" in body
        for path in ("/drive", "/drive?token=", f"/drive?token={access.token[:-1]}"):
            with pytest.raises(InvalidStatus, match="403"):
                connect(f"ws://127.0.0.1:{served.port}{path}")
        assert request(served.port, f"/{served.key}", {})[0] == 200
        elsewhere = 403 if access.is_local else 200
        assert request(served.port, f"/{served.key}", {"Host": "192.168.1.5:80"})[0] == elsewhere
        assert request(served.port, f"/{served.key}", {"Host": "evil.example"})[0] == 403
        with connect(served.url) as page:
            assert json.loads(page.recv(timeout=10))["type"] == "hello"


def test_addresses_that_only_this_machine_reaches():
    assert all(AccessControl.of(name).is_local for name in ("127.0.0.1", "::1", "localhost", "127.3.2.1"))
    assert not any(AccessControl.of(name).is_local for name in ("0.0.0.0", "::", "192.168.0.2", "carbox"))


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
        for _ in range(connected_page.MAX_MALFORMED + 1):
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
def test_new_starts_are_taken_now_and_then_only(car, served, monkeypatch):
    monkeypatch.setattr("hosts.simulator.server.NEW_START_PERIOD", NEVER)
    with connect(served.url) as page:
        for _ in range(20):
            page.send(json.dumps({"type": "command", "name": "reset"}))
        assert "ignored" in texts(page, "refused")["text"]
        page.send(json.dumps({"type": "command", "name": "pause"}))
        until(lambda: ("pause", 0.0) in car.orders)
    assert car.orders.count(("reset", 0.0)) == 1


def test_one_page_too_many_is_refused_with_a_sentence(served):
    with ExitStack() as opened:
        pages = [opened.enter_context(connect(served.url)) for _ in range(web.MAX_PAGES)]
        for page in pages:
            texts(page, "hello")
        status, _, body = request(served.port, f"/drive{served.key}", {}, upgrade=True)
        assert status == 503
        assert b"8 pages are connected" in body
        pages[3].close()
        until(lambda: request(served.port, f"/drive{served.key}", {}, upgrade=True)[0] == 101)


@pytest.mark.parametrize("message", [b"", b"GET / HTTP/1.1\r\n"])
def test_silent_connections_are_limited_and_block_no_other(served, message):
    """The oldest are ended; who has the token is served at once, and stays."""
    most = web.MAX_STRANGERS
    with RawClient(served.port, f"/drive{served.key}") as page, ExitStack() as opened:
        silent = [opened.enter_context(RawClient.silent(served.port)) for _ in range(2 * most)]
        for line in silent:
            with suppress(OSError):
                line.sendall(message)
        until(lambda: len(select.select(silent, [], [], 0)[0]) >= most)  # closed ones can be read
        assert set(select.select(silent, [], [], 0)[0]) == set(silent[:most]) or not message
        assert request(served.port, f"/{served.key}", {})[0] == 200
        with connect(served.url) as another:
            texts(another, "hello")
        assert len(select.select(silent, [], [], 0)[0]) <= most + 2  # the others were not waited for
        page.send('{"type":"report"}')
        while not (isinstance(data := page.receive(), str) and '"report"' in data):
            pass


def test_connections_that_say_nothing_do_not_hold_the_end(car, monkeypatch):
    """A server that closes would wait for their handshakes as long as one may take."""
    monkeypatch.setattr("hosts.simulator.server._ANSWER_TIMEOUT", NEVER)
    with ExitStack() as opened, serving(car) as served:
        for _ in range(70):
            line = opened.enter_context(RawClient.silent(served.port))
            line.sendall(b"GET / HTTP/1.1\r\n")
        assert request(served.port, f"/{served.key}", {})[0] == 200  # the last ones are connected too


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
        response = b"".join(iter(lambda: line.recv(4096), b""))
        head, _, body = response.partition(b"\r\n\r\n")
        assert head.startswith(b"HTTP/1.1 200 OK")
        assert f"Content-Length: {len(json.dumps(WORLD))}".encode() in head
        assert body == b""


@pytest.mark.parametrize("within", [NEVER, 0.5])
def test_unread_responses_are_limited_and_end(car, monkeypatch, within):
    """Those that wait hold a piece of the body each; a page that reads is served as soon as they are gone."""
    monkeypatch.setattr(web, "READ_WITHIN", within)
    monkeypatch.setattr("tests.hosts.simulator.served.WORLD", {"name": os.urandom(3_000_000).hex()})
    with serving(car) as served, ExitStack() as opened:
        requested = f"GET /world{served.key} HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\n\r\n".encode()
        lines = [opened.enter_context(RawClient.silent(served.port)) for _ in range(2 * web.MAX_ANSWERS)]
        for line in lines:
            line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            line.sendall(requested)
        until(lambda: all(select.select([line], [], [], 0)[0] for line in lines))
        if within == NEVER:
            heads = [line.recv(20).split(b" ")[1] for line in lines]
            assert (heads.count(b"200"), heads.count(b"503")) == (web.MAX_ANSWERS, web.MAX_ANSWERS)
            return
        until(lambda: request(served.port, f"/{served.key}", {})[0] == 200)
        assert request(served.port, f"/world{served.key}", {})[2].endswith(b'"}')


def test_empty_fragments_count(served):
    with RawClient(served.port, f"/drive{served.key}") as page:
        page.fragments(4000)
        until(lambda: any("may send 400 messages a second" in text for text in served.told))


def test_a_flood_of_strangers_keeps_no_page_away(car, monkeypatch):
    """Of those without the token so many a second are taken; who has it is served."""
    monkeypatch.setattr(web, "STRANGERS_PER_SECOND", 1)
    with serving(car) as served:
        requested = f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{served.port}\r\n\r\n".encode()
        ended = 0
        for _ in range(100):
            with RawClient.silent(served.port) as line, suppress(OSError):
                line.sendall(requested)
                ended += line.recv(1) == b""
        assert ended < 100
        with connect(served.url) as page:
            texts(page, "hello")

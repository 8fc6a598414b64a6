"""Messages between server and pages, by two independent clients."""

import errno
import gzip
import json
import socket
import struct
import time
import urllib.request
from types import SimpleNamespace

import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from hosts.common.errors import HostError
from hosts.simulator import connected_page, web
from tests.hosts.simulator.pages import HEADER, frames, read_to_the_end, texts, until
from tests.hosts.simulator.raw_client import request
from tests.hosts.simulator.served import PLACES, WORLD, serving


def want(page, **values):
    """A wish of the keys of a page."""
    page.send(json.dumps({"type": "want", "source": "keys", "values": values}))


def test_a_page_gets_its_description_first_and_then_frames_of_all_numbers(served, car):
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
        want(page, steering=[0.3, 1.6], throttle=[1, None])
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


def test_every_page_is_informed_of_a_new_device(car, served):
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


def test_a_closed_page_releases_its_inputs_and_a_second_one_keeps_its_own(car, served):
    with connect(served.url) as one, connect(served.url) as two:
        want(one, throttle=[1.0, 2.5], steering=[0.4, 1.6])
        until(lambda: car.wanted.get("throttle") == (1.0, 2.5))
        want(two, brake=[1.0, 4.0])
        until(lambda: car.wanted.get("brake") == (1.0, 4.0))
        one.close()
        until(lambda: car.wanted["throttle"] == (0.0, 5.0) and car.wanted["steering"] == (0.0, 3.0))
        assert car.wanted["brake"] == (1.0, 4.0)
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


def test_a_stalled_page_releases_its_inputs_and_drives_again_afterwards(car, served, monkeypatch):
    monkeypatch.setattr(connected_page, "STALLED", 0.2)
    with connect(served.url) as page:
        for turn in (1, 2):
            want(page, throttle=[1.0, 2.5])
            until(lambda turn=turn: car.wishes == turn * [{"throttle": (1.0, 2.5)}, {"throttle": (0.0, 5.0)}])
            until(lambda turn=turn: sum("no longer sends messages: throttle" in text for text in served.told) == turn)


def test_page_and_world_are_handed_out_packed_where_the_client_can(served):
    with urllib.request.urlopen(f"http://127.0.0.1:{served.port}/{served.key}", timeout=10) as answer:
        assert answer.read() == b"<!DOCTYPE html><title>page</title>"
        assert answer.headers["Content-Type"] == "text/html; charset=utf-8"
    status, headers, body = request(served.port, f"/world{served.key}", {"Accept-Encoding": "gzip, br"})
    assert status == 200
    assert headers["content-encoding"] == "gzip"
    assert json.loads(gzip.decompress(body)) == WORLD


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


def test_a_port_that_is_taken_names_the_next_free_one():
    with web.listening_socket("127.0.0.1", 0) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(
            HostError, match=rf"The port {port} of 127.0.0.1 is taken .*; the port (\d+) is free"
        ) as refusal:
            web.listening_socket("127.0.0.1", port)
        free = int(str(refusal.value).rsplit(" ", 1)[1].rstrip("."))
        web.listening_socket("127.0.0.1", free).close()


def test_a_port_that_the_user_may_not_have(monkeypatch):
    def refuse(*_, **__):
        raise PermissionError(errno.EACCES, "Permission denied")

    monkeypatch.setattr(web.socket, "create_server", refuse)
    with pytest.raises(HostError, match=r"The system does not allow you to use the port 80; give 1024 or above\."):
        web.listening_socket("127.0.0.1", 80)


def test_every_printed_address_is_served():
    """The name of this machine may be one of IPv4 alone."""
    with web.listening_socket("::", 0) as listening:
        port = listening.getsockname()[1]
        for address in ("127.0.0.1", "::1"):
            with socket.create_connection((address, port), timeout=5):
                pass

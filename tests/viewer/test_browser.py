"""How the user's browser gets an address that nobody else may know."""

import threading
from http.server import BaseHTTPRequestHandler, HTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlsplit

import pytest

from tests.in_browser import wait_until
from viewer import open_browser


class Told(BaseHTTPRequestHandler):
    """Keeps the paths that are asked for."""

    paths: tuple[str, ...] = ()

    def do_GET(self) -> None:
        Told.paths += (self.path,)
        self.send_response(200)
        self.send_header("Content-Type", "text/html")
        self.end_headers()
        self.wfile.write(b"<title>there</title>")

    def log_message(self, *_: Any) -> None:
        pass


@pytest.mark.slow
def test_a_secret_address_is_on_no_command_line_and_is_reached(tmp_path, monkeypatch, chromium):
    addresses: list[str] = []
    monkeypatch.setattr(open_browser.webbrowser, "open", lambda address: addresses.append(address) or True)
    monkeypatch.setenv("DISPLAY", ":0")
    path = "/?token=se-cr_et&x=\"<'"
    with HTTPServer(("127.0.0.1", 0), Told) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            assert open_browser.open_secretly(f"http://127.0.0.1:{server.server_port}{path}", tmp_path)
            (address,) = addresses
            assert "se-cr_et" not in address
            assert Path(unquote(urlsplit(address).path)).parent == tmp_path
            page = chromium.new_page()
            page.goto(address)
            wait_until(page, "document.title === 'there'")
            page.close()
        finally:
            server.shutdown()
            thread.join()
    assert unquote(next(requested for requested in Told.paths if "token" in requested)) == path

"""The page on a server of its own, and a browser."""

from __future__ import annotations

import functools
import http.server
import os
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from browser import Browser, program

TARGET = Path(os.environ.get("BOWKNOT_TARGET", "target"))


class Handler(http.server.SimpleHTTPRequestHandler):
    extensions_map = {
        **http.server.SimpleHTTPRequestHandler.extensions_map,
        ".wasm": "application/wasm",
        ".js": "text/javascript",
    }

    def log_message(self, *_: object) -> None:
        pass


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "long: left out by `cargo xtask web --test --quick`, as CI runs it")


@pytest.fixture(scope="session")
def address() -> Iterator[str]:
    """Where the folders `web` and `npm` of the target folder are served."""
    handler = functools.partial(Handler, directory=TARGET)
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


@pytest.fixture(scope="session")
def pictures() -> Path:
    """Where pictures of the page are kept, to be looked at."""
    return TARGET / "xtask" / "web-pictures"


@pytest.fixture
def browser() -> Iterator[Browser]:
    if program() is None:
        assert os.environ.get("CI") != "true", "CI needs a Chromium to open the page in: apt-get install chromium"
        pytest.skip("no Chromium on this machine to open the page in (Debian: apt-get install chromium)")
    browser = Browser()
    yield browser
    browser.close()
    assert browser.faults == []

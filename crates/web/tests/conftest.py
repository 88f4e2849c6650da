"""The page on a server of its own, and a browser."""

from __future__ import annotations

import contextlib
import os
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from browser import Browser, program

TARGET = Path(os.environ.get("BOWKNOT_TARGET", "target"))


sys.path.insert(0, str(Path(__file__).parent.parent))
import serve


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "long: left out by `cargo xtask web --test --quick`, as CI runs it")


@contextlib.contextmanager
def served(handler: type[serve.Handler]) -> Iterator[str]:
    """Where the folders `web` and `npm` of the target folder are served."""
    quiet = type("Quiet", (handler,), {"log_message": lambda *_: None})
    with serve.server(TARGET, quiet, 0) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


@pytest.fixture(scope="session")
def address() -> Iterator[str]:
    """The address of a server that isolates no page."""
    with served(serve.Handler) as address:
        yield address


@pytest.fixture(scope="session")
def isolated() -> Iterator[str]:
    """The address of a server whose pages may have threads."""
    with served(serve.IsolatingHandler) as address:
        yield address


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

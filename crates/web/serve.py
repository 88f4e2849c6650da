"""Serves a folder to this machine as an isolated page, which may have threads: `python3 crates/web/serve.py target/web`.

What isolates it are two headers, which other servers can send as well.
"""

from __future__ import annotations

import functools
import http.server
import sys
from pathlib import Path

ISOLATED = {"Cross-Origin-Opener-Policy": "same-origin", "Cross-Origin-Embedder-Policy": "require-corp"}


class Handler(http.server.SimpleHTTPRequestHandler):
    extensions_map = {
        **http.server.SimpleHTTPRequestHandler.extensions_map,
        ".wasm": "application/wasm",
        ".js": "text/javascript",
    }
    headers_of_all: dict[str, str] = {}

    def end_headers(self) -> None:
        for name, value in self.headers_of_all.items():
            self.send_header(name, value)
        super().end_headers()


class IsolatingHandler(Handler):
    headers_of_all = ISOLATED


def server(folder: Path, handler: type[Handler], port: int) -> http.server.ThreadingHTTPServer:
    return http.server.ThreadingHTTPServer(("127.0.0.1", port), functools.partial(handler, directory=folder))


if __name__ == "__main__":
    if len(sys.argv) != 2 or not Path(sys.argv[1]).is_dir():
        sys.exit("usage: python3 crates/web/serve.py FOLDER")
    with server(Path(sys.argv[1]), IsolatingHandler, 8000) as serving:
        print("http://localhost:8000")
        serving.serve_forever()

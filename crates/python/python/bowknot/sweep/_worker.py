"""A worker of the local pool: jobs come as lines of JSON, outcomes go back so."""

from __future__ import annotations

import json
import os
import queue
import signal
import sys
import threading
from typing import Any

from .. import _native
from ._work import work


def main() -> None:
    """Makes runs until it is told to stop or the pool is gone."""
    # Batch systems end all processes of a job by SIGTERM.
    for end in (signal.SIGINT, signal.SIGTERM):
        signal.signal(end, signal.default_int_handler)
    # Whatever prints must not come between the outcomes.
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    jobs: queue.SimpleQueue[dict[str, Any]] = queue.SimpleQueue()
    threading.Thread(target=_listen, args=(jobs,), daemon=True).start()
    answer: object = _native.__version__
    try:
        while True:
            answers.write(json.dumps(answer) + "\n")
            answers.flush()
            answer = work(jobs.get())
    except KeyboardInterrupt:
        raise SystemExit(130) from None


def _listen(jobs: queue.SimpleQueue[dict[str, Any]]) -> None:
    for line in sys.stdin.buffer:
        jobs.put(json.loads(line))
    # The pool is gone, however it ended: nobody waits for what is being made.
    os._exit(0)

"""What the tests of sweeps share."""

from pathlib import Path

import bowknot

SETS = {"simulation.frames": 3, "body.sheet.material": "silk"}
SMALL = {"scene": "drape", "scale": 0.2, "set": SETS, "table": "table.jsonl"}

#: Runs that take a while.
LONG = {"scene": "drape", "scale": 0.3, "set": {"simulation.frames": 60}, "table": "table.jsonl"}
LONG["grid"] = {"body.sheet.friction": [0.0, 0.1, 0.2, 0.3]}


def sweep(study, folder, **options):
    """A sweep on two processes that prints nothing."""
    return bowknot.sweep(study, out=folder, **{"progress": False, "workers": 2, **options})


def without_costs(rows):
    """The columns that are the same in each sweep."""
    return [{key: value for key, value in row.items() if not key.startswith("cost.")} for row in rows]


def begun(folder):
    """Number of runs that are under way and have time steps."""
    runs = [path.parent for path in Path(folder).glob("runs/*/stats.jsonl") if path.stat().st_size]
    return sum(not (run / "sweep.json").exists() for run in runs)

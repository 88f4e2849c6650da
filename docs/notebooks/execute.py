"""Executes the notebooks of this folder, all or those named, and writes their outputs into them.

    python docs/notebooks/execute.py [NAME..]

It needs what `requirements.txt` lists, and bowknot. Whatever tells of the machine or of the time is left out, and an output that
names a folder of this machine is refused.
"""

import sys
import tempfile
from pathlib import Path

import nbformat
from nbclient import NotebookClient

FOLDER = Path(__file__).resolve().parent
#: Longest time that a cell may take [s].
LIMIT = 900


def main(names):
    known = {path.stem: path for path in sorted(FOLDER.glob("*.ipynb"))}
    unknown = [name for name in names if name not in known]
    if unknown:
        sys.exit(f"no notebook {', '.join(unknown)}; there are: {', '.join(known)}")
    for name in names or known:
        print(name, flush=True)
        execute(known[name])


def execute(path):
    notebook = nbformat.read(path, as_version=4)
    # A folder of its own: what cells write is gone afterwards.
    with tempfile.TemporaryDirectory() as folder:
        context = {"metadata": {"path": folder}}
        client = NotebookClient(
            notebook, timeout=LIMIT, kernel_name="python3", resources=context, coalesce_streams=True
        )
        client.execute()
        refused = [folder, str(Path.home()), sys.prefix, str(FOLDER.parents[1])]
    for cell in notebook.cells:
        cell.metadata.pop("execution", None)
    notebook.metadata = {
        "kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"},
        "language_info": {"name": "python"},
    }
    text = nbformat.writes(notebook) + "\n"
    for place in refused:
        if len(place) > 1 and place in text:
            sys.exit(f"{path.name}: an output names {place}; change what its cell prints")
    path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])

"""The block of docs/judge.md on other solvers, its table as CSV and its pictures, from all runs."""

import csv
import io
import shutil

from scenes import SCENES

BEGIN, END = "<!-- begin peers -->\n", "<!-- end peers -->\n"
COLUMNS = (
    "solver", "intersecting frames", "intersecting pairs per 100 frames", "deepest (mm)", "hints between frames",
    "largest stretch", "CPU s",
)


def write(root, rows):
    """Writes docs/judge/solvers.csv, the pictures beside it, and the block; `rows` are pairs of a row and a folder."""
    folder, file = root / "docs" / "judge", root / "docs" / "judge.md"
    folder.mkdir(exist_ok=True)
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0][0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: rounded(value) for key, value in row.items()} for row, _ in rows)
    (folder / "solvers.csv").write_text(text.getvalue())
    for _, run in rows:
        picture = folder / f"{run.name}.png"
        picture.unlink(missing_ok=True)
        if (run / "first.png").exists():
            shutil.copyfile(run / "first.png", picture)
    before, _, rest = file.read_text().partition(BEGIN)
    _, mark, after = rest.partition(END)
    if not mark:
        raise ValueError(f"{file} lacks the lines {BEGIN.strip()} and {END.strip()}")
    file.write_text(before + BEGIN + block(rows) + END + after)


def block(rows):
    """One table per scene."""
    lines = []
    for name, make in SCENES.items():
        scene = make()
        vertices = sum(len(body.x) for body in scene.bodies)
        size = f"{vertices:,} vertices, {scene.frames} frames after the start"
        lines += [f"**{scene.title.capitalize()}** (`{name}`; {size})", ""]
        lines += ["| " + " | ".join(COLUMNS) + " |", "|---|" + "--:|" * (len(COLUMNS) - 1)]
        lines += [line(row, run) for row, run in rows if row["scene"] == name]
        lines.append("")
    return "\n".join(lines)


def line(row, run):
    solver = row["solver"]
    if (run / "first.png").exists():
        solver = f"[{solver}](judge/{run.name}.png)"
    cells = [
        solver, f"{row['intersecting_frames']} of {row['frames']}", number(row["pairs_per_100_frames"]),
        number(1000.0 * row["deepest_m"]), number(row["hints_between_frames"]), f"{row['largest_stretch']:.2f}",
        number(row["cpu_s"]),
    ]
    return "| " + " | ".join(cells) + " |"


def number(value):
    """Three digits, or all of a larger number."""
    return f"{value:,.0f}" if value >= 100 or value == int(value) else f"{value:.3g}"


def rounded(value):
    return f"{value:.6g}" if isinstance(value, float) else value

"""Tables as CSV, and the block on peers of docs/benchmarks.md."""

import csv
import io
import shutil
import subprocess
import textwrap
from dataclasses import dataclass

from measure import Spread
from setting import REPOSITORY, Unusable

PAGE = REPOSITORY / "docs" / "benchmarks.md"
README = REPOSITORY / "README.md"
TABLES = REPOSITORY / "docs" / "benchmarks"
WIDTH = 110
BEGIN, END = "<!-- begin peers -->\n", "<!-- end peers -->\n"


@dataclass
class Table:
    """Rows of text for NAME.csv. A spread takes three columns: median, smallest, largest."""

    name: str
    columns: list
    rows: list

    def csv(self):
        spread = [any(isinstance(row[k], Spread) for row in self.rows) for k in range(len(self.columns))]
        lines = [[]]
        for name, wide in zip(self.columns, spread, strict=True):
            lines[0] += [name, f"{name}_min", f"{name}_max"] if wide else [name]
        for row in self.rows:
            line = []
            for cell, wide in zip(row, spread, strict=True):
                if isinstance(cell, Spread):
                    line += [cell.median, cell.low, cell.high]
                else:
                    line += [cell, "", ""] if wide else [cell]
            lines.append(line)
        text = io.StringIO()
        csv.writer(text, lineterminator="\n").writerows(lines)
        return text.getvalue()


@dataclass
class Section:
    """What a comparison found; `name` is that of its file."""

    name: str
    title: str
    question: str
    finding: str
    caveats: str
    tables: list
    conditions: str

    def markdown(self):
        files = [f"[{table.name}.csv](benchmarks/{table.name}.csv)" for table in self.tables]
        end = f"{', '.join(files)}; `python crates/bench/peers/{self.name}.py`. {self.conditions}"
        # The commit stands beside the figures: it may be older than that of other results.
        commit = self.conditions.split(";")[0].lower()
        result = f"**Result, {commit}:** {self.finding}"
        parts = [_wrap(part) for part in (self.question, result, self.caveats)]
        return "\n\n".join([f"### {self.title}", *parts, end]) + "\n"


def keep(section, records, folder):
    """Writes the section, its tables, and `records`, all that was measured, as CSV."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "section.md").write_text(section.markdown(), encoding="utf-8")
    names = list(dict.fromkeys(key for record in records for key in record))
    text = io.StringIO()
    writer = csv.DictWriter(text, names, lineterminator="\n")
    writer.writeheader()
    writer.writerows(records)
    (folder / "records.csv").write_text(text.getvalue(), encoding="utf-8")
    for table in section.tables:
        (folder / f"{table.name}.csv").write_text(table.csv(), encoding="utf-8")
        print(table.csv())
    print(section.markdown())
    print(f"{folder}")


HEADING = """Other programs run beside Bowknot on the same input, in turns, on the same number of
threads. CPU seconds are user and system time of all threads; medians over the turns, with the
smallest and largest in the tables. A ratio is the peer's seconds over Bowknot's, turn by turn. Each
comparison names the commit that was measured; see `crates/bench/peers/README.md` for how to repeat
it and for what the times include."""


def ensure_clean():
    """Refuses a git tree with changes, so that the commit beside each result is the code."""
    command = ["git", "status", "--porcelain", "--", "."]
    command += [f":(exclude){path.relative_to(REPOSITORY)}" for path in (PAGE, TABLES, README)]
    done = subprocess.run(command, cwd=REPOSITORY, capture_output=True, text=True, check=False)
    if done.returncode != 0 or done.stdout.strip():
        raise Unusable(
            f"{PAGE} is written from a clean git tree only; commit these files first, or use --quick:\n"
            f"{done.stdout or done.stderr}"
        )


def publish(folders, names):
    """Puts the results that full runs left in `folders`, by name, between the markers of the page. Other comparisons of
    `names`, which is their order, stay as they are there."""
    ensure_clean()
    page = PAGE.read_text(encoding="utf-8")
    start, end = page.find(BEGIN), page.find(END)
    if not 0 <= start < end:
        raise Unusable(f"{PAGE} lacks the lines {BEGIN.strip()} and {END.strip()}")
    sections = sections_of(page[start + len(BEGIN) : end], names)
    for name, folder in folders.items():
        sections[name] = (folder / "section.md").read_text(encoding="utf-8")
    ordered = [sections[name] for name in names if name in sections]
    text = "\n".join([f"## Peers\n\n{_wrap(HEADING)}\n", *ordered])
    PAGE.write_text(page[: start + len(BEGIN)] + text + page[end:], encoding="utf-8")
    for folder in folders.values():
        for table in folder.glob("peers-*.csv"):
            shutil.copyfile(table, TABLES / table.name)
    print("`cargo run --release -p bowknot-bench -- age` takes the results into the first section.")


def sections_of(block, names):
    """The sections of a block, by the name of the script that each of them names."""
    parts = [f"### {part.rstrip()}\n" for part in block.split("\n### ")[1:]]
    return {name: part for part in parts for name in names if f"crates/bench/peers/{name}.py" in part}


def _wrap(text):
    """Lines of limited length; words are never split."""
    filler = textwrap.TextWrapper(WIDTH, break_long_words=False, break_on_hyphens=False)
    return "\n\n".join(filler.fill(" ".join(p.split())) for p in text.split("\n\n"))

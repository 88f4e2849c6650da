"""Tables as CSV and Markdown, sections of the page."""

import csv
import io
import textwrap
from dataclasses import dataclass

from setting import REPOSITORY, Unusable

PAGE = REPOSITORY / "docs" / "benchmarks.md"
WIDTH = 120


@dataclass
class Table:
    """Rows of text; `plain` columns are words, the others numbers, to the right."""

    caption: str
    columns: list
    rows: list
    plain: int = 1

    def markdown(self):
        marks = ["---" if k < self.plain else "--:" for k in range(len(self.columns))]
        lines = [" | ".join(row) for row in (self.columns, *self.rows)]
        lines = [f"| {lines[0]} |", f"|{'|'.join(marks)}|", *(f"| {line} |" for line in lines[1:])]
        return f"{_wrap(self.caption)}\n\n" + "\n".join(lines)


@dataclass
class Section:
    """What a comparison found; `name` is that of its file."""

    name: str
    title: str
    question: str
    finding: str
    tables: list
    notes: str
    conditions: str

    def markdown(self):
        parts = [f"### {self.title}", _wrap(self.question), f"**{_wrap(self.finding)}**"]
        parts += [table.markdown() for table in self.tables]
        parts += [_wrap(self.notes)]
        parts += [f"`python crates/bench/peers/{self.name}.py`. {self.conditions}"]
        return "\n\n".join(parts) + "\n"


def keep(section, records, folder):
    """Writes the section, and `records`, all that was measured, as CSV; says where."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "section.md").write_text(section.markdown(), encoding="utf-8")
    names = list(dict.fromkeys(key for record in records for key in record))
    text = io.StringIO()
    writer = csv.DictWriter(text, names, lineterminator="\n")
    writer.writeheader()
    writer.writerows(records)
    (folder / f"{section.name}.csv").write_text(text.getvalue(), encoding="utf-8")
    print(section.markdown())
    print(f"{folder}")


HEADING = """Other people's programs beside Bowknot on the same input, one after the other and
back, on the same number of threads. CPU seconds are user and system time of all threads; with
several turns the median stands with the least and largest. A ratio is the peer's seconds over
Bowknot's, turn by turn. `crates/bench/peers/README.md` says how to repeat it."""


def rewrite(sections):
    """Puts the texts of sections between the markers of the page, or at its end."""
    text = "\n".join([f"## Peers, timed in the same run\n\n{_wrap(HEADING)}\n", *sections])
    block = f"<!-- begin peers -->\n{text}<!-- end peers -->\n"
    page = PAGE.read_text(encoding="utf-8")
    start, end = page.find("<!-- begin peers -->\n"), page.find("<!-- end peers -->\n")
    if start < 0 and end < 0:
        page = f"{page.rstrip()}\n\n{block}"
    elif 0 <= start < end:
        page = page[:start] + block + page[end + len("<!-- end peers -->\n") :]
    else:
        raise Unusable(f"{PAGE}: the markers of section peers do not belong together; mend them")
    PAGE.write_text(page, encoding="utf-8")


def _wrap(text):
    """Lines of at most 120 characters; words are never split."""
    filler = textwrap.TextWrapper(WIDTH, break_long_words=False, break_on_hyphens=False)
    return "\n\n".join(filler.fill(" ".join(p.split())) for p in text.split("\n\n"))

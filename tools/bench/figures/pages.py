"""Puts the tables into the pages, between `<!-- table: NAME -->` and `<!-- end of table -->`."""
import re
import sys

from .plot import PROJECT
from .tables import TABLES

MARKED = re.compile(r"(<!-- table: (\w+) -->\n).*?(<!-- end of table -->\n)", re.DOTALL)


def filled(text, page):
    """The page's text with all its tables filled again."""
    def replace(match):
        if match[2] not in TABLES:
            sys.exit(f"{page}: unknown table {match[2]}, expected one of: {' '.join(TABLES)}")
        try:
            return f"{match[1]}\n" + "\n".join(TABLES[match[2]]()) + f"\n\n{match[3]}"
        except FileNotFoundError:  # not measured yet
            return match[0]
    return MARKED.sub(replace, text)


def pages():
    return [PROJECT / "README.md", *sorted((PROJECT / "docs").glob("*.md"))]


def fill():
    for page in pages():
        old = page.read_text()
        new = filled(old, page.name)
        if new != old:
            page.write_text(new)
            print(f"filled {page.relative_to(PROJECT)}")


def check():
    """Returns 1 if a page differs from the measurements, else 0."""
    stale = [str(page.relative_to(PROJECT)) for page in pages() if filled(page.read_text(), page.name) != page.read_text()]
    for page in stale:
        print(f"{page}: a table differs from docs/measured; run tools/bench/draw", file=sys.stderr)
    found = {name for page in pages() for _, name, _ in MARKED.findall(page.read_text())}
    unused = sorted(set(TABLES) - found)
    for name in unused:
        print(f"no page shows the table {name}", file=sys.stderr)
    return 1 if stale or unused else 0

"""Runs the Python blocks of each page of the documentation in order, in one namespace, from the project's folder."""
import os
import pathlib
import re

import pytest

DATA = pathlib.Path(os.environ.get("FCL_STPBV_DATA", pathlib.Path(__file__).parents[2] / "data"))
PROJECT = DATA.parent
PAGES = {page: re.findall(r"^```python\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE)
         for page in [PROJECT / "README.md", *sorted((PROJECT / "docs").glob("*.md"))]}


def test_there_are_blocks():
    assert sum(len(blocks) for blocks in PAGES.values()) >= 2


@pytest.mark.parametrize("page", [page for page, blocks in PAGES.items() if blocks], ids=lambda page: page.name)
def test_the_blocks_of_a_page_run_in_order(page, monkeypatch):
    monkeypatch.chdir(PROJECT)
    namespace = {}
    for block in PAGES[page]:
        exec(compile(block, page.name, "exec"), namespace)

"""Runs every Python block of the documentation, from the project's folder."""
import os
import pathlib
import re

import pytest

DATA = pathlib.Path(os.environ.get("FCL_STPBV_DATA", pathlib.Path(__file__).parents[2] / "data"))
PROJECT = DATA.parent
PAGES = [PROJECT / "README.md", *sorted((PROJECT / "docs").glob("*.md"))]
BLOCKS = [(page.name, block) for page in PAGES
          for block in re.findall(r"^```python\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE)]


def test_there_are_blocks():
    assert len(BLOCKS) >= 2


@pytest.mark.parametrize("page,block", BLOCKS)
def test_a_block_runs(page, block, monkeypatch):
    monkeypatch.chdir(PROJECT)
    exec(compile(block, page, "exec"), {})

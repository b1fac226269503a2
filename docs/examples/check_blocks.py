"""Checks that every ```cpp block of README.md and docs/*.md stands in a program of docs/examples: check_blocks.py PROJECT"""
import pathlib
import re
import sys


def words(text):
    """The text with every run of white space replaced by one space."""
    return " ".join(text.split())


project = pathlib.Path(sys.argv[1])
programs = [words(path.read_text()) for path in (project / "docs/examples").glob("*.cpp")]
missing, seen = [], 0
for page in [project / "README.md", *sorted((project / "docs").glob("*.md"))]:
    for block in re.findall(r"^```cpp\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE):
        seen += 1
        # A block's includes and its body may be in different places of the program.
        parts = [words(part) for part in block.split("\n\n") if part.strip()]
        if not any(all(part in program for part in parts) for program in programs):
            missing.append(f"{page.name}: {block.strip().splitlines()[0]} ...")
print(f"{seen} blocks, {len(missing)} in no program of docs/examples", *missing, sep="\n")
sys.exit(1 if missing or not seen else 0)

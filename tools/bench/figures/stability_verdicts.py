"""The hard cases' verdicts, grouped and counted: for the chart and the tables of docs/stability.md."""
import collections

from . import palette

# From best to worst, as test/reference/stability/judge.h has them.
ORDER = ("exact", "global", "local", "within tolerance", "jump", "wrong", "no answer", "NaN", "exception", "hang", "abort")
FIRST_FAILURE = ORDER.index("jump")
Method = collections.namedtuple("Method", "column id title")  # column: in each row's verdicts
Cell = collections.namedtuple("Cell", "failed shade words")


def methods(data):
    """The methods with the names that all charts use, this library's first, the best of them in front."""
    named = [Method(column, method["id"], palette.METHODS[method["title"]][2] if method["title"] in palette.METHODS else method["title"])
             for column, method in enumerate(data["about"]["methods"])]
    ours = [method for method in named if method.id.startswith("stpbv")]
    return ours[::-1] + [method for method in named if method not in ours]


def groups(data):
    """{group: its rows}, in the order of the cases."""
    found = {}
    for row in data["rows"]:
        found.setdefault(row["group"], []).append(row)
    return found


def fails(verdict):
    return ORDER.index(verdict) >= FIRST_FAILURE


def failures(data):
    """{method's id: number of cases that it fails}"""
    return {method["id"]: sum(fails(row["verdicts"][m]) for row in data["rows"])
            for m, method in enumerate(data["about"]["methods"])}


def cell(cases, m):
    """The result of one method for a group: number of failures, index into the palette's verdicts, words."""
    judged = [(ORDER.index(row["verdicts"][m]), row["amounts"][m]) for row in cases]
    worst, amount = max(judged)
    count = collections.Counter(ORDER[verdict] for verdict, _ in judged)
    failed = sum(verdict >= FIRST_FAILURE for verdict, _ in judged)
    name = ORDER[worst]
    size = {"jump": f"jump of {amount:.0e}", "wrong": f"wrong by {amount:.0e}"}
    if failed:
        words = f"{failed}: {size.get(name, name)}"
    elif count["within tolerance"]:
        words = f"{count['within tolerance']} within tolerance"
    elif count["global"] or count["local"]:
        words = f"{count['global']} global, {count['local']} local"
    else:
        words = "exact"
    shades = {"exact": 0, "global": 0, "local": 1, "within tolerance": 1, "jump": 2, "wrong": 3 if amount < 1e-5 else 4 if amount < 1e-3 else 5,
              "no answer": 6, "NaN": 7, "exception": 7, "hang": 8, "abort": 8}
    return Cell(failed, shades[name], words)

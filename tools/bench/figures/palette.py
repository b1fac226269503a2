"""The one palette: a method has the same colour and mark in every chart."""

# name in the measurements: (colour, gnuplot's point type, name in a chart)
METHODS = {
    "STP-BV warm": ("#1f4e96", 7, "STP-BV, from the last answer"),
    "STP-BV through FCL": ("#3398c8", 13, "STP-BV, from FCL's witness"),
    "FCL with gap stop": ("#3f9a58", 11, "FCL's GJK, duality-gap stop"),
    "FCL libccd": ("#c44e52", 7, "FCL libccd"),
    "FCL indep": ("#d2722f", 5, "FCL indep"),
    "Bullet GJK": ("#8172b3", 9, "Bullet GJK"),
}
# SMOOTH is this library, SECOND another way to use it. FCL stands for polyhedra as FCL's users query them.
SMOOTH, SECOND, _, FCL, _, OTHER = (METHODS[name][0] for name in METHODS)
# Other ways to use hulls. HULL_MARGIN: a margin r around them, and exact distances.
MANIFOLD, HULL_MARGIN, ROUNDED_FCL, HACD = "#b8860b", "#4d4d4d", "#8e1c5a", "#7f8f2a"
SWEEPS = ("#b0528f", "#2f7f86", "#8c613c", "#333333")  # not methods: settings, robots, scenarios
PEERS = {"ours": (SMOOTH, 7, "these parts"), "HACD": (HACD, 5, "hulls of HACD's partition")}  # of convex parts
NEUTRAL, TICKS, QUIET, GRID = "#555555", "#444444", "#888888", "#dddddd"  # small print, tick labels, axes, grid

# Verdicts of the hard cases, from best to worst: (words, colour).
VERDICTS = (("exact", "#d9e8d4"), ("within 1e-6, or local and said so", "#a9c9e8"), ("gradient jumps", "#f3dc8f"),
            ("wrong, < 10 µm", "#f0b467"), ("wrong, < 1 mm", "#e58a4d"), ("wrong by more", "#c44e52"),
            ("no answer", "#b8a4d4"), ("NaN or exception", "#7d5ba6"), ("hang or abort", "#222222"))


def look(method):
    """gnuplot's options for a method's lines and marks."""
    colour, mark, _ = METHODS[method]
    return f"lc rgb '{colour}' pt {mark}"

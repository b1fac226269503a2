"""The tables of the docs, each made of measurements: {name: function that gives the lines between its markers}.

A table begins with the commands that were run, so that the figures stand beside what made them.
"""
import re
import statistics

from . import palette, stability_verdicts
from .plot import captured, is_text, measured

TABLES = {}


def table(*sources):
    """Registers a table under its function's name, and puts the commands of these measurements above it."""
    def register(function):
        def lines():
            commands = [captured(source)[0] if is_text(source) else measured(source)["command"] for source in sources]
            head = ["<!-- not run: tools/bench/all runs it -->", "", *(f"    {command}" for command in commands), ""] if commands else []
            return head + function()
        TABLES[function.__name__] = lines
        return function
    return register


def markdown(head, rows):
    """Columns of numbers stand on the right, so that their digits are below each other."""
    line = lambda cells: "| " + " | ".join(str(cell) for cell in cells) + " |"
    cells = [[str(cell) for cell in row] for row in rows]
    number = lambda words: re.match(r"(\*\*)?[-+]?[0-9]", words)
    numbers = lambda column: any(map(number, column)) and all(number(words) or words in ("", "-") for words in column)
    return [line(head), "|" + "".join("---:|" if numbers(column) else "---|" for _, *column in zip(head, *cells)), *map(line, cells)]


def span(values, digits=1):
    """The range of some values, to so many digits after the point."""
    low, high = f"{min(values):.{digits}f}", f"{max(values):.{digits}f}"
    return low if low == high else f"{low} to {high}"


@table()
def first_page():
    rows, verdicts = measured("summary")["rows"], measured("stability")
    failures = stability_verdicts.failures(verdicts)
    whole = [statistics.median(row[key] for row in rows) for key in ("speedup_small_162", "speedup_large_162")]
    drop_in = [row["ns_fcl"] / row["ns_exact_warm"] for row in measured("adapter")["rows"]
               if row["shape"] == "geodesic 162" and row["motion"] in ("small", "large")]
    return [f"- **Fast**: a query is {span(whole, 0)} times as fast as `fcl::distance` ([performance](docs/performance.md), `speed_accuracy --summary`),",
            f"  through FCL's objects and with closer bodies about {span(drop_in, 0)} times ([fcl](docs/fcl.md), `adapter_figures`).",
            f"- **Robust**: {len(verdicts['rows'])} hard cases with {failures['stpbv_warm']} failures, where FCL fails {failures['fcl_libccd_1e-6']} "
            "([stability](docs/stability.md), `stability`).",
            "- **Exact** to rounding. Every answer has a lower and an upper bound, between which the truth lies, rounding included",
            "  ([stability](docs/stability.md#fuzzing-and-soak), ten million queries, `truth_soak`)."]


@table("summary")
def summary():
    rows = measured("summary")["rows"]
    lines = [("times the speed of `fcl::distance`, 162 vertices, small steps", "speedup_small_162"),
             ("times the speed of `fcl::distance`, 162 vertices, large steps", "speedup_large_162"),
             ("times the speed of `fcl::distance`, 12 vertices, small steps", "speedup_small_12"),
             ("growth of the mean time from 12 to 2562 vertices", "growth_12_2562"),
             ("the same with FCL's queries in between, which empty the caches", "growth_12_2562_beside_fcl"),
             ("cost of penetration up to both margins, in separated queries", "cost_within_margins_162"),
             ("cost of overlap 2 to 4 cm deep, in separated queries", "cost_deeper_162")]
    body = [(words, span([row[key] for row in rows]), f"{statistics.median(row[key] for row in rows):.1f}") for words, key in lines]
    worst = lambda key: f"{max(row[key] for row in rows):.1e}"
    body += [("largest error of the distance (m)", "", worst("distance_error_max")), ("largest error of the normal (rad)", "", worst("normal_error_max"))]
    return markdown(("figure", f"range of {len(rows)} run" + "s" * (len(rows) > 1), "median, or worst"), body)


NAMES = {"FCL libccd": "FCL libccd", "FCL indep": "FCL indep", "Bullet GJK": "Bullet GJK", "FCL with gap stop": "FCL's GJK, duality-gap stop, warm",
         "STP-BV through FCL": "STP-BV, from FCL's witness", "STP-BV warm": "STP-BV, from the last answer"}


@table("size")
def size():
    rows = measured("size")["rows"]
    at = {(row["method"], row["vertices"], row["steps"]): row["ns_p50"] for row in rows}
    vertices = sorted({row["vertices"] for row in rows})
    return markdown(("median in ns, small / large steps", *(f"{v:,}" for v in vertices)),
                    [(words, *(f"{at[method, v, 'small']:.0f} / {at[method, v, 'large']:.0f}" for v in vertices))
                     for method, words in NAMES.items() if (method, vertices[0], "small") in at])


@table("solver_error")
def solver_error():
    rows = [row for row in measured("solver_error")["rows"] if row["steps"] == "large"]
    return markdown(("method", "setting", "median time (ns)", "distance, 99th percentile (m)", "distance, worst (m)", "normal, worst (rad)",
                     "of answers checked", "off by > 1 µm", "no answer"),
                    [(palette.METHODS[row["method"]][2], row["setting"], f"{row['ns_p50']:.0f}", *(f"{row[key]:.1e}" for key in
                      ("distance_error_p99", "distance_error_max", "normal_error_max")), row["checked"], row["off_by_more_than_1e-6"], row["missed"])
                     for row in rows
                     if row["setting"] not in ("tolerance 1e-04", "tolerance 1e-08", "tolerance 1e-12", "cold") or row["method"].startswith("STP")])


@table("model_error")
def model_error():
    return markdown(("varied", "to", "vertices", "largest over-cover (mm)", "median time (ns)", "gradient by a shift (1/m)", "by a turn (m/rad²)"),
                    [(row["sweep"], row["setting"], row["vertices"], f"{1e3 * row['over_cover_most_m']:.1f}", f"{row['ns_p50']:.0f}",
                      f"{row['steepness_shift']:.3g}", f"{row['steepness_turn']:.3g}") for row in measured("model_error")["rows"]])


@table("jump_test")
def jump_test():
    rows = measured("jump_test")["rows"]
    steps = sorted({row["path_steps"] for row in rows})[::2] + [max(row["path_steps"] for row in rows)]
    at = {(row["method"], row["path_steps"]): row["largest_change"] for row in rows}
    return markdown(("largest change in one step, of", *(f"{n:,} steps" for n in steps)),
                    [(words, *(f"{at[method, n]:.1e}" for n in steps)) for method, words in NAMES.items() if (method, steps[0]) in at])


@table("build")
def build():
    return markdown(("cloud", "points", "vertices", "seconds, median of 5", "µs / (V log2 V)", "bytes a vertex"),
                    [(row["cloud"], f"{row['points']:,}", f"{row['vertices']:,}", f"{row['seconds']:.3g}", f"{row['us_per_v_log_v']:.2f}",
                      f"{row['bytes_per_vertex']:.0f}") for row in measured("build")["rows"]])


@table("adapter")
def features():
    share = lambda row: (f"{row['right']:.2f} %", f"{row['neighbour']:.2f} %", f"{row['farther']:.3f} %", f"{row['none']:.2f} %")
    motions = {"large": "large", "small": "small", "apart": "far apart"}
    return markdown(("", "", "right", "one neighbour away", "farther", "none"),
                    [(row["shape"], motions[row["motion"]], *share(row)) for row in measured("adapter")["rows"]])


@table()
def adapter_costs():
    rows = [row for row in measured("adapter")["rows"] if row["motion"] != "apart"]
    ns = lambda row, way: row[f"ns_{way}"]
    return markdown(("", "", "fcl::distance", "witness, cold", "witness, warm", "exact, from the witness", "exact, cold", "exact, warm", "exact, cold / FCL",
                     "exact, warm / FCL", "cold / without FCL"),
                    [(row["shape"], row["motion"],
                      *(f"{ns(row, way):.0f}" for way in ("fcl", "witness_cold", "witness_warm", "exact_from_witness", "exact_cold", "exact_warm")),
                      *(f"{ns(row, way) / ns(row, 'fcl'):.2f}" for way in ("exact_cold", "exact_warm")),
                      f"{ns(row, 'exact_cold') / ns(row, 'core_cold'):.2f}") for row in rows])


@table("collide")
def collide():
    return markdown(("body", "nearest centres (m)", "collide", "asked", "fcl::collide", "cold", "warm", "cold / FCL", "warm / FCL",
                     "FCL's depth over 1 % too large"),
                    [(row["body"], f"{row['nearest']:.2f}", f"{row['hits']:.0f} %", row["asked"],
                      *(f"{row[way]:.0f}" for way in ("ns_fcl", "ns_cold", "ns_warm")),
                      *(f"{row[way] / row['ns_fcl']:.2f}" for way in ("ns_cold", "ns_warm")),
                      f"{row['fcl_too_deep']:.0f} %" if "fcl_too_deep" in row else "") for row in measured("collide")["rows"]])


@table("verdict")
def verdict():
    rows = {(row["way"], row["bodies"]): row for row in measured("verdict")["rows"]}
    bodies = list(dict.fromkeys(key[1] for key in rows))
    cell = lambda row: f"{row['ns']:,.0f} ({row['ratio']:.3g})"
    return markdown(("ns, and as a multiple of the first way's, hulls", *bodies),
                    [(way, *(cell(rows[way, name]) for name in bodies)) for way in dict.fromkeys(key[0] for key in rows)])


@table("shapes")
def shapes():
    rows = {(row["body"], row["asked"], row["nearest"], row["shape"]): row for row in measured("shapes")["rows"]}
    names = list(dict.fromkeys(key[3] for key in rows))
    cell = lambda row: f"{row['ns_fcl']:,.0f} / {row['ns_cold']:,.0f} ({row['ns_cold'] / row['ns_fcl']:.2g}, {row['ns_warm'] / row['ns_fcl']:.2g})"
    return markdown(("body", "asked", "nearest centres (m)", *names),
                    [(body, asked, f"{nearest:.2f}", *(cell(rows[key]) if (key := (body, asked, nearest, name)) in rows else "" for name in names))
                     for body, asked, nearest in dict.fromkeys(key[:3] for key in rows)])


@table("meshes")
def meshes():
    us = {(row["surface"], row["place"], row["asked"], row["body"]): (row["us_fcl"], row["us"]) for row in measured("meshes")["rows"]}
    bodies = list(dict.fromkeys(key[3] for key in us))
    places = {"meets": "overlap", "apart": "apart"}
    short = lambda us: f"{us:,.0f}" if us >= 100 else f"{us:.3g}"
    cell = lambda fcl, ours: f"{short(fcl)} / {short(ours)} ({ours / fcl:.2g})"
    return markdown(("surface", "the two", "asked", *bodies),
                    [(surface, places[place], asked, *(cell(*us[surface, place, asked, body]) for body in bodies))
                     for surface, place, asked in dict.fromkeys(key[:3] for key in us)])


@table("constraints", "constraints_jvrc1")
def constraints():
    body = []
    for name in "constraints", "constraints_jvrc1":
        data = measured(name)
        fcl = {row["steps"]: statistics.median(row["us_p50"]) for row in data["rows"] if row["what"].startswith("`fcl")}
        for row in data["rows"]:
            middle = statistics.median(row["us_p50"])
            body.append((data["about"]["robot"], data["about"]["pairs"], row["what"], row["steps"], f"{middle:.3g} µs",
                         f"{statistics.median(row['us_p99']):.3g} µs", f"{1e3 * middle / data['about']['pairs']:.0f} ns", f"{fcl[row['steps']] / middle:.1f}"))
    return markdown(("robot", "pairs", "what", "steps", "median", "99th percentile", "a pair", "times FCL's speed"), body)


@table("robot", "robot_jvrc1")
def robot():
    body = []
    for name in "robot", "robot_jvrc1":
        data = measured(name)
        for row in data["rows"]:
            hits = f"{row['hits'] / data['about']['configurations']:.2f}" if row["what"] in ("all pairs", "first hit", "batch, first hit") else ""
            ratio = f"{row['ratio']:.2f} ({row['ratio_least']:.2f} to {row['ratio_most']:.2f})"
            body.append((data["about"]["robot"], data["about"]["pairs"], row["what"], row["steps"], row["way"], f"{row['us']:.3g} µs", ratio, hits))
    return markdown(("robot", "pairs", "what", "steps", "way", "a configuration", "times the first way's", "hits"), body)


@table("robot_size")
def robot_size():
    rows = measured("robot_size")["rows"]
    at = {(row["varied"], row[row["varied"]], row["what"], row["way"], row["steps"]): row["us"] for row in rows}
    columns = list(dict.fromkeys(key[:2] for key in at))
    heads = [f"{value:.0f} {varied}" for varied, value in columns]
    return markdown(("µs a configuration, small / random steps", "way", *heads),
                    [(what, way, *(" / ".join(f"{at[(*column, what, way, steps)]:.3g}" for steps in ("small", "random")) for column in columns))
                     for what in ("all pairs", "d and J") for way in dict.fromkeys(row["way"] for row in rows if row["what"] == what)])


@table("distance_soak")
def distance_soak():
    _, lines = captured("distance_soak")
    radii = {}
    for line in lines[1:]:
        fields = line.split()
        if len(fields) < 10 or fields[-9] not in ("cold", "warm"):
            continue
        start, (queries, not_exact, gap, _, pairs, most, _, _) = fields[-9], map(float, fields[-8:])
        radii.setdefault(fields[0], []).append((start, queries, not_exact, gap, pairs, most))
    mean = lambda rows, start: sum(r[1] * r[4] for r in rows if r[0] == start) / sum(r[1] for r in rows if r[0] == start)
    return markdown(("R (m)", "queries", "not exact", "widest certificate (m)", "patch pairs a query, cold / warm", "most"),
                    [(R, f"{sum(r[1] for r in rows):,.0f}", f"{sum(r[2] for r in rows):.0f}", f"{max(r[3] for r in rows):.1e}",
                      f"{mean(rows, 'cold'):.2f} / {mean(rows, 'warm'):.2f}", f"{max(r[5] for r in rows):.0f}") for R, rows in radii.items()])


def printed_table(name, drop=()):
    """The markdown table in a program's output, without the columns `drop`."""
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in captured(name)[1] if line.startswith("|")]
    keep = [i for i, head in enumerate(rows[0]) if head not in drop]
    return markdown([rows[0][i] for i in keep], [[row[i] for i in keep] for row in rows[2:]])


@table("shape_soak")
def shape_soak():
    head, *rest = printed_table("shape_soak", drop=("ns a query",))
    return [head.replace("askew", "not opposite"), *rest]


@table("deep_soak")
def deep_soak():
    lines = printed_table("deep_soak", drop=("us",))
    return lines[:2] + [line for line in lines if line.startswith("| all |")]


@table("mirrored_limbs")
def mirrored_limbs():
    return ["    " + line for line in captured("mirrored_limbs")[1]]


@table("stability")
def stability_totals():
    data = measured("stability")
    failures = stability_verdicts.failures(data)
    count = lambda verdict, column: sum(row["verdicts"][column] == verdict for row in data["rows"])
    return markdown((f"{len(data['rows'])} cases", *stability_verdicts.ORDER, "failures"),
                    [(method.title, *(count(verdict, method.column) for verdict in stability_verdicts.ORDER), f"**{failures[method.id]}**")
                     for method in stability_verdicts.methods(data)])


@table()
def stability_groups():
    data = measured("stability")
    methods = stability_verdicts.methods(data)
    return markdown(("group (cases)", *(method.title for method in methods)),
                    [(f"{group} ({len(cases)})", *(stability_verdicts.cell(cases, method.column).words for method in methods))
                     for group, cases in stability_verdicts.groups(data).items()])


@table("proof_boxes_panda", "proof_boxes")
def proofs():
    body = []
    for name in "proof_boxes_panda", "proof_boxes":
        a = measured(name)["about"]
        body.append((a["robot"], a["pairs"], f"{a['proven_by_levers']} of {a['most_boxes_of_levers']:,} boxes each",
                     f"{a['proven_by_planes']} of {a['most_boxes_of_planes']:,}",
                     f"{a['hardest_proof']:,}", f"{a['fewer_boxes_median']:.0f} ({a['fewer_boxes_pairs']} pairs)", f"{a['us_a_box']:.0f} µs",
                     a["pairs"] - a["proven_by_planes"]))
    return markdown(("robot", "pairs", "proven by levers, at most", "by planes, at most", "boxes of the hardest proof",
                     "times fewer boxes where levers take 100 or more", "a box by planes", "left open"), body)


@table("posture_grid")
def posture_grid():
    ways = {"neighbours": "from the neighbours", "independent": "independent"}
    return markdown(("scene", "starts", "places", "with a posture", "from a neighbour's", "places a second and core", "iterations, median", "distances",
                     "cost"),
                    [(row["scene"], ways[row["way"]], f"{row['places']:,}", row["found"], row["from_neighbour"] if row["way"] == "neighbours" else "",
                      row["places_per_second"], f"{row['iterations']:.0f}", f"{row['distances']:,.0f}", f"{row['cost']:.2f}")
                     for row in measured("posture_grid")["rows"]])


@table("scale")
def scale():
    return markdown(("batch", "jobs", "seconds a job", "one process (s)", "two processes (s)", "efficiency", "of what the machine gives", "bytes a result",
                     "at most"),
                    [(row["batch"], row["jobs"], row["seconds_a_job"], row["one_process"], row["two_processes"], row["efficiency"], row["of_the_machine"],
                      f"{row['bytes_a_result']:,}", f"{row['most_bytes']:,}") for row in measured("scale")["rows"]])


@table("scene", "scene_jvrc1")
def scene():
    rows = []
    for robot, name in (("hrp2_style", "scene"), ("JVRC-1", "scene_jvrc1")):
        figures = measured(name)
        rows += [(robot, row["model"], f"{row['vertices']:,}", f"{row['rows']:,}", f"{row['us_a_tick']:.0f} / {row['us_handed_over']:.0f}",
                  f"{1e3 * row['excess_mean']:.0f} ({1e3 * row['excess_most']:.0f})", f"{row['verdicts_differ']:,} of {row['pairs_differ']} pairs",
                  f"{row['others_differ']:,}") for row in figures["rows"]]
    return markdown(("robot", "model", "vertices", "rows", "µs a tick / with hand-over", "excess over the meshes, mean (most), mm", "verdicts that differ",
                     "elsewhere"), rows)


def parts_by_link():
    """{link: {(method, most): row}} of parts_benchmark on a robot."""
    links = {}
    for row in measured("parts")["rows"]:
        links.setdefault(row["mesh"], {})[row["method"], row["most"]] = row
    return links


def mm(metres):
    """Millimetres with two digits after the decimal point; smaller values are known to a hundredth of a millimetre."""
    return f"{1e3 * metres:.2f}"


@table("parts")
def parts():
    """The parts of each link. Of mirrored links, only one is listed."""
    links = {name: rows for name, rows in parts_by_link().items() if not (name.startswith("L_") and "R" + name[1:] in parts_by_link())}
    counts = list(dict.fromkeys(most for rows in links.values() for _, most in rows))
    cell = lambda rows, most: " / ".join(f"{mm(row['excess'])} ({row['parts']})" for row in (rows["ours", most], rows["HACD", most]))
    first = lambda rows: next(iter(rows.values()))
    return markdown(("link", "triangles", "hull", *(f"{most} parts" for most in counts)),
                    [(name.removesuffix("_S"), first(rows)["triangles"], mm(first(rows)["hull_excess"]), *(cell(rows, most) for most in counts))
                     for name, rows in links.items()])


@table("parts")
def parts_summary():
    links, level = parts_by_link(), 1e-5  # m, the accuracy of the bounds
    body = []
    for most in dict.fromkeys(most for rows in links.values() for _, most in rows):
        pairs = [(rows["ours", most], rows["HACD", most]) for rows in links.values()]
        apart = [(ours, theirs) for ours, theirs in pairs if abs(ours["excess"] - theirs["excess"]) > level + 1e-3 * theirs["excess"]]
        nearer = [ours["excess"] / theirs["excess"] for ours, theirs in apart if ours["excess"] < theirs["excess"]]
        tick = {row["method"]: row for row in measured("parts")["about"]["ticks"] if row["most"] == most}
        body.append((most, len(nearer), len(pairs) - len(apart), len(apart) - len(nearer),
                     f"{statistics.median(nearer):.2f}" if nearer else "", *(f"{mm(statistics.mean(one[i]['excess'] for one in pairs))}" for i in (0, 1)),
                     *(f"{tick[method]['rows']:,} / {tick[method]['us_a_tick']:.0f}" for method in ("ours", "HACD")),
                     *(f"{sum(one[i]['seconds'] for one in pairs):.0f}" for i in (0, 1))))
    return markdown(("parts at most", "nearer", "level", "farther", "share of HACD's excess where nearer, median", "excess, mean (mm)", "HACD's",
                     "rows / µs a tick", "HACD's",
                     "seconds", "HACD's"), body)


@table("radii")
def radii():
    return markdown(("robot", "r", "volumes meet", "meshes meet", "hull only", "margin only", "normal turns (rad/m), median"),
                    [(row["robot"], row["r"], row["meet"], row["meshes meet"], row["hull only"], row["margin only"], f"{row['lipschitz']:.0f}")
                     for row in measured("radii")["rows"]])


@table("posture_study")
def posture_study():
    rows = measured("posture_study")["rows"]
    good = lambda row: row["solved"] and row["clear"]
    tasks = {}
    for row in rows:
        tasks.setdefault(row["seed"], {})[row["distances"]] = row
    feasible = [results for results in tasks.values() if next(iter(results.values()))["feasible"]]
    by_all = [results for results in feasible if all(map(good, results.values()))]
    best = {id(results): min(row["cost"] for row in results.values()) for results in by_all}
    body = []
    for name in rows[0] and list(next(iter(tasks.values()))):
        solved = [results[name] for results in feasible if good(results[name])]
        middle = lambda value: statistics.median(value(results[name], results) for results in by_all)
        body.append((name, f"{100 * sum(row['starts'] == 1 for row in solved) / len(feasible):.1f} %", f"{100 * len(solved) / len(feasible):.1f} %",
                     sum(row["solved"] and not row["clear"] for row in rows if row["distances"] == name),
                     f"{middle(lambda row, _: row['iterations']):.0f}", f"{middle(lambda row, _: row['calls']):.0f}",
                     f"{middle(lambda row, _: 1e3 * row['seconds']):.1f}",
                     f"{middle(lambda row, results: 100 * (row['cost'] / best[id(results)] - 1)):.1f} %"))
    return markdown(("distances", "solved at the first start", "within 5", "hits a mesh", "iterations", "distances", "ms", "cost above the best"), body)


@table("posture_ipopt")
def posture_ipopt():
    about = measured("posture_ipopt")["about"]
    count = lambda row: f"{row['points']:.0f}" + (f" + {row['hessians']:.0f}" if row["hessians"] else "")
    return markdown(("distances", "solver", f"solved of {about['tasks']}, first start", f"within {about['starts']}", "points + Hessians", "ms",
                     "ms, mean of all tasks"),
                    [(row["bodies"], row["solver"], row["first"], row["within"], count(row), f"{row['ms']:g}", f"{row['mean_ms']:g}")
                     for row in measured("posture_ipopt")["rows"]])


TASKS = ("place", "slot", "pack", "corner")


@table(*(f"optimise_{task}" for task in TASKS))
def optimise():
    cells, order = {}, []
    for task in TASKS:
        for row in measured(f"optimise_{task}")["rows"]:
            key = (row["method"], row["solver"])
            order += [] if key in order else [key]
            work = f"{row['points']:.0f}" + (f" + {row['hessians']:.0f}" if row["hessians"] else "")
            cells[key, task] = f"{row['solved']:.0f} %, {work}, {row['ms']:g} ms"
    return markdown(("model", "solver", *TASKS), [(*key, *(cells[key, task] for task in TASKS)) for key in order])


CONTROLLERS = {"no collision rows": "no collision rows", "hull + r": "hull + r, r 10 mm", "manifold": "manifold, r 10 mm",
               "STP-BV R = 10": "STP-BV, r 10 mm, R 10 m", "STP-BV R = 1": "STP-BV, r 10 mm, R 1 m",
               "flat, R = 10": "STP-BV | flat, r 10 mm, R 10 m", "flat, R = 1": "STP-BV | flat, r 10 mm, R 1 m"}
SCENARIOS = {"table": "held box on a table", "rail": "along a rail", "wall": "along a side wall", "boxes": "two held boxes",
             "hand": "a round hand over a table", "arms": "both forearms", "step": "a foot beside a step", "shelf": "a held box along a shelf's edge"}


def three(value):
    """Three digits, without a power of ten."""
    return f"{float(f'{value:.3g}'):g}"


def controllers(*names):
    """The rows of some measurements of control_bench, {(scenario, method): row}, and their scenarios."""
    rows = [row for name in names for row in measured(name)["rows"]]
    return {(row["scenario"], row["method"]): row for row in rows}, list(dict.fromkeys(row["scenario"] for row in rows))


def peaks(name):
    at, scenarios = controllers(name)
    cell = lambda row: f"{three(row['peak'])} ({three(row['worst_peak'])})" if row else "-"
    about = measured(name)["about"]
    return markdown((f"{about['runs']} runs" + ", noise" * about["noise"], *CONTROLLERS),
                    [(SCENARIOS[s], *(cell(at.get((s, method))) for method in CONTROLLERS.values())) for s in scenarios])


@table("control")
def control():
    return peaks("control")


@table("control_noise")
def control_noise():
    return peaks("control_noise")


@table("control_more")
def control_more():
    return peaks("control_more")


@table("control_acceleration")
def control_acceleration():
    return peaks("control_acceleration")


@table("control_advice")
def control_advice():
    mm = lambda metres: f"{1e3 * metres:.2g}" if metres > 5e-5 else "0.0"
    return markdown(("scenario, speeds stated", "clearance (mm)", "at most (m/s²)", "r (mm)", "R (m)", "over-cover (mm)", "added (m/s²)", "lost (mm)",
                     "joints' peak (rad/s²)"),
                    [(f"{SCENARIOS[row['scenario']]}, {row['speed']:.2g} m/s, {row['turning']:.2g} rad/s", f"{1e3 * row['clearance']:g}", three(row["at_most"]),
                      mm(row["r"]), three(row["R"]), mm(row["over_cover"]),
                      three(row["added"]) if row["as_stated"] else f"{three(row['added'])}, too fast", mm(row["lost"]), three(row["peak"]))
                     for row in measured("control_advice")["rows"]])


@table("control", "control_more", *(f"optimise_{task}" for task in TASKS), "posture_study")
def continuity():
    """All tasks: what hulls, their manifold of rows, and STP-BVs need."""
    at, scenarios = controllers("control", "control_more")
    names = [CONTROLLERS[key] for key in ("hull + r", "manifold", "STP-BV R = 10", "STP-BV R = 1", "flat, R = 1")]
    body = [(f"controller, {SCENARIOS[s]}", "peak rad/s²", *(three(at[s, m]["peak"]) if (s, m) in at else "-" for m in names)) for s in scenarios]
    for solver, words in (("IPOPT, exact Hessian", "IPOPT"), ("IPOPT, exact Hessian, continued", "IPOPT, R continued"), ("SLSQP", "SLSQP")):
        for task in TASKS:
            rows = {row["method"]: row for row in measured(f"optimise_{task}")["rows"] if row["solver"] == solver}
            cell = lambda model: next((f"{row['solved']:.0f} %, {row['points'] + row['hessians']:.0f}"
                                       for name, row in rows.items() if name.startswith(model[0]) and name.endswith(model[1])), "-")
            body.append((f"{words}, {task}", "solved, evaluations", cell(("hull + r", "")), "-", cell(("STP-BV", "R 10 m")), cell(("STP-BV", "R 1 m")), "-"))
    study = measured("posture_study")
    first = lambda source: [row for row in study["rows"] if row["feasible"] and row["distances"] == source]
    share = lambda rows: f"{100 * sum(row['solved'] and row['clear'] for row in rows) / len(rows):.1f} %"
    body.append(("postures, SLSQP", f"solved within {study['about']['starts']} starts", share(first("hulls, rounded, exact")), "-", share(first("STP-BV")),
                 "-", "-"))
    return markdown(("task", "measure", "hulls with a margin", "hulls, manifold", "STP-BV, R = 10 m", "STP-BV, R = 1 m", "one flat, R = 1 m"), body)

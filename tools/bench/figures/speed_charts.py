"""Charts of docs/performance.md and docs/fcl.md, and the README's speed against accuracy."""
from . import palette
from .plot import TIME_TICS, UNLABEL, block, draw, legend, measured, origin, panels, single, ticks

ROBOTS = {"jvrc1": "JVRC-1"}  # a robot's name in the pages, if it differs from its file's name
STEPS = {"small": "small steps: 1° and 1 mm", "large": "large steps: 20° and 2 cm"}


def default_setting(row):
    """One setting per method: FCL's default tolerance, and the warm start of this library's GJK."""
    return row["setting"] in ("tolerance 1e-06", "double precision") or \
        row["method"].startswith("STP-BV") or (row["method"], row["setting"]) == ("FCL with gap stop", "warm")


def method_legend(rows, height):
    """All methods that were measured, in the palette's order."""
    present = {row["method"] for row in rows}
    return legend([(colour, mark, words) for name, (colour, mark, words) in palette.METHODS.items() if name in present], height)


def speed_accuracy(height=440):
    """The chart of the README: one point per method, worst error against median time."""
    data = measured("solver_error")
    rows = {row["method"]: row for row in data["rows"] if row["steps"] == "large" and default_setting(row)}
    ours, fcl = rows["STP-BV warm"], rows["FCL libccd"]
    below = origin(data, [f"{data['about']['vertices']} vertices a body, 20° and 2 cm between queries. Up: p5 to p99, mark at the median. "
                          f"Across: median to worst of {ours['checked']} answers,",
                          "mark at the worst. Polyhedral methods against the polyhedra, with FCL's default tolerance; STP-BV against the STP-BVs."])
    floor = 2e-18  # where an error of 0 is drawn
    offset = {"FCL with gap stop": "1.6,0.7", "STP-BV through FCL": "1.6,-0.3", "STP-BV warm": "1.6,-0.3", "Bullet GJK": "-11,0.8"}
    scale = {"FCL with gap stop": 1.9, "STP-BV through FCL": 1.1}  # one lies on the other
    text = single(height, below) + "set logscale xy\nset xrange [1e-18:1e-1]\nset yrange [50:3e4]\nset format x '1e%T'\n" \
        f"set ytics {TIME_TICS}\nset xlabel 'error of the distance (m)'\nset ylabel 'median time of a query' offset 1\nset key off\n" \
        "set object 1 rectangle from graph 0,0 to graph 0.27,0.46 fc rgb '#e6f2e1' fs solid noborder behind\n" \
        "set label 1 'best: fast and exact' at graph 0.015,0.05 font ',15' tc rgb '#3d7a35'\n"
    plots = []
    for i, (method, row) in enumerate(rows.items()):
        name, worst = f"$m{i}", max(row["distance_error_max"], floor)
        text += block(name, [(worst, row["ns_p50"], max(row["distance_error_p50"], floor), worst, row["ns_p5"], row["ns_p99"],
                              palette.METHODS[method][2])])
        plots += [f"{name} using 1:2:3:4:5:6 with xyerrorbars {palette.look(method)} ps {scale.get(method, 1.3)} lw 1.3",
                  f"{name} using 1:2:7 with labels left offset {offset.get(method, '1.2,0.6')}"]
    draw("speed_accuracy",
         f"{fcl['ns_p50'] / ours['ns_p50']:.0f} times as fast as FCL, and exact to {ours['distance_error_max']:.0e} m",
         text + "plot " + ", ".join(plots), below, height)


def size(height=440):
    data = measured("size")
    below = origin(data, ["Geodesic spheres of radius 0.20 m, centres 0.38 to 0.80 m apart, r = 1 cm, R = 10 m. Medians;",
                          f"bands from p5 to p99 of FCL libccd and of the STP-BV from the last answer. At most {data['about']['most_calls']:,} calls a point."])
    text = panels(2, height, below, legend_rows=2, panel_titles=True) + method_legend(data["rows"], height) + \
        f"set logscale xy\nset xrange [9:14000]\nset yrange [50:4e6]\nset ytics {TIME_TICS}\n" \
        f"set xtics {ticks(12, 42, 162, 642, 2562, 10242)}\nset xlabel 'vertices of each body'\nset ylabel 'time of a query' offset 1\n"
    largest = max(row["vertices"] for row in data["rows"])
    at = {(row["method"], row["steps"]): row["ns_p50"] for row in data["rows"] if row["vertices"] == largest}
    times = {steps: f"{at['FCL libccd', steps] / at['STP-BV warm', steps]:.0f}" for steps in STEPS}
    for step, words in STEPS.items():
        bands, plots = [], []
        for i, method in enumerate(palette.METHODS):
            rows = [(r["vertices"], r["ns_p5"], r["ns_p50"], r["ns_p99"]) for r in data["rows"]
                    if r["steps"] == step and r["method"] == method]
            if not rows:
                continue
            name, look = f"${step}{i}", palette.look(method)
            text += block(name, rows)
            if method in ("FCL libccd", "STP-BV warm"):
                bands.append(f"{name} using 1:2:4 with filledcurves fs transparent solid 0.18 noborder fc rgb '{palette.METHODS[method][0]}'")
            plots.append(f"{name} using 1:3 with linespoints {look} ps 0.8 lw 2")
        text += f"set title '{words}' offset 0,-0.6\nplot " + ", ".join(bands + plots) + "\n" + UNLABEL
    fastest = all(row["ns_p50"] >= other["ns_p50"] for row in data["rows"] for other in data["rows"] if other["method"] == "STP-BV warm" and
                  (row["steps"], row["vertices"]) == (other["steps"], other["vertices"]))
    least, most = sorted(times.values(), key=float)
    draw("size", f"STP-BV queries are {'fastest at every size, ' if fastest else ''}{least} to {most} times as fast as FCL at {largest:,} vertices",
         text + "unset multiplot\n", below, height)


def solver_error(height=450):
    data = measured("solver_error")
    rows = [row for row in data["rows"] if row["steps"] == "large"]
    tolerance = lambda row: float(row["setting"].split()[1])
    below = origin(data, [f"Geodesic spheres of {data['about']['vertices']} vertices, large steps, {rows[0]['checked']} answers checked, "
                          "each method against the exact distance of the",
                          "bodies it is asked about. A method without a tolerance is a level line, with marks anywhere on it."])
    text = panels(2, height, below, legend_rows=2) + method_legend(rows, height) + \
        "set logscale xy\nset xrange [1e-1:1e-13] reverse\nset xtics ('1e-2' 1e-2, '1e-4' 1e-4, '1e-6' 1e-6, '1e-8' 1e-8, '1e-10' 1e-10, '1e-12' 1e-12)\n" \
        "set xlabel 'tolerance asked for'\n"
    for panel, column in (("error", "distance_error_max"), ("time", "ns_p50")):
        plots = [] if panel == "time" else [f"x with lines dt 2 lc rgb '{palette.QUIET}'"]
        if panel == "error":
            text += f"set label 4 'error = tolerance' at 1e-10,1e-9 center rotate by -31 font ',12' tc rgb '{palette.NEUTRAL}'\n"
        levels = []  # of the methods without a tolerance
        for i, (method, (colour, mark, _)) in enumerate(palette.METHODS.items()):
            mine = [row for row in rows if row["method"] == method]
            asked = [row for row in mine if row["setting"].startswith("tolerance")]
            if asked:
                points, marked = sorted((tolerance(row), row[column]) for row in asked), f"linespoints pt {mark} ps 0.8"
            else:
                points, marked = [(x, row[column]) for row in mine if default_setting(row) for x in (1e-1, 1e-13)], "lines"
                levels += [points[0][1]] if points else []
                # Where lines coincide, alternating marks show which methods they belong to.
                text += block(f"$marks{panel}{i}", [(10.0 ** -x, points[0][1]) for x in range(2 + 2 * (i % 3), 14, 6)] if points else [])
            if points:
                text += block(f"${panel}{i}", points)
                plots.append(f"${panel}{i} using 1:2 with {marked} lw 2 lc rgb '{colour}'")
                plots += [] if asked else [f"$marks{panel}{i} using 1:2 with points pt {mark} ps 0.8 lc rgb '{colour}'"]
        together = [level for level in levels if panel == "error" and level < 1e-14]
        if len(together) > 1:
            text += f'set label 3 "{len(together)} lines on each other,\\n{max(together):.0e} m" ' \
                    f'at graph 0.03,0.24 left font ",12" tc rgb "{palette.NEUTRAL}"\n'
        text += "set format y '1e%T'\nset yrange [1e-17:1]\nset ytics 1e-16,1e4,1\nunset mytics\n" \
                "set ylabel 'worst error of the distance (m)'\n" if panel == "error" else \
            f"unset format y\nset yrange [60:1e5]\nset ytics {TIME_TICS}\nset ylabel 'median time of a query' offset 1\n"
        text += "plot " + ", ".join(plots) + "\n" + UNLABEL + "unset label 3\nunset label 4\n"
    worst = max(row["distance_error_max"] / tolerance(row) for row in rows if row["method"] == "FCL libccd")
    draw("solver_error", f"FCL libccd's worst error is up to {worst:.0f} times its tolerance; the STP-BV's is rounding" if worst > 1.5 else
         "FCL libccd keeps its tolerance, and takes longer than the STP-BV does to be exact", text + "unset multiplot\n", below, height)


def model_error(height=430):
    data = measured("model_error")
    left = [row["vertices"] for row in data["rows"] if row["sweep"] == "vertices"]
    # colour, name, line width and mark size, labels in the first and the second panel: {setting: offset}
    sweeps = {"r": (palette.SWEEPS[0], "r from 1 to 50 mm", 4, 1.0, {"1 mm": "0.9,0.5", "5 mm": "0.9,0.5", "50 mm": "0.9,0"},
                    {"1 mm": "0.9,0.5", "2 mm": "0.9,0.5", "50 mm": "-0.5,0.9"}),
              "R": (palette.SWEEPS[1], "R from 0.3 to 100 m", 2.5, 0.8, {"0.3 m": "-1.5,0.9", "3 m": "-0.5,0.9", "100 m": "-3,-0.9"},
                    {"0.3 m": "-1.5,0.9", "3 m": "-1,-0.9", "100 m": "0.9,0"}),
              "vertices": (palette.SWEEPS[2], f"vertices left by reduce(): {max(left)} to {min(left)}", 2, 0.6,
                           {"16": "-2.6,-0.6", "8": "-2.2,-0.4", "2": "-2.2,-0.4"}, {})}
    below = origin(data, ["A prism of 64 sides, radius 0.1 m, length 0.4 m, against itself 1 to 50 mm apart. "
                          "Largest eigenvalue of the Hessian over 6000 poses.",
                          "What is not varied: r = 1 cm, R = 10 m, 128 vertices."])
    text = panels(2, height, below, legend_rows=1) + legend([(colour, 7, name) for colour, name, *_ in sweeps.values()], height) + \
        "set logscale xy\nset xrange [2:150]\nset xtics (2, 5, 10, 20, 50, 100)\nset xlabel 'largest over-cover (mm)'\n"
    for panel, column, words, span in ((0, "steepness_shift", "change by a shift (1/m)", "[3:1500]"),
                                       (1, "steepness_turn", "change by a turn (m/rad²)", "[3:200]")):
        plots = []
        for i, (sweep, (colour, _, width, mark, *shown)) in enumerate(sweeps.items()):
            rows = [(1e3 * row["over_cover_most_m"], row[column], row["setting"]) for row in data["rows"] if row["sweep"] == sweep]
            text += block(f"$panel{panel}{i}", rows)
            plots.append(f"$panel{panel}{i} using 1:2 with linespoints pt 7 ps {mark} lw {width} lc rgb '{colour}'")
            for k, row in enumerate(row for row in rows if row[2] in shown[panel]):
                text += block(f"$label{panel}{i}{k}", [row])
                plots.append(f"$label{panel}{i}{k} using 1:2:3 with labels left offset {shown[panel][row[2]]} font ',12' tc rgb '{colour}'")
        text += f"set ylabel 'gradient: {words}'\nset yrange {span}\nset ytics {ticks(10, 100, 1000)}\nplot " + ", ".join(plots) + "\n" + UNLABEL
    draw("model_error", "A larger r calms the gradient; a smaller R calms it when bodies turn; both cost over-cover", text + "unset multiplot\n", below, height)


def jump_test(height=440):
    data = measured("jump_test")
    below = ["A box of 20 cm rocks by 4° past parallel faces over a plate; derivative with the box's twist, 1 for a unit normal. r = 1 cm, R = 10 m.",
             f"{data['command']}. Marks on each other: the polyhedral methods above, both STP-BV methods below."]
    text = single(height, below, legend_rows=2) + "set logscale xy\nset xrange [20:150000]\nset yrange [1e-6:1]\nset format y '1e%T'\n" \
        f"set xtics {ticks(100, 1000, 10000, 100000)}\n" \
        "set xlabel 'steps of the path'\nset ylabel 'largest change in one step'\n"
    # For lines that coincide: wide ones below, narrow ones above, open marks around small ones.
    looks = {"FCL libccd": (6, 1.9), "FCL indep": (4, 1.4), "Bullet GJK": (8, 1.1), "FCL with gap stop": (11, 0.7),
             "STP-BV through FCL": (12, 1.9), "STP-BV warm": (7, 0.7)}
    plots, entries = [], []
    for i, (method, (mark, points)) in enumerate(looks.items()):
        rows = [(row["path_steps"], row["largest_change"]) for row in data["rows"] if row["method"] == method]
        if rows:
            colour, _, words = palette.METHODS[method]
            text += block(f"$jump{i}", rows)
            plots.append(f"$jump{i} using 1:2 with linespoints lc rgb '{colour}' pt {mark} ps {points} lw 2")
            entries.append((colour, mark, words))
    draw("jump_test", "Finer steps make the STP-BVs' gradient change less; the polyhedra's jump stays",
         text + legend(entries, height) + "plot " + ", ".join(plots), below, height)


def collide(height=460):
    """Contacts and yes-or-no answers of this library and FCL, body by body, deeper ones further to the left."""
    data = measured("collide")
    ways = (("ns_fcl", palette.FCL, 7, "fcl::collide"), ("ns_cold", palette.SECOND, 13, "fcl_stpbv::collide, no memory"),
            ("ns_warm", palette.SMOOTH, 7, "the same with a PairCache"))
    nearest = list(dict.fromkeys(row["nearest"] for row in data["rows"]))
    bodies = list(dict.fromkeys(row["body"] for row in data["rows"]))
    depths = ", ".join(f"{100 * d:.0f}" for d in nearest)
    small_print = origin(data, [f"Each body three times: two of it, centres {depths} cm to 42 cm more apart, 1° and 1 mm a step. Medians of nine passes."])
    text = panels(2, height, small_print, legend_rows=1, panel_titles=True) + \
        legend([(colour, mark, name) for _, colour, mark, name in ways], height) + \
        f"set logscale y\nset ytics {TIME_TICS}\nset yrange [30:10100]\nset ylabel 'median time of a call' offset 1\nset xrange [-0.5:{len(bodies) - 0.5}]\n" \
        "set xtics (" + ", ".join(f"'{body}' {i}" for i, body in enumerate(bodies)) + ") rotate by 30 right font ',12'\n"
    for panel, (asked, title) in enumerate((("contact", "contacts: depth, normal, points"), ("yes or no", "yes or no"))):
        plots = []
        for i, (key, colour, mark, _) in enumerate(ways):
            text += block(f"$collide{panel}{i}", [(bodies.index(row["body"]) + 0.25 * (nearest.index(row["nearest"]) - 1), row[key])
                                                  for row in data["rows"] if row["asked"] == asked])
            plots.append(f"$collide{panel}{i} using 1:2 with points pt {mark} ps 0.9 lc rgb '{colour}'")
        text += f"set title '{title}' offset 0,-0.6\nplot " + ", ".join(plots) + "\n" + UNLABEL
    share = lambda asked: [100 * row["ns_warm"] / row["ns_fcl"] for row in data["rows"] if row["asked"] == asked]
    title = "With a PairCache a yes or no takes {:.0f} to {:.0f} % of FCL's time, a contact {:.0f} to {:.0f} %".format(
        *(end for asked in ("yes or no", "contact") for end in (min(share(asked)), max(share(asked)))))
    draw("collide", title, text + "unset multiplot\n", small_print, height)


def robot(height=470):
    """Verdicts and distances of whole configurations, for the pairs of two robots."""
    asked = [(what, steps) for what in ("first hit", "all pairs", "d and J") for steps in ("small", "random")]
    bullet = any(row["way"] == "Bullet GJK, no J" for row in measured("robot")["rows"])  # whether its distances were measured
    ways = (("fcl_stpbv", palette.SMOOTH, 7, "CollisionChecker; d and J: CollisionConstraints"),
            ("2 threads", palette.SECOND, 13, "their batch on 2 threads"),
            ("FCL, broadphase", palette.FCL, 7, "FCL's broadphase; d: fcl::distance, no J"),
            ("Bullet, collision world", palette.OTHER, 9, "Bullet's collision world" + "; d: its GJK, no J" * bullet))
    distances = {"FCL, broadphase": "fcl::distance, no J", "Bullet, collision world": "Bullet GJK, no J"}
    missing = "a batch of all pairs" + ", Bullet's distances" * (not bullet)
    small_print = origin({**measured("robot"), "command": "robot_bench"},
                         [f"First hit and all pairs: collisions only; d and J: distances. Medians. Not made: {missing}."])
    text = panels(2, height, [*small_print, ""], legend_rows=2, panel_titles=True) + \
        legend([(colour, mark, name) for _, colour, mark, name in ways], height, columns=2) + \
        f"set logscale y\nset ytics {TIME_TICS}\nset yrange [300:2e6]\nset ylabel 'time of a configuration' offset 1\nset xrange [-0.5:{len(asked) - 0.5}]\n" \
        "set xtics (" + ", ".join(f"'{what}, {steps}' {i}" for i, (what, steps) in enumerate(asked)) + ") rotate by 30 right font ',12'\n"
    ratios = {"FCL, broadphase": [], "fcl::distance, no J": []}
    for panel, name in enumerate(("robot", "robot_jvrc1")):
        data, plots = measured(name), []
        for what, found in ratios.items():
            found += [row["ratio"] for row in data["rows"] if row["way"] == what]
        for i, (way, colour, mark, _) in enumerate(ways):
            names = {way, distances.get(way, way)}
            text += block(f"$robot{panel}{i}", [(asked.index(key), 1e3 * row["us"]) for row in data["rows"] if row["way"] in names
                                                for key in [(row["what"].removeprefix("batch, "), row["steps"])] if key in asked])
            plots.append(f"$robot{panel}{i} using 1:2 with points pt {mark} ps 1.1 lc rgb '{colour}'")
        about = data["about"]
        text += f"set title '{ROBOTS.get(about['robot'], about['robot'])}: {about['pairs']} pairs' offset 0,-0.6\nplot " + ", ".join(plots) + "\n" + UNLABEL
    draw("robot", "A robot's verdicts are {:.2g} to {:.2g} times as fast as FCL's, its distances {:.2g} to {:.2g} times".format(
        *(end for found in ratios.values() for end in (min(found), max(found)))), text + "unset multiplot\n", small_print, height)


def robot_size(height=490):
    """Configurations a second against the number of pairs and of vertices, after small steps."""
    data = measured("robot_size")
    rows = [row for row in data["rows"] if row["steps"] == "small"]
    ours = ("fcl_stpbv", palette.SMOOTH, 7)
    ways = {"all pairs": (ours, ("FCL, broadphase", palette.FCL, 7), ("Bullet, collision world", palette.OTHER, 9)),
            "d and J": (ours, ("fcl::distance, no J", palette.FCL, 7), ("FCL's GJK, duality-gap stop, no J", palette.METHODS["FCL with gap stop"][0], 11),
                        ("Bullet GJK, no J", palette.OTHER, 9))}
    own, robot = next(row["vertices"] for row in rows if row["varied"] == "pairs"), data["about"]["robot"]
    small_print = origin({**data, "command": "robot_bench --sizes"},
                         [f"{ROBOTS.get(robot, robot)} in small steps. Left: its own bodies, {own:.0f} vertices on average. "
                          "Right: ellipsoids in the boxes around them.",
                          "FCL and Bullet: hulls, distances without J."])
    entries = [(palette.SMOOTH, 7, "this library"), (palette.FCL, 7, "FCL: broadphase; fcl::distance"),
               (palette.METHODS["FCL with gap stop"][0], 11, palette.METHODS["FCL with gap stop"][2]), (palette.OTHER, 9, "Bullet: world; GJK"),
               (palette.NEUTRAL, 7, "line: verdicts, all pairs"), (palette.NEUTRAL, 6, "dashed, open: distances (and J)")]
    text = panels(2, height, small_print, legend_rows=2) + legend(entries, height) + \
        "set logscale xy\nset yrange [500:1e6]\nset ytics ('1k' 1e3, '10k' 1e4, '100k' 1e5, '1M' 1e6)\nset ylabel 'configurations a second' offset 1\n"
    for varied, title in (("pairs", "number of pairs"), ("vertices", "vertices of each body, 130 pairs")):
        at = sorted({row[varied] for row in rows if row["varied"] == varied})
        text += f"set xrange [{0.75 * at[0]:g}:{1.35 * at[-1]:g}]\nset xtics ({', '.join(f'{x:g}' for x in at)})\nset xlabel '{title}'\n"
        plots = []
        for what, all_ways in ways.items():
            for way, colour, mark in all_ways:
                name = f"${varied}{len(plots)}"
                text += block(name, [(row[varied], 1e6 / row["us"]) for row in rows if (row["varied"], row["what"], row["way"]) == (varied, what, way)])
                look = f"pt {mark} dt 1" if what == "all pairs" else f"pt {mark - 1} dt 2"
                plots.append(f"{name} using 1:2 with linespoints {look} ps 1 lw 2 lc rgb '{colour}'")
        text += "plot " + ", ".join(plots) + "\n" + UNLABEL
    found = {what: [row["ratio"] for row in rows if row["what"] == what and row["way"] == all_ways[1][0]] for what, all_ways in ways.items()}
    draw("robot_size", "In small steps verdicts are {:.2g} to {:.2g} times as fast as FCL's, distances {:.2g} to {:.2g} times".format(
        *(end for ratios in found.values() for end in (min(ratios), max(ratios)))), text + "unset multiplot\n", small_print, height)


CHARTS = (speed_accuracy, size, solver_error, model_error, jump_test, collide, robot, robot_size)

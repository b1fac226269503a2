"""Charts of the jump, the hard cases, proofs, radii, parts and controllers."""
import pathlib
import statistics

from . import palette, stability_verdicts
from .plot import UNLABEL, block, captured, draw, legend, measured, origin, panels, single, ticks


def jump(width=350, height=294):
    """The README's picture, as wide as it is shown there: the derivative with the angle, as a box rocks past parallel faces."""
    command, lines = captured("jump_sweep")
    small_print = ["A 20 cm box rocks over a plate; r = 1 cm, R = 10 m on both.", command]
    text = single(height, small_print, legend_rows=1, width=width, left=72) + \
        legend([(palette.FCL, 5, "polyhedra, by FCL"), (palette.SMOOTH, 5, "STP-BVs over them")], height, columns=2, width=width) + \
        block("$sweep", [map(float, line.split(",")) for line in lines[1:]]) + "set xlabel 'angle of the box to the plate (degrees)'\nset xrange [-2:2]\n" \
        "set xtics 1\nset ylabel 'derivative (m/rad)'\nset yrange [-0.12:0.12]\nset ytics 0.1\n" \
        f"plot $sweep using 1:3 with points pt 7 ps 0.3 lc rgb '{palette.FCL}', '' using 1:5 with lines lw 3 lc rgb '{palette.SMOOTH}'"
    draw("jump", "The derivative jumps on polyhedra only", text, small_print, height, width)


def stability():
    """Groups of hard cases from top to bottom, methods from left to right: the worst verdict, and how many failed."""
    data = measured("stability")
    methods = stability_verdicts.methods(data)
    groups = stability_verdicts.groups(data)
    failures = stability_verdicts.failures(data)
    row_height, top, bottom, left = 20, 216, 106, 270
    height = top + bottom + row_height * (len(groups) + 1)
    cells, counts = [], []
    for y, (group, cases) in enumerate(groups.items()):
        for x, method in enumerate(methods):
            cell = stability_verdicts.cell(cases, method.column)
            cells.append((x, y, palette.VERDICTS[cell.shade][1]))
            if cell.failed:
                counts.append((x, y, str(cell.failed), "#ffffff" if cell.shade >= 5 else "#222222"))
    counts += [(x, len(groups), str(failures[method.id]), "#222222") for x, method in enumerate(methods)]
    text = f"set lmargin at screen {left / 800:.4f}\nset rmargin at screen 0.935\nset bmargin at screen {bottom / height:.4f}\n" \
        f"set tmargin at screen {1 - top / height:.4f}\nunset grid\nset border 0\nset key off\n" \
        f"set xrange [-0.5:{len(methods) - 0.5}]\nset yrange [{len(groups) + 0.5}:-0.5]\n" \
        f"set x2range [-0.5:{len(methods) - 0.5}]\nunset xtics\nset style fill solid noborder\n"
    names = ", ".join(f'"{method.title}" {x}' for x, method in enumerate(methods))
    text += f"set x2tics ({names}) rotate by 55 left font ',12' scale 0 offset -0.3,0.2\n"
    text += "set ytics (" + ", ".join(f'"{group} ({len(cases)})" {y}' for y, (group, cases) in enumerate(groups.items())) + \
        f", \"failures of {len(data['rows'])}\" {len(groups)}) font ',12' scale 0\n"
    for i, (words, colour) in enumerate(palette.VERDICTS):
        x, y = 24 + 258 * (i % 3), height - bottom + 26 + 20 * (i // 3)
        text += f"set object {i + 1} rectangle from screen {x / 800:.4f},{1 - (y - 6) / height:.4f} " \
                f"to screen {(x + 16) / 800:.4f},{1 - (y + 6) / height:.4f} " \
            f"fc rgb '{colour}' fs solid noborder\nset label {200 + i} '{words}' at screen {(x + 22) / 800:.4f},{1 - y / height:.4f} left font ',12'\n"
    plots = []
    for i, (_, colour) in enumerate(palette.VERDICTS):
        mine = [(x, y) for x, y, c in cells if c == colour]
        if mine:
            text += block(f"$cells{i}", mine)
            plots.append(f"$cells{i} using 1:2:($1-0.47):($1+0.47):($2-0.45):($2+0.45) with boxxyerror fc rgb '{colour}'")
    for i, colour in enumerate(("#ffffff", "#222222")):
        mine = [(x, y, words) for x, y, words, c in counts if c == colour]
        if mine:
            text += block(f"$counts{i}", mine)
            plots.append(f"$counts{i} using 1:2:3 with labels font ',11' tc rgb '{colour}'")
    ours = failures["stpbv_warm"]
    draw("stability", f"{len(data['rows'])} hard cases: the STP-BV query fails {ours or 'none'}, FCL's default {failures['fcl_libccd_1e-6']}",
         text + "plot " + ", ".join(plots),
         ["A cell: the worst verdict of a group of cases; its number: how many fail (a jump, or worse). The legend goes from best to worst."],
         height)


def proof_boxes(height=420):
    data = measured("proof_boxes")
    about, pairs = data["about"], data["about"]["pairs"]
    small_print = origin(data, [f"{pairs} pairs of {about['robot']} that samples and descents find clear; "
                                f"at most {about['most_boxes_of_levers']:,} boxes by levers "
                                f"and {about['most_boxes_of_planes']:,} by planes."])
    text = single(height, small_print, legend_rows=1) + legend([(palette.SMOOTH, 5, "planes between the links"),
                                                                (palette.SWEEPS[0], 5, "levers of the joints")], height) + \
        "set logscale x\nset xrange [1:50000]\nset yrange [0:100]\n" \
        f"set xtics {ticks(1, 10, 100, 1000, 10000)}\n" \
        "set xlabel 'boxes of joint values'\nset ylabel 'pairs proven (%)'\n"
    plots = []
    for i, (bound, colour) in enumerate((("levers", palette.SWEEPS[0]), ("planes", palette.SMOOTH))):
        boxes = sorted(row["boxes"] for row in data["rows"] if row["bound"] == bound)
        text += block(f"$bound{i}", [(1, 0), *((b, 100 * (k + 1) / pairs) for k, b in enumerate(boxes))])
        plots.append(f"$bound{i} using 1:2 with steps lw 2.5 lc rgb '{colour}'")
    draw("proof_boxes", f"Planes prove {about['proven_by_planes']} of {pairs} pairs in few boxes, levers {about['proven_by_levers']} in many",
         text + "plot " + ", ".join(plots), small_print, height)


def radii(height=420):
    """What r saves in collisions, and what it costs in smoothness of the gradient, for whole robots."""
    data = measured("radii")
    robots = list(dict.fromkeys(row["robot"] for row in data["rows"]))
    top = 1.15 * max(row["margin only"] for row in data["rows"]) + 1
    small_print = ["Pairs in the neutral posture, all but adjacent and rigid ones, R = 10 m. auto: r and R fitted to each link.",
                   "By their margins only: the volumes meet, the convex hulls do not. tools/bench/radii"]
    entries = [*((palette.SWEEPS[i], 7, robot) for i, robot in enumerate(robots)), (palette.NEUTRAL, 7, "one r for all links"), (palette.NEUTRAL, 2, "auto")]
    text = single(height, small_print, legend_rows=1) + legend(entries, height, columns=5) + \
        f"set logscale x\nset xrange [15:700]\nset xtics (25, 50, 100, 200, 500)\nset yrange [-2:{top:g}]\nset ytics 0,5\n" \
        "set xlabel 'the normal turns by at most (rad/m), median of all pairs'\nset ylabel 'pairs that collide only by margins'\n"
    plots = []
    for i, robot in enumerate(robots):
        rows = [(row["lipschitz"], row["margin only"], "r = " + row["r"]) for row in data["rows"] if row["robot"] == robot]
        colour = palette.SWEEPS[i]
        text += block(f"$fixed{i}", [row for row in rows if row[2] != "r = auto"]) + block(f"$auto{i}", [row for row in rows if row[2] == "r = auto"])
        plots += [f"$fixed{i} using 1:2 with linespoints pt 7 ps {1.2 - 0.3 * i:g} lw {4 - 1.2 * i:g} lc rgb '{colour}'",
                  f"$auto{i} using 1:2 with points pt 2 ps 1.6 lw 3 lc rgb '{colour}'"]
    plots.append(f"$fixed0 using 1:({0.93 * top:g}):3 with labels font ',12' tc rgb '{palette.NEUTRAL}'")
    draw("radii", "A smaller r avoids false collisions; the normal may then turn faster", text + "plot " + ", ".join(plots), small_print, height)


def control(height=450):
    """Peak joint acceleration in each scenario: first where a body moves along a face or an edge, then between round bodies."""
    data = [measured("control"), measured("control_more")]
    rows = [row for one in data for row in one["rows"]]
    hull, smooth = "hull + r, r 10 mm", "STP-BV, r 10 mm, R 10 m"
    colours = {hull: palette.HULL_MARGIN, "manifold, r 10 mm": palette.MANIFOLD, smooth: palette.SMOOTH, "STP-BV, r 10 mm, R 1 m": palette.SECOND}
    round_bodies = {"hand": "round hand", "arms": "forearms"}
    flat_bodies = [name for name in dict.fromkeys(row["scenario"] for row in rows) if name not in round_bodies]
    peak = {(row["scenario"], row["method"]): row["peak"] for row in rows}
    places = {name: x for x, name in enumerate(flat_bodies)} | {name: len(flat_bodies) + 0.5 + 1.15 * i for i, name in enumerate(round_bodies)}
    width = 0.2  # of a bar
    at = lambda x, i: x + (i - (len(colours) - 1) / 2) * width
    bars = [[(at(x, i), peak[name, method]) for name, x in places.items() if (name, method) in peak] for i, method in enumerate(colours)]
    missing = [(at(x, i), 0.25) for name, x in places.items() for i, method in enumerate(colours) if (name, method) not in peak]
    small_print = [f"HRP-2-style robot at 1 kHz, medians of {data[0]['about']['runs']} runs a scenario, no noise. "
                   "Manifold: a row for each near pair of features.",
                   *(one["command"] for one in data)]
    text = single(height, small_print, legend_rows=2) + legend([(c, 5, name) for name, c in colours.items()], height, columns=2) + \
        f"set style fill solid noborder\nset boxwidth {width}\nset logscale y\nset yrange [0.2:5000]\nset xrange [-0.6:{max(places.values()) + 0.6:g}]\n" \
        f"set ytics {ticks(1, 10, 100, 1000)}\nset grid noxtics\nset ylabel 'peak joint acceleration (rad/s²)' offset 1.5\n" \
        "set xtics (" + ", ".join(f"'{round_bodies.get(name, name)}' {x:g}" for name, x in places.items()) + ") scale 0\n"
    for i, (words, names) in enumerate((("along a face or an edge", flat_bodies), ("round bodies", list(round_bodies)))):
        text += f"set label {200 + i} '{words}' at {(places[names[0]] + places[names[-1]]) / 2:g}, graph -0.17 center\n"
    plots = []
    for i, colour in enumerate(colours.values()):
        text += block(f"$bars{i}", bars[i])
        plots.append(f"$bars{i} using 1:2 with boxes lc rgb '{colour}'")
    if missing:
        text += block("$missing", missing)
        plots.append(f"$missing using 1:2:('not measured') with labels left rotate by 90 font ',11' tc rgb '{palette.NEUTRAL}'")
    times = [peak[name, hull] / peak[name, smooth] for name in flat_bodies]
    digits = lambda value: f"{float(f'{value:.2g}'):,.0f}"
    draw("control", f"Along a face or an edge hulls give {digits(min(times))} to {digits(max(times))} times the peaks of STP-BVs with R = 10 m",
         text + "plot " + ", ".join(plots), small_print, height)


def clearance(height=480):
    """What r and R cost in clearance and save in accelerations, for a held box against flat things. A line: one R, with r growing along it."""
    data = measured("control_radii")
    scenarios = list(dict.fromkeys(row["scenario"] for row in data["rows"]))
    marks = {"R 1 m": 7, "R 3 m": 5, "R 10 m": 8}
    small_print = ["A held box of 14 x 10 x 6 cm, or two. A line: one R, with r = 1, 5 and 10 mm. Lost: what the hulls keep beyond the 10 mm asked for.",
                   data["command"]]
    text = panels(2, height, small_print, legend_rows=2, panel_titles=True) + \
        legend([*((colour, 7, name) for colour, name in zip(palette.SWEEPS, scenarios)),
                *((palette.NEUTRAL, mark, radius.replace("R", "R =")) for radius, mark in marks.items())], height, columns=4) + \
        "set logscale xy\nset xlabel 'clearance lost (mm)'\nset ylabel 'peak joint acceleration (rad/s²)'\n"
    spans = (f"set xrange [1.5:200]\nset xtics {ticks(2, 5, 10, 20, 50, 100)}\nset yrange [0.7:40]\nset ytics {ticks(1, 2, 5, 10, 20)}\n",
             f"set xrange [1.3:40]\nset xtics {ticks(2, 5, 10, 20)}\nset yrange [1:8]\nset ytics {ticks(1, 2, 3, 5)}\n")
    for panel, (start, title) in enumerate((("STP-BV, ", "both bodies smooth"), ("STP-BV | flat, ", "the obstacle flat, with a margin r"))):
        plots, lines = [], []
        for colour, scenario in zip(palette.SWEEPS, scenarios):
            for radius, mark in marks.items():
                rows = [(1e3 * row["clearance"] - 10, row["peak"], row["method"].split(", ")[1]) for row in data["rows"]
                        if row["scenario"] == scenario and row["method"].startswith(start) and row["method"].endswith(radius)]
                if rows:
                    name = f"$points{panel}_{len(plots)}"
                    text += block(name, rows)
                    plots.append(f"{name} using 1:2 with linespoints pt {mark} ps 0.7 lw 1.2 lc rgb '{colour}'")
                    lines.append(rows)
        highest = max(lines, key=lambda line: line[0][1])  # has room above for the names
        text += block(f"$names{panel}", [(x, y, words.replace("r ", "r = ")) for x, y, words in highest])
        plots.append(f"$names{panel} using 1:2:3 with labels {'center offset 0,0.9' if panel else 'left offset 0.7,0.6'} font ',12' tc rgb '{palette.NEUTRAL}'")
        text += spans[panel] + f"set title '{title}' offset 0,-0.6\nplot " + ", ".join(plots) + "\n" + UNLABEL
    draw("clearance", "A small R calms the joints, and costs clearance only where the obstacle is smooth too", text + "unset multiplot\n", small_print, height)


def advice(height=460):
    """How well advised radii keep their promise, and how much a larger clearance helps the joints."""
    data = measured("control_advice")
    scenarios = dict(zip(dict.fromkeys(row["scenario"] for row in data["rows"]), palette.SWEEPS))
    asked = min(row["at_most"] for row in data["rows"])
    share = lambda row: row["added"] / row["at_most"] if row["as_stated"] else None
    flattest = sorted((row for row in data["rows"] if row["scenario"] == "wall"), key=lambda row: row["R"])[-1:]  # shows why its joints jerk there
    small_print = [f"Radii advised for a clearance and at most {asked:g} m/s² that the shapes may add; what is held moves at 1 kHz, "
                   "the obstacle flat (boxes: both round).",
                   f"Open: so little clearance that the advice says its bound is above {asked:g} m/s². Left: only runs that moved as stated.", data["command"]]
    text = panels(2, height, small_print, legend_rows=1, panel_titles=True) + \
        legend([(colour, 7, scenario) for scenario, colour in scenarios.items()], height, columns=4) + \
        f"set logscale xy\nset xrange [0.35:45]\nset xtics (0.5, 1, 2, 4, 8, 16, 32)\nset xlabel 'clearance given (mm)'\n" \
        f"set label 1 'the bound of the advice' at 45,1.6 right font ',12' tc rgb '{palette.NEUTRAL}'\n"
    for panel, (title, value, axes) in enumerate((
            ("added by the shapes", share, "set yrange [0.001:3]\nset ytics (0.001, 0.01, 0.1, 1)\n"
                                           "set ylabel 'measured, as a share of the bound' offset 0.5\n"),
            ("at the joints", lambda row: row["peak"], "set yrange [1:100]\nset ytics (1, 2, 5, 10, 20, 50, 100)\n"
                                                       "set ylabel 'peak joint acceleration (rad/s²)'\n"))):
        plots = [] if panel else [f"1 with lines lw 1.5 dt 2 lc rgb '{palette.NEUTRAL}'"]
        for i, (scenario, colour) in enumerate(scenarios.items()):
            points = [(1e3 * row["clearance"], value(row), row["at_most"] > asked) for row in data["rows"] if row["scenario"] == scenario]
            text += block(f"$points{panel}{i}", points) + block(f"$open{panel}{i}", [point[:2] for point in points if point[2]])
            plots += [f"$points{panel}{i} using 1:2 with linespoints pt 7 ps 0.9 lw 2 lc rgb '{colour}'",
                      f"$open{panel}{i} using 1:2 with points pt 7 ps 0.5 lc rgb '#ffffff'"]
        text += axes + f"set title '{title}' offset 0,-0.6\nplot " + ", ".join(plots) + "\n" + UNLABEL + "unset label 1\n"
        for row in flattest:
            text += f"set label 2 'R = {row['R']:.0f} m' at {1.15e3 * row['clearance']:g},{1.1 * row['peak']:g} left font ',12' tc rgb '{scenarios['wall']}'\n"
    most = max((row["added"] / row["at_most"] for row in data["rows"] if row["as_stated"]), default=0)
    draw("advice", f"Advised radii add at most {100 * most:.0f} % of their bound; more clearance calms the rail and the boxes",
         text + "unset multiplot\n", small_print, height)


def parts(height=440):
    """How close convex parts are to their meshes, depending on their number and on what they cost a controller."""
    data = measured("parts")
    rows, costs, links = data["rows"], data["about"]["ticks"], data["about"]["concave_links"]
    hulls = {row["mesh"]: row["hull_excess"] for row in rows}
    mean = lambda values: 1e3 * statistics.mean(values)
    curves = {}
    for method in dict.fromkeys(row["method"] for row in rows):
        curves[method] = [(1, mean(hulls.values()), costs[0]["us_a_tick"])]
        for tick in costs:
            if tick["method"] == method:
                of = [row["excess"] for row in rows if (row["method"], row["most"]) == (method, tick["most"])]
                curves[method].append((tick["most"], mean(of), tick["us_a_tick"]))
    program, robot = data["command"].split()[0], pathlib.Path(data["command"].split()[2]).name
    small_print = [f"JVRC-1: the mean of its {links} concave links; excess: the most that a hull is from the mesh's solid. "
                   "A tick: distances and Jacobian of all",
                   f"pairs of all links' parts, {costs[0]['rows']} to {max(tick['rows'] for tick in costs):,} rows, without what leaves far rows out. "
                   "Numbers: parts a link at most.",
                   f"{program} --robot {robot}: {data['machine']}"]
    text = panels(2, height, small_print, legend_rows=1) + \
        legend([palette.PEERS[method] for method in curves], height) + \
        f"set logscale xy\nset yrange [{0.5 * min(y for curve in curves.values() for _, y, _ in curve):g}:{2 * mean(hulls.values()):g}]\n" \
        "set ytics (0.5, 1, 2, 5, 10, 20, 50)\n" \
        "set ylabel 'excess over the mesh (mm), mean'\n"
    for panel, (column, words, axes) in enumerate(((1, "convex parts of a link, at most", "set xrange [0.9:9]\nset xtics (1, 2, 4, 8)\n"),
                                                   (3, "what all pairs cost, µs a tick",
                                                    f"set xrange [50:5000]\nset xtics {ticks(50, 100, 200, 500, 1000, 2000, 5000)} font ',12'\n"))):
        plots = []
        for i, (method, curve) in enumerate(curves.items()):
            colour, mark, _ = palette.PEERS[method]
            if not panel:
                text += block(f"$parts{i}", curve)
            plots.append(f"$parts{i} using {column}:2 with linespoints pt {mark} ps 0.9 lw 2 lc rgb '{colour}'")
            if panel:
                plots.append(f"$parts{i} using 3:2:1 with labels offset {'-1.2,-0.8' if not i else '1.2,0.8'} font ',12' tc rgb '{colour}'")
        text += axes + f"set xlabel '{words}'\nplot " + ", ".join(plots) + "\n" + UNLABEL
    at = {(method, most): y for method, curve in curves.items() for most, y, _ in curve}
    draw("parts", f"Four parts a link: on average {at['ours', 4]:.2g} mm from the mesh, HACD's {at['HACD', 4]:.2g} mm", text + "unset multiplot\n",
         small_print, height)


CHARTS = (jump, stability, proof_boxes, radii, parts, control, clearance, advice)

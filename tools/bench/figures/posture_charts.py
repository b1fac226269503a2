"""Charts of postures: the effort that finding them takes, and the places that have one."""
import statistics
import xml.etree.ElementTree as xml

from . import palette
from .plot import PROJECT, UNLABEL, block, draw, legend, measured, panels, quoted


def posture_profile(height=400):
    data = measured("posture_study")
    colours = {"STP-BV": palette.SMOOTH, "hulls, rounded, exact": palette.HULL_MARGIN, "hulls, rounded, FCL": palette.ROUNDED_FCL,
               "hulls, plain FCL": palette.FCL}
    dashed = "hulls, rounded, FCL"  # which lies on the exact ones
    tasks = {}
    for row in data["rows"]:
        if row["feasible"]:
            tasks.setdefault(row["seed"], {})[row["distances"]] = row
    small_print = [f"{len(tasks)} feasible ones of {data['about']['tasks']} random tasks, solved within {data['about']['starts']} starts, "
                   "free of collisions of the meshes.",
                   f"Across: effort as a multiple of the best method's on the same task. Dashed: {dashed}.", f"{data['command']}: {data['machine']}"]
    text = panels(3, height, small_print, legend_rows=1, panel_titles=True, between=52, left=76) + \
        legend([(colour, 5, name) for name, colour in colours.items()], height, columns=4) + \
        "set logscale x\nset xlabel 'times the best'\nset ylabel 'tasks solved (%)'\n"
    spans = {"work": "set xrange [1:5]\nset xtics (1, 1.5, 2, 3, 5)\nset yrange [40:100]\n",
             "time": "set xrange [1:10]\nset xtics (1, 2, 5, 10)\nset yrange [0:100]\n"}
    for panel, (words, column) in enumerate((("iterations", "iterations"), ("distances computed", "calls"), ("time", "seconds"))):
        plots = []
        for i, (name, colour) in enumerate(colours.items()):
            ratios = []
            for results in tasks.values():
                good = {k: r[column] for k, r in results.items() if r["solved"] and r["clear"]}
                if name in good:
                    ratios.append(good[name] / min(good.values()))
            curve = [(1, 0), *((ratio, 100 * (k + 1) / len(tasks)) for k, ratio in enumerate(sorted(ratios))), (1000, 100 * len(ratios) / len(tasks))]
            text += block(f"$profile{panel}{i}", curve)
            plots.append(f"$profile{panel}{i} using 1:2 with steps lw 2 {'dt (6,4)' if name == dashed else ''} lc rgb '{colour}'")
        text += spans.get(words, spans["work"]) + f"set title '{words}' offset 0,-0.6\nplot " + ", ".join(plots) + "\n" + UNLABEL + "unset ylabel\n"
    good = [{name: row for name, row in results.items() if row["solved"] and row["clear"]} for results in tasks.values()]
    found = [sum(name in results for results in good) for name in colours]
    share = statistics.median(results["STP-BV"]["seconds"] / results["hulls, plain FCL"]["seconds"] for results in good if len(results) == len(colours))
    draw("posture_profile", f"Postures: each way finds {min(found)} to {max(found)} of {len(tasks)}; STP-BVs take {100 * share:.0f} % of plain FCL's time",
         text + "unset multiplot\n", small_print, height)


def success_map(name, scene, where, across, upward, panel, height, tics, around=()):
    """Places of a grid with a posture: panels by the first axis, the second upwards, the last across. `across` and `upward`: their words.
    `around`: things drawn over them as (left, low, right, high), with a cross at 0, 0."""
    data = measured("posture_grid")
    first, second, last = (axis["count"] for axis in data["about"]["axes"][scene])
    axes, rows = data["about"]["axes"][scene], data["about"]["maps"][scene]
    at = lambda axis, i: axis["from"] + (axis["to"] - axis["from"]) * i / max(1, axis["count"] - 1)
    step = lambda axis: (axis["to"] - axis["from"]) / max(1, axis["count"] - 1)
    totals = {row["way"]: row for row in data["rows"] if row["scene"] == scene}
    kinds = {"b": (palette.SWEEPS[1], "found both ways"), "n": (palette.SWEEPS[0], "only from the neighbours"), "i": (palette.SWEEPS[2], "only independently"),
             ".": (palette.GRID, "not found")}
    warm, cold = totals["neighbours"], totals["independent"]
    kinds = {mark: look for mark, look in kinds.items() if any(mark in row for row in rows)}
    title = f"{scene.capitalize()}: starts from the neighbours' postures reach {warm['found']:,} of {warm['places']:,} places, independent ones {cold['found']}"
    small_print = [f"{where} {data['about']['starts']} starts of its own for each place.",
                   f"{data['command']}: {data['machine']}"]
    text = panels(first, height, small_print, legend_rows=1, panel_titles=True, between=18) + legend([(c, 5, words) for c, words in kinds.values()], height) + \
        f"unset grid\nset style fill solid noborder\nset xtics {tics} font ',12'\nset xlabel {quoted(across)}\nset ylabel {quoted(upward)}\n" \
        f"set xrange [{at(axes[2], -0.7):g}:{at(axes[2], last - 0.3):g}]\nset yrange [{at(axes[1], -0.7):g}:{at(axes[1], second - 0.3):g}]\n"
    for i, (left, low, right, high) in enumerate(around):
        text += f"set object {i + 1} rectangle from {left:.3f},{low:.3f} to {right:.3f},{high:.3f} front fs empty border lc rgb '#222222' lw 1.5\n"
    for i in range(first):
        plots = []
        for k, (mark, (colour, _)) in enumerate(kinds.items()):
            cells = [(at(axes[2], x), at(axes[1], y)) for y in range(second) for x, found in enumerate(rows[i * second + y]) if found == mark]
            if cells:
                text += block(f"$cells{i}_{k}", cells)
                x, y = 0.5 * step(axes[2]), 0.5 * step(axes[1])
                plots.append(f"$cells{i}_{k} using 1:2:($1-{x:g}):($1+{x:g}):($2-{y:g}):($2+{y:g}) with boxxyerror fc rgb '{colour}'")
        if around:
            text += block(f"$origin{i}", [(0, 0)])
            plots.append(f"$origin{i} with points pt 1 ps 0.8 lw 2 lc rgb '#222222'")
        text += f"set title {quoted(panel(at(axes[0], i)))} offset 0,-0.6\nplot " + ", ".join(plots or ["NaN"]) + "\n"
        text += UNLABEL + "unset ylabel\nset format y ''\n"
    draw(name, title, text + "unset multiplot\n", small_print, height, crisp=True)


def boxes_beside(urdf, place):
    """The boxes of a scene that lie in the place's plane across y, as (left, low, right, high) from the place (m)."""
    scene, found = xml.parse(urdf).getroot(), []
    for joint in scene.iter("joint"):
        box = scene.find(f"link[@name='{joint.find('child').get('link')}']/collision/geometry/box")
        if box is not None:
            x, y, z = (float(at) - mine for at, mine in zip(joint.find("origin").get("xyz").split(), place))
            length, width, height = (float(size) / 2 for size in box.get("size").split())
            found += [(x - length, z - height, x + length, z + height)] if abs(y) < width else []
    return found


def posture_grid_fridge(height=400):
    can = (0.52, 0.17, 0.96)  # the hand's place around it in data/fridge/reach.json
    success_map("posture_grid_fridge", "fridge",
                "The left hand, by where the feet stand. Cross at 0, 0: around the can where it stands. Outlines: the fridge.", "forward (m)", "upward (m)",
                lambda value: f"feet {-100 * value:.0f} cm back" if value else "feet in front", height, 0.2,
                boxes_beside(PROJECT / "data/fridge/fridge.urdf", can))


def posture_grid_ladder(height=340):
    success_map("posture_grid_ladder", "ladder",
                "The hands, by the left foot's rung. 0 to the left: where data/ladder/climb.json puts them.", "hands to the left (m)", "rungs above the third",
                lambda value: f"left foot {value:.0f} rung{'s' * (value > 1)} up" if value else "feet on one rung", height, 0.2)


CHARTS = (posture_profile, posture_grid_fridge, posture_grid_ladder)

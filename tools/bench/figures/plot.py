"""A chart by gnuplot, 800 px wide where nothing else is said: what all charts share, from the fonts to the line that says how it was measured."""
import html
import json
import pathlib
import shutil
import subprocess
import sys

from . import palette

PROJECT = pathlib.Path(__file__).resolve().parents[3]
MEASURED, IMAGES = PROJECT / "docs/measured", PROJECT / "docs/images"
WIDTH = 800
TIME_TICS = "('10 ns' 1e1, '100 ns' 1e2, '1 µs' 1e3, '10 µs' 1e4, '100 µs' 1e5, '1 ms' 1e6)"


def measured(name):
    """A measurement: command, machine, spread, about, rows. $ROBOTS stands for the folder of robots that are not part of the project (CONTRIBUTING.md)."""
    data = json.loads((MEASURED / f"{name}.json").read_text())
    return {**data, "command": data["command"].replace("../shared/robots", "$ROBOTS")}


def is_text(name):
    """Whether a measurement is a program's printed output."""
    return (MEASURED / f"{name}.txt").exists()


def captured(name):
    """A program's printed output: (command, lines)."""
    first, *lines = (MEASURED / f"{name}.txt").read_text().splitlines()
    return first.removeprefix("$ "), lines


def origin(measurement, words):
    """The lines under a chart: what was measured, and on which machine and how reproducibly."""
    machine = measurement["machine"]
    if measurement["spread"]:
        machine += f"; repeated blocks agree within {100 * measurement['spread']:.0f} %"
    return [*words, f"{measurement['command']}: {machine}"]


def quoted(words):
    return "'" + words.replace("'", "''") + "'"


def ticks(*values):
    """gnuplot's list of ticks at these values, with commas between thousands."""
    return "(" + ", ".join(f"'{value:,}' {value}" for value in values) + ")"


def block(name, rows):
    """A data block that later commands call `name`. None is a gap."""
    cell = lambda value: '"' + value + '"' if isinstance(value, str) else "NaN" if value is None else f"{value:g}"
    return f"{name} << EOD\n" + "\n".join(" ".join(map(cell, row)) for row in rows) + "\nEOD\n"


def draw(name, title, commands, below=(), height=420, width=WIDTH, crisp=False):
    """Writes NAME.svg completely or not at all. `below`: lines of small print. `crisp`: no seams between cells that touch."""
    if not shutil.which("gnuplot"):
        sys.exit("the charts need gnuplot (Debian package gnuplot-nox)")
    IMAGES.mkdir(parents=True, exist_ok=True)
    part = IMAGES / f"{name}.part.svg"
    script = [f"set terminal svg size {width},{height} font 'Helvetica,14' background '#ffffff'",
              "set encoding utf8", f"set output {quoted(str(part))}", "set termoption noenhanced",
              f"set grid lc rgb '{palette.GRID}'", f"set border 3 lc rgb '{palette.QUIET}'", f"set tics nomirror textcolor rgb '{palette.TICKS}'",
              f"set label 101 {quoted(title)} at screen 0.012,{1 - 20 / height:.4f} left font ',16'"]
    for i, line in enumerate(reversed(below)):
        script.append(f"set label {102 + i} {quoted(line)} at screen 0.012,{(10 + 16 * i) / height:.4f} left font ',11' "
                      f"tc rgb '{palette.NEUTRAL}'")
    done = subprocess.run(["gnuplot"], input="\n".join(script) + "\n" + commands + "\n", text=True, capture_output=True)
    if done.returncode or not part.exists() or "line" in done.stderr:
        part.unlink(missing_ok=True)
        sys.exit(f"gnuplot could not draw {name}:\n{done.stderr[-800:]}")
    text = part.read_text().replace("<title>Gnuplot</title>", f"<title>{html.escape(title)}</title>", 1)
    part.write_text(text.replace("<svg", '<svg shape-rendering="crispEdges"', 1) if crisp else text)
    part.rename(IMAGES / f"{name}.svg")


def margins(height, small_print, legend_rows=0, panel_titles=False, left=92, width=WIDTH):
    """The edges (left, right, bottom, top) of the plotting area, as shares of the picture."""
    top = 44 + 22 * legend_rows + (20 if panel_titles else 0)
    return left / width, 1 - 30 / width, (66 + 16 * len(small_print)) / height, 1 - top / height


def single(*arguments, **options):
    left, right, bottom, top = margins(*arguments, **options)
    return "".join(f"set {side}margin at screen {at:.4f}\n" for side, at in zip("lrbt", (left, right, bottom, top)))


def panels(count, *arguments, between=92, **options):
    """Starts `count` panels beside each other."""
    edges = ",".join(f"{at:.4f}" for at in margins(*arguments, **options))
    return f"set multiplot layout 1,{count} margins {edges} spacing {between / WIDTH:.4f}\n"


def legend(entries, height, columns=3, width=WIDTH):
    """Rows of marks and words under the title. An entry: (colour, point type, words)."""
    text = "set key off\n"
    for i, (colour, mark, words) in enumerate(entries):
        x, y = 24 + (i % columns) * (width - 30) / columns, 48 + 22 * (i // columns)
        level = y + {9: 1, 11: -1}.get(mark, 0)  # triangles are not centred on their position
        at = f"at screen {x / width:.4f},{1 - level / height:.4f}"
        text += f"set label {120 + 2 * i} '' {at} point pt {mark} ps 1 lc rgb '{colour}'\n"
        text += f"set label {121 + 2 * i} {quoted(words)} at screen {(x + 14) / width:.4f},{1 - y / height:.4f} left font ',13'\n"
    return text


# To be added after the first of several panels, because otherwise each panel would print the title, the
# legend and the small print again.
UNLABEL = "".join(f"unset label {i}\n" for i in range(101, 140))

"""The page that controller.py writes: curves over time, as chart.h draws them, in the style of page_head.h."""
import pathlib
import re

import numpy as np


def chart(title, seconds, low, high, curves, level=None):
    """Curves over `seconds` from 10^low to 10^high. Each: (name, colour, values). `level`: (name, value) of a dashed line."""
    x = lambda time: 56 + 734 * time / seconds
    y = lambda value: 234 - 204 * (np.clip(np.log10(np.maximum(value, 10.0**low)), low, high) - low) / (high - low)
    svg = [f"<h2>{title}</h2>", "<div class='chart'><svg viewBox='0 0 800 276'>", "<text x='423' y='272' text-anchor='middle'>time (s)</text>"]
    for value in 10.0 ** np.arange(low, high + 1):
        svg.append(f"<path d='M56 {y(value):g}H790' stroke='currentColor' opacity='.15'/><text x='50' y='{y(value) + 5:g}' text-anchor='end'>{value:g}</text>")
    for time in range(seconds + 1):
        svg.append(f"<path d='M{x(time):g} 30V234' stroke='currentColor' opacity='.15'/><text x='{x(time):g}' y='252' text-anchor='middle'>{time}</text>")
    if level:
        svg.append(f"<path d='M56 {y(level[1]):g}H790' stroke='currentColor' stroke-dasharray='6 4'/><text x='62' y='{y(level[1]) - 6:g}'>{level[0]}</text>")
    for i, (name, colour, values) in enumerate(curves):
        points = " ".join(f"{x(seconds * k / len(values)):.1f},{at:.1f}" for k, at in enumerate(y(values)))
        svg.append(f"<path d='M{56 + 240 * i} 12h24' stroke='{colour}' stroke-width='3'/><text x='{86 + 240 * i}' y='17'>{name}</text>"
                   f"<polyline fill='none' stroke='{colour}' stroke-width='1.5' points='{points}'/>")
    return "\n".join(svg) + "</svg></div>\n"


def page(found, text, charts):
    """`found` is the title. The style is that of the C++ examples' pages."""
    style = re.search(r'R"\((.*?)\)"', pathlib.Path(__file__).with_name("page_head.h").read_text(), re.DOTALL)[1]
    return (f'<!DOCTYPE html>\n<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{found}</title>\n'
            f"<style>{style}</style>\n<h1>{found}</h1>\n<p>{text}</p>\n" + "".join(charts) + "</html>\n")

#!/usr/bin/env python3
"""Writes the ladder and the task of standing on it (Python standard library only).

    python3 make_ladder.py            # writes ladder.urdf and the task files
    python3 make_ladder.py --check    # exit status 1 if a file differs from what would be written

World frame: x forward, y left, z up. The right foot stands on rung 1, over the origin. The tables are in millimetres and degrees, what
is written is in metres and radians.
"""
import json
import math
import os
import sys

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(FOLDER))
import scene_files  # noqa: E402

RUNGS, SPACING, SLOPE = 10, 250, 70  # along the ladder, which leans forward
HALF_WIDTH = 600                    # from the middle to a rail
RUNG, RAIL = 15, (60, 40)           # radius; depth and width
BALL = 40                           # the rung is this far ahead of the ankle, under the ball of the foot
SOLE = -105                         # below the ankle
FEET, HANDS = 95, 150               # to either side of the middle
HIGH = 3                            # the lowest rung for the hands

WOOD, METAL = "0.72 0.55 0.35 1", "0.75 0.77 0.8 1"
UP = (math.cos(math.radians(SLOPE)), 0, math.sin(math.radians(SLOPE)))  # along the ladder


def rung(number, y=0):
    """The middle of a rung, or a place beside it."""
    along = (number - 1) * SPACING
    return BALL + along * UP[0], y, SPACING + along * UP[2]


def parts():
    """As scene_files.urdf() takes them."""
    for number in range(1, RUNGS + 1):
        yield (f"rung_{number}", f'<cylinder radius="{RUNG / 1000}" length="{2 * HALF_WIDTH / 1000}"/>', rung(number),
               (math.pi / 2, 0, 0), METAL)
    for side, sign in (("left", 1), ("right", -1)):
        yield (f"{side}_rail", f'<box size="{scene_files.metres((*RAIL, (RUNGS + 1) * SPACING))}"/>',
               rung((RUNGS + 1) / 2, sign * (HALF_WIDTH + RAIL[1] / 2)), (0, math.radians(90 - SLOPE), 0), WOOD)


def metres(point):
    return [round(value / 1000, 9) for value in point]


def climb():
    """Feet on rung 1, hands on rung HIGH. On a ladder the hands carry too, so that no static stability is asked for."""
    def foot(name, link, y):
        x, y, z = rung(1, y)
        return {"name": name, "link": link, "frame": {"position": metres((BALL, 0, SOLE))}, "target": {"position": metres((x, y, z + RUNG))}}

    def hand(name, link, sign):
        # With the arm stretched forward the hand's x axis points up; here it lies along the rung, the back of the hand is above.
        return {"name": name, "link": link, "frame": {"position": metres((0, -30 * sign, -135)), "rpy": [0, math.pi / 2, 0]},
                "target": {"position": metres(rung(HIGH, sign * HANDS)), "rpy": [sign * math.pi / 2, 0, 0]}, "free": ["rz"]}
    rungs = [f"rung_{number}" for number in range(1, RUNGS + 1)]
    holding = [f"{side}{link}" for side in "RL" for link in ("LEG_LINK5", "ARM_LINK5", "ARM_LINK6")]
    return {"base": "floating", "start": {"state": "reach", "base": {"position": metres((0, 0, 705 + SPACING + RUNG))}},
            "placements": [foot("right foot", "RLEG_LINK5", -FEET), foot("left foot", "LLEG_LINK5", FEET),
                           hand("right hand", "RARM_LINK5", -1), hand("left hand", "LARM_LINK5", 1)],
            "collisions": {"ignore": [{"links": holding, "obstacles": rungs}]}}


def climb_grid():
    """525 places: how many rungs the left foot is higher, which rung the hands hold, how far aside."""
    step = metres([SPACING * part for part in UP])
    hands = ("right hand", "left hand")
    return {"axes": [{"name": "left foot up, rungs", "move": {"left foot": step}, "from": 0, "to": 2, "count": 3},
                     {"name": "hands up, rungs", "move": dict.fromkeys(hands, step), "from": 0, "to": 6, "count": 7},
                     {"name": "hands to the left", "move": dict.fromkeys(hands, [0, 1, 0]), "from": -0.48, "to": 0.48, "count": 25}]}


def files():
    yield "ladder.urdf", scene_files.urdf("ladder", "make_ladder.py", parts())
    for name, content in (("climb", climb()), ("climb_grid", climb_grid())):
        yield f"{name}.json", json.dumps(content, indent=1) + "\n"


if __name__ == "__main__":
    sys.exit(scene_files.main(__doc__, FOLDER, files()))

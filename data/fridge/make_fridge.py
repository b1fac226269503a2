#!/usr/bin/env python3
"""Writes the fridge, its contents and the task of taking a can from it (Python standard library only).

    python3 make_fridge.py            # writes fridge.urdf, meshes/carafe.obj and the task files
    python3 make_fridge.py --check    # exit status 1 if a file differs from what would be written

World frame: the robot's feet stand around the origin, x forward into the fridge, y left, z up. The tables are in
millimetres and degrees, what is written is in metres and radians.
"""

import json
import math
import os
import sys

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(FOLDER))
import scene_files  # noqa: E402
from scene_files import metres  # noqa: E402

FRONT, BACK = 212, 800          # of the shelves' compartment
LEFT, RIGHT = 215, -330         # inner sides of its panels
FLOOR, TOP = 740, 1520
PANEL, DOOR = 40, 60            # thicknesses
OPEN = 92                       # the upper door's angle; the lower one is shut
CAN = (520, 170)                # where the can stands: x, y
SHELF = 860                     # the shelf that it stands on, upper side
CAN_RADIUS, CAN_HEIGHT, GRASP = 26, 130, 100  # the hand closes at this height above the shelf
CARAFE = (425, 35)
CLEMENTINES = ((435, 138), (446, 198))  # in front of the can
CLEMENTINE = 25                 # radius

WHITE, GLASS, ORANGE, RED = "0.93 0.94 0.95 1", "0.6 0.75 0.8 1", "0.95 0.55 0.1 1", "0.8 0.1 0.15 1"


def box(low, high):
    """(geometry, centre) of a box with these corners."""
    size = [b - a for a, b in zip(low, high)]
    return f'<box size="{metres(size)}"/>', [(a + b) / 2 for a, b in zip(low, high)]


def parts():
    """As scene_files.urdf() takes them."""
    outer_left, outer_right = LEFT + PANEL, RIGHT - PANEL
    items = []

    def add(name, shape, colour=WHITE, yaw=0):
        items.append((name, shape[0], shape[1], (0, 0, math.radians(yaw)), colour))

    add("left_panel", box((FRONT, LEFT, FLOOR), (BACK, outer_left, TOP)))
    add("right_panel", box((FRONT, outer_right, FLOOR), (BACK, RIGHT, TOP)))
    add("back_panel", box((BACK, outer_right, FLOOR), (BACK + PANEL, outer_left, TOP)))
    add("top_panel", box((FRONT, outer_right, TOP), (BACK + PANEL, outer_left, TOP + PANEL)))
    add("lower_body", box((FRONT, outer_right, 40), (BACK + PANEL, outer_left, FLOOR)))
    add("lower_door", box((FRONT - DOOR, outer_right, 60), (FRONT, outer_left, FLOOR - 10)))
    # Shut, the upper door reaches from its hinge at the left panel's outer front edge along -y, at x < FRONT.
    width, turn = outer_left - outer_right, math.radians(OPEN)
    along = (-math.sin(turn), -math.cos(turn))  # from the hinge along the open door
    outward = (-math.cos(turn), math.sin(turn))  # at 0 degrees -x: away from the compartment
    centre = [FRONT + along[0] * width / 2 + outward[0] * DOOR / 2,
              outer_left + along[1] * width / 2 + outward[1] * DOOR / 2, (FLOOR + TOP + PANEL) / 2]
    add("upper_door", (f'<box size="{metres((width, DOOR, TOP + PANEL - FLOOR))}"/>', centre),
        yaw=math.degrees(math.atan2(along[1], along[0])))
    add("shelf_low", box((FRONT + 20, RIGHT, SHELF - 12), (BACK, LEFT, SHELF)), GLASS)
    add("shelf_high", box((FRONT + 20, RIGHT, SHELF + 320), (BACK, LEFT, SHELF + 332)), GLASS)
    add("can", (f'<cylinder radius="{CAN_RADIUS / 1000}" length="{CAN_HEIGHT / 1000}"/>',
                (*CAN, SHELF + CAN_HEIGHT / 2)), RED)
    add("carafe", ('<mesh filename="package://fridge/meshes/carafe.obj"/>', (*CARAFE, SHELF)), GLASS)
    for i, (x, y) in enumerate(CLEMENTINES, 1):
        add(f"clementine_{i}", (f'<sphere radius="{CLEMENTINE / 1000}"/>', (x, y, SHELF + CLEMENTINE)), ORANGE)
    return items


def carafe(sides=24):
    """OBJ of a carafe standing on z = 0: a profile of (radius, height) in mm, turned around z."""
    profile = [(46, 0), (52, 8), (55, 60), (50, 120), (36, 165), (30, 200), (34, 230)]
    lines = ["# Written by make_fridge.py. Do not edit."]
    for radius, height in profile:
        for i in range(sides):
            angle = 2 * math.pi * i / sides
            lines.append(f"v {radius * math.cos(angle) / 1000:.6f} {radius * math.sin(angle) / 1000:.6f} {height / 1000:.6f}")
    bottom, top = sides * len(profile) + 1, sides * len(profile) + 2
    lines += ["v 0 0 0", f"v 0 0 {profile[-1][1] / 1000:.6f}"]
    for i in range(sides):
        j = (i + 1) % sides
        for ring in range(len(profile) - 1):
            a, b = ring * sides + 1, (ring + 1) * sides + 1
            lines += [f"f {a + i} {a + j} {b + j}", f"f {a + i} {b + j} {b + i}"]
        last = (len(profile) - 1) * sides + 1
        lines += [f"f {bottom} {1 + j} {1 + i}", f"f {top} {last + i} {last + j}"]
    return "\n".join(lines) + "\n"


def pick_can():
    """The task: both feet on the floor, the left hand around the can, 33 pairs with the fridge as in the paper."""
    sole = [[0.14, 0.07, -0.105], [0.14, -0.064, -0.105], [-0.1, 0.07, -0.105], [-0.1, -0.064, -0.105]]
    right_sole = [[x, -y, z] for x, y, z in sole]
    arm = ["LARM_LINK3", "LARM_LINK4", "LARM_LINK5"]
    fingers = "LARM_LINK6"
    return {
        "base": "floating",
        "start": {"state": "zero", "base": {"position": [0, 0, 0.705]}},
        "placements": [
            {"name": "right foot", "link": "RLEG_LINK5", "frame": {"position": [0, 0, -0.105]},
             "target": {"position": [0, -0.095, 0]}},
            {"name": "left foot", "link": "LLEG_LINK5", "frame": {"position": [0, 0, -0.105]},
             "target": {"position": [0, 0.095, 0]}},
            # With the arm stretched forward, the hand's x axis points up; the fingers close about it.
            {"name": "left hand", "link": "LARM_LINK5", "frame": {"position": [0, -0.03, -0.135], "rpy": [0, 1.5707963267948966, 0]},
             "target": {"position": [CAN[0] / 1000, CAN[1] / 1000, (SHELF + GRASP) / 1000]}, "free": ["rz"]},
        ],
        "stability": {"contacts": [{"link": "RLEG_LINK5", "points": right_sole}, {"link": "LLEG_LINK5", "points": sole}],
                      "margin": 0.02},
        "collisions": {"pairs": [
            {"links": ["BODY", "CHEST_LINK1", "HEAD_LINK1", "LARM_LINK1", "LARM_LINK2", *arm], "obstacles": ["upper_door"]},
            {"links": ["BODY", "RLEG_LINK2", "RLEG_LINK3", "LLEG_LINK2", "LLEG_LINK3"], "obstacles": ["lower_door"]},
            {"links": ["LARM_LINK2", *arm], "obstacles": ["left_panel"]},
            {"links": [*arm, fingers], "obstacles": ["shelf_low", "carafe"]},
            {"links": ["HEAD_LINK1", *arm], "obstacles": ["shelf_high"]},
            {"links": ["LARM_LINK5", fingers], "obstacles": ["clementine_1", "clementine_2"]},
        ]},
    }


def reach():
    """The task at any place: every pair is checked, but for the can, which the hand holds wherever it is."""
    return {**pick_can(), "collisions": {"ignore": [{"obstacles": ["can"]}]}}


def reach_grid():
    """2000 places around the fridge: how far the feet stand from it, how high and how far forward the hand is."""
    def along(name, move, first, last, count, **more):
        return {"name": name, "move": move, **more, "from": first / 1000, "to": last / 1000, "count": count}
    x, z = CAN[0], SHELF + GRASP  # where pick_can() has the hand
    forward, up = [1, 0, 0], [0, 0, 1]
    return {"axes": [along("feet forward", {"right foot": forward, "left foot": forward}, -400, 0, 5, base=forward),
                     along("hand up", {"left hand": up}, 400 - z, 1730 - z, 20),
                     along("hand forward", {"left hand": forward}, 50 - x, 772 - x, 20)]}


def files():
    yield "fridge.urdf", scene_files.urdf("fridge", "make_fridge.py", parts())
    yield "meshes/carafe.obj", carafe()
    yield "package.xml", ('<?xml version="1.0"?>\n<package format="3">\n  <name>fridge</name>\n  <version>0.1.0</version>\n'
                          "  <description>A fridge to take a can from</description>\n"
                          '  <maintainer email="developers@fcl-stpbv.invalid">fcl_stpbv developers</maintainer>\n'
                          '  <license>BSD-2-Clause</license>\n</package>\n')
    for name, content in (("pick_can", pick_can()), ("reach", reach()), ("reach_grid", reach_grid())):
        yield f"{name}.json", json.dumps(content, indent=1) + "\n"


if __name__ == "__main__":
    sys.exit(scene_files.main(__doc__, FOLDER, files()))

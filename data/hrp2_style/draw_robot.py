#!/usr/bin/env python3
"""Draws the robot as flat-shaded views into hrp2_style.png (Python standard library only).

From left to right: zero posture from the front and from the side, half-sitting and reach from an oblique
direction. An orthographic z-buffer at twice the picture's resolution, then averaged 2 x 2.
"""

import argparse
import math
import os
import struct
import zlib

import robot_table
from links import link_parts
from shapes import merged

PIXELS_PER_MM = 0.4
VIEW_WIDTH, VIEW_HEIGHT = 380, 680  # pixels of each view
OVERSAMPLING = 2
BACKGROUND = (255, 255, 255)
LIGHT = (0.35, -0.45, 0.82)  # in view coordinates: toward the viewer, to the right, up
VIEWS = [("zero", 0.0, 0.0), ("zero", 90.0, 0.0), ("half_sitting", 38.0, 12.0), ("reach", 52.0, 12.0)]


def colour(link):
    if link.startswith("HEAD_LINK1") or link.endswith(("LINK5", "LINK6")):
        return (92, 104, 120)
    if link[1:4] in ("LEG", "ARM") and link[-1] in "014":
        return (120, 126, 134)
    return (216, 220, 226) if link[:5] != "CHEST" and link != "BODY" else (170, 190, 214)


def multiply(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def apply(matrix, p):
    return tuple(sum(matrix[i][k] * p[k] for k in range(3)) for i in range(3))


def rotation(axis, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
            "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis]


def forward_kinematics(angles):
    """Pose (rotation, position in mm, base at the origin) of every link; `angles` in degrees by joint."""
    poses = {robot_table.BASE: ([[1, 0, 0], [0, 1, 0], [0, 0, 1]], (0.0, 0.0, 0.0))}
    for joint in robot_table.joints():
        turn, at = poses[joint.parent]
        shift = apply(turn, joint.origin)
        poses[joint.child] = (multiply(turn, rotation(joint.axis, angles[joint.name])),
                              tuple(a + s for a, s in zip(at, shift)))
    return poses


def view_triangles(posture, azimuth, elevation):
    """(corners in view coordinates: depth toward the viewer, right, up; colour) of every triangle. Azimuth 0
    looks at the robot's front, 90 at its left side."""
    camera = multiply(rotation("y", elevation), rotation("z", -azimuth))
    poses = forward_kinematics(robot_table.posture(posture))
    lowest = 0.0
    result = []
    for link, (turn, at) in poses.items():
        mesh = merged(link_parts(link))
        world = [tuple(a + b for a, b in zip(apply(turn, p), at)) for p in mesh.points]
        lowest = min(lowest, min(p[2] for p in world))
        seen = [apply(camera, p) for p in world]
        result += [([seen[i] for i in t], colour(link)) for t in mesh.triangles]
    across = [p[1] for corners, _ in result for p in corners]
    shift = apply(camera, (0.0, 0.0, -lowest))
    shift = (shift[0], -0.5 * (min(across) + max(across)), shift[2])
    return [([tuple(a + b for a, b in zip(p, shift)) for p in corners], rgb) for corners, rgb in result]


def shaded(corners, rgb):
    """Brightness from dark (facing away from the light) to bright; None for a triangle the viewer cannot see."""
    u = [corners[1][i] - corners[0][i] for i in range(3)]
    v = [corners[2][i] - corners[0][i] for i in range(3)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.sqrt(sum(x * x for x in n))
    if length == 0.0 or n[0] <= 0.0:
        return None
    bright = 0.68 + 0.34 * sum(a * b for a, b in zip(n, LIGHT)) / length
    return tuple(min(255, int(c * bright)) for c in rgb)


def draw_view(triangles):
    """Rows of (r, g, b) at the oversampled resolution."""
    scale = PIXELS_PER_MM * OVERSAMPLING
    width, height = VIEW_WIDTH * OVERSAMPLING, VIEW_HEIGHT * OVERSAMPLING
    image = [[BACKGROUND] * width for _ in range(height)]
    depth = [[-1e9] * width for _ in range(height)]
    for corners, rgb in triangles:
        paint = shaded(corners, rgb)
        if paint:
            fill([(width / 2 + p[1] * scale, height - 40 * OVERSAMPLING - p[2] * scale, p[0]) for p in corners],
                 paint, image, depth)
    return image


def fill(corners, paint, image, depth):
    """One triangle of (column, row, nearness), row by row between its edges."""
    rows = [c[1] for c in corners]
    for row in range(max(0, math.ceil(min(rows))), min(len(image) - 1, math.floor(max(rows))) + 1):
        crossings = []
        for (x0, y0, z0), (x1, y1, z1) in zip(corners, corners[1:] + corners[:1]):
            if y0 != y1 and min(y0, y1) <= row <= max(y0, y1):
                t = (row - y0) / (y1 - y0)
                crossings.append((x0 + t * (x1 - x0), z0 + t * (z1 - z0)))
        (x0, z0), (x1, z1) = min(crossings), max(crossings)
        slope = (z1 - z0) / (x1 - x0) if x1 > x0 else 0.0
        for column in range(max(0, math.ceil(x0)), min(len(image[0]) - 1, math.floor(x1)) + 1):
            z = z0 + slope * (column - x0)
            if z > depth[row][column]:
                depth[row][column] = z
                image[row][column] = paint


def averaged(image):
    n = OVERSAMPLING
    return [[tuple(sum(image[r + i][c + j][k] for i in range(n) for j in range(n)) // (n * n) for k in range(3))
             for c in range(0, len(image[0]), n)] for r in range(0, len(image), n)]


def write_png(path, rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    raw = b"".join(b"\0" + bytes(v for pixel in row for v in pixel) for row in rows)
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw, 9))
                  + chunk(b"IEND", b""))


def main():
    argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()  # takes none
    views = [averaged(draw_view(view_triangles(*view))) for view in VIEWS]
    rows = [sum((view[r] for view in views), []) for r in range(VIEW_HEIGHT)]
    write_png(os.path.join(os.path.dirname(os.path.abspath(__file__)), "hrp2_style.png"), rows)


if __name__ == "__main__":
    main()

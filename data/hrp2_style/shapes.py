"""Closed triangle meshes a humanoid's shells are made of.

Lengths are millimetres. A mesh is built along its own z axis and then turned and moved into its link's
frame (x forward, y left, z up). Triangles are counter-clockwise seen from outside.
"""

import math
from typing import NamedTuple


class Mesh(NamedTuple):
    points: list  # (x, y, z) in millimetres
    triangles: list  # (i, j, k), indices into points


# ---- outlines: closed counter-clockwise curves in the xy plane, as lists of (x, y) ----


def superellipse(a, b, count, power=2.0):
    """|x/a|^power + |y/b|^power = 1. The half step in the angle keeps the outline symmetric about both axes
    without a vertex on them, so that the four sides of a boxy outline are flat."""
    outline = []
    for k in range(count):
        angle = 2.0 * math.pi * (k + 0.5) / count
        c, s = math.cos(angle), math.sin(angle)
        radius = (abs(c) ** power + abs(s) ** power) ** (-1.0 / power)
        outline.append((a * radius * c, b * radius * s))
    return outline


def chamfered_rectangle(a, b, chamfer, cuts=0):
    """Rectangle of half sides a and b with its corners cut off; `cuts` extra vertices on each side."""
    corners = [(a, -b + chamfer), (a, b - chamfer), (a - chamfer, b), (-a + chamfer, b),
               (-a, b - chamfer), (-a, -b + chamfer), (-a + chamfer, -b), (a - chamfer, -b)]
    outline = []
    for k, (x, y) in enumerate(corners):
        outline.append((x, y))
        if k % 2 == 0:  # the side from corner k to the next one; odd k are the chamfers
            nx, ny = corners[k + 1]
            for c in range(1, cuts + 1):
                t = c / (cuts + 1)
                outline.append((x + t * (nx - x), y + t * (ny - y)))
    return outline


def sole_outline(heel, toe, inner, outer, count=24):
    """A left foot's print: straight sides at y = -inner and y = outer, rounded heel (x = -heel) and toe."""
    outline = []
    for x, y in superellipse(1.0, 1.0, count, 4.0):
        outline.append((x * (toe if x > 0 else heel), y * (outer if y > 0 else inner)))
    return outline


# ---- solids ----


def section(outline, z, scale=1.0, at=(0.0, 0.0)):
    """The outline as a ring of points at height z, scaled about its own origin and then moved to `at`."""
    return [(at[0] + scale * x, at[1] + scale * y, z) for x, y in outline]


def loft(rings, bottom=None, top=None):
    """Skin over rings of equally many points, in order of rising z. Each end is closed by a fan about
    `bottom` and `top`: points given for a pointed end, else the middle of the end ring (a flat cap)."""
    n = len(rings[0])
    points = [p for ring in rings for p in ring]
    triangles = []
    for r in range(len(rings) - 1):
        for k in range(n):
            a, b = r * n + k, r * n + (k + 1) % n
            triangles += [(a, b, b + n), (a, b + n, a + n)]
    for ring_start, apex, ring in ((0, bottom, rings[0]), ((len(rings) - 1) * n, top, rings[-1])):
        points.append(apex or tuple(math.fsum(p[i] for p in ring) / n for i in range(3)))
        centre = len(points) - 1
        for k in range(n):
            a, b = ring_start + k, ring_start + (k + 1) % n
            triangles.append((centre, b, a) if ring_start == 0 else (centre, a, b))
    return Mesh(points, triangles)


def limb(stations, count=20, power=2.4, rounded=(0.0, 0.0), dome=2):
    """Tapered limb. A station is (z, half depth a, half width b, centre x, centre y), in order of falling z
    as one goes down a hanging limb. `rounded` = (top, bottom) lengths by which an elliptic dome of `dome`
    rings goes beyond the first and the last station; 0 leaves that end flat."""
    stations = sorted(stations)
    rings = [section(superellipse(a, b, count, power), z, 1.0, (x, y)) for z, a, b, x, y in stations]

    def dome_rings(station, length):
        z, a, b, x, y = station
        angles = [0.5 * math.pi * k / (dome + 1) for k in range(1, dome + 1)]
        outline = superellipse(a, b, count, power)
        return [section(outline, z + length * math.sin(t), math.cos(t), (x, y)) for t in angles]

    top, bottom = rounded
    above, below = stations[-1], stations[0]
    tip_above = tip_below = None
    if top:
        rings = rings + dome_rings(above, top)
        tip_above = (above[3], above[4], above[0] + top)
    if bottom:
        rings = dome_rings(below, -bottom)[::-1] + rings
        tip_below = (below[3], below[4], below[0] - bottom)
    return loft(rings, tip_below, tip_above)


def superellipsoid(a, b, c, power, around=24, rings=9):
    """Shell of half axes a, b, c with one vertex at each pole; `power` 2 is an ellipsoid, more is boxier."""
    levels = []
    for k in range(1, rings + 1):
        angle = math.pi * (k / (rings + 1) - 0.5)
        co, si = math.cos(angle), math.sin(angle)
        radius = (abs(co) ** power + abs(si) ** power) ** (-1.0 / power)
        levels.append(section(superellipse(a, b, around, power), c * radius * si, radius * co))
    return loft(levels, (0.0, 0.0, -c), (0.0, 0.0, c))


def chamfered_box(size, chamfer, cuts=1):
    """Box about the origin with every edge cut off. Sides are subdivided by `cuts`, top and bottom carry an
    inner ring: many coplanar vertices on each flat side, as in a shell that CAD software tessellated."""
    a, b, h = (0.5 * s for s in size)
    full = chamfered_rectangle(a, b, chamfer, cuts)
    inset = chamfered_rectangle(a - chamfer, b - chamfer, 0.5 * chamfer, cuts)
    rings = [section(inset, -h, 0.5), section(inset, -h)]
    for k in range(cuts + 2):
        rings.append(section(full, (-h + chamfer) + k / (cuts + 1) * 2.0 * (h - chamfer)))
    rings += [section(inset, h), section(inset, h, 0.5)]
    return loft(rings)


def drum(radius, start, end, count=20, chamfer=3.0):
    """Cylinder about z from z = start to z = end, with chamfered rims."""
    circle = superellipse(radius, radius, count)
    small = (radius - chamfer) / radius
    return loft([section(circle, start, small), section(circle, start + chamfer),
                 section(circle, end - chamfer), section(circle, end, small)])


# ---- placing ----


def moved(mesh, x=0.0, y=0.0, z=0.0):
    return Mesh([(p[0] + x, p[1] + y, p[2] + z) for p in mesh.points], mesh.triangles)


def along_x(mesh):
    """The mesh's z axis becomes x, its x axis y and its y axis z (a rotation: no handedness changes)."""
    return Mesh([(z, x, y) for x, y, z in mesh.points], mesh.triangles)


def along_y(mesh):
    """The mesh's z axis becomes y, its y axis x and its x axis z (a rotation)."""
    return Mesh([(y, z, x) for x, y, z in mesh.points], mesh.triangles)


def pitched(mesh, degrees):
    """Turned about y by the right hand rule: a positive angle lowers the nose (+x goes down)."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return Mesh([(c * x + s * z, y, -s * x + c * z) for x, y, z in mesh.points], mesh.triangles)


def rolled(mesh, degrees):
    """Turned about x by the right hand rule."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return Mesh([(x, c * y - s * z, s * y + c * z) for x, y, z in mesh.points], mesh.triangles)


def mirrored(mesh):
    """Image in the xz plane (y -> -y); the triangles are reversed so that they still face outward."""
    return Mesh([(x, -y, z) for x, y, z in mesh.points], [(i, k, j) for i, j, k in mesh.triangles])


def left_and_right(mesh):
    """The mesh and its image in the xz plane, as two parts."""
    return [mesh, mirrored(mesh)]


# ---- finishing and measuring ----


def tenths(value):
    """A length in whole tenths of a millimetre. The bias (1e-6 of a tenth) sends ties away from zero, so
    that the last bit of sin and cos, which differs between C libraries, cannot change a file."""
    return int(math.copysign(math.floor(abs(value) * 10.0 + 0.5 + 1e-6), value))


def finished(mesh):
    """The mesh on the 0.1 mm grid, without the triangles that the grid has flattened to a line or point
    and without points that no triangle uses. Points that fall together become one."""
    index, points, triangles = {}, [], []
    for triangle in mesh.triangles:
        corners = [tuple(tenths(v) / 10.0 for v in mesh.points[i]) for i in triangle]
        if len(set(corners)) < 3:
            continue
        for corner in corners:
            if corner not in index:
                index[corner] = len(points)
                points.append(corner)
        triangles.append(tuple(index[corner] for corner in corners))
    return Mesh(points, triangles)


def merged(parts):
    """The parts as one mesh; no surface is joined."""
    points, triangles = [], []
    for part in parts:
        offset = len(points)
        points += part.points
        triangles += [tuple(i + offset for i in t) for t in part.triangles]
    return Mesh(points, triangles)


def mass_properties(parts, mass):
    """(centre of mass [mm], inertia about it as (xx, xy, xz, yy, yz, zz) [kg mm^2]) of closed meshes filled
    with one density such that they weigh `mass` [kg]; space that two parts share counts twice."""
    volume, first, second = 0.0, [0.0] * 3, [[0.0] * 3 for _ in range(3)]
    mesh = merged(parts)
    for i, j, k in mesh.triangles:
        a, b, c = mesh.points[i], mesh.points[j], mesh.points[k]
        # Signed volume of the tetrahedron (origin, a, b, c) and its moments, exact for a linear simplex.
        v = (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0])
             + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6.0
        total = [a[m] + b[m] + c[m] for m in range(3)]
        volume += v
        for m in range(3):
            first[m] += v * total[m] / 4.0
            for n in range(3):
                second[m][n] += v * (total[m] * total[n] + a[m] * a[n] + b[m] * b[n] + c[m] * c[n]) / 20.0
    centre = [f / volume for f in first]
    density = mass / volume
    cov = [[density * second[m][n] - mass * centre[m] * centre[n] for n in range(3)] for m in range(3)]
    return centre, (cov[1][1] + cov[2][2], -cov[0][1], -cov[0][2],
                    cov[0][0] + cov[2][2], -cov[1][2], cov[0][0] + cov[1][1])

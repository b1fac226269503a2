"""Writers for the mesh formats that robot descriptions use: STL (binary and ASCII), OBJ and COLLADA.

Every writer takes the parts of a link (closed `shapes.Mesh`es in millimetres on the 0.1 mm grid, in the link's
frame) and `per_millimetre`, the file's unit (0.001 for a file in metres, 1 for one in millimetres). The numbers
written are exact decimals, and a mirrored mesh gets the same digits with the other sign.
"""

import math
import struct

from shapes import merged

DECIMALS = {1.0: 1, 0.1: 2, 0.001: 4}  # digits after the point that 0.1 mm needs in a unit of this size


def number(value, per_millimetre):
    text = f"{value * per_millimetre:.{DECIMALS[per_millimetre]}f}"
    return text[1:] if float(text) == 0.0 and text[0] == "-" else text


def facet_normal(a, b, c):
    u = [b[i] - a[i] for i in range(3)]
    v = [c[i] - a[i] for i in range(3)]
    n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    length = math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
    return tuple(x / length + 0.0 for x in n) if length > 0.0 else (0.0, 0.0, 0.0)


def write_stl_binary(path, parts, per_millimetre):
    mesh = merged(parts)
    with open(path, "wb") as out:
        # The header must not begin with "solid", by which readers tell an ASCII file.
        out.write(b"binary STL, hrp2_style".ljust(80, b" "))
        out.write(struct.pack("<I", len(mesh.triangles)))
        for triangle in mesh.triangles:
            corners = [mesh.points[i] for i in triangle]
            out.write(struct.pack("<3f", *(round(x, 6) + 0.0 for x in facet_normal(*corners))))
            for corner in corners:
                out.write(struct.pack("<3f", *(float(number(x, per_millimetre)) for x in corner)))
            out.write(struct.pack("<H", 0))


def write_stl_ascii(path, parts, per_millimetre):
    mesh = merged(parts)
    lines = ["solid hrp2_style"]
    for triangle in mesh.triangles:
        corners = [mesh.points[i] for i in triangle]
        normal = " ".join(f"{round(x, 6) + 0.0:.6f}" for x in facet_normal(*corners))
        lines += [f"  facet normal {normal}", "    outer loop"]
        lines += ["      vertex " + " ".join(number(x, per_millimetre) for x in c) for c in corners]
        lines += ["    endloop", "  endfacet"]
    write_text(path, lines + ["endsolid hrp2_style"])


def write_obj(path, parts, per_millimetre):
    lines, offset = [], 1
    for k, part in enumerate(parts):
        lines.append(f"o part_{k}")
        lines += ["v " + " ".join(number(x, per_millimetre) for x in p) for p in part.points]
        lines += ["f " + " ".join(str(i + offset) for i in t) for t in part.triangles]
        offset += len(part.points)
    write_text(path, lines)


def write_dae(path, parts, per_millimetre, up_axis):
    """COLLADA 1.4.1. As URDF tools expect, the numbers are in the link's frame whatever <up_axis> says, while
    <unit> counts. Each part is a geometry of its own; from the second on, its node carries the part's
    place along x and z, as exporters write a scene of several objects."""
    metres_per_unit = 0.001 / per_millimetre
    lines = ['<?xml version="1.0" encoding="utf-8"?>',
             '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">',
             "  <asset>", "    <created>2000-01-01T00:00:00</created>",
             "    <modified>2000-01-01T00:00:00</modified>",
             f'    <unit name="{UNIT_NAMES[per_millimetre]}" meter="{metres_per_unit:g}"/>',
             f"    <up_axis>{up_axis}</up_axis>", "  </asset>", "  <library_geometries>"]
    places = [(0.0, 0.0, 0.0)] + [middle(part) for part in parts[1:]]
    for k, (part, place) in enumerate(zip(parts, places)):
        lines += dae_geometry(f"part_{k}", part, place, per_millimetre)
    lines += ["  </library_geometries>", "  <library_visual_scenes>", '    <visual_scene id="scene">']
    for k, place in enumerate(places):
        lines.append(f'      <node id="node_{k}">')
        if k > 0:
            shift = " ".join(number(x, per_millimetre) for x in place)
            lines.append(f"        <translate>{shift}</translate>")
        lines += [f'        <instance_geometry url="#part_{k}"/>', "      </node>"]
    lines += ["    </visual_scene>", "  </library_visual_scenes>",
              '  <scene><instance_visual_scene url="#scene"/></scene>', "</COLLADA>"]
    write_text(path, lines)


UNIT_NAMES = {1.0: "millimeter", 0.1: "centimeter", 0.001: "meter"}


def middle(part):
    """Middle of the part's box in x and z, on the 0.1 mm grid. y stays, so that symmetry in y stays exact."""
    def mid(axis):
        values = [p[axis] for p in part.points]
        return round(0.5 * (min(values) + max(values)))
    return (float(mid(0)), 0.0, float(mid(2)))


def dae_geometry(name, part, place, per_millimetre):
    coordinates = " ".join(number(round(x - s, 1), per_millimetre) for p in part.points for x, s in zip(p, place))
    indices = " ".join(str(i) for t in part.triangles for i in t)
    return [f'    <geometry id="{name}">', "      <mesh>", f'        <source id="{name}_positions">',
            f'          <float_array id="{name}_array" count="{3 * len(part.points)}">{coordinates}</float_array>',
            "          <technique_common>",
            f'            <accessor source="#{name}_array" count="{len(part.points)}" stride="3">',
            *(f'              <param name="{axis}" type="float"/>' for axis in "XYZ"),
            "            </accessor>", "          </technique_common>", "        </source>",
            f'        <vertices id="{name}_vertices">',
            f'          <input semantic="POSITION" source="#{name}_positions"/>', "        </vertices>",
            f'        <triangles count="{len(part.triangles)}">',
            f'          <input semantic="VERTEX" source="#{name}_vertices" offset="0"/>',
            f"          <p>{indices}</p>", "        </triangles>", "      </mesh>", "    </geometry>"]


def write_text(path, lines):
    with open(path, "w", encoding="utf-8", newline="\n") as out:
        out.write("\n".join(lines) + "\n")

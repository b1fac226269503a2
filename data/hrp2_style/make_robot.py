#!/usr/bin/env python3
"""Writes the humanoid's meshes, hrp2_style.urdf and hrp2_style.srdf (Python standard library only).

    make_robot.py            write the files beside this script
    make_robot.py --check    write them to a temporary folder and compare byte for byte
    make_robot.py --tables   print the README's tables of links and joints

What is written is in metres, kilograms and radians; the tables it is made from are in robot_table.py.
"""

import filecmp
import math
import os
import sys
import tempfile
from xml.sax.saxutils import quoteattr

import pairs
import robot_table as table
from links import link_parts
from mesh_files import write_dae, write_obj, write_stl_ascii, write_stl_binary
from shapes import mass_properties, merged

HERE = os.path.dirname(os.path.abspath(__file__))
COLOURS = {"shell": "0.85 0.86 0.89 1", "trunk": "0.67 0.75 0.84 1", "dark": "0.36 0.41 0.47 1"}


def plain(value, digits):
    """Shortest decimal of `value` rounded to `digits`, never -0."""
    return f"{round(value, digits) + 0.0:.{digits}f}".rstrip("0").rstrip(".")


def numbers(values, digits=6):
    return " ".join(plain(v, digits) for v in values)


# ---- meshes ----


def write_meshes(folder):
    os.makedirs(folder, exist_ok=True)
    for link in table.links():
        file_name, entry, _ = table.mesh_file(link)
        if entry.shared and table.is_right(link):
            continue
        path, parts = os.path.join(folder, file_name), link_parts(link)
        if entry.extension == "dae":
            write_dae(path, parts, entry.per_millimetre, entry.style)
        elif entry.extension == "obj":
            write_obj(path, parts, entry.per_millimetre)
        elif entry.style == "binary":
            write_stl_binary(path, parts, entry.per_millimetre)
        else:
            write_stl_ascii(path, parts, entry.per_millimetre)


# ---- URDF ----


def material(link):
    if link.startswith(("BODY", "CHEST")):
        return "trunk"
    return "dark" if link[-1] in "0146" and not link.startswith("HEAD_LINK1") else "shell"


def link_inertial(link):
    """(mass [kg], centre of mass [m], inertia about it [kg m^2]). A right link's are the images of the left
    one's: y changes sign, and so do xy and yz."""
    left = table.left_name(link)
    mass = table.MASSES[left]
    centre, inertia = mass_properties(link_parts(left), mass)
    sign = -1.0 if table.is_right(link) else 1.0
    signs = (1, sign, 1, 1, sign, 1)
    if left == link and not link.startswith(("LLEG", "LARM")):
        signs = (1, 0, 1, 1, 0, 1)  # the trunk is symmetric: only rounding noise is left in xy and yz
        sign = 0.0
    centre = [centre[0] / 1000, sign * centre[1] / 1000, centre[2] / 1000]
    return mass, centre, [s * i * 1e-6 for s, i in zip(signs, inertia)]


def link_xml(link):
    mass, centre, inertia = link_inertial(link)
    file_name, _, scale = table.mesh_file(link)
    scale_text = "" if scale == (1.0, 1.0, 1.0) else f' scale="{numbers(scale)}"'
    mesh = f'<geometry><mesh filename="package://{table.NAME}/meshes/{file_name}"{scale_text}/></geometry>'
    tensor = " ".join(f'{name}="{plain(value, 8)}"'
                      for name, value in zip(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), inertia))
    return [f'  <link name="{link}">', "    <inertial>", f'      <origin xyz="{numbers(centre)}" rpy="0 0 0"/>',
            f'      <mass value="{plain(mass, 3)}"/>', f"      <inertia {tensor}/>", "    </inertial>",
            "    <visual>", f"      {mesh}", f'      <material name="{material(link)}"/>', "    </visual>",
            "    <collision>", f"      {mesh}", "    </collision>", "  </link>"]


def joint_xml(joint):
    origin = numbers([x / 1000 for x in joint.origin])
    axis = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}[joint.axis]
    lower, upper, velocity = (plain(math.radians(x), 6) for x in (joint.lower, joint.upper, joint.velocity))
    return [f'  <joint name="{joint.name}" type="revolute">', f'    <parent link="{joint.parent}"/>',
            f'    <child link="{joint.child}"/>', f'    <origin xyz="{origin}" rpy="0 0 0"/>',
            f'    <axis xyz="{axis}"/>',
            f'    <limit lower="{lower}" upper="{upper}" effort="{plain(joint.effort, 1)}" velocity="{velocity}"/>',
            "  </joint>"]


def write_urdf(path):
    lines = ['<?xml version="1.0"?>', "<!-- Written by make_robot.py. Do not edit. -->",
             f'<robot name="{table.NAME}">']
    for name, rgba in COLOURS.items():
        lines.append(f'  <material name="{name}"><color rgba="{rgba}"/></material>')
    for link in table.links():
        lines += link_xml(link)
    for joint in table.joints():
        lines += joint_xml(joint)
    write_text(path, lines + ["</robot>"])


# ---- SRDF ----


def write_srdf(path):
    lines = ['<?xml version="1.0"?>', "<!-- Written by make_robot.py. Do not edit. -->",
             f'<robot name="{table.NAME}">',
             '  <virtual_joint name="floating_base" type="floating" parent_frame="world" '
             f'child_link="{table.BASE}"/>']
    for group, base, tip in table.CHAINS:
        lines += [f'  <group name="{group}">', f'    <chain base_link="{base}" tip_link="{tip}"/>', "  </group>"]
    lines += ['  <group name="whole_body">']
    lines += [f'    <group name="{group}"/>' for group, _, _ in table.CHAINS] + ["  </group>"]
    for name in table.POSTURES:
        lines.append(f'  <group_state name="{name}" group="whole_body">')
        lines += [f'    <joint name="{joint}" value="{plain(math.radians(value), 6)}"/>'
                  for joint, value in table.posture(name).items()]
        lines.append("  </group_state>")
    for link1, link2, reason in pairs.disabled_pairs():
        lines.append(f'  <disable_collisions link1={quoteattr(link1)} link2={quoteattr(link2)} '
                     f'reason={quoteattr(reason)}/>')
    write_text(path, lines + ["</robot>"])


def write_text(path, lines):
    with open(path, "w", encoding="utf-8", newline="\n") as out:
        out.write("\n".join(lines) + "\n")


# ---- what the script does ----


def write_all(folder):
    write_meshes(os.path.join(folder, "meshes"))
    write_urdf(os.path.join(folder, f"{table.NAME}.urdf"))
    write_srdf(os.path.join(folder, f"{table.NAME}.srdf"))


def generated_files(folder):
    meshes = os.path.join(folder, "meshes")
    names = [os.path.join("meshes", name) for name in sorted(os.listdir(meshes))]
    return names + [f"{table.NAME}.urdf", f"{table.NAME}.srdf"]


def check():
    """Names of files that differ from what the tables give, or are on one side only."""
    with tempfile.TemporaryDirectory() as fresh:
        write_all(fresh)
        names = sorted(set(generated_files(fresh)) | set(generated_files(HERE)))
        _, different, missing = filecmp.cmpfiles(fresh, HERE, names, shallow=False)
        return different + missing


def print_tables():
    print("| link | mass [kg] | parts | vertices | triangles | mesh file | unit, style | scale in the URDF |")
    print("|---|---|---|---|---|---|---|---|")
    for link in table.links():
        file_name, entry, scale = table.mesh_file(link)
        parts = link_parts(link)
        mesh = merged(parts)
        unit = {1.0: "mm", 0.1: "cm", 0.001: "m"}[entry.per_millimetre]
        style = f"{unit}, {entry.style}" if entry.style else unit
        print(f"| {link} | {table.MASSES[table.left_name(link)]:.1f} | {len(parts)} | {len(mesh.points)} "
              f"| {len(mesh.triangles)} | {file_name} | {style} | {numbers(scale)} |")
    print()
    columns = ("joint", "parent", "child", "origin [mm]", "axis", "lower [deg]", "upper [deg]", "effort [N m]",
               "velocity [deg/s]")
    print("| " + " | ".join(columns) + " |")
    print("|" + "---|" * len(columns))
    for j in table.joints():
        print(f"| {j.name} | {j.parent} | {j.child} | {numbers(j.origin)} | {j.axis} | {j.lower} | {j.upper} "
              f"| {j.effort} | {j.velocity} |")


def main(arguments):
    if arguments == ["--check"]:
        stale = check()
        for name in stale:
            print(f"differs from what make_robot.py writes: {name}", file=sys.stderr)
        return 1 if stale else 0
    if arguments == ["--tables"]:
        print_tables()
        return 0
    if arguments:
        print(__doc__, file=sys.stderr)
        return 2
    write_all(HERE)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

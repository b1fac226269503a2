"""What the scripts that write scenes share: lengths in words, a URDF of fixed shapes, and files that are written or compared."""
import argparse
import os


def metres(values):
    """Lengths in mm as a URDF has them."""
    return " ".join(f"{v / 1000:.6g}" for v in values)


def urdf(name, script, parts):
    """A scene of shapes that stand still. Of each: name, geometry, centre (mm), roll, pitch and yaw (rad), colour."""
    lines = ['<?xml version="1.0"?>', f"<!-- Written by {script}. Do not edit. -->", f'<robot name="{name}">', '  <link name="world"/>']
    for part, geometry, centre, turn, colour in parts:
        lines += [f'  <link name="{part}">',
                  f'    <visual><geometry>{geometry}</geometry><material name="{part}"><color rgba="{colour}"/></material></visual>',
                  f"    <collision><geometry>{geometry}</geometry></collision>", "  </link>",
                  f'  <joint name="{part}_place" type="fixed">',
                  f'    <origin xyz="{metres(centre)}" rpy="{" ".join(f"{angle:.9g}" for angle in turn)}"/>',
                  f'    <parent link="world"/><child link="{part}"/>', "  </joint>"]
    return "\n".join(lines + ["</robot>"]) + "\n"


def main(description, folder, files):
    """Writes the files, (name, text) each, or with --check only compares them; the exit status."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    check, different = parser.parse_args().check, []
    for name, text in files:
        path = os.path.join(folder, name)
        old = open(path, encoding="utf-8").read() if os.path.exists(path) else None
        if old == text:
            continue
        different.append(name)
        if not check:
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "w", encoding="utf-8", newline="\n") as out:
                out.write(text)
    print("\n".join(different) if different else "up to date")
    return 1 if check and different else 0

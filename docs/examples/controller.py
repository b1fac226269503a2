"""Two arms move the boxes they hold past each other at 1 kHz, kept apart by a velocity damper: controller.py PROJECT FOLDER

The loop of controller.cpp: once on smooth bodies (r = 1 cm, R = 10 m), once on nearly sharp ones (r = 1 um, R = 1 km) with the
same margin, whose gradient all but jumps. Writes controller_py.csv and controller_py.html into the folder.
"""
import pathlib
import sys
import tempfile
import xml.etree.ElementTree as xml

import numpy as np

import fcl_stpbv
from chart import chart, page

PERIOD, DURATION = 1e-3, 6  # s
INFLUENCE, SECURITY, DAMPING = 0.05, 0.01, 0.5  # m, m, m/s
ARMS = {"LARM": 1, "RARM": -1}
BENT = {"0": -0.6, "1": 0.25, "3": -1.2}  # joints of an arm at the start; the roll, 1, is mirrored


def turned(axis, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]] if axis == "x" else [[c, 0, s], [0, 1, 0], [-s, 0, c]])


def level(side):
    """Roll, pitch and yaw of a level box in the hand of an arm that is bent as it starts."""
    r = turned("y", -BENT["3"]) @ turned("x", -BENT["1"] * side) @ turned("y", -BENT["0"])
    return f"{np.arctan2(r[2, 1], r[2, 2])} {-np.arcsin(r[2, 0])} {np.arctan2(r[1, 0], r[0, 0])}"


def with_boxes(urdf):
    """The robot's tree with the two boxes as its only bodies."""
    root = xml.parse(urdf).getroot()
    for link in root.findall("link"):
        for shape in link.findall("collision") + link.findall("visual"):
            link.remove(shape)
    for arm, side in ARMS.items():
        link = xml.SubElement(root, "link", name=f"{arm}_BOX")
        xml.SubElement(xml.SubElement(xml.SubElement(link, "collision"), "geometry"), "box", size="0.12 0.10 0.16")
        joint = xml.SubElement(root, "joint", name=f"{arm}_HOLDS", type="fixed")
        xml.SubElement(joint, "parent", link=f"{arm}_LINK5")
        xml.SubElement(joint, "child", link=f"{arm}_BOX")
        xml.SubElement(joint, "origin", xyz="0 0 -0.12", rpy=level(side))
    return xml.tostring(root, encoding="unicode")


def wanted(start, at, t):
    """The desired motion of the arms without collisions: inwards and back, one hand up while the other goes down."""
    q = start.copy()
    for arm, side in ARMS.items():
        q[at[f"{arm}_JOINT0"]] += side * 0.15 * np.sin(2 * t)
        q[at[f"{arm}_JOINT1"]] -= side * 0.4 * (1 - np.cos(np.pi * t / 3)) / 2
        q[at[f"{arm}_JOINT2"]] -= side * 0.5 * (1 - np.cos(np.pi * t / 3)) / 2
        q[at[f"{arm}_JOINT4"]] += side * 0.04 * np.sin(3 * t)
        q[at[f"{arm}_JOINT5"]] += 0.03 * np.sin(2.3 * t)
    return q


def run(urdf, r, R, margin):
    """For each tick: distance of the boxes beyond their margin, and the largest joint acceleration."""
    robot = fcl_stpbv.Robot(urdf, r=r, R=R)
    damper = fcl_stpbv.VelocityDamper(robot, influence=INFLUENCE + margin, security=SECURITY + margin, damping=DAMPING, period=PERIOD)
    at = {name: i for i, name in enumerate(robot.names)}
    start = robot.neutral.copy()
    for arm, side in ARMS.items():
        for joint, angle in BENT.items():
            start[at[f"{arm}_JOINT{joint}"]] = angle * (side if joint == "1" else 1)
    q, qd, ticks = start.copy(), 0 * start, []
    for t in np.arange(0, DURATION, PERIOD):
        velocity = 10 * (wanted(start, at, t) - q)  # the task: proportional control
        for row, bound in zip(*damper.update(q, qd)):  # one row at most: the quadratic program min |x - task|^2 is a projection
            velocity += row * max(0.0, bound - row @ velocity) / (row @ row)
        ticks.append((damper.d[0] - margin, np.abs(velocity - qd).max() / PERIOD))
        qd = velocity
        q = q + PERIOD * qd
    return np.array(ticks)


def page_of(found, smooth, sharp):
    """The page with the curves of both runs."""
    curves = lambda column, unit: [("nearly sharp bodies", "var(--hulls)", sharp[:, column] / unit),
                                   ("smooth bodies", "var(--smooth)", smooth[:, column] / unit)]
    return page(found, "Two arms move the boxes they hold past each other, kept apart by a velocity damper. "
                       "The peaks are those after 0.5 s: before, the arms start from rest.",
                [chart("Largest joint acceleration (rad/s²)", DURATION, -1, 3, curves(1, 1)),
                 chart("Distance beyond the margins (mm)", DURATION, 0, 3, curves(0, 1e-3), ("10 mm, to be kept", 10))])


def main(project, folder):
    path = pathlib.Path(folder) / "controller_py.csv"
    if not path.parent.is_dir():  # reported at once, not after the run
        raise NotADirectoryError(f"{folder} is no folder: FOLDER is where the table goes")
    robot = pathlib.Path(project) / "data/hrp2_style/hrp2_style.urdf"
    if not robot.is_file():
        raise FileNotFoundError(f"{robot} is missing: PROJECT is the folder that holds data/")
    with tempfile.TemporaryDirectory() as place:
        urdf = pathlib.Path(place) / "boxes.urdf"
        urdf.write_text(with_boxes(robot))
        smooth, sharp = run(str(urdf), 0.01, 10, 0), run(str(urdf), 1e-6, 1000, 0.01)
    times = np.arange(len(smooth)) * PERIOD
    np.savetxt(path, np.column_stack([times, smooth, sharp]), delimiter=",", comments="",
               header="seconds,distance,acceleration,distance_sharp,acceleration_sharp")
    peak, peak_sharp = smooth[500:, 1].max(), sharp[500:, 1].max()  # without the start from rest
    found = f"On smooth bodies the joints reach {peak:.1f} rad/s², on nearly sharp ones {peak_sharp:.0f} rad/s²"
    path.with_suffix(".html").write_text(page_of(found, smooth, sharp), encoding="utf-8")
    print(f"peak acceleration {peak:.3g} rad/s^2 on smooth bodies, {peak_sharp:.3g} on sharp ones; {smooth[:, 0].min():.4f} m kept")
    return 0 if peak_sharp > 10 * peak and smooth[:, 0].min() > 0.99 * SECURITY else 1


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    try:
        sys.exit(main(*sys.argv[1:]))
    except OSError as error:
        sys.exit(str(error))

"""The robot in tables: joints, masses, mesh files, postures and groups.

Figures are those of the left limbs; `side` turns them into the right ones by the mirror y -> -y. Under that
mirror a turn about y keeps its sign, a turn about x or z changes it, for all joint axes are +x, +y or +z
on both sides. Tables are in millimetres and degrees; what is written is in metres and radians.
"""

from typing import NamedTuple


class Joint(NamedTuple):
    name: str
    parent: str
    child: str
    origin: tuple  # mm, in the parent link's frame; no joint frame is turned
    axis: str  # "x" roll, "y" pitch, "z" yaw
    lower: float  # degrees
    upper: float
    effort: float  # N m
    velocity: float  # degrees per second


class MeshFile(NamedTuple):
    extension: str  # stl, obj or dae
    style: str  # "binary" or "ascii" (stl), up axis (dae), unused (obj)
    per_millimetre: float  # the file's unit: 0.001 metres, 0.1 centimetres, 1 millimetres
    shared: bool = False  # the right limb takes the left one's file with a negative y scale


NAME = "hrp2_style"
BASE = "BODY"
BASE_HEIGHT = 705  # mm from the soles to the hip joints in the zero posture: 300 + 300 + 105

TRUNK = [
    Joint("CHEST_JOINT0", "BODY", "CHEST_LINK0", (32, 0, 350.7), "z", -45, 45, 120, 200),
    Joint("CHEST_JOINT1", "CHEST_LINK0", "CHEST_LINK1", (0, 0, 0), "y", -5, 60, 180, 150),
    Joint("HEAD_JOINT0", "CHEST_LINK1", "HEAD_LINK0", (-7, 0, 297.3), "z", -45, 45, 20, 270),
    Joint("HEAD_JOINT1", "HEAD_LINK0", "HEAD_LINK1", (0, 0, 0), "y", -30, 45, 20, 270),
]
LEFT_LEG = [
    Joint("LLEG_JOINT0", "BODY", "LLEG_LINK0", (0, 60, 0), "z", -30, 45, 120, 200),
    Joint("LLEG_JOINT1", "LLEG_LINK0", "LLEG_LINK1", (0, 0, 0), "x", -20, 35, 160, 220),
    Joint("LLEG_JOINT2", "LLEG_LINK1", "LLEG_LINK2", (0, 0, 0), "y", -125, 42, 180, 250),
    Joint("LLEG_JOINT3", "LLEG_LINK2", "LLEG_LINK3", (0, 35, -300), "y", 0, 150, 200, 350),
    Joint("LLEG_JOINT4", "LLEG_LINK3", "LLEG_LINK4", (0, 0, -300), "y", -75, 42, 180, 250),
    Joint("LLEG_JOINT5", "LLEG_LINK4", "LLEG_LINK5", (0, 0, 0), "x", -35, 20, 120, 220),
]
LEFT_ARM = [
    Joint("LARM_JOINT0", "CHEST_LINK1", "LARM_LINK0", (8, 250, 181), "y", -180, 60, 60, 300),
    Joint("LARM_JOINT1", "LARM_LINK0", "LARM_LINK1", (0, 0, 0), "x", -10, 95, 60, 250),
    Joint("LARM_JOINT2", "LARM_LINK1", "LARM_LINK2", (0, 0, 0), "z", -92, 92, 40, 350),
    Joint("LARM_JOINT3", "LARM_LINK2", "LARM_LINK3", (0, 0, -250), "y", -137, 2, 40, 350),
    Joint("LARM_JOINT4", "LARM_LINK3", "LARM_LINK4", (0, 0, -110), "z", -92, 92, 20, 400),
    Joint("LARM_JOINT5", "LARM_LINK4", "LARM_LINK5", (0, 0, -140), "y", -54, 36, 20, 400),
    Joint("LARM_JOINT6", "LARM_LINK5", "LARM_LINK6", (0, 8, -94), "x", -60, 16, 10, 200),
]

# kg; the sum over all 31 links is 58 kg, batteries included.
MASSES = {
    "BODY": 8.0, "CHEST_LINK0": 0.8, "CHEST_LINK1": 13.6, "HEAD_LINK0": 0.6, "HEAD_LINK1": 1.8,
    "LLEG_LINK0": 1.0, "LLEG_LINK1": 1.2, "LLEG_LINK2": 4.0, "LLEG_LINK3": 2.5, "LLEG_LINK4": 0.8,
    "LLEG_LINK5": 1.5,
    "LARM_LINK0": 0.8, "LARM_LINK1": 0.8, "LARM_LINK2": 1.5, "LARM_LINK3": 1.0, "LARM_LINK4": 0.8,
    "LARM_LINK5": 0.5, "LARM_LINK6": 0.2,
}

# Formats are mixed on purpose, as in descriptions that grew over years.
MESH_FILES = {
    "BODY": MeshFile("dae", "Z_UP", 1.0),
    "CHEST_LINK0": MeshFile("obj", "", 0.001),
    "CHEST_LINK1": MeshFile("dae", "Y_UP", 1.0),
    "HEAD_LINK0": MeshFile("stl", "ascii", 0.001),
    "HEAD_LINK1": MeshFile("dae", "X_UP", 0.001),
    "LLEG_LINK0": MeshFile("stl", "binary", 0.001),
    "LLEG_LINK1": MeshFile("stl", "binary", 1.0),
    "LLEG_LINK2": MeshFile("stl", "binary", 0.001),
    "LLEG_LINK3": MeshFile("dae", "Z_UP", 0.1),
    "LLEG_LINK4": MeshFile("stl", "ascii", 0.001),
    "LLEG_LINK5": MeshFile("obj", "", 0.001),
    "LARM_LINK0": MeshFile("stl", "binary", 0.001, shared=True),
    "LARM_LINK1": MeshFile("dae", "Y_UP", 0.001, shared=True),
    "LARM_LINK2": MeshFile("stl", "binary", 0.001, shared=True),
    "LARM_LINK3": MeshFile("obj", "", 1.0, shared=True),
    "LARM_LINK4": MeshFile("stl", "ascii", 0.001),
    "LARM_LINK5": MeshFile("dae", "Z_UP", 1.0, shared=True),
    "LARM_LINK6": MeshFile("stl", "binary", 0.001, shared=True),
}

# Degrees, of the left limbs; joints that are not named are at 0.
POSTURES = {
    "zero": {},
    "half_sitting": {"LLEG_JOINT2": -26, "LLEG_JOINT3": 50, "LLEG_JOINT4": -24, "LARM_JOINT0": 15,
                     "LARM_JOINT1": 10, "LARM_JOINT3": -30, "LARM_JOINT6": -10},
    "reach": {"LLEG_JOINT2": -32, "LLEG_JOINT3": 58, "LLEG_JOINT4": -32, "CHEST_JOINT1": 6, "HEAD_JOINT1": 12,
              "LARM_JOINT0": -48, "LARM_JOINT1": 8, "LARM_JOINT2": -20, "LARM_JOINT3": -38, "LARM_JOINT5": -8,
              "LARM_JOINT6": 10},
}


def is_right(name):
    return name[0] == "R"


def left_name(name):
    """Name of the left twin (of a right limb's part), else the name itself."""
    return "L" + name[1:] if is_right(name) else name


def right_name(name):
    """Name of the right twin; the trunk's and the head's parts have none and keep theirs."""
    return "R" + name[1:] if name[:4] in ("LLEG", "LARM") else name


def mirrored_joint(joint):
    x, y, z = joint.origin
    lower, upper = (joint.lower, joint.upper) if joint.axis == "y" else (-joint.upper, -joint.lower)
    return joint._replace(name=right_name(joint.name), parent=right_name(joint.parent),
                          child=right_name(joint.child), origin=(x, -y if y else 0, z), lower=lower, upper=upper)


def joints():
    """All 30 joints in the robot's order: right leg, left leg, chest, head, right arm, left arm."""
    right_leg, right_arm = ([mirrored_joint(j) for j in limb] for limb in (LEFT_LEG, LEFT_ARM))
    return right_leg + LEFT_LEG + TRUNK + right_arm + LEFT_ARM


def links():
    """All 31 links: the base, then each joint's child in the joints' order."""
    return [BASE] + [j.child for j in joints()]


def posture(name):
    """Degrees by joint name, all 30 joints, symmetric about the xz plane."""
    values = {}
    for joint in joints():
        value = POSTURES[name].get(left_name(joint.name), 0)
        flips = is_right(joint.name) and joint.axis != "y"
        values[joint.name] = -value if flips and value else value
    return values


def mesh_file(link):
    """(file name under meshes/, the MeshFile, URDF scale) of a link."""
    entry = MESH_FILES[left_name(link)]
    owner = left_name(link) if entry.shared else link
    # COLLADA files declare their unit; for the others the URDF's scale has to bring them to metres.
    size = 1.0 if entry.extension == "dae" else 0.001 / entry.per_millimetre
    flip = -1.0 if entry.shared and is_right(link) else 1.0
    return f"{owner}.{entry.extension}", entry, (size, flip * size, size)


# MoveIt-style planning groups: (group, base link, tip link).
CHAINS = [("right_leg", "BODY", "RLEG_LINK5"), ("left_leg", "BODY", "LLEG_LINK5"),
          ("torso", "BODY", "CHEST_LINK1"), ("head", "CHEST_LINK1", "HEAD_LINK1"),
          ("right_arm", "CHEST_LINK1", "RARM_LINK6"), ("left_arm", "CHEST_LINK1", "LARM_LINK6")]

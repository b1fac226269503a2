"""Which pairs of links the SRDF takes out of the self-collision check, and why.

Reasons are those of MoveIt's Setup Assistant:

    Adjacent  joined by a joint
    Default   both belong to one composite joint (hip, waist, neck, shoulder, ankle), so that their convex hulls
              with 1 cm of margin overlap in the zero posture already
    Never     within the joint limits the hulls stay more than 3 cm apart, which is more than both margins;
              found by 60 000 random postures and by minimising each pair's distance from 40 starts
    User      one of them is a small link of a composite joint and lies behind the larger links around it, which
              are checked in its place

"Contact" refers to convex hulls with a margin, not to the bare meshes. All other pairs are checked.
"""

import itertools

import robot_table as table

# Links around one composite joint, by their left or central names.
COMPOSITE_JOINTS = [
    {"BODY", "LLEG_LINK0", "LLEG_LINK1", "LLEG_LINK2"},  # hip
    {"BODY", "CHEST_LINK0", "CHEST_LINK1"},  # waist
    {"CHEST_LINK1", "HEAD_LINK0", "HEAD_LINK1"},  # neck
    {"CHEST_LINK1", "LARM_LINK0", "LARM_LINK1"},  # shoulder, chest's side
    {"LARM_LINK0", "LARM_LINK1", "LARM_LINK2"},  # shoulder, arm's side
    {"LLEG_LINK3", "LLEG_LINK4", "LLEG_LINK5"},  # ankle
]

# The small links of the composite joints.
ENCLOSED = {"CHEST_LINK0", "HEAD_LINK0", "LLEG_LINK0", "LLEG_LINK1", "LLEG_LINK4", "LARM_LINK0", "LARM_LINK1"}

# Pairs that cannot meet. With a link of the trunk or head: either side. With two limbs: see the name.
NEVER_WITH_TRUNK = [("BODY", "HEAD_LINK1"), ("CHEST_LINK1", "LLEG_LINK2"), ("CHEST_LINK1", "LLEG_LINK3"),
                    ("HEAD_LINK1", "LLEG_LINK2")]
NEVER_SAME_SIDE = [("LARM_LINK2", "LARM_LINK5"), ("LARM_LINK2", "LARM_LINK6"), ("LARM_LINK3", "LARM_LINK5"),
                   ("LARM_LINK3", "LARM_LINK6"), ("LARM_LINK4", "LARM_LINK6")]
NEVER_ACROSS = [("LARM_LINK2", "LARM_LINK2"), ("LARM_LINK2", "LARM_LINK3"), ("LARM_LINK2", "LARM_LINK4"),
                ("LARM_LINK3", "LARM_LINK3"), ("LARM_LINK3", "LARM_LINK4")]


def opposite_limbs(link1, link2):
    """Whether one is a left and the other a right limb's link."""
    sides = {"R" if table.is_right(link) else "L" if link.startswith(("LLEG", "LARM")) else ""
             for link in (link1, link2)}
    return sides == {"L", "R"}


def reason(link1, link2, adjacent):
    """Why the pair is not checked; None if it is."""
    if frozenset((link1, link2)) in adjacent:
        return "Adjacent"
    across = opposite_limbs(link1, link2)
    left1, left2 = table.left_name(link1), table.left_name(link2)
    if not across and any({left1, left2} <= group for group in COMPOSITE_JOINTS):
        return "Default"
    never = NEVER_ACROSS if across else NEVER_WITH_TRUNK + NEVER_SAME_SIDE
    if (left1, left2) in never or (left2, left1) in never:
        return "Never"
    return "User" if left1 in ENCLOSED or left2 in ENCLOSED else None


def all_pairs():
    """(link1, link2, reason or None) for each of the 465 pairs, in the links' order."""
    adjacent = {frozenset((j.parent, j.child)) for j in table.joints()}
    return [(a, b, reason(a, b, adjacent)) for a, b in itertools.combinations(table.links(), 2)]


def disabled_pairs():
    return [(a, b, why) for a, b, why in all_pairs() if why]


def checked_pairs():
    return [(a, b) for a, b, why in all_pairs() if why is None]

"""The shells of every link: for each link a function that returns its closed parts.

Millimetres, in the link's frame: x forward, y left, z up, origin on the link's own joint, all joints at zero
(standing upright, arms hanging). Limbs are the left ones; the right ones are their images (y -> -y).
"""

from shapes import (along_x, along_y, chamfered_box, chamfered_rectangle, drum, finished, left_and_right, limb, loft,
                    mirrored, moved, pitched, rolled, section, sole_outline, superellipsoid)

# ---- trunk and head ----


def body():
    """Pelvis, with hip covers and a column that carries the chest's yaw joint 350.7 mm above the hips."""
    pelvis = moved(chamfered_box((190, 250, 110), 26, 2), -5, 0, 95)
    column = limb([(322, 66, 78, 30, 0), (285, 70, 84, 26, 0), (225, 74, 98, 14, 0), (165, 82, 112, 2, 0),
                   (146, 88, 118, -2, 0)], 28, 3.4)
    belt = moved(chamfered_box((24, 150, 74), 10, 2), 94, 0, 98)
    battery = moved(chamfered_box((40, 170, 84), 12, 2), -110, 0, 100)
    hip_cover = moved(along_y(drum(50, 0, 22, 20, 5)), 0, 118, 84)
    return [pelvis, column, belt, battery] + left_and_right(hip_cover)


def chest_yaw():
    """Turntable of the chest's yaw joint and the axle of its pitch joint."""
    return [drum(62, -30, -10, 24, 4), drum(44, -10, 12, 20, 2), along_y(drum(26, -78, 78, 16, 4))]


def chest():
    """Torso shell with breast plates, collar, shoulder mounts and the computers' back-pack."""
    shell = limb([(262, 76, 126, -22, 0), (236, 92, 146, -20, 0), (185, 98, 156, -18, 0), (120, 94, 150, -18, 0),
                  (70, 86, 128, -14, 0), (30, 78, 104, -8, 0), (4, 68, 88, -4, 0)], 20, 3.6, (14, 12))
    plate = moved(pitched(chamfered_box((26, 104, 92), 11, 1), -8), 77, 66, 186)
    badge = moved(chamfered_box((16, 60, 40), 6, 0), 76, 0, 96)
    collar = moved(drum(56, 264, 288, 16, 5), -5, 0, 0)
    mount = moved(along_y(drum(50, 130, 168, 12, 5)), 8, 0, 181)
    pack = moved(chamfered_box((128, 270, 262), 28, 1), -183, 0, 138)
    spine = moved(chamfered_box((70, 150, 210), 8, 0), -110, 0, 140)
    lid = moved(chamfered_box((20, 180, 170), 8, 0), -237, 0, 142)
    return [shell, collar, pack, spine, lid, badge] + left_and_right(plate) + left_and_right(mount)


def neck():
    """Neck post (yaw) with the axle of the pitch joint."""
    return [drum(38, -36, -6, 20, 4), drum(30, -6, 20, 16, 3), along_y(drum(20, -46, 46, 16, 3))]


def head():
    """Helmet with visor, chin guard, ear pods and a crest flush with the crown, 187 mm above the joint."""
    helmet = moved(superellipsoid(104, 82, 88, 2.5, 28, 11), 0, 0, 99)
    visor = moved(pitched(loft([section(chamfered_rectangle(30, 66, 14, 1), z, s)
                                for z, s in ((-28, 0.8), (-20, 1.0), (12, 1.0), (24, 0.86))]), 6), 82, 0, 108)
    chin = moved(limb([(26, 34, 52, 62, 0), (8, 30, 44, 60, 0)], 20, 3.0, (4, 6)), 0, 0, 16)
    crest = moved(chamfered_box((118, 20, 22), 7, 2), -16, 0, 176)
    ear = moved(along_y(drum(32, 72, 92, 20, 6)), -6, 0, 96)
    return [helmet, visor, chin, crest] + left_and_right(ear)


# ---- left leg ----


def hip_yaw():
    """Drum of the hip's yaw motor, under the pelvis, with its flange."""
    return [drum(44, 22, 62, 20, 4), drum(34, 8, 26, 16, 3)]


def hip_roll():
    """Axle of the hip's roll joint and the block that carries the pitch motor."""
    return [along_x(drum(34, -64, 64, 16, 5)), moved(chamfered_box((76, 62, 64), 12, 1), 0, 10, -4)]


def thigh():
    """Thigh: leans from the hip joint to the knee, which lies 35 mm further out."""
    shell = limb([(8, 66, 54, 4, 31), (-40, 76, 58, 6, 32), (-100, 78, 58, 6, 33), (-170, 70, 54, 4, 34),
                  (-232, 58, 50, 0, 35), (-258, 50, 48, -2, 35)], 24, 2.7, (34, 18), 3)
    guard = moved(pitched(chamfered_box((16, 70, 120), 7, 2), -5), 80, 34, -120)
    return [shell, guard]


def shank():
    """Knee drum, knee cap, calf, shin guard and the fork of the ankle."""
    knee = along_y(drum(48, -49, 49, 24, 6))
    cap = moved(pitched(chamfered_box((26, 72, 70), 11, 2), 6), 44, 0, -4)
    calf = limb([(-30, 48, 46, 0, 0), (-80, 60, 51, -8, 0), (-130, 62, 52, -10, 0), (-190, 52, 47, -6, 0),
                 (-235, 42, 42, -2, 0), (-252, 38, 42, 0, 0)], 24, 2.7, (12, 10))
    shin = moved(pitched(chamfered_box((18, 56, 130), 7, 2), 4), 50, 0, -128)
    fork = moved(chamfered_box((46, 10, 84), 4, 1), 0, 44, -278)
    return [knee, cap, calf, shin] + left_and_right(fork)


def ankle():
    """Cross of the ankle's pitch (y) and roll (x) axles."""
    return [along_y(drum(26, -38, 38, 12, 4)), along_x(drum(22, -40, 40, 12, 4))]


def foot():
    """Sole 105 mm below the ankle, 240 mm long; shell with instep and toe cap; brackets of the roll axle."""
    print_ = sole_outline(100, 140, 64, 70, 28)
    sole = loft([section(print_, -105, 0.5), section(print_, -105, 0.97), section(print_, -101),
                 section(print_, -88), section(print_, -85, 0.98)])
    shell = loft([section(print_, -86, 0.95), section(print_, -72, 0.93),
                  section(sole_outline(88, 112, 56, 60, 28), -54), section(sole_outline(70, 62, 46, 48, 28), -36),
                  section(sole_outline(52, 40, 36, 38, 28), -28)])
    bracket = moved(along_x(drum(27, -6, 6, 16, 2)), 0, 2, 0)
    stem = moved(chamfered_box((14, 50, 40), 4, 0), 0, 2, -24)
    brackets = [moved(part, x) for x in (-48, 48) for part in (bracket, stem)]
    return [sole, shell] + brackets


# ---- left arm, hanging; the palm faces the body ----


def shoulder_pitch():
    """Drum of the shoulder's pitch motor, on the chest's mount, and the plate of the roll joint."""
    return [along_y(drum(46, -82, -58, 20, 5)), along_y(drum(36, -60, -30, 16, 3))]


def shoulder_roll():
    """Shoulder cap: the robot's widest place, 621 mm from side to side, and the roll axle."""
    cap = superellipsoid(60, 60.5, 58, 2.5, 24, 7)
    return [cap, along_x(drum(24, -68, 68, 16, 4))]


def upper_arm():
    """Upper arm with the two cheeks of the elbow."""
    shell = limb([(-52, 45, 46, 0, 0), (-110, 46, 47, 0, 0), (-165, 42, 44, 0, 0), (-205, 38, 42, 0, 0)],
                 20, 2.7, (10, 8))
    cheek = moved(along_y(drum(32, -6, 6, 20, 2)), 0, 38, -250)
    strap = moved(chamfered_box((52, 12, 62), 4, 1), 0, 38, -220)
    return [shell] + left_and_right(cheek) + left_and_right(strap)


def forearm():
    """Elbow drum and the near half of the forearm, down to the wrist's yaw bearing."""
    return [along_y(drum(30, -31, 31, 20, 4)),
            limb([(-18, 34, 31, 0, 0), (-50, 41, 40, 0, 0), (-80, 41, 40, 0, 0), (-104, 38, 38, 0, 0)], 20, 2.7,
                 (8, 0)),
            moved(chamfered_box((12, 46, 56), 5, 1), 40, 0, -70)]


def wrist_yaw():
    """Far half of the forearm, with a cuff; turns about the forearm's own axis."""
    return [drum(40, -26, -4, 20, 4),
            limb([(-22, 36, 35, 0, 0), (-70, 34, 32, 0, 0), (-104, 29, 27, 0, 0)], 20, 2.7, (0, 8)),
            moved(along_y(drum(19, -31, 31, 16, 3)), 0, 0, -132),
            *(moved(chamfered_box((26, 8, 44), 3, 0), 0, y, -116) for y in (-25, 25))]


def hand():
    """Palm and the fixed thumb, which stands on the palm's inner side (-y)."""
    axle = along_y(drum(16, -18, 18, 16, 3))
    palm = moved(chamfered_box((82, 34, 70), 10, 2), 0, 2, -50)
    wrist = limb([(-6, 18, 14, 0, 0), (-24, 26, 15, 0, 1)], 16, 2.7, (4, 0))
    knuckles = moved(along_x(drum(13, -40, 40, 16, 3)), 0, 8, -94)
    thumb_base = moved(rolled(limb([(10, 15, 13, 0, 0), (-26, 13, 12, 0, 0)], 12, 2.5, (6, 5)), -30), 12, -20, -56)
    thumb_tip = moved(limb([(10, 12, 11, 0, 0), (-34, 10, 9, 0, 4)], 12, 2.5, (5, 8)), 12, -36, -92)
    return [axle, wrist, palm, knuckles, thumb_base, thumb_tip]


def fingers():
    """Three fingers on one axle, slightly bent inward."""
    parts = [along_x(drum(10, -37, 37, 12, 2))]
    for x in (-26, 0, 26):
        length = 74 if x == 0 else 68
        near = moved(limb([(-4, 11, 10, 0, 0), (-0.52 * length, 10, 9.5, 0, -1)], 12, 2.6, (5, 4)), x)
        tip = moved(limb([(-0.55 * length, 9.5, 9, 0, -2), (-length, 8, 7.5, 0, -8)], 12, 2.6, (5, 7)), x)
        parts += [near, tip]
    return parts


# Central links and left limbs by name.
BUILDERS = {
    "BODY": body, "CHEST_LINK0": chest_yaw, "CHEST_LINK1": chest, "HEAD_LINK0": neck, "HEAD_LINK1": head,
    "LLEG_LINK0": hip_yaw, "LLEG_LINK1": hip_roll, "LLEG_LINK2": thigh, "LLEG_LINK3": shank,
    "LLEG_LINK4": ankle, "LLEG_LINK5": foot,
    "LARM_LINK0": shoulder_pitch, "LARM_LINK1": shoulder_roll, "LARM_LINK2": upper_arm, "LARM_LINK3": forearm,
    "LARM_LINK4": wrist_yaw, "LARM_LINK5": hand, "LARM_LINK6": fingers,
}


def link_parts(name):
    """The link's parts on the 0.1 mm grid, in its own frame [mm]."""
    if name.startswith("R"):
        return [mirrored(part) for part in link_parts("L" + name[1:])]
    return [finished(part) for part in BUILDERS[name]()]

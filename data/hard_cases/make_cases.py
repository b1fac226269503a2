#!/usr/bin/env python3
"""Writes the *.case files beside it from the numbers of the published reports. Usage: make_cases.py

A cylinder becomes the prism over a regular 32-gon inscribed in its base: distance codes for polyhedra know no
cylinders, and the prism keeps the report's parallel features and sizes.
"""
import argparse
import math
from pathlib import Path

FOLDER = Path(__file__).parent
SHARP = "a query for the signed distance throws: the origin is outside of the polytope"

argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter).parse_args()  # takes none


def box(x, y, z):
    return [((i & 1) * x - x / 2, (i >> 1 & 1) * y - y / 2, (i >> 2 & 1) * z - z / 2) for i in range(8)]


def cylinder(radius, length, axis=2, sides=32):
    points = []
    for k in range(sides):
        angle = 2 * math.pi * k / sides
        for end in (-length / 2, length / 2):
            p = [radius * math.cos(angle), radius * math.sin(angle)]
            p.insert(axis, end)
            points.append(tuple(p))
    return points


def at(x, y, z):
    return [1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z]


def quaternion(w, x, y, z, t):
    n = math.sqrt(w * w + x * x + y * y + z * z)
    w, x, y, z = w / n, x / n, y / n, z / n
    return [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), t[0],
            2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), t[1],
            2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), t[2]]


def about_z(angle, t):
    return quaternion(math.cos(angle / 2), 0, 0, math.sin(angle / 2), t)


def write(name, report, said, first, second, placements, radii=None, facets=None):
    lines = [f"report {report}", f"said {said}"]
    if radii:
        lines.append("radii {!r} {!r}".format(*radii))
    for number, (pose_a, pose_b) in enumerate(placements):
        if number:
            lines.append("next")
        for which, (points, pose) in enumerate(((first, pose_a), (second, pose_b))):
            lines.append("body")
            if not number:
                lines += ["v {!r} {!r} {!r}".format(*map(float, p)) for p in points]
                lines += ["f " + " ".join(map(str, f)) for f in (facets or [[], []])[which]]
            lines.append("pose " + " ".join(repr(float(x)) for x in pose))
    (FOLDER / f"{name}.case").write_text("\n".join(lines) + "\n")


IDENTITY = at(0, 0, 0)
FCL, DRAKE = "flexible-collision-library/fcl", "RobotLocomotion/drake"

write("fcl_293", f"{FCL}#293 boxes", "the nearest points are NaN: the last simplex is a segment taken for a triangle",
      box(2.75, 6, 0.05), box(0.424, 0.15, 0.1686),
      [(at(1.625, 0, 0.5), quaternion(0.672811, 0.340674, 0.155066, 0.638138, (0.192074, -0.277870, 0.273546)))])

write("fcl_319", f"{FCL}#319 box and cylinder",
      "expandPolytope throws 'this should not happen': nearest point and new vertex both on an edge",
      box(0.05, 0.39, 1.47), cylinder(0.18, 0.18),
      [(quaternion(0.707107, 0, 0, 0.707107, (0.8, -0.385, 0.735)),
        quaternion(0.991445, 0, 0, -0.130526, (0.4, -0.4, 0.93)))])

DOOR = [0, -1, 0, 0.8, 1, 0, 0, -0.4575, 0, 0, 1, 1.0225]
write("fcl_319_can", f"{FCL}#319 cylinder and door, comment of 2019-03-27",
      "expandPolytope throws: touching contact that should have been identified before",
      cylinder(0.05, 0.06), box(0.025, 0.35, 1.845),
      [([-0.99999999997999022838, 6.2572835802045040178e-10, 6.3260669852976095481e-06, 0.57500009756757608503,
         6.3260669851683709551e-06, -6.3943303429958554955e-10, 0.99999999997999056145, -0.42711963046787942977,
         6.2573180158128459924e-10, 1, 6.3942912945996747041e-10, 1.1867093358746836351], DOOR)])
write("fcl_390_can", f"{FCL}#390 cylinder and door, comment of 2019-04-10", SHARP,
      cylinder(0.05, 0.06), box(0.025, 0.35, 1.845),
      [([-0.97313010759279283679, -0.12202804064972551379, 0.19526123781136842106, 0.87472781461138560122,
         0.20950801135757171623, -0.11745920593569325607, 0.97072639199619581429, -0.4038687881347159947,
         -0.095520609678929752073, 0.98555187191549953329, 0.13986894183635001365, 1.5871328698116491385], DOOR)])
write("fcl_390", f"{FCL}#390 boxes", SHARP,
      box(0.03, 0.12, 0.1), box(0.025, 0.35, 1.845),
      [([-3.0627937852578681533e-08, -0.99999999999999888978, -2.8893865161583314238e-08, 0.63499979627350811029,
         0.9999999999999980016, -3.0627939739957803544e-08, 6.4729926918527511769e-08, -0.48500002215636439651,
         -6.4729927722963847085e-08, -2.8893863029448751323e-08, 0.99999999999999711342, 1.0778146458339641356],
        DOOR)])
write("fcl_395", f"{FCL}#395 boxes", "the signed query throws: triangle_size_is_zero",
      box(0.46, 0.48, 0.01), box(0.049521, 0.146, 0.0725),
      [(at(-0.721, -0.772, 0.81),
        [0.10758262492983036718, -0.6624881850015212903, -0.74130653817877356637, -0.42677133002999478872,
         0.22682184885125472595, -0.709614040775253474, 0.6670830248314786326, -0.76596851247746788882,
         -0.96797615037608542021, -0.23991106241273435495, 0.07392465377049164954, 0.80746731400091054098])])
write("fcl_398", f"{FCL}#398 boxes with parallel faces in each other", "the signed query throws",
      box(0.614, 3, 0.37), box(0.494, 0.552, 0.01), [(at(-0.675, 0, 0.9115), at(-0.692, 0, 0.935))])
write("fcl_399", f"{FCL}#399 boxes side by side", "boxes that are apart are handed to EPA: " + SHARP,
      box(0.23768037557601928711, 0.15702305734157562256, 0.25), box(0.01, 0.78165709972381591797, 0.25),
      [([-0.099432387353076273628, 0.99504432079443971837, 0, 0.29526406526565551758,
         -0.99504432079443971837, -0.099432387353076273628, 0, -0.013230856508016586304, 0, 0, 1, 0],
        [0.99506598442099225554, 0.099215354901756730444, 0, 0.22759585694545214629,
         -0.099215354901756730444, 0.99506598442099225554, 0, 0.14974093549228112421, 0, 0, 1, 0])])
write("fcl_415", f"{FCL}#415 boxes", "the signed query throws: the new vertex is colinear with an existing edge",
      box(0.02, 0.33, 0.02), box(0.452, 0.27, 0.42),
      [(at(0.053999999999999936939, -0.77200000000000001954, 0.40500000000000002665),
        at(0.12099999999999999645, -0.62960505750432682603, 0.29999999999999998890))])
write("fcl_415_turned", f"{FCL}#415 turned boxes", "the signed query throws: query point colinear with the edge",
      box(0.49, 0.05, 0.21), box(0.035, 0.12, 0.03),
      [([4.8966386501092529215e-12, -1, 0, -0.43999999999999994671, 1, 4.8966386501092529215e-12, 0,
         -0.61499999999858001587, 0, 0, 1, 0.35499999999999998224],
        [0.83512153565236335595, -0.55006546945762568868, -9.4542360608233572896e-16, -0.40653441507331000704,
         0.55006546945762568868, 0.83512153565236313391, 1.1787444236552387666e-15, -0.69166166923735727945,
         1.2902271444330665572e-16, -1.4878153530113264589e-15, 1, 0.43057093858718892276])])
write("fcl_428", f"{FCL}#428 boxes", "the signed query throws",
      box(0.2, 0.33, 0.1), box(0.452, 0.27, 0.6),
      [(at(-0.071000000000000035305, -0.77200000000000001954, 0.79999999999999993339),
        at(0.12099999999999999645, -0.78769605692727695523, 0.53422044196125151316))])
write("fcl_445", f"{FCL}#445 boxes that touch", SHARP,
      box(0.3165, 0.2276, 0.1768), box(0.4943, 0.3546, 0.0752),
      [([0.44540578475530234748, 0.89532881496493399442, -8.8937407685638678971e-09, 1.2652949075960071568,
         -0.89532881496493377238, 0.44540578475530190339, -2.8948680226084145336e-08, 1.4551012423210101243,
         -2.1957263975186326105e-08, 2.0856732016652919226e-08, 0.99999999999999955591, 0.49480006232932938204],
        [0.44171122913485860728, 0.8971572827861190591, -1.622764514865468214e-09, 1.1304016226141906376,
         -0.8971572827861190591, 0.44171122913485860728, -5.1621053952306079594e-09, 1.8410802645284281009,
         -3.9144271413829990148e-09, 3.7360349218094348098e-09, 1, 0.44400006232932492933])])
TILTED = (0.96193976625564348026, 0.15401279915737359216, 0.22572537250328919556,
          -0.19134171618254486313, 0.96936494951283913579, 0.15401279915737359216,
          -0.19509032201612822033, -0.19134171618254486313, 0.96193976625564348026)


def turned(r, x, y, z):
    return [*r[0:3], x, *r[3:6], y, *r[6:9], z]


write("fcl_493", f"{FCL}#493 tilted boxes that touch", SHARP, box(0.5, 0.5, 0.5), box(0.5, 0.5, 0.5),
      [(turned(TILTED, 2.0770063995786869349, 0.48468247475641951239, 1.1543291419087275962),
        turned(TILTED, 2, 0, 1.25))])
TILTED2 = (0.94096063217417758029, 0.29296840037289501035, 0.16959541586174811667,
           -0.23569836841299879326, 0.92661523595848427348, -0.29296840037289506586,
           -0.2429801799032638987, 0.23569836841299884878, 0.94096063217417758029)
write("fcl_495", f"{FCL}#495 tilted boxes an epsilon apart", "GJK says touching, EPA says apart, the query throws",
      box(0.25, 0.25, 0.25), box(0.25, 0.25, 0.25),
      [(turned(TILTED2, 0.073242100093223821977, 0.2316538089896212349, 1.3089245921032497399),
        turned(TILTED2, 0, 0, 1.25))])
write("fcl_508", f"{FCL}#508 unit boxes along y and z",
      "the distance of two unit boxes 4 m apart is 3.16228 instead of 3: the stop compares two norms",
      box(1, 1, 1), box(1, 1, 1), [(at(0, 4, 0), IDENTITY), (at(0, 0, 4), IDENTITY), (at(0, 1.99, 0), IDENTITY)])

write("drake_21673_boxes", f"{DRAKE}#21673 box on a wall, comment of 2024-09-25", SHARP,
      box(0.05, 0.55, 0.3), box(0.25, 0.2, 0.15),
      [([0.00079632671073326442932, -0.99999968293183538748, 0, 0.75000000000000055511, 0.99999968293183538748,
         0.00079632671073326442932, 0, -2.4083553715553102684e-15, 0, 0, 1, 0.15],
        [6.1232339957367660359e-17, 0, 1, 0.75, -1, 6.1232339957367660359e-17, 6.1232339957367660359e-17, 0,
         -6.1232339957367660359e-17, -1, 3.7493994566546440196e-33, 0.15])])
write("drake_21234", f"{DRAKE}#21234 cylinder and shelf", SHARP, cylinder(0.041, 0.17), box(0.3, 0.6, 0.016),
      [([0.62286449762754547699, 0.71651535568044355529, -0.31407891153229777759, 0.20238033346825459735,
         -0.20605566270224237591, -0.23703718387133412837, -0.94939688083050233214, 0.027845683594011010065,
         -0.75470582445316081177, 0.65606334948423605802, 4.0172294049188053423e-17, 0.3114233939246693339],
        at(0.4, 0, 0.26885000000000003340))])
write("drake_1668", f"{DRAKE}#1668 cubes that overlap at a corner",
      "20 contacts, most of them outside of the overlap, against one pair of deepest points",
      box(20, 20, 20), box(10, 10, 10), [(IDENTITY, at(14, 14, 14))], radii=(0.1, 500))
write("python_fcl_28", "BerkeleyAutomation/python-fcl#28 long boxes",
      "the nearest points are not as far apart as the distance says",
      box(20, 5, 1000), box(5, 5, 1000),
      [(about_z(math.pi / 3, (-2, 0, 0)), at(-5, 10, 0)), (about_z(math.pi / 3, (-2, 0, 0)), at(-15, 15, 0))],
      radii=(0.1, 1e5))

write("libccd_25", "danfis/libccd#25 cubes on top of each other",
      "ccdGJKPenetration returns depth 0 and a direction of NaN; the depth is 0.1",
      box(2, 2, 2), box(2, 2, 2), [(IDENTITY, at(0, 0, 1.9))], radii=(0.01, 100))
write("coal_604", "coal-library/coal#604 boxes in a stack",
      "with a tolerance of 1e-6 the distance of two close boxes is totally wrong",
      box(0.363, 0.277, 0.363), box(0.363, 0.363, 0.277),
      [([0.9999195703, 0.01021849413, 0.007512347878, 1.503354966, -0.01021878248, 0.9999477869, -3.329855922e-17,
         -0.8531707835, -0.007511955635, -7.676704888e-05, 0.9999717819, 0.7700092418],
        [0.9998670967, -0.01297708324, 0.009868343982, 1.48838308, 0.01297771517, 0.9999157859, 5.255670031e-17,
         -1.102020834, -0.009867512928, 0.0001280685574, 0.9999513067, 0.4497073799])])
write("coal_144", "coal-library/coal#144 cubes that just overlap; coal-library/coal#325",
      "one contact in a corner of the common face; where vertex meets vertex the distance is minus infinity",
      box(2, 2, 2), box(2, 2, 2), [(IDENTITY, at(1.9999, 0, 0)), (IDENTITY, at(2, 2, 2))], radii=(0.01, 100))
write("ncollide_157", "dimforge/ncollide#157 cuboid in a cylinder",
      "distance 0 and 'intersecting', but no contact; farther from the origin only",
      cylinder(0.5, 1.85, axis=1), box(0.1, 1.5, 1), [(at(10.97, 0.925, 61.02), at(11.5, 0.75, 60.5)),
                                                     (at(10.97, 0.925, 1.02), at(11.5, 0.75, 0.5))])
write("parry_315", "dimforge/parry#315 cubes with a common face",
      "the contact of two cubes that touch has a point in a corner and a normal along y instead of x",
      box(1, 1, 1), box(1, 1, 1), [(at(0.5, 0.5, 0.5), at(1.5, 0.5, 0.5))])
write("parry_253", "dimforge/parry#253 triangles, a vertex on a face; dimforge/parry#246", "the contact query panics",
      [(-13.174434, 1, 8.736801), (3.5251038, 1, 12.1), (3.2048466, 1, 12.218325)],
      [(-1.63, 0, 11.19), (-2.349647, 0, 11.037681), (-2.349647, 1, 11.037681)], [(IDENTITY, IDENTITY)],
      radii=(0.01, 200), facets=[[[0, 1, 2]], [[0, 1, 2]]])
write("parry_431", "dimforge/parry#431 rectangles",
      "distance 3.710461 in one order of the arguments, 3.5731668 in the other",
      [(x, y, 0) for x in (-1, 1) for y in (-1, 1)], [(x, y, 0) for x in (-1, 1) for y in (-2, 2)],
      [(IDENTITY, at(-5.573167, 0, 0))], radii=(0.01, 50))

write("distance3d_27", "AlexanderFabisch/distance3d#27 random octahedra", "under the title 'GJK error': a minimal example on which GJK ends in an error",
      [(1.9408982677575293, 1.7555630101186028, 0.18558370457138618),
       (0.8325772811802072, 0.07348739881751665, 1.7363835855830982),
       (0.4647979626331866, 0.7802364656205514, 0.7683352436509485),
       (1.8147849498111688, 0.1710650007346617, 1.802196858095821),
       (0.05742372721610556, 1.6599005060005285, 0.014474511746654706),
       (1.5270861966500002, 0.4945624540164677, 0.7162419894551117)],
      [(0.13746727993941066, 0.20129636190312772, 0.34482818309629215),
       (0.5315223185064999, 0.859293459032485, 0.6275795914219559),
       (0.5810087058274663, 0.42871589938255994, 0.6201313431197037),
       (0.48395328848552066, 0.35710287272501984, 0.27586601014041534),
       (0.1586377710691551, 0.6421620047252284, 0.6487788989727401),
       (0.5185197562895357, 0.058044153658207476, 0.4020269780737239)], [(IDENTITY, IDENTITY)])
write("distance3d_72", "AlexanderFabisch/distance3d#72 a long box through a turned one",
      "two trivial overlapping boxes trigger an assertion",
      [(x, y, z) for x in (-119.5, -89.5) for y in (-120.5, -119.5) for z in (-119.5, -120.5)],
      [(-90.0, -120.14644661, -120.85355335), (-90.0, -120.85355339, -120.14644656),
       (-90.70710679, -119.64644658, -120.35355338), (-90.70710679, -120.35355336, -119.64644659),
       (-89.29289321, -119.64644664, -120.35355341), (-89.29289321, -120.35355342, -119.64644662),
       (-90.0, -119.14644661, -119.85355344), (-90.0, -119.85355339, -119.14644665)],
      [(IDENTITY, IDENTITY)], radii=(0.01, 1000))
write("opengjk_3", "MattiaMontanari/openGJK#3 polygons in one plane", "distance 0.508965 for polygons that intersect",
      [(0.795121, -0.727851, 0), (-0.178424, -0.989183, 0), (-0.412644, -0.770664, 0), (0.566564, 0.548772, 0)],
      [(-0.211223, -0.511346, 0), (-0.347973, 0.45872, 0), (0.277308, 0.969689, 0)], [(IDENTITY, IDENTITY)])
OUTER = ((90945.08, 54122.54), (91077.46, 53745.082), (91454.92, 53877.46), (91322.54, 54254.918))
INNER = ((90919.64, 54037.383), (91162.62, 53719.637), (91480.36, 53962.617), (91237.38, 54280.363))
write("opengjk_52", "MattiaMontanari/openGJK#52 overlapping prisms far from the origin",
      "distance 0.0032915 for polyhedra that overlap by hundreds of units",
      [(x, y, z) for z in (300, 0) for x, y in OUTER], [(x, y, z) for z in (300, 0) for x, y in INNER],
      [(IDENTITY, IDENTITY)], radii=(1, 1e5))
write("dolfinx_3653", "FEniCS/dolfinx#3653 a point and a hull of seven", "GJK ends in: max iteration limit reached",
      [(44.2919, 39.7508, 18.8208)],
      [(46.0659, 38.6251, 16.3637), (44.2764, 42.3867, 18.239), (50.0397, 38.4649, 19.9843),
       (47.1963, 40.4563, 19.1057), (48.0266, 38.5593, 18.2475), (45.1735, 40.495, 17.3336),
       (48.0415, 40.4456, 18.1963)], [(IDENTITY, IDENTITY)], radii=(0.01, 200))
HULL = [(-0.0611590669, -0.13801524, -0.158372656), (0.0620514415, 0.135089189, -0.159879193),
        (-0.105518319, -0.100999095, -0.188289702), (-0.107238553, -0.102976903, 0.1569262),
        (-0.0851279497, -0.122304708, 0.156887323), (-0.0590926372, -0.104567274, -0.242715642)]
QUATERNION = (0.5425650813, 0.0029009761, 0.0001424328, 0.8400087479)
write("mujoco_warp_1527", "google-deepmind/mujoco_warp#1527 hulls of six points",
      "a small positive distance for meshes that overlap (in its own frame of the mesh; here as the vertices stand)", HULL, HULL,
      [(quaternion(*QUATERNION, (-0.141666584, 0, 0)), quaternion(*QUATERNION, (0.141666584, 0, 0)))])
write("mujoco_warp_1430", "google-deepmind/mujoco_warp#1430 a small box on a large one",
      "the larger the ground, the deeper boxes sink in before a contact is found, and in the end none is",
      box(200, 200, 0.5), box(0.2, 0.2, 0.2),
      [(at(0, 0, 0.25), at(0, 0, 0.6 + gap)) for gap in (0, -1e-6, -1e-4, -1e-3, 1e-4)], radii=(0.01, 1e4))
write("mujoco_warp_1649", "google-deepmind/mujoco_warp#1649 cubes", "the distance is off by the geometries' margins",
      box(1, 1, 1), box(1, 1, 1), [(IDENTITY, at(3, 0, 0))])

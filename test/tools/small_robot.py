"""Small robots, as the texts of their URDFs and meshes."""


def link(name, *geometries):
    shapes = "".join(f"<collision><geometry>{geometry}</geometry></collision>" for geometry in geometries)
    return f'<link name="{name}">{shapes}</link>'


def joint(name, parent, child, kind="revolute", origin="0 0 0", axis="1 0 0", limits=(-1, 1)):
    return (f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/><origin xyz="{origin}"/><axis xyz="{axis}"/>'
            f'<limit lower="{limits[0]}" upper="{limits[1]}" effort="1" velocity="1"/></joint>')


def box_obj(side, *middles):
    """One OBJ mesh of several boxes, each of triangles that face outward."""
    text = ""
    for k, middle in enumerate(middles):
        for x in (-side, side):
            for y in (-side, side):
                for z in (-side, side):
                    text += "v %.9g %.9g %.9g\n" % (middle[0] + x, middle[1] + y, middle[2] + z)
        for a, b, c, d in ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)):
            for corners in ((a, b, c), (a, c, d)):
                text += "f " + " ".join(str(v + 8 * k) for v in corners) + "\n"
    return text

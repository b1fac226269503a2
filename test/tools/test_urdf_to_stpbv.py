"""urdf_to_stpbv as a user runs it.

    test_urdf_to_stpbv.py PROGRAM REPORT
"""
import hashlib
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import time
import unittest
from xml.etree import ElementTree

import numpy as np

from small_robot import box_obj
from tool_case import ToolCase

PROGRAM, REPORT = sys.argv[1:3]
# The programs' mesh readers have single precision: 6e-8 for coordinates of up to 1 m, plus a margin.
ROUNDING = 2e-7


def read_obj(path):
    vertices, faces = [], []
    for line in pathlib.Path(path).read_text().splitlines():
        words = line.split()
        if words and words[0] == "v":
            vertices.append([float(w) for w in words[1:4]])
        elif words and words[0] == "f":
            faces.append([int(w.split("/")[0]) - 1 for w in words[1:4]])
    return np.array(vertices), np.array(faces)


def outside(points, hull):
    """Largest distance of points outside the planes of a convex mesh that faces outwards; negative if all are inside."""
    vertices, faces = hull
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return np.max(points @ normals.T - np.sum(normals * a, axis=1), axis=1)


class Conversion(ToolCase):
    def setUp(self):
        super().setUp()
        self.folder = pathlib.Path(self.folder)
        self.place = self.folder / "robots" / "gate"
        self.place.mkdir(parents=True)
        self.out = self.folder / "out"

    def run_tool(self, *arguments, tool=PROGRAM, **options):
        return self.run_command(tool, *arguments, **options)

    def convert(self, *arguments, **options):
        return self.run_tool(self.place / "gate.urdf", "-o", self.out, "--samples", "50", *arguments, **options)

    def report(self, urdf, *arguments):
        done = self.run_tool(urdf, "-r", "0.01", "--samples", "50", "--format", "json", *arguments, tool=REPORT)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        return done.returncode, json.loads(done.stdout)

    def gate(self):
        """A box that slides through a gate of two posts, and a fork that turns beside them; with visuals, a capsule and a scale."""
        (self.place / "gate.obj").write_text(box_obj(0.1, (-0.3, 0, 0), (0.3, 0, 0)))
        (self.place / "box.obj").write_text(box_obj(50, (0, 0, 0)))
        (self.place / "fork.obj").write_text(box_obj(0.05, (0, 0, 0), (0.3, 0, 0.02), (0.6, 0, 0.05)))
        (self.place / "gate.urdf").write_text(
            '<robot name="gate"><link name="gate">'
            '<visual><geometry><mesh filename="gate.obj"/></geometry><material name="red"/></visual>'
            '<collision name="posts"><geometry><mesh filename="gate.obj"/></geometry></collision>'
            '<collision><origin xyz="0 3 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>'
            '<link name="box"><collision><geometry><mesh filename="box.obj" scale="0.001 0.001 0.001"/></geometry></collision></link>'
            '<link name="my fork/2"><collision><origin xyz="0 0 0.5" rpy="0.3 -0.2 1"/>'
            '<geometry><mesh filename="fork.obj" scale="1 -1 1"/></geometry></collision></link>'
            '<link name="carriage"><collision><origin xyz="0 5 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>'
            '<joint name="spin" type="revolute"><parent link="carriage"/><child link="box"/><axis xyz="0 0 1"/>'
            '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
            '<joint name="slide" type="prismatic"><parent link="gate"/><child link="carriage"/><axis xyz="0 0 1"/>'
            '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
            '<joint name="turn" type="revolute"><parent link="gate"/><child link="my fork/2"/><origin xyz="0 1 0"/>'
            '<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint></robot>')
        return self.place / "gate.urdf"

    def manifest(self):
        return json.loads((self.out / "manifest.json").read_text())

    def states(self, folder):
        """Data that show whether a file was written again."""
        return {str(p.relative_to(folder)): (p.stat().st_mtime_ns, p.stat().st_ino, p.read_bytes())
                for p in folder.rglob("*") if p.is_file()}

    def test_a_second_run_repeats_the_warnings(self):
        urdf = self.gate()
        urdf.write_text(urdf.read_text().replace('lower="-1" upper="1"', 'lower="0" upper="0"'))
        first, second = self.convert(), self.convert()
        self.assertIn("is up to date", second.stdout)
        self.assertIn("they never move", first.stderr)
        self.assertEqual(second.stderr, first.stderr)
        self.assertTrue(self.manifest()["warnings"])

    def test_the_parts_are_convex_cover_the_mesh_and_keep_within_their_bounds(self):
        self.gate()
        done = self.convert("--parts", "4")
        self.assertEqual(done.returncode, 0, done.stderr)
        rng = np.random.default_rng(1)
        manifest = self.manifest()
        entries = {link["body"]: link for link in manifest["links"]}
        self.assertEqual({name: len(e.get("parts", [])) for name, e in entries.items()},
                         {"gate": 2, "gate#2": 0, "box": 1, "my fork/2": 3, "carriage": 0})
        for name, scale in (("gate", (1, 1, 1)), ("box", (0.001,) * 3), ("my fork/2", (1, -1, 1))):
            entry = entries[name]
            vertices, faces = read_obj(entry["mesh"])
            self.assertEqual(entry["mesh_sha256"], hashlib.sha256(pathlib.Path(entry["mesh"]).read_bytes()).hexdigest())
            self.assertEqual(entry["scale"], list(scale))
            vertices = vertices * scale
            pick = rng.dirichlet((1, 1, 1), (2000, 1))
            points = (pick @ vertices[faces[rng.integers(len(faces), size=2000)]])[:, 0]
            hulls = [read_obj(self.out / part["collision"]) for part in entry["parts"]]
            for hull in hulls:
                self.assertLess(np.max(outside(hull[0], hull)), 1e-12)
            self.assertLess(np.max(np.min([outside(points, hull) for hull in hulls], axis=0)), ROUNDING)
            # Each mesh consists of boxes, so the distance of a point from them is known.
            boxes = [(vertices[i:i + 8].min(axis=0), vertices[i:i + 8].max(axis=0)) for i in range(0, len(vertices), 8)]
            for hull, part in zip(hulls, entry["parts"]):
                points = (pick @ hull[0][hull[1][rng.integers(len(hull[1]), size=2000)]])[:, 0]
                far = np.min([np.linalg.norm(np.maximum(0, np.maximum(low - points, points - high)), axis=1)
                              for low, high in boxes], axis=0)
                self.assertLessEqual(np.max(far), part["hull_excess_max"] + ROUNDING)
                self.assertLess(part["hull_excess_max"], 2e-4)  # each box is a part, up to the accuracy of the bound
                self.assertGreaterEqual(part["over_cover_max"], part["r"])
            self.assertAlmostEqual(entry["excess_max"], entry["hull_excess_max"]
                                   + max(part["over_cover_max"] for part in entry["parts"]), places=12)
        self.assertEqual(manifest["excess_max"], max(e.get("excess_max", 0) for e in manifest["links"]))
        self.assertIn("gate: 6 convex parts, their volumes", done.stdout)

    def test_the_report_says_the_same_of_the_output_as_of_the_robot_with_parts(self):
        urdf = self.gate()
        self.assertEqual(self.convert("--parts", "4", "-r", "0.01").returncode, 0)
        status, before = self.report(urdf, "--parts", "4")
        again, after = self.report(self.out / "gate.urdf")
        self.assertEqual(again, status)
        key = lambda pair: (pair["link1"], pair["link2"])
        pairs = {key(pair): pair for pair in before["pairs"]}
        self.assertEqual(sorted(pairs), sorted(map(key, after["pairs"])))
        for pair in after["pairs"]:
            same = pairs[key(pair)]
            self.assertEqual((pair["reason"], pair["checked"], pair["cause"]), (same["reason"], same["checked"], same["cause"]))
            # The search ends anywhere within its tolerance, and the meshes differ in their last digits.
            self.assertAlmostEqual(pair["min_distance"], same["min_distance"], delta=1e-5)
        srdf = self.run_tool(urdf, "-r", "0.01", "--samples", "50", "--parts", "4", "--format", "srdf", tool=REPORT)
        self.assertEqual((self.out / "gate.srdf").read_text(), srdf.stdout)
        self.assertIn("disable_collisions", srdf.stdout)
        # The volumes in the folder are the same as in the report.
        vertices = {l["name"]: l["vertices"] for l in before["links"] if l.get("vertices")}
        entry = next(e for e in self.manifest()["links"] if e["body"] == "gate")
        self.assertEqual([p["vertices"] for p in entry["parts"]], [vertices["gate:1"], vertices["gate:2"]])

    def test_auto_splits_only_what_a_pair_needs(self):
        self.gate()
        self.assertEqual(self.convert("--parts", "auto", "-r", "0.01").returncode, 0)
        parts = {e["body"]: len(e.get("parts", [])) for e in self.manifest()["links"]}
        self.assertEqual((parts["gate"], parts["my fork/2"]), (2, 1))
        self.assertEqual(self.report(self.out / "gate.urdf")[0], 0)
        self.assertEqual(self.convert("--parts", "none", "--force").returncode, 0)
        self.assertEqual({len(e.get("parts", [0])) for e in self.manifest()["links"]}, {1})

    def test_a_second_run_does_nothing_and_a_changed_mesh_makes_only_its_own_parts_anew(self):
        self.gate()
        self.assertEqual(self.convert("--parts", "4").returncode, 0)
        before, kept = self.states(self.out), self.states(self.folder / "cache")
        again = self.convert("--parts", "4", "--jobs", "1")
        self.assertEqual((again.returncode, again.stdout.strip()), (0, "%s is up to date" % self.out))
        self.assertEqual(self.states(self.out), before)
        (self.place / "fork.obj").write_text(box_obj(0.04, (0, 0, 0), (0.3, 0, 0.02), (0.6, 0, 0.05)))
        changed = self.convert("--parts", "4")
        self.assertIn("convex parts", changed.stdout)
        contents = lambda states: {name: state[2] for name, state in states.items() if name.startswith(("meshes", "volumes"))}
        old, new = contents(before), contents(self.states(self.out))
        self.assertEqual(old.keys(), new.keys())
        self.assertEqual({name.split("/")[1].split("_2_")[0] for name in old if old[name] != new[name]}, {"my_fork"})
        now = self.states(self.folder / "cache")
        self.assertEqual({name: now[name] for name in kept}, kept)  # none of the others was written again
        # Other options make another robot.
        self.assertIn("convex parts", self.convert("--parts", "4", "-r", "0.02").stdout)

    def test_files_that_are_the_users_are_never_replaced(self):
        self.gate()
        self.out.mkdir()
        (self.out / "notes.txt").write_text("mine")
        self.refused(self.convert(), str(self.out), "holds files that no conversion wrote")
        (self.out / "notes.txt").unlink()
        self.assertEqual(self.convert().returncode, 0)  # an empty folder is accepted like a missing one
        for name in ("notes.txt", "meshes/package.xml"):
            (self.out / name).write_text("mine")
            for force in ((), ("--force",)):
                self.refused(self.convert("-r", "0.02", *force), name, "it would be lost")
            self.assertEqual((self.out / name).read_text(), "mine")
            (self.out / name).unlink()
        srdf = self.out / "gate.srdf"
        srdf.write_text(srdf.read_text() + "<!-- mine -->")
        self.refused(self.convert(), "gate.srdf", "--force")
        self.assertIn("mine", srdf.read_text())
        self.assertEqual(self.convert("--force").returncode, 0)
        self.assertNotIn("mine", srdf.read_text())
        self.assertEqual([p.name for p in self.folder.iterdir() if p.name.startswith(".")], [])
        # The robot itself is not overwritten.
        self.refused(self.run_tool(self.place / "gate.urdf", "-o", self.place), "lies in it")
        self.refused(self.run_tool(self.place / "gate.urdf", "-o", self.folder), "lies in it")
        for name, target, says in (("input", self.place / "gate.urdf", "is a file, expected a folder"),
                                   ("loop", "loop", "a link that leads nowhere"), ("none", "nowhere", "a link that leads nowhere")):
            (self.folder / name).symlink_to(target)
            self.refused(self.run_tool(self.place / "gate.urdf", "-o", self.folder / name), says)
        self.refused(self.run_tool(self.place / "gate.urdf", "-o", self.place / "gate.obj"), "gate.obj")
        self.refused(self.run_tool(self.place / "gate.urdf", "-o", self.folder / "no" / "where"), "does not exist")
        self.refused(self.run_tool(self.place / "gate.urdf", "-o", self.place / "gate.obj" / "out"), "gate.obj is a file, expected")
        self.refused(self.run_tool(self.place / "gate.urdf", "-o", "-"), "-o -: expected the name of a folder")
        for damaged in ("{}", "", '{"program": "urdf_to_stpbv", "ke'):
            (self.out / "manifest.json").write_text(damaged)
            self.refused(self.convert(), "manifest.json: is no manifest of a conversion; name a new or an empty folder")

    def test_a_urdf_that_is_a_link_has_its_meshes_beside_the_file(self):
        self.gate()
        (self.folder / "link.urdf").symlink_to("robots/gate/gate.urdf")
        done = self.run_tool(self.folder / "link.urdf", "-o", self.out, "--samples", "50", "--parts", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        written = (self.out / "link.urdf").read_text()
        visual = re.search(r'<visual>\s*<geometry>\s*<mesh filename="([^"]*)"', written)[1]
        self.assertTrue((self.out / visual).samefile(self.place / "gate.obj"), visual)

    def test_a_robot_that_cannot_be_loaded_leaves_nothing(self):
        urdf = self.gate()
        sound = urdf.read_text()
        self.refused(self.run_tool(self.place / "none.urdf", "-o", self.out), "none.urdf")
        self.refused(self.run_tool("-", "-o", self.out, input=sound), "-: is no regular file")
        for change, says in ((lambda t: t.replace("fork.obj", "spoon.obj"), "spoon.obj"),
                             (lambda t: t.replace('lower="-1"', 'lower="x"'), "gate.urdf"), (lambda t: t[:600], "gate.urdf")):
            urdf.write_text(change(sound))
            self.refused(self.convert(), says)
            self.assertFalse(self.out.exists())
        urdf.write_text(sound)
        (self.place / "fork.obj").write_text("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.refused(self.convert(), "fork.obj")
        left_out = self.convert("--skip-invalid")
        self.assertEqual(left_out.returncode, 3, left_out.stderr)
        self.assertIn("fork.obj", left_out.stderr)
        self.assertIn("fork.obj", self.manifest()["left_out"][0])
        self.assertEqual(self.convert("--skip-invalid").returncode, 3)  # up to date, but still incomplete
        for wrong in (("--parts", "0"), ("--parts", "65"), ("--parts", "some"), ("--jobs", "0"), ("-r", "-1"), ("--effort", "1")):
            self.assertEqual(self.convert(*wrong).returncode, 2, wrong)

    def test_an_input_from_a_pipe_is_refused_as_it_is_read_more_than_once(self):
        urdf = self.gate()
        pose = self.pose({"turn": 0.5})
        srdf = self.place / "gate.srdf"
        srdf.write_text('<robot name="gate"><group name="g"><joint name="turn"/></group><group_state name="state" group="g">'
                        '<joint name="turn" value="0.5"/></group_state></robot>')
        for option, path in (("--neutral", pose), ("--srdf", srdf), ("--obstacles", urdf)):
            with self.subTest(option=option):
                self.refused(self.convert(option, "-", input=path.read_text()), "-: is no regular file")
                reading, writing = os.pipe()
                os.write(writing, path.read_bytes())
                os.close(writing)
                name = f"/dev/fd/{reading}"
                self.refused(self.convert(option, name, pass_fds=[reading]), name + ": is no regular file")
                os.close(reading)
        self.assertFalse(self.out.exists())

    def test_another_neutral_posture_is_another_robot(self):
        self.gate()
        srdf = self.place / "gate.srdf"
        srdf.write_text('<robot name="gate"><group name="g"><joint name="turn"/></group><group_state name="state" group="g">'
                        '<joint name="turn" value="0.5"/></group_state></robot>')
        (self.folder / "state").mkdir()  # a folder of its name is no posture

        def converted(*arguments):
            done = self.convert(*arguments, cwd=self.folder)
            self.assertEqual(done.returncode, 0, done.stderr)
            return "up to date" not in done.stdout

        for angle in (0.5, 0.4):
            self.assertTrue(converted("--neutral", self.pose({"turn": angle})))
            self.assertFalse(converted("--neutral", self.folder / "pose.json"))
        self.assertTrue(converted("--srdf", srdf, "--neutral", "state"))
        self.assertFalse(converted("--srdf", srdf, "--neutral", "state"))
        inside = self.out / "pose.json"
        inside.write_text('{"turn": 0.5}')
        self.refused(self.convert("--neutral", inside), "pose.json lies in it and is read")

    def test_a_damaged_urdf_is_refused_or_its_output_loads(self):
        urdf, dice = self.gate(), random.Random(5)
        sound = urdf.read_text()
        words = sound.replace("<", " <").split(" ")
        for _ in range(12):
            k = dice.randrange(len(words))
            urdf.write_text(" ".join(words[:k] + ([words[k]] * 2 if dice.random() < 0.3 else []) + words[k + 1:]))
            before = self.states(self.out)
            done = self.convert("--parts", "2", "--force")
            self.assertIn(done.returncode, (0, 2), done.stderr)
            if done.returncode == 2:
                self.assertRegex(done.stderr, r"^urdf_to_stpbv: .*gate\.urdf|no such file")
                self.assertEqual(self.states(self.out), before)
            else:
                self.assertIn(self.run_tool(self.out / "gate.urdf", "--samples", "5", tool=REPORT).returncode, (0, 1))

    def test_other_meshes_are_still_found_and_names_may_have_a_prefix(self):
        self.gate()
        self.convert("--parts", "2")
        text = (self.out / "gate.urdf").read_text()
        self.assertIn('filename="../robots/gate/gate.obj"', text)  # the visual one
        self.assertIn('name="posts_0"', text)
        self.assertIn("sphere", text)
        self.assertNotIn("scale", text)
        found = self.run_tool(self.out / "gate.urdf", "--visual", "--samples", "5", tool=REPORT)
        self.assertIn("no pair of bodies is checked", found.stderr)  # the only visual shape was found
        self.convert("--parts", "2", "--mesh-prefix", "package://gate/")
        self.assertIn('filename="package://gate/meshes/gate_1.obj"', (self.out / "gate.urdf").read_text())
        self.refused(self.convert("--mesh-prefix", "package://gate"), "package://gate: expected a / at its end")

    def test_a_visual_mesh_named_by_file_is_still_found(self):
        for name in ("file://gate.obj", f"file://{self.place}/gate.obj", f"file://localhost{self.place}/gate.obj", "file://a%20gate.obj"):
            urdf = self.gate()
            (self.place / "a gate.obj").write_bytes((self.place / "gate.obj").read_bytes())
            visual = '<visual><geometry><mesh filename="{}"/>'
            urdf.write_text(urdf.read_text().replace(visual.format("gate.obj"), visual.format(name)))
            self.convert("--parts", "2", "--force")
            found = self.run_tool(self.out / "gate.urdf", "--visual", "--samples", "5", tool=REPORT)
            self.assertIn("no pair of bodies is checked", found.stderr, name)

    def test_links_whose_names_look_like_files_of_others_keep_their_own(self):
        urdf = self.gate()
        urdf.write_text(urdf.read_text().replace('"box"', '"gate_0"'))
        self.assertEqual(self.convert("--parts", "2").returncode, 0)
        files = [part[kind] for e in self.manifest()["links"] for part in e.get("parts", []) for kind in ("collision", "volume")]
        self.assertEqual(len(files), len(set(files)))
        sizes = {e["body"]: [np.ptp(read_obj(self.out / p["collision"])[0], axis=0).max() for p in e["parts"]]
                 for e in self.manifest()["links"] if e["mesh"]}
        np.testing.assert_allclose(sizes["gate"], [0.2, 0.2])
        np.testing.assert_allclose(sizes["gate_0"], [0.1])

    def test_line_ends_and_tabs_in_names_are_references(self):
        urdf = self.gate()
        urdf.write_text(urdf.read_text().replace('"box"', '"box&#10;a&#9;b"'))
        done = self.convert("--parts", "2")
        self.assertEqual(done.returncode, 0, done)
        self.assertIn('"box&#10;a&#9;b"', (self.out / "gate.urdf").read_text())

    def test_the_pair_list_is_xml_in_whatever_encoding_the_robot_has_its_names(self):
        urdf = self.gate()
        sound = urdf.read_text().replace('"box"', '"bo\u00eete"')
        for encoding in ("ISO-8859-1", "UTF-8"):
            urdf.write_bytes(f'<?xml version="1.0" encoding="{encoding}"?>{sound}'.encode(encoding))
            for srdf in ("", '<robot name="gate"/>', '<?xml version="1.0" encoding="utf-8"?><robot name="gate"/>'):
                (self.place / "gate.srdf").write_text(srdf)
                given = ("--srdf", self.place / "gate.srdf") if srdf else ()
                done = self.run_tool(urdf, "-o", self.out, "--samples", "20", "--parts", "none", "--force", "-q", *given)
                self.assertEqual(done.returncode, 0, done.stderr)
                pairs = ElementTree.parse(self.out / "gate.srdf").getroot().iter("disable_collisions")
                self.assertIn("bo\u00eete", [name for pair in pairs for name in (pair.get("link1"), pair.get("link2"))])

    def test_files_keep_their_names_whatever_way_the_folder_is_given(self):
        urdf = self.gate()
        (self.place / "red.png").write_bytes(b"")
        urdf.write_text(urdf.read_text().replace('<material name="red"/>',
                                                 '<material name="red"><texture filename="red.png"/></material>'))
        (self.folder / "a").mkdir()
        for out in ("new", "new2/", "./new3", "a/new4", str(self.folder / "new5")):
            done = self.run_tool("robots/gate/gate.urdf", "-o", out, "--samples", "5", cwd=self.folder)
            self.assertEqual(done.returncode, 0, done)
            written = self.folder / out
            names = re.findall(r'filename="([^"]*)"', (written / "gate.urdf").read_text())
            self.assertIn("red.png", [pathlib.Path(name).name for name in names])
            for name in names:
                self.assertTrue((written / name).is_file(), (out, name))

    def test_in_a_folder_that_was_moved_other_meshes_are_found_again(self):
        self.gate()
        self.assertEqual(self.convert("--parts", "none").returncode, 0)
        (self.folder / "deep").mkdir()
        self.out = self.out.rename(self.folder / "deep" / "out")
        self.assertIn("convex parts, no link was split, their volumes", self.convert("--parts", "none").stdout)
        visual = re.search(r'<visual>\s*<geometry>\s*<mesh filename="([^"]*)"', (self.out / "gate.urdf").read_text())[1]
        self.assertTrue((self.out / visual).samefile(self.place / "gate.obj"), visual)

    def test_a_robot_of_primitives_is_said_to_have_no_meshes(self):
        ball = '<link name="%s"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>'
        (self.place / "gate.urdf").write_text(
            '<robot name="gate">' + ball % "a" + ball % "b" + '<joint name="j" type="prismatic"><parent link="a"/>'
            '<child link="b"/><origin xyz="1 0 0"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>')
        done = self.convert()
        self.assertEqual(done.returncode, 0, done)
        self.assertIn("gate: no meshes; 0 of 1 pairs checked -> ", done.stdout)

    def test_visual_shapes_become_collision_shapes(self):
        (self.place / "gate.obj").write_text(box_obj(0.1, (-0.3, 0, 0), (0.3, 0, 0)))
        (self.place / "gate.urdf").write_text(
            '<robot name="gate"><link name="gate"><visual><geometry><mesh filename="gate.obj"/></geometry>'
            '<material name="red"/></visual></link><link name="ball"><visual><geometry><sphere radius="0.05"/></geometry></visual>'
            '</link><joint name="slide" type="prismatic"><parent link="gate"/><child link="ball"/><origin xyz="0 1 0"/>'
            '<axis xyz="0 1 0"/><limit lower="-2" upper="0" effort="1" velocity="1"/></joint></robot>')
        done = self.convert("--parts", "2", "-r", "0.01", "--neutral", str(self.pose({"slide": -1.2})))
        self.assertEqual(done.returncode, 0, done)
        self.assertIn("0 of 1 pairs checked", done.stdout)  # the two links are adjacent
        self.assertEqual(self.manifest()["pairs"]["checked"], 0)
        text = (self.place / "gate.urdf").read_text().replace(
            "</robot>", '<link name="far"><visual><geometry><box size="1 1 1"/></geometry></visual></link><joint name="j" '
            'type="prismatic"><parent link="ball"/><child link="far"/><origin xyz="9 0 0"/><limit lower="0" upper="1" effort="1" '
            'velocity="1"/></joint></robot>')
        (self.place / "gate.urdf").write_text(text)
        self.assertEqual(self.convert("--parts", "2", "-r", "0.01").returncode, 0)
        status, found = self.report(self.out / "gate.urdf")
        self.assertEqual(sorted(l["name"] for l in found["links"]), ["ball", "far", "gate", "gate#2"])
        self.assertEqual(found["warnings"], [])
        self.assertEqual(status, 0)

    def pose(self, joints):
        path = self.folder / "pose.json"
        path.write_text(json.dumps(joints))
        return path

    def start_and_wait_for_parts(self, count):
        """Starts a conversion that takes seconds, and waits until at least `count` parts are in the cache."""
        urdf = self.gate()
        links = "".join('<link name="l%d"><collision><geometry><mesh filename="many%d.obj"/></geometry></collision></link>'
                        '<joint name="k%d" type="revolute"><parent link="gate"/><child link="l%d"/><origin xyz="0 %d 0"/>'
                        '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>' % (k, k, k, k, 4 * k + 9) for k in range(6))
        urdf.write_text(urdf.read_text().replace("</robot>", links + "</robot>"))
        for k in range(6):
            turns = [(0.3 * np.cos(i + k), 0.3 * np.sin(i + k), 0.03 * i) for i in range(12)]
            (self.place / ("many%d.obj" % k)).write_text(box_obj(0.06, *turns))
        cache = self.folder / "cache" / "fcl_stpbv"
        parts = lambda: {p.name: p.stat().st_mtime_ns for p in cache.glob("*.parts")} if cache.exists() else {}
        running = subprocess.Popen([PROGRAM, str(urdf), "-o", str(self.out), "--samples", "5", "--jobs", "2"],
                                   env=self.environment(), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        until = time.monotonic() + 100
        while len(parts()) < count and running.poll() is None and time.monotonic() < until:
            time.sleep(0.01)
        return running, parts

    def test_files_that_come_into_the_folder_meanwhile_are_never_replaced(self):
        running, _ = self.start_and_wait_for_parts(1)
        self.assertIsNone(running.poll())
        self.out.mkdir()
        (self.out / "notes.txt").write_text("mine")
        self.assertIn("holds files that no conversion wrote", running.communicate(timeout=100)[1])
        self.assertEqual(running.returncode, 2)
        self.assertEqual([p.name for p in self.out.iterdir()], ["notes.txt"])

    def test_an_interrupted_run_leaves_no_folder_and_its_parts_in_the_cache(self):
        running, parts = self.start_and_wait_for_parts(4)
        running.send_signal(signal.SIGINT)
        running.communicate(timeout=60)
        self.assertEqual(running.returncode, -signal.SIGINT)
        done = parts()
        self.assertGreaterEqual(len(done), 4)
        self.assertFalse(self.out.exists())
        self.assertEqual(self.run_tool(self.place / "gate.urdf", "-o", self.out, "--samples", "5").returncode, 0)
        self.assertEqual({name: time for name, time in parts().items() if name in done}, done)
        self.assertGreater(len(parts()), len(done))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)

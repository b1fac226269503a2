#!/usr/bin/env python3
"""mesh_to_stpbv as its users run it: exit codes, reports, and files whole or not at all.

usage: test_mesh_to_stpbv.py PROGRAM SOURCE_FOLDER
"""
import json
import math
import os
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import time
import unittest

from small_robot import box_obj
from terminal import shown_on_terminal
from tool_case import ToolCase

PROGRAM = SOURCE = SHARED = ""
KEYS = ["input", "points", "vertices", "edges", "faces", "r", "R", "over_cover_max", "over_cover_mean",
        "excess_max", "excess_max_open", "volume", "build_seconds", "verified"]
CUBE = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]


def read(path):
    with open(path, "rb") as file:
        return file.read()


def points_file(points):
    return "3\n%d\n" % len(points) + "".join("%r %r %r\n" % p for p in points)


class MeshToStpbv(ToolCase):
    def setUp(self):
        super().setUp()
        self.put("cube.txt", points_file(CUBE))
        self.put("other.txt", points_file([(x, 2 * y, z) for x, y, z in CUBE]))
        self.put("broken.txt", points_file(CUBE)[:40])

    def names(self, folder=""):
        return sorted(os.listdir(self.path(folder)))

    def run_tool(self, *arguments, code=0, stdin=os.devnull):
        with open(self.path(stdin), "rb") as file:
            done = self.run_command(PROGRAM, *arguments, cwd=self.folder, stdin=file)
        self.assertEqual(done.returncode, code, done.stderr + done.stdout)
        return done

    def refused(self, *arguments, says, code=2, **options):
        before = {name: os.path.isfile(self.path(name)) and read(self.path(name)) for name in self.names()}
        done = self.run_tool(*arguments, code=code, **options)
        for words in says:
            self.assertIn(words, done.stderr)
        self.assertEqual(done.stdout, "")
        after = {name: os.path.isfile(self.path(name)) and read(self.path(name)) for name in self.names()}
        self.assertEqual(before, after)

    def test_an_excess_is_kept_or_the_report_says_that_it_is_not(self):
        steps = [(x, 0) for x in range(7)] + [(6, 6)] + [(x + (k == 0), 6 - x) for x in range(5, -1, -1) for k in (0, 1)]
        corners = [(*steps[i], z) for z in (0, 1) for i in range(len(steps))]
        n = len(steps)
        sides = [(i, (i + 1) % n, n + (i + 1) % n, n + i) for i in range(n)]  # walls of a staircase, without ends
        self.put("stairs.obj", "".join("v %d %d %d\n" % p for p in corners)
                 + "".join("f %s\n" % " ".join(str(i + 1) for i in side) for side in sides))
        def made(*arguments):
            return self.run_tool("stairs.obj", "-r", "0.001", "-o", "stairs.stpbv", "--force", *arguments).stdout
        near = json.loads(made("--excess", "0.3", "--json"))
        self.assertTrue(near["excess_reached"])
        self.assertLessEqual(near["hull_excess_max"], 0.3)
        self.assertNotIn("excess_reached", json.loads(made("--parts", "2", "--json")))
        far = json.loads(made("--excess", "0.3", "--parts", "2", "--json"))
        self.assertEqual(len(far["parts"]), 2)
        self.assertFalse(far["excess_reached"])
        self.assertGreater(far["hull_excess_max"], 0.3)
        self.assertIn("NOT within the 300.000 mm asked for", made("--excess", "0.3", "--parts", "2"))
        self.assertNotIn("NOT", made("--excess", "0.3"))

    def test_radii_that_fit_the_mesh_are_those_of_the_robot_tools(self):
        # A cube of 1 cm: r is a twentieth of its side, and so is the bulge of R. For a cube of 1 m that would
        # exceed 1 cm.
        def radii(*arguments):
            report = json.loads(self.run_tool("cube.txt", "-o", "a.stpbv", "--json", "--force", *arguments).stdout)
            return report["r"], report["R"]

        ball, r = math.sqrt(3) / 2 * 0.01, 0.0005
        fitting = r + (ball ** 2 + r ** 2) / (2 * r)
        for arguments, expected in ((["-r", "auto"], (r, fitting)), (["-r", "auto", "-R", "auto"], (r, fitting)), (["-r", "auto", "-R", "5"], (r, 5))):
            for found, wanted in zip(radii("--scale", "0.01", *arguments), expected):
                self.assertAlmostEqual(found, wanted, delta=1e-6 * wanted)
        self.assertEqual(radii("-r", "auto")[0], 0.01)
        self.assertEqual(radii("-r", "0.003", "-R", "auto")[0], 0.003)
        self.assertNotEqual(radii("-r", "0.003", "-R", "auto")[1], 10)
        self.assertEqual(radii("-r", "20", "-R", "auto")[0], 20)  # above the R of 10 that holds where it is not given
        self.put("one.txt", points_file([(1, 2, 3)]))
        self.assertIn("fitted r 0 mm, R 10 m", self.run_tool("one.txt", "-o", "one.stpbv", "-r", "auto").stdout)
        self.assertIn("fitted r 10 mm, R ", self.run_tool("cube.txt", "-o", "a.stpbv", "-r", "auto", "--force").stdout)
        self.refused("cube.txt", "-o", "new.stpbv", "-r", "fit", says=["-r: got fit, expected a number from 0 to 1e+06, or auto"])
        self.run_tool("cube.txt", "-o", "cube.stpbv")
        self.refused("cube.stpbv", "-o", "new.stpbv", "-r", "auto", code=1, says=["cube.stpbv: is an STP-BV already", "leave out -r"])

    def test_advised_radii_keep_what_is_asked_for_or_nothing_is_written(self):
        task = "clearance=0.6,acceleration=1,speed=0.3,turning=1,distance=0.01,others=round"
        done = json.loads(self.run_tool("cube.txt", "-o", "cube.stpbv", "--json", "--advise", task).stdout)
        self.assertLessEqual(done["advised_acceleration"], 1)
        self.assertLessEqual(done["over_cover_max"] + done["advised_per_period"], 0.6)
        self.assertIn("advised r", self.run_tool("cube.txt", "-o", "cube.stpbv", "--advise", task, "--force").stdout)
        self.refused("cube.txt", "-o", "new.stpbv", "--advise", "clearance=0.001", code=1, says=["cube.txt", "no r and R keep both", "acceleration="])
        self.refused("cube.txt", "-o", "new.stpbv", "--advise", "clearance=0.001,period=1", code=1, says=["cube.txt", "shorter period"])
        self.refused("cube.stpbv", "-o", "new.stpbv", "--advise", task, code=1, says=["cube.stpbv", "is an STP-BV already"])
        for wrong in ("", "clearance", "clearance=0.6,", "clearance=0.6,clearance=0.7", "others=flat,others=flat",
                      "clearance=x", "clearance=0", "clearance=1e-10", "acceleration=1e-300", "speed=1e-310",
                      "clearance=nan", "speed=-1", "fast=1", "others=square", ","):
            self.refused("cube.txt", "-o", "new.stpbv", "--advise", wrong, says=["--advise"])
        for other in (["-r", "1"], ["-R", "10"], ["--parts", "2"], ["--excess", "0.1"]):
            self.refused("cube.txt", "-o", "new.stpbv", "--advise", task, *other, says=["--advise"])

    def test_one_input_is_written_to_the_named_file(self):
        done = self.run_tool("cube.txt", "-o", "cube.stpbv")
        self.assertTrue(read(self.path("cube.stpbv")).startswith(b"stpbv 1\nr 0.01\nR 10\nvertices 8\n"))
        for words in ("8 points in", "8 vertices", "12 edges", "6 faces", "volume", "over-cover max", "mean", " mm", "built in", " s"):
            self.assertIn(words, done.stdout)
        self.assertLessEqual(max(len(line) for line in done.stdout.splitlines()), 80)
        self.assertEqual(done.stderr, "")

    def test_the_same_input_gives_the_same_bytes(self):
        self.run_tool("cube.txt", "-o", "a.stpbv")
        self.run_tool("cube.txt", "-o", "b.stpbv")
        self.assertEqual(read(self.path("a.stpbv")), read(self.path("b.stpbv")))

    def test_several_inputs_go_into_a_folder(self):
        done = self.run_tool("cube.txt", "other.txt", "-o", "out/deep")
        self.assertEqual(self.names("out/deep"), ["cube.stpbv", "other.stpbv"])
        self.assertEqual([line for line in done.stdout.splitlines() if line[0] != " "],
                         [f"{name}.txt -> out/deep/{name}.stpbv" for name in ("cube", "other")])
        self.assertEqual(done.stderr, "")

    def test_one_input_goes_into_a_folder_that_exists(self):
        os.mkdir(self.path("out"))
        self.run_tool("cube.txt", "-o", "out")
        self.run_tool("cube.txt", "-o", "new/")
        self.assertEqual(self.names("out") + self.names("new"), ["cube.stpbv", "cube.stpbv"])

    def test_json_has_exactly_the_documented_keys(self):
        report = json.loads(self.run_tool("cube.txt", "-o", "a.stpbv", "--json", "-r", "0.02", "-R", "5").stdout)
        self.assertEqual(list(report), KEYS)
        self.assertEqual([report[key] for key in KEYS[:7]], ["cube.txt", 8, 8, 12, 6, 0.02, 5])
        self.assertIsNone(report["verified"])
        self.assertGreater(report["over_cover_max"], report["over_cover_mean"])
        self.assertGreater(report["over_cover_mean"], 0.02)
        self.assertGreater(report["volume"], 1)
        report = json.loads(self.run_tool("cube.txt", "-o", "b.stpbv", "--json", "-q", "--verify").stdout)
        self.assertIs(report["verified"], True)

    def test_a_gate_of_two_posts_exceeds_its_mesh_by_half_of_the_gap(self):
        # Two unit cubes 2 m apart. In the middle between them, the hull's side is 1 m away from both.
        self.put("gate.obj", box_obj(0.5, (0, 0, 0), (3, 0, 0)))
        report = json.loads(self.run_tool("gate.obj", "-o", "gate.stpbv", "--json", "-r", "0.02", "-R", "100").stdout)
        for key in ("excess_max", "excess_max_open"):
            self.assertGreaterEqual(report[key], 1 + report["over_cover_max"] - 1e-9)
            self.assertLess(report[key], 1.03 + report["over_cover_max"])
        cloud = json.loads(self.run_tool("cube.txt", "-o", "a.stpbv", "--json").stdout)
        self.assertIsNone(cloud["excess_max"])

    def test_json_of_several_inputs_is_one_object_a_line(self):
        done = self.run_tool("cube.txt", "broken.txt", "other.txt", "-o", "out", "--json", code=1)
        reports = [json.loads(line) for line in done.stdout.splitlines()]
        self.assertEqual([report["input"] for report in reports], ["cube.txt", "other.txt"])

    def test_quiet_says_nothing(self):
        done = self.run_tool("cube.txt", "-o", "a.stpbv", "-q")
        self.assertEqual(done.stdout + done.stderr, "")

    def test_an_input_that_fails_does_not_stop_the_others(self):
        done = self.run_tool("broken.txt", "missing.stl", "cube.txt", "-o", "out", code=1)
        self.assertEqual(self.names("out"), ["cube.stpbv"])
        self.assertIn("broken.txt:", done.stderr)
        self.assertIn("missing.stl: no such file", done.stderr)
        self.assertIn("2 of 3 inputs failed", done.stderr)

    def test_where_all_inputs_fail_no_folder_is_left(self):
        done = self.run_tool("broken.txt", "missing.stl", "-o", "new/deep/", code=1)
        self.assertIn("all 2 inputs failed, nothing is written", done.stderr)
        self.assertFalse(os.path.exists(self.path("new")))
        os.mkdir(self.path("kept"))  # an existing folder of the user stays
        self.run_tool("broken.txt", "missing.stl", "-o", "kept", code=1)
        self.assertTrue(os.path.exists(self.path("kept")))

    def test_any_number_of_jobs_gives_the_same_files_and_reports_in_order(self):
        inputs = ["cube.txt", "broken.txt", "other.txt"]
        for i in range(20):
            name = "cloud%d.txt" % i
            self.put(name, points_file([(x, y * (1 + 0.1 * i), z + 0.01 * i * x) for x, y, z in CUBE]))
            inputs.append(name)

        def run(jobs):
            done = self.run_tool(*inputs, "-o", "out" + jobs, "--json", "--jobs", jobs, code=1)
            reports = [json.loads(line) for line in done.stdout.splitlines()]
            for report in reports:
                del report["build_seconds"]
            return reports, done.stderr, [read(self.path("out%s/%s" % (jobs, name))) for name in self.names("out" + jobs)]

        reports, complaints, files = run("1")
        self.assertEqual([report["input"] for report in reports], [name for name in inputs if name != "broken.txt"])
        self.assertEqual((reports, complaints, files), run("5"))
        self.refused("cube.txt", "-o", "none.stpbv", "--jobs", "0", says=["--jobs"])

    def test_a_radius_too_small_states_the_one_that_works(self):
        self.refused("cube.txt", "-o", "a.stpbv", "-R", "0.5", says=["cube.txt: ", "smallest usable R", "0.876"], code=1)

    def test_usage_errors_exit_with_2_and_change_nothing(self):
        self.put("old.stpbv", "old")
        os.mkdir(self.path("twin"))
        self.put("twin/cube.txt", points_file(CUBE))
        for arguments, says in [
                (["cube.txt"], ["-o"]),
                ([], ["INPUT"]),
                (["cube.txt", "-o"], ["-o"]),
                (["cube.txt", "-o", "old.stpbv"], ["old.stpbv: exists", "--force"]),
                (["cube.txt", "other.txt", "-o", "old.stpbv"], ["-o old.stpbv: is a file", "folder"]),
                (["cube.txt", "other.txt", "-o", "old.stpbv", "--force"], ["-o old.stpbv: is a file", "folder"]),
                (["cube.txt", "twin/cube.txt", "-o", "out"], ["cube.txt and twin/cube.txt", "out/cube.stpbv"]),
                (["cube.txt", "cube.txt", "-o", "out"], ["cube.txt and cube.txt"]),
                (["cube.txt", "-o", "none/a.stpbv"], ["none/a.stpbv", "does not exist"]),
                (["cube.txt", "-o", "old.stpbv/"], ["old.stpbv"]),
                (["cube.txt", "-o", "cube.txt", "--force"], ["cube.txt: is an input"]),
                (["cube.txt", "other.txt", "-o", ".", "--format", "sch", "--force"], ["cube.txt: is an input"]),
                (["cube.txt", "-o", "a.stpbv", "-r", "x"], ["-r", "x"]),
                (["cube.txt", "-o", "a.stpbv", "-r=-1"], ["-r"]),
                (["cube.txt", "-o", "a.stpbv", "-r", "nan"], ["-r"]),
                (["cube.txt", "-o", "a.stpbv", "-r", "1e-400"], ["-r", "got 1e-400, too small for a double, expected a number from 0 to 1e+06"]),
                (["cube.txt", "-o", "a.stpbv", "-r", "1", "-R", "1"], ["-R"]),
                (["cube.txt", "-o", "a.stpbv", "--scale", "0"], ["--scale"]),
                (["cube.txt", "-o", "a.stpbv", "--format", "sch"], ["-o a.stpbv", "--format sch", ".txt"]),
                (["cube.txt", "-o", "a.stpbv", "--format", "step"], ["--format", "stpbv", "sch"]),
                (["cube.txt", "-o", "a.stpbv", "--preview", "a.doc"], ["--preview a.doc", ".glb"]),
                (["cube.txt", "other.txt", "-o", "out", "--preview", "a.obj"], ["--preview a.obj", "one input"]),
                (["cube.txt", "-o", "a.obj"], ["-o a.obj: a volume is no mesh", ".stpbv", "--preview a.obj"]),
                (["cube.txt", "-o", "a.stl", "--parts", "2"], ["-o a.stl: a volume is no mesh"]),
                (["cube.txt", "-o", "a.stpbv", "-r", "0.01", "--advise", "clearance=0.01"], ["--advise", "give only one of them"]),
                (["cube.txt", "-o", "a.stpbv", "--preview", "none/a.obj"], ["none/a.obj"]),
                (["cube.txt", "-o", "a.stpbv", "--nonsense"], ["--nonsense"])]:
            with self.subTest(arguments=arguments):
                self.refused(*arguments, says=says)

    def test_force_replaces_a_file(self):
        self.put("a.stpbv", "old")
        self.run_tool("cube.txt", "-o", "a.stpbv", "--force")
        self.assertTrue(read(self.path("a.stpbv")).startswith(b"stpbv 1"))

    def test_a_failure_keeps_the_old_file_under_force(self):
        self.put("a.stpbv", "old")
        self.run_tool("broken.txt", "-o", "a.stpbv", "--force", code=1)
        self.assertEqual(read(self.path("a.stpbv")), b"old")

    def two_pieces(self, name, flat=False):
        """A tetrahedron, and 1 m away another one or a flat triangle, whose volume is a spindle."""
        corners = [(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)]
        faces = [(1, 3, 2), (1, 2, 4), (2, 3, 4), (1, 4, 3)]
        text = "".join("v %g %g %g\n" % corner for corner in corners)
        text += "v 1 0 0\nv 2 0 0\nv 1.5 0.01 0\n" if flat else "".join("v %g %g %g\n" % (x + 1, y, z) for x, y, z in corners)
        faces += [(5, 6, 7)] if flat else [tuple(v + 4 for v in face) for face in faces]
        self.put(name, text + "".join("f %d %d %d\n" % face for face in faces))

    def test_volumes_replace_no_input_and_no_preview_replaces_a_volume(self):
        for name in ("w_0.obj", "w_1.obj", "body.obj"):
            self.two_pieces(name)
            os.symlink(name, self.path(name.replace(".obj", ".stpbv")))
        os.symlink("w_1.obj", self.path("link.obj"))
        os.mkdir(self.path("out"))
        os.symlink("../w_0.obj", self.path("out/body_0.stpbv"))
        for arguments, says in [
                (["w_0.obj", "-o", "w.stpbv"], "w_0.stpbv: is an input"),
                (["link.obj", "-o", "w.stpbv"], "w_1.stpbv: is an input"),
                (["body.obj", "w_0.obj", "-o", "out"], "out/body_0.stpbv: is an input")]:
            for count in (["--parts", "2"], ["--excess", "0.01"]):
                with self.subTest(arguments=arguments, count=count):
                    self.refused(*arguments, "--force", *count, says=[says])
        self.refused("body.obj", "-o", "t.stpbv", "--preview", "body.obj", "--force", says=["body.obj: is an input", "give --preview"])
        self.refused("-", "-o", "w_0.stpbv", "--force", says=["w_0.stpbv: is an input"], stdin="w_0.obj")
        self.put("v.ply", "old")
        for name in ("v.stpbv", "v_1.stpbv"):  # a volume is written through a link
            os.symlink("v.ply", self.path(name))
        self.refused("body.obj", "-o", "v.stpbv", "--preview", "v.ply", "--force", says=["v.ply: is the volume v.stpbv itself"])
        os.unlink(self.path("v.stpbv"))
        self.refused("body.obj", "-o", "v.stpbv", "--preview", "v.ply", "--parts", "2", "--force",
                     says=["v.ply: is the volume v_1.stpbv itself"])
        self.assertEqual(read(self.path("v.ply")), b"old")
        os.symlink("n.ply", self.path("n.stpbv"))  # the link's target does not exist yet
        self.refused("body.obj", "-o", "n.stpbv", "--preview", "n.ply", says=["n.ply: is the volume n.stpbv itself"])
        self.run_tool("body.obj", "-o", "t.stpbv", "--parts", "2", "--preview", "t.ply")
        self.assertTrue(read(self.path("t_0.stpbv")).startswith(b"stpbv 1"))

    def test_a_gltf_is_looked_into_once_for_all_names_of_parts(self):
        self.put("large.gltf", json.dumps({"asset": {"version": "2.0"}, "extras": list(range(300000))}))

        def seconds():  # processor time, which other processes do not change
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            self.run_tool("large.gltf", "-o", "part.stpbv", "--excess", "0.01", "--force", code=1)
            return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

        alone = seconds()
        for part in range(64):
            self.put("part_%d.stpbv" % part, "old")
        self.assertLess(seconds(), 5 * alone)

    def test_parts_are_written_all_or_none(self):
        self.two_pieces("two.obj", flat=True)
        self.refused("two.obj", "-o", "two.txt", "--parts", "2", "--format", "sch", "--preview", "two.ply", code=1,
                     says=["two_1.txt: ", "one or two vertices"])
        self.put("two_1.stpbv", "old")
        self.refused("two.obj", "-o", "two.stpbv", "--parts", "2", code=1, says=["two_1.stpbv: exists", "--force"])
        os.symlink("/dev/full", self.path("full_1.stpbv"))
        self.refused("two.obj", "-o", "full.stpbv", "--parts", "2", code=1, says=["full_1.stpbv: "])
        os.mkdir(self.path("a_1.stpbv"))
        self.refused("two.obj", "-o", "a.stpbv", "--parts", "2", "--force", code=1, says=["a_1.stpbv: is a folder"])
        self.run_tool("two.obj", "-o", "two.stpbv", "--parts", "2", "--force")
        self.assertTrue(read(self.path("two_1.stpbv")).startswith(b"stpbv 1"))
        self.put("two_2.stpbv", "old")
        done = self.run_tool("two.obj", "-o", "two.stpbv", "--parts", "2", "--force")
        self.assertIn("two_2.stpbv: is from an earlier run", done.stderr)
        self.put("whole.stpbv", "old")
        os.mkdir(self.path("out"))
        self.put("out/two.stpbv", "old")
        for output in ("whole.stpbv", "out"):  # the name without a number is not written
            self.run_tool("two.obj", "-o", output, "--parts", "2")
        for name in ("whole.stpbv", "out/two.stpbv"):
            self.assertEqual(read(self.path(name)), b"old")

    def test_parts_cover_points_that_belong_to_no_triangle(self):
        self.put("loose.ply", "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
              "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 3 3\n4 3 3\n3 0 1 2\n")
        report = json.loads(self.run_tool("loose.ply", "-o", "loose.stpbv", "--parts", "4", "--json").stdout)
        self.assertEqual((report["pieces"], report["closed_pieces"]), (3, 2))  # the triangle is open
        points = [line.split()[:3] for i in range(len(report["parts"])) for line in read(self.path("loose_%d.stpbv" % i)).splitlines()]
        for point in ([b"3", b"3", b"3"], [b"4", b"3", b"3"]):
            self.assertIn(point, points)

    def test_parts_of_an_open_mesh_claim_no_inside(self):
        triangles = "".join("v %d %d 0\nv %d %d 0\nv %d %d 1\n" % (x, 0, x + 1, 0, x, 1) for x in (0, 5))
        self.put("open.obj", triangles + "f 1 2 3\nf 4 5 6\n")
        said = self.run_tool("open.obj", "-o", "open.stpbv", "--parts", "2").stdout
        self.assertIn("0 of 2 pieces closed, the triangles alone are covered", said)

    def test_parts_of_a_volume_or_of_points_are_refused_as_such(self):
        self.run_tool("cube.txt", "-o", "a.stpbv", "-q")
        self.run_tool("a.stpbv", "-o", "a_sch.txt", "--format", "sch", "-q")
        for name, says in (("a.stpbv", "is an STP-BV already"), ("a_sch.txt", "is an STP-BV already"), ("cube.txt", "has no triangles")):
            for count in (["--parts", "2"], ["--excess", "0.01"]):
                self.refused(name, "-o", "b.stpbv", *count, says=[name + ": " + says, "give"], code=1)

    def test_a_segment_without_margin_has_a_preview_and_a_point_is_refused_before_anything_is_written(self):
        self.put("two.txt", points_file(CUBE[:2]))
        self.run_tool("two.txt", "-o", "two.stpbv", "-r", "0", "--preview", "two.obj")
        self.assertGreater(read(self.path("two.obj")).count(b"\nf "), 10)
        self.put("one.txt", points_file(CUBE[:1]))
        self.refused("one.txt", "-o", "one.stpbv", "-r", "0", "--preview", "one.obj", says=["one.txt: ", "give -r"], code=1)
        self.assertFalse(os.path.exists(self.path("one.stpbv")))

    def test_help_has_every_option_and_examples(self):
        text = self.run_tool("--help").stdout
        for words in ("-o", "-r", "-R", "--scale", "--format", "--preview", "--verify", "--json", "--force", "-q",
                      "Examples:", "Exit status:"):
            self.assertIn(words, text)

    def test_scale_and_radii_act(self):
        self.run_tool("cube.txt", "-o", "a.stpbv", "--scale", "0.5", "-r", "0.25", "-R", "3")
        text = read(self.path("a.stpbv")).decode()
        self.assertIn("r 0.25\nR 3\n", text)
        self.assertIn("0.5 0.5 0.5", text)

    def test_volumes_are_converted_between_formats(self):
        self.run_tool("cube.txt", "-o", "a.stpbv", "-q")
        self.run_tool("a.stpbv", "-o", "a_sch.txt", "--format", "sch", "-q")
        self.run_tool("a_sch.txt", "-o", "b.stpbv", "-q", "--verify")
        self.assertEqual(read(self.path("a.stpbv")), read(self.path("b.stpbv")))
        self.refused("a.stpbv", "-o", "c.stpbv", "-R", "20", says=["a.stpbv: is an STP-BV already", "R = 10"], code=1)
        self.run_tool("a.stpbv", "-o", "d.stpbv", "-R", "10", "-q")
        self.assertNotIn("built in", self.run_tool("a.stpbv", "-o", "e.stpbv").stdout)
        for kind in ("stpbv", "sch"):  # a volume's file may have any name
            self.run_tool("a.stpbv", "-o", kind + ".bak", "--format", kind, "-q")
            self.run_tool(kind + ".bak", "-o", kind + "_back.stpbv", "-q")
            self.assertEqual(read(self.path("a.stpbv")), read(self.path(kind + "_back.stpbv")))

    def test_what_sch_core_cannot_hold_is_said(self):
        self.put("two.txt", points_file(CUBE[:2]))
        self.refused("two.txt", "-o", "a.txt", "--format", "sch", says=["a.txt", "one or two vertices", "stpbv"], code=1)

    def shell(self, command):
        """Runs a command in which $T is the program."""
        return super().shell(f'T="{PROGRAM}"; {command}', cwd=self.folder)

    def test_volumes_come_from_and_go_to_pipes_and_descriptors(self):
        self.run_tool("cube.txt", "-o", "cube.stpbv")
        volume = read(self.path("cube.stpbv")).decode()
        for command in ('"$T" cube.txt -o -', '"$T" cube.txt -o /dev/stdout', '"$T" cube.txt -o /dev/stdout | cat',
                        '"$T" - -o - < cube.txt', 'cat cube.txt | "$T" - -o -', 'cat cube.txt | "$T" /dev/stdin -o -',
                        '"$T" <(cat cube.txt) -o -', '"$T" cube.stpbv -o - --json', 'cat cube.stpbv | "$T" - -o -',
                        'exec 3>&1; "$T" cube.txt -q -o >(cat >&3); sleep 0.5', 'mkfifo p; cat p & "$T" cube.txt -q -o p; wait; rm p',
                        'mkfifo p.txt; cat cube.txt > p.txt & "$T" p.txt -o -; rm p.txt'):
            with self.subTest(command=command):
                done = self.shell(command)
                self.assertEqual(done.stdout, volume, done.stderr)
        for command in ('"$T" cube.txt -o - | "$T" - -o - --format sch | "$T" - -o -',):
            self.assertEqual(self.shell(command).stdout, volume)
        # There may be a file behind a descriptor. The shell decides whether to replace it.
        for number, command in enumerate(('"$T" cube.txt -o - > %s', '"$T" cube.txt -o /dev/stdout > %s', '"$T" cube.txt -o /dev/fd/1 > %s',
                                          '"$T" cube.txt -q -o /dev/fd/3 3> %s')):
            with self.subTest(command=command):
                name = "redirected%d" % number
                done = self.shell(command % name)
                self.assertEqual((done.returncode, read(self.path(name)).decode()), (0, volume), done.stderr)

    def test_several_volumes_do_not_go_to_standard_output(self):
        self.refused("cube.txt", "other.txt", "-o", "-", says=["-o -", "one volume"])
        self.refused("cube.txt", "--parts", "2", "-o", "-", says=["-o -", "one volume"])

    def test_a_mesh_from_a_pipe_gives_the_volume_of_its_file(self):
        self.two_pieces("two.obj")
        shutil.copy(pathlib.Path(SOURCE, "data/hrp2_style/meshes/HEAD_LINK1.dae"), self.path("head.dae"))
        self.put("cube.xyz", "# a cube\n" + "".join("%r %r %r\n" % p for p in CUBE))
        self.run_tool("cube.txt", "-o", "cube.stpbv", "--preview", "cube.glb", "-q")
        for name in ("two.obj", "head.dae", "cube.glb", "cube.xyz"):
            self.run_tool(name, "-o", name + ".stpbv", "-q", "--scale", "0.5")
            volume = read(self.path(name + ".stpbv")).decode()
            for command in ('cat %s | "$T" - -o - --scale 0.5', 'cat %s | "$T" /dev/stdin -o - --scale 0.5', '"$T" - -o - --scale 0.5 < %s',
                            '"$T" /dev/stdin -o - --scale 0.5 < %s', '"$T" <(cat %s) -o - --scale 0.5'):
                with self.subTest(command=command % name):
                    done = self.shell(command % name)
                    self.assertEqual((done.returncode, done.stdout), (0, volume), done.stderr)
        self.run_tool("two.obj", "-o", "file.stpbv", "--parts", "2", "-q")
        self.run_tool("-", "-o", "pipe.stpbv", "--parts", "2", "-q", stdin="two.obj")
        for part in "01":
            self.assertEqual(read(self.path(f"file_{part}.stpbv")), read(self.path(f"pipe_{part}.stpbv")))

    def test_a_cloud_is_read_by_its_name_and_a_wrong_line_is_named(self):
        self.run_tool("cube.txt", "-o", "cube.stpbv", "-q")
        shutil.copy(self.path("cube.txt"), self.path("cube.qc"))
        for ending in ("xyz", "pts"):
            self.put("cube." + ending, "".join("%r\t%r %r # m\n" % p for p in CUBE))
        for ending in ("qc", "xyz", "pts"):
            self.run_tool("cube." + ending, "-o", ending + ".stpbv", "-q")
            self.assertEqual(read(self.path(ending + ".stpbv")), read(self.path("cube.stpbv")))
        self.put("water.xyz", "3\nwater\nO 0 0 0\nH 1 0 0\nH 0 1 0\n")
        self.refused("water.xyz", "-o", "a.stpbv", says=["water.xyz:1: got '3', expected three coordinates", "chemistry"], code=1)
        self.put("odd.pts", "0 0 0\n1 0 0\n0 1\n")
        self.refused("odd.pts", "-o", "a.stpbv", says=["odd.pts:3: got 2 words, expected three coordinates"], code=1)

    def test_points_whose_first_line_begins_like_another_format_are_read_as_points(self):
        others = [(4, 0, 0), (3, 0, 0), (3, 1, 0), (3, 0, 1)]
        # Two radii and a count, as sch-core's files have, and a dimension before counts, as qhull's have.
        for first in ((10, 20, 30), (0, 1, 2), (3, -1, -2)):
            text = "".join("%d %d %d\n" % point for point in [first, *others])
            for name in ("cloud.txt", "cloud.xyz", "cloud", "-"):
                with self.subTest(first=first, name=name):
                    if name != "-":
                        self.put(name, text)
                    stdin = {"stdin": name} if name != "-" else {"stdin": "cloud"}
                    done = self.run_tool(name, "-o", "cloud.stpbv", "-R", "1000", "--json", "--force", **stdin)
                    self.assertEqual(json.loads(done.stdout)["points"], 5)
            self.put("wrong.xyz", text + "1 two 3\n")
            self.refused("wrong.xyz", "-o", "new.stpbv", code=1, says=["wrong.xyz:6: got 'two', expected a coordinate"])
        self.refused("cloud.xyz", "-o", "new.stpbv", "--scale", "1e-300", code=1, says=["cloud.xyz: "])

    def test_a_broken_mesh_from_a_pipe_and_a_device_are_refused(self):
        for command, says in (('echo solid | "$T" - -o a.stpbv', "-:1: .*endsolid"), ('"$T" /dev/zero -o a.stpbv', "device"),
                              ('echo nothing | "$T" - -o a.stpbv', "-: cannot be read as a mesh"), ('"$T" - -o a.stpbv < /dev/zero', "device"),
                              ('ln -s /dev/zero z.stpbv; "$T" z.stpbv -o a.stpbv', "device"),
                              ('ln -s /dev/zero z.stl; "$T" z.stl -o a.stpbv', "expected a file"),
                              ('"$T" - -o a.stpbv --parts 2 < cube.txt', "has no triangles")):
            with self.subTest(command=command):
                done = self.shell(command)
                self.assertEqual((done.returncode, done.stdout), (1, ""), done)
                self.assertRegex(done.stderr, says)
        self.assertFalse(os.path.exists(self.path("a.stpbv")))

    def test_output_that_cannot_be_written_is_a_failure(self):
        for command, code in (('"$T" cube.txt -o a.stpbv > /dev/full', 2), ('"$T" cube.txt -o b.stpbv --json > /dev/full', 2),
                              ('"$T" cube.txt -o - > /dev/full', 1), ('"$T" cube.txt -o /dev/full', 1)):
            with self.subTest(command=command):
                done = self.shell(command)
                self.assertEqual(done.returncode, code, done)
                self.assertIn("cannot be written", done.stderr)

    def test_a_pipe_that_nobody_reads_or_writes_is_left_by_a_signal(self):
        os.mkfifo(self.path("p"))
        for arguments in (["cube.txt", "-o", "p"], ["p", "-o", "a.stpbv"]):
            for number in (signal.SIGINT, signal.SIGTERM):
                process = subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stderr=subprocess.DEVNULL)
                time.sleep(0.5)
                process.send_signal(number)
                self.assertEqual(process.wait(20), -number)
        self.assertNotIn("a.stpbv", self.names())

    def test_previews_are_written_and_read_back(self):
        for kind in ("obj", "stl", "ply", "glb"):
            self.run_tool("cube.txt", "-o", kind + ".stpbv", "--preview", "p." + kind)
            report = json.loads(self.run_tool("p." + kind, "-o", "back_" + kind, "--json", "-r", "0", "-R", "20").stdout)
            self.assertGreater(report["points"], 100)
        self.refused("cube.txt", "-o", "new.stpbv", "--preview", "p.obj", says=["p.obj: exists", "--force"])

    def test_a_preview_that_cannot_be_written_leaves_no_volume(self):
        os.symlink("/dev/full", self.path("full.obj"))
        self.two_pieces("pieces.obj")
        for arguments in (["cube.txt"], ["pieces.obj", "--parts", "2"]):
            self.refused(*arguments, "-o", "new.stpbv", "--preview", "full.obj", says=["full.obj: cannot be written"], code=1)
            self.assertEqual([n for n in os.listdir(self.path(".")) if n.startswith("new")], [])

    def test_no_bar_and_no_escape_codes_away_from_a_terminal(self):
        done = self.run_tool("cube.txt", "other.txt", "-o", "out")
        self.assertEqual(done.stderr, "")
        self.assertNotIn("\033", done.stdout)

    def on_a_terminal(self, *arguments, kind="xterm", columns=80):
        """The program's output on a terminal as its standard error."""
        return shown_on_terminal(self, [PROGRAM, *arguments], "stderr", columns, stdout=subprocess.DEVNULL, cwd=self.folder,
                                 env={**os.environ, "TERM": kind})

    def test_a_bar_on_a_terminal(self):
        arguments = ["cube.txt", "other.txt", "-o", "out", "--force"]
        self.assertIn("1/2", self.on_a_terminal(*arguments))
        self.assertEqual(self.on_a_terminal(*arguments, "-q"), "")
        self.assertEqual(self.on_a_terminal(*arguments, kind="dumb"), "")  # such a terminal cannot rewrite a line

    def test_a_bar_keeps_to_its_line_and_cuts_no_character(self):
        # One letter takes two cells, one takes one, and one consists of two characters.
        names = [letter * 60 + ".txt" for letter in ("\u53f3", "\u0434", "o\u0308")]
        for name in names:
            self.put(name, points_file(CUBE))
        shown = self.on_a_terminal(*(self.path(name) for name in names), "-o", "out", "-j", "1", columns=40)
        bars = [line for line in re.split(r"\r\x1b\[K", shown) if line.startswith("[")]
        self.assertEqual([bar.split()[1] for bar in bars], ["0/3", "1/3", "2/3"])
        for bar, (letter, cells) in zip(bars, (("\u53f3", 2), ("\u0434", 1), ("o\u0308", 1))):
            self.assertEqual(bar.split()[2], letter * (20 // cells))  # of 39 cells, 19 are the bar and its count

    def test_an_interrupted_run_leaves_whole_files_only(self):
        inputs = []
        for i in range(300):
            inputs.append("p%d.txt" % i)
            self.put(inputs[-1], points_file([(x + 0.001 * i, y, z) for x, y, z in CUBE]))
        for wait, end in ((0.02, signal.SIGINT), (0.05, signal.SIGTERM), (0.1, signal.SIGINT)):
            process = subprocess.Popen([PROGRAM, *inputs, "-o", "out", "-q", "--force"], cwd=self.folder)
            time.sleep(wait)
            process.send_signal(end)
            process.wait(60)
            written = self.names("out") if os.path.isdir(self.path("out")) else []
            for name in written:
                self.assertTrue(name.endswith(".stpbv"), name)
                self.assertTrue(read(self.path("out/" + name)).endswith(b"\nend\n"), name)

    def test_the_humanoid_converts(self):
        folder = os.path.join(SHARED, "robots/jvrc_description/convex/jvrc1")
        if not os.path.isdir(folder):
            self.skipTest("skipped: ../shared/robots is missing")
        inputs = [os.path.join(folder, name) for name in sorted(os.listdir(folder))]
        self.assertEqual(len(inputs), 35)
        for form in ("stpbv", "sch"):
            done = self.run_tool(*inputs, "-o", form, "--json", "--verify", "--format", form)
            reports = [json.loads(line) for line in done.stdout.splitlines()]
            self.assertEqual(len(reports), 35)
            self.assertTrue(all(report["verified"] for report in reports))
            self.assertEqual(len(self.names(form)), 35)


if __name__ == "__main__":
    PROGRAM = os.path.abspath(sys.argv[1])
    SOURCE = os.path.abspath(sys.argv[2])
    SHARED = os.path.join(os.path.dirname(SOURCE), "shared")
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])

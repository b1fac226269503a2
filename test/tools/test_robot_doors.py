"""What comes in and goes out of the tools on robots: bad shapes, numbers and files are told and never read as clear.

    test_robot_doors.py URDF_COLLISION_REPORT FIND_POSTURE
"""
import csv
import io
import json
import os
import re
import signal
import struct
import subprocess
import sys
import time
import unittest

from report_page import page_text
from small_robot import joint, link
from tool_case import ToolCase

REPORT, POSTURE = sys.argv[1:3]


def robot(*first):
    return ('<robot name="r">' + link("a", '<sphere radius="0.1"/>', *first) + link("b", '<sphere radius="0.1"/>') +
            link("c", '<sphere radius="0.1"/>') + joint("j", "a", "b", origin="1 0 0") + joint("k", "b", "c", origin="1 0 0") + '</robot>')


def readable(text, form):
    """The output in a format; for a page, the text of its packed report."""
    return page_text(text) if form == "html" else text


BAD = ['<sphere radius="0"/>', '<mesh filename="missing.stl"/>']
TASK = '{"base": "fixed", "placements": []}'


class Doors(ToolCase):
    def setUp(self):
        super().setUp()
        self.good = self.put("good.urdf", robot())
        self.bad = self.put("bad.urdf", robot(*BAD))
        self.task = self.put("task.json", TASK)

    def refuses(self, *command, names):
        self.refused(self.run_command(*command), *names)

    def test_all_shapes_that_are_wrong_are_told_at_once_and_nothing_is_written(self):
        for command in ([REPORT, self.bad], [POSTURE, self.bad, self.task]):
            self.refuses(*command, names=["link 'a', collision 2", "link 'a', collision 3", "missing.stl"])

    def test_skip_invalid_names_what_it_left_out_in_every_format_and_never_exits_0(self):
        for form in ("text", "json", "csv", "srdf", "html"):
            done = self.run_command(REPORT, self.bad, "--skip-invalid", "--samples", "20", "--format", form)
            self.assertEqual(done.returncode, 3, done.stderr)
            for number in (2, 3):
                self.assertIn(f"link 'a', collision {number}", readable(done.stdout, form), form)
            if form == "srdf":
                self.assertIn('link1="a" link2="b"', done.stdout)
                self.assertNotIn('reason="Never"', done.stdout)
                self.assertIn("left out; exit status 3, as --skip-invalid left 2 shapes out\n", done.stderr)
        for form in ("text", "json", "html"):
            done = self.run_command(POSTURE, self.bad, self.task, "--skip-invalid", "--format", form)
            self.assertEqual(done.returncode, 3, done.stderr)
            self.assertIn("link 'a', collision 2", readable(done.stdout, form), form)
        self.assertEqual(self.run_command(REPORT, self.good, "--skip-invalid", "--samples", "20").returncode, 0)
        self.assertIn('reason="Never"', self.run_command(REPORT, self.good, "--samples", "20", "--format", "srdf").stdout)

    def test_a_shape_that_was_left_out_is_told_on_lines_of_its_own(self):
        for command in ([REPORT], [POSTURE, self.task]):
            done = self.run_command(command[0], self.bad, *command[1:], "--skip-invalid")
            self.assertRegex(done.stdout, r"\nLEFT OUT, NOT CHECKED: .*missing\.stl: no such file; tried\n  /.*missing\.stl\n")

    def test_a_robot_without_bodies_is_not_clear(self):
        empty = self.put("empty.urdf", '<robot name="r"><link name="a"/></robot>')
        broken = self.put("broken.urdf", '<robot name="r">' + link("a", *BAD) + "</robot>")
        for command in ([REPORT], [POSTURE]):
            more = [self.task] if command == [POSTURE] else []
            self.refuses(*command, empty, *more, names=["no link has a shape"])
            self.refuses(*command, broken, *more, "--skip-invalid",
                         names=["no shape could be read", "broken.urdf:1: link 'a', collision 1"])

    def test_links_on_either_side_of_one_whose_shape_is_left_out_are_checked(self):
        def side(name, x, size):
            return (f'<link name="{name}"><collision><origin xyz="{x} 0 0"/><geometry><box size="{size} 0.1 0.1"/>'
                    '</geometry></collision></link>')

        for middle, status in (("", 2), ('<collision><geometry><mesh filename="missing.stl"/></geometry></collision>', 1)):
            path = self.put("three.urdf", '<robot name="r">' + side("left", 0, 0.1) + f'<link name="m">{middle}</link>' +
                            side("right", 0.3, 0.4) + '<joint name="f" type="fixed"><parent link="left"/><child link="m"/>'
                            '<origin xyz="0.3 0 0"/></joint><joint name="j" type="revolute"><parent link="m"/>'
                            '<child link="right"/><axis xyz="0 0 1"/><limit lower="0" upper="3.14" effort="1" velocity="1"/>'
                            '</joint></robot>')
            done = self.run_command(REPORT, path, "--skip-invalid", "--samples", "200", "--format", "srdf")
            self.assertEqual(done.returncode, status, done)  # without a shape in between, the two links are adjacent
            self.assertNotIn("disable_collisions", done.stdout)

    def test_csv_has_all_columns_for_a_shape_left_out_too(self):
        text = self.run_command(REPORT, self.bad, "--skip-invalid", "--samples", "20", "--format", "csv").stdout
        self.assertEqual({len(row) for row in csv.reader(io.StringIO(text))}, {21})
        left_out = [row for row in csv.DictReader(io.StringIO(text)) if not row["link1"]]
        self.assertEqual([(row["link2"], row["checked"]) for row in left_out], [("", "0")] * 2)
        for row in left_out:
            self.assertIn("left out: ", row["reason"])

    def test_where_visual_shapes_were_asked_for_they_are_what_is_missing(self):
        scene = self.put("scene.urdf", robot())
        seen = self.put("seen.urdf", robot().replace("collision", "visual"))
        self.refuses(REPORT, seen, "--visual", "--obstacles", scene, names=[scene, "leave out --visual"])

    def test_no_output_replaces_a_file_that_is_read(self):
        mesh = "".join(f"v {x} {y} {z}\n" for x, y, z in ((0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1))) + "f 1 2 3\nf 1 2 4\n"
        meshes = [self.put(name, mesh) for name in ("body.obj", "crate.obj")]
        urdf = self.put("arm.urdf", robot('<mesh filename="body.obj"/>'))
        scene = self.put("scene.urdf", '<robot name="s">' + link("crate", '<mesh filename="package://pkg/crate.obj"/>') + "</robot>")
        os.mkdir(self.path("pkg"))
        os.rename(meshes[1], self.path("pkg/crate.obj"))
        srdf, pose = self.put("arm.srdf", '<robot name="r"/>'), self.put("pose.json", '{"j": 0}')
        way = self.put("way.csv", "j\n0\n0.1\n")
        files = ["--srdf", srdf, "--obstacles", scene, "--package-path", self.folder]
        os.symlink(srdf, self.path("link"))
        os.link(urdf, self.path("hard"))
        read = [urdf, srdf, scene, meshes[0]] + [self.path(name) for name in ("link", "hard", "pkg/../arm.urdf", "pkg/crate.obj")]
        for output in read + [pose]:
            self.refused_to_write(output, REPORT, urdf, *files, "--pose", pose)
        self.refused_to_write(pose, REPORT, urdf, "--neutral", pose)
        self.refused_to_write(way, REPORT, urdf, "--trajectory", way)
        for output in read + [self.task]:
            self.refused_to_write(output, POSTURE, urdf, self.task, *files)
        with open(urdf, encoding="utf-8") as file:
            self.refused_to_write(urdf, REPORT, "-", stdin=file)
        # The meshes of a robot or a scene from a pipe are known only after it was read.
        absolute = self.put("absolute.urdf", robot(f'<mesh filename="{meshes[0]}"/>'))
        for command in (f"cat {absolute} | {REPORT} - --samples 20 -q", f"{POSTURE} <(cat {absolute}) {self.task} -q",
                        f"{REPORT} {self.good} --obstacles <(cat {absolute}) --samples 20 -q"):
            self.refused_to_write(meshes[0], "bash", "-c", command + ' "$@"', "bash")
        published = self.path("published")
        os.mkdir(published)
        polyhedron = self.put("published/body-ch.txt", "3\n4\n0 0 0\n0.1 0 0\n0 0.1 0\n0 0 0.1\n")
        self.refused_to_write(polyhedron, REPORT, urdf, "--polyhedra", published)
        points = struct.pack("<12f", 0, 0, 0, 0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1) + struct.pack("<6H", 0, 1, 2, 0, 1, 3)
        buffer = self.path("body.bin")
        with open(buffer, "wb") as file:
            file.write(points)
        self.put("body.gltf", json.dumps({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "buffers": [{"uri": "body.bin", "byteLength": 60}],
            "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [0.1, 0.1, 0.1]},
                          {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}]}))
        binary = self.put("binary.urdf", robot('<mesh filename="body.gltf"/>'))
        self.assertEqual(self.run_command(REPORT, binary, "--samples", "20").returncode, 0)
        self.refused_to_write(buffer, REPORT, binary)
        # Only the SRDF may be updated.
        self.refused_to_write(urdf, REPORT, urdf, *files, "--format", "srdf")
        done = self.run_command(REPORT, urdf, "--srdf", srdf, "--samples", "20", "--format", "srdf", "-o", srdf)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(srdf, encoding="utf-8") as file:
            self.assertIn("disable_collisions", file.read())
        # A file that is not an input may be replaced.
        self.assertEqual(self.run_command(REPORT, urdf, "--samples", "20", "-o", way).returncode, 0)

    def refused_to_write(self, output, *command, **options):
        with self.subTest(command=command, output=output):
            with open(output, "rb") as file:
                before = file.read()
            done = self.run_command(*command, "-o", output, **options)
            self.assertEqual((done.returncode, done.stdout), (2, ""), done)
            self.assertIn(output + ": is an input, and writing would replace it", done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
            with open(output, "rb") as file:
                self.assertEqual(file.read(), before)

    def test_options_that_would_do_nothing_are_refused(self):
        scene = self.put("scene.urdf", robot())
        nowhere = self.path("nowhere")
        for command in ([REPORT, self.good], [POSTURE, self.good, self.task]):
            for arguments, says in ((["--obstacles", ""], "--obstacles: the value is empty"),
                                    (["--obstacles=", self.good], "--obstacles: the value is empty"),
                                    (["--flat", "obstacles"], "--flat obstacles: there are no obstacles"),
                                    (["--flat", "a", "--link", "a=0.01,10"], "--flat a: --link gives the same link"),
                                    (["--link", "a=0.01,10,"], "--link a=0.01,10,: got nothing"),
                                    (["--advise", "clearance=0.01,clearance=0.02"], "clearance comes twice"),
                                    (["--advise", "clearance=0.01,"], "got ''"),
                                    (["--package-path", nowhere], f"--package-path {nowhere}: is no folder")):
                self.refuses(*command, *arguments, names=[says])
            done = self.run_command(*command, "--obstacles", scene, "--flat", "obstacles", "--package-path", self.folder)
            self.assertIn(done.returncode, (0, 1), done.stderr)

    def test_numbers_that_are_none_or_out_of_range_are_refused(self):
        for option in ("--margin", "-r", "-R", "--prove", "--over-cover"):
            for value in ("nan", "inf", "-inf", "1e300", "1,5"):
                self.refuses(REPORT, self.good, option + "=" + value if option[1] == "-" else option + value,
                             names=[option])
        self.refuses(REPORT, self.good, "-r", "0x1p-7", names=["-r", "expected a number"])  # hexadecimal
        for value in ("-1", "1e9", "nan"):
            self.refuses(REPORT, self.good, "--seed", value, names=["--seed"])
            self.refuses(POSTURE, self.good, self.task, "--seed", value, names=["--seed"])
        for command in ([REPORT, self.good], [POSTURE, self.good, self.task]):
            for values in ("nan,1", "-0.1,1", "1e-310,1", "0.01,inf", "0.01,1e300", "0.01,0", "0.01,1,-1", "0.01,1,nan", "0.01,1,x"):
                self.refuses(*command, "--link", "a=" + values, names=["--link a=" + values, "expected a number from"])
            self.refuses(*command, "--link", "a=0.2,0.1", names=["--link a=0.2,0.1", "R must be larger than r"])
            self.refuses(*command, "--link", "a=0.1,1", "--link", "a=0.2,1", names=["--link a=0.2,1", "already"])
            self.refuses(*command, "-r", "0.2", "-R", "0.1", names=["-r 0.2 -R 0.1", "larger"])
            self.refuses(*command, "-r", "20", names=["-r 20", "larger"])
        for pose in ('{"j": 1e300}', '{"j": 0, "j": 1}', '{"nobody": 0}', '[0]', '{"j": null}', "nan"):
            self.refuses(REPORT, self.good, "--pose", self.put("pose.json", pose), names=["pose.json"])
        for task in ('{"placements": [], "placements": []}', '{"placements": [], "x": 1}'):
            self.refuses(POSTURE, self.good, self.put("bad.json", task), names=["bad.json"])

    def test_what_would_put_links_where_nothing_can_be_checked_is_refused(self):
        # The bodies of a second document would be lost, an axis of 1e200 has no length, and at 1e300 there is
        # no distance.
        cases = {"1e300 0 0": ("1 0 0", "within 1e6 m"), '<box size="1e300 1 1"/>': ('<sphere radius="0.1"/>', "at most 1e6 m"),
                 '<axis xyz="1e200 0 1e200"/>': ('<axis xyz="1 0 0"/>', "axis has no direction"),
                 'lower="2e6" upper="3e6"': ('lower="-1" upper="1"', "between -1e6 and 1e6"),
                 '<mimic joint="k" multiplier="1e300"/></joint><joint name="k"': ('</joint><joint name="k"', "mimic")}
        for number, (wrong, (right, words)) in enumerate(cases.items()):
            urdf = self.put(f"wrong{number}.urdf", robot().replace(right, wrong, 1))
            self.refuses(REPORT, urdf, names=[urdf, words])
            self.refuses(POSTURE, urdf, self.task, names=[urdf, words])
        twice = self.put("twice.urdf", robot() + robot())
        self.refuses(REPORT, twice, names=[twice, "<robot> follows the root element"])
        big = "".join(f"v {x} {y} {z}\n" for x, y, z in ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))) + "f 1 2 3\nf 1 2 4\n"
        mesh = f'<mesh filename="{self.put("big.obj", big)}" scale="1e200 1 1"/>'
        self.refuses(REPORT, self.put("mesh.urdf", robot(mesh)), names=["big.obj", "within 1e6 m"])

    def test_limits_that_stand_for_none_are_no_error(self):
        urdf = self.put("far.urdf", robot().replace('lower="-1" upper="1"', 'lower="-1e16" upper="1e16"'))
        self.assertEqual(self.run_command(REPORT, urdf, "--samples", "20").returncode, 0)

    def test_both_tools_take_the_same_options_for_the_robot_in_the_same_words(self):
        def options(tool):
            text = self.run_command(tool, "--help").stdout
            parts = re.split(r"\n  (?=-)", text)[1:]
            return {part.split()[0].split(",")[0]: " ".join(part.split()) for part in parts}
        report, posture = options(REPORT), options(POSTURE)
        for name in ("--srdf", "--obstacles", "--package-path", "--visual", "--skip-invalid", "--no-cache", "-r", "-R",
                     "--primitives", "--over-cover", "--link", "--flat"):
            self.assertEqual(report[name], posture[name])

    def test_an_srdf_that_does_not_fit_is_warned_of_and_hides_no_pair(self):
        srdf = self.put("other.srdf", '<robot name="other"><disable_collision link1="a" link2="c"/>'
                                      '<disable_collisions link1="a" link2="z"/></robot>')
        done = self.run_command(REPORT, self.good, "--srdf", srdf, "--samples", "20", "--format", "json")
        self.assertEqual(done.returncode, 0, done.stderr)
        for part in ("'other'", "<disable_collision>", "'z'"):
            self.assertIn(part, done.stderr)
            self.assertTrue(any(part in warning for warning in json.loads(done.stdout)["warnings"]))

    def test_what_either_tool_writes_is_a_posture(self):
        for command in ([REPORT, self.good, "--samples", "20"], [POSTURE, self.good, self.task]):
            written = self.put("written.json", self.run_command(*command, "--format", "json").stdout)
            done = self.run_command(REPORT, self.good, "--samples", "20", "--pose", written)
            self.assertEqual("proposes no neutral posture" in done.stderr, command[0] == REPORT, done.stderr)
            self.assertEqual(done.returncode, 2 if command[0] == REPORT else 0, done.stderr)

    def test_output_goes_to_files_pipes_and_descriptors_and_a_failed_write_is_a_failure(self):
        run = f"{REPORT} {self.good} --samples 20 --format csv -q"
        whole = self.shell(run).stdout
        self.assertIn("link1,link2", whole)
        head = whole.splitlines()[0]
        for command in (f"{run} -o -", f"{run} -o /dev/stdout", f"{run} -o /dev/stdout | cat", f"{run} -o /dev/fd/3 3>&1",
                        f"{run} -o >(cat >&2) 2>&1; sleep 0.2"):
            done = self.shell(command)
            self.assertIn(head, done.stdout + done.stderr, command)
        for command in (f"{run} > /dev/full", f"{run} -o /dev/full", f"{POSTURE} {self.good} {self.task} > /dev/full"):
            done = self.shell(command)
            self.assertEqual(done.returncode, 2, command)
            self.assertIn("cannot be written", done.stderr)

    def test_input_comes_from_pipes_too(self):
        for command in (f"cat {self.good} | {REPORT} -", f"cat {self.good} | {REPORT} /dev/stdin",
                        f"{REPORT} - < {self.good}", f"{REPORT} <(cat {self.good})"):
            done = self.shell(command + " --samples 20")
            self.assertEqual(done.returncode, 0, done.stderr)
        pose = self.put("pose.json", '{"j": 0.5}')
        done = self.shell(f"{REPORT} {self.good} --pose <(cat {pose})")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_an_srdf_from_a_pipe_is_written_with_the_new_pairs(self):
        srdf = self.put("good.srdf", '<robot name="r"><group_state name="home" group="all"><joint name="j" value="0"/></group_state></robot>')
        from_file = self.shell(f"{REPORT} {self.good} --samples 20 --format srdf --srdf {srdf} -q")
        for command in (f"--srdf <(cat {srdf})", f"--srdf - < {srdf}"):
            done = self.shell(f"{REPORT} {self.good} --samples 20 --format srdf -q " + command)
            self.assertEqual((done.returncode, done.stdout), (from_file.returncode, from_file.stdout), done.stderr)
        self.assertIn('<group_state name="home"', from_file.stdout)
        self.assertIn("<disable_collisions", from_file.stdout)

    def test_an_option_for_meshes_says_so_where_there_are_none(self):
        for option in ("--flat a", "--link a=0.01,1,0.1", "--over-cover 0.1"):
            done = self.shell(f"{REPORT} {self.good} --samples 20 {option}")
            self.assertIn("no mesh that could", done.stderr, option)

    def test_a_percent_encoded_buffer_of_a_mesh_is_not_replaced(self):
        buffer = self.put("a b.bin", "x")
        self.put("body.gltf", json.dumps({"asset": {"version": "2.0"}, "buffers": [{"uri": "a%20b.bin", "byteLength": 1}]}))
        done = self.run_command(REPORT, self.put("encoded.urdf", robot('<mesh filename="body.gltf"/>')), "-o", buffer)
        self.assertIn("a b.bin: is an input", done.stderr)

    def test_a_pipe_that_nobody_reads_or_writes_is_left_by_a_signal(self):
        fifo = self.path("fifo")
        os.mkfifo(fifo)
        for command in ([REPORT, self.good, "--samples", "20", "-o", fifo], [REPORT, fifo]):
            for number in (signal.SIGINT, signal.SIGTERM):
                process = subprocess.Popen(command, env=self.environment(), stderr=subprocess.DEVNULL)
                time.sleep(0.7)
                process.send_signal(number)
                self.assertEqual(process.wait(timeout=20), -number)
        self.assertEqual(set(os.listdir(self.folder)) - {"cache"}, {"bad.urdf", "fifo", "good.urdf", "task.json"})

    def test_a_name_of_255_bytes_is_written(self):
        path = self.path("n" * 255)
        done = self.run_command(REPORT, self.good, "--samples", "20", "-o", path)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(os.path.getsize(path) > 0)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

"""urdf_collision_report as a user runs it.

    test_urdf_collision_report.py PROGRAM SOURCE_FOLDER
"""
import csv
import io
import json
import math
import os
import re
import subprocess
import sys
import unittest

from report_page import page_data
from small_robot import box_obj, joint, link
from tool_case import ToolCase

PROGRAM, SOURCE = sys.argv[1:3]
ROBOT = os.path.join(SOURCE, "data/hrp2_style/hrp2_style")
SHARED = os.path.join(os.path.dirname(os.path.abspath(SOURCE)), "shared", "robots")


class Report(ToolCase):
    def run_tool(self, *arguments, **options):
        return self.run_command(PROGRAM, *arguments, **options)

    def robot(self, body):
        return self.put("robot.urdf", f'<robot name="small">{body}</robot>')

    def humanoid(self, *arguments):
        return self.run_tool(ROBOT + ".urdf", "--srdf", ROBOT + ".srdf", "--samples", "20", *arguments)

    def slider(self):
        """Two balls of 5 cm: `moving` slides along x from 1 m away towards `still`. A third ball is far away."""
        ball = '<sphere radius="0.05"/>'
        return self.robot(link("root") + link("still", ball) + link("moving", ball) + link("far", ball)
                          + joint("turn", "root", "still") + joint("spin", "root", "far", origin="0 9 0")
                          + joint("slide", "root", "moving", "prismatic", "1 0.06 0", "-1 0 0", (-2, 2)))

    def follow(self, name, text, *arguments):
        return self.run_tool(self.slider(), "--primitives", "flat", "--samples", "20", "--trajectory",
                             self.put(name, text), *arguments)

    def test_a_trajectory_that_collides_between_its_way_points_names_time_and_pair(self):
        # The balls touch 0.08 m before the middle: after 0.92 m of 2 m, which take 4 s.
        for name, text in [("way.csv", "time,slide\n1,0\n5,2\n"),
                           ("way.json", '{"joints": ["slide"], "points": [[0], [2]], "time": [1, 5]}'),
                           ("ros2.json", '{"header": {"frame_id": ""}, "joint_names": ["slide"], "points": [{"positions": [0], "velocities": [], '
                                         '"time_from_start": {"sec": 0, "nanosec": 1000000000}}, {"positions": [2], "time_from_start": {"sec": 5}}]}'),
                           ("ros1.json", '{"joint_names": ["slide"], "points": [{"positions": [0], "time_from_start": {"secs": 1, "nsecs": 0}}, '
                                         '{"positions": [2], "time_from_start": 5}]}')]:
            done = self.follow(name, text, "--format", "json")
            self.assertEqual(done.returncode, 1, done.stderr)
            report = json.loads(done.stdout)
            found = report["trajectory"]
            self.assertEqual(found["verdict"], "contact")
            self.assertLessEqual(found["free_until"], 2.84 + 1e-9)
            self.assertAlmostEqual(found["contact"]["time"], 2.84, delta=5e-6)
            self.assertEqual({found["contact"]["link1"], found["contact"]["link2"]}, {"still", "moving"})
            pair = next(p for p in report["pairs"] if {p["link1"], p["link2"]} == {"still", "moving"})
            self.assertAlmostEqual(pair["distance"], -0.04, delta=1e-6)  # exactly above each other
            self.assertAlmostEqual(pair["time"], 3, delta=0.01)
            self.assertLessEqual(found["steepest_approach"], 0.5)  # m/s
            self.assertGreater(found["steepest_approach"], 0.49)
            verdict = page_data(self.follow(name, text, "--format", "html").stdout)["trajectory"]["verdict"]
            self.assertRegex(verdict, r"^CONTACT of \w+ - \w+ at 2\.8\d+ s$")
            self.assertIn(f" way points: {verdict}, at (", self.follow(name, text).stdout)

    def test_the_pair_of_the_first_contact_comes_first_with_the_times_beside(self):
        # A ball grazes another one after 0.4 m, is 1 mm deep in it at 0.5 m, and hits the middle of a third
        # one at 1 m.
        ball = '<sphere radius="0.05"/>'
        robot = self.robot(link("root") + link("grazed", ball) + link("hit", ball) + link("moving", ball)
                           + joint("g", "root", "grazed", origin="0.5 0.099 0") + joint("h", "root", "hit", origin="1 0 0")
                           + joint("slide", "root", "moving", "prismatic", limits=(0, 2)))
        arguments = [robot, "--primitives", "flat", "--samples", "20", "--trajectory", self.put("way.csv", "time,slide\n0,0\n10,1\n")]
        done = self.run_tool(*arguments)
        self.assertRegex(done.stdout, r"CONTACT of grazed - moving at 4\.8\d* s, at")
        lines = done.stdout.splitlines()
        head = next(i for i, line in enumerate(lines) if line.startswith("pair "))
        self.assertRegex(lines[head - 1] + "\n" + lines[head], r"closest +steepest joint\npair .* cause +at  \[m/rad")
        self.assertEqual([lines[head + 1], lines[head + 3]], ["first contact, 1 pair:", "meshes meet, 1 pair:"])
        self.assertRegex(lines[head + 2], r"^grazed - moving +-1\.000 +0\.000 +0\.000  meshes meet +[45]\.\d{3} s  ")
        self.assertRegex(lines[head + 4], r"^hit - moving +-\d+\.\d+ +0\.000 +0\.000  meshes meet +(10\.000|9\.9\d\d) s")
        self.assertRegex(self.run_tool(*arguments, "--top", "1").stdout, r"\ngrazed - moving .*\n\.\.\. and 2 more \(--top\)\n")
        pairs = [(p["link1"], p["link2"]) for p in json.loads(self.run_tool(*arguments, "--format", "json").stdout)["pairs"]]
        self.assertEqual(pairs[:2], [("grazed", "moving"), ("hit", "moving")])
        page = page_data(self.run_tool(*arguments, "--format", "html").stdout)["pairs"]
        self.assertEqual((page[0]["link1"], page[0]["link2"]), ("grazed", "moving"))

    def test_a_touch_that_is_not_decided_hides_no_contact_of_another_pair(self):
        # A ball comes down onto a table, with a distance of 0 up to rounding, and rolls along it against
        # another ball. The centres are 0.3 m apart then, with 0.1 m of height, at x = 0.8 - sqrt(0.08).
        def slide(name, parent, child, axis, origin):
            return (f'<joint name="{name}" type="prismatic"><parent link="{parent}"/><child link="{child}"/><origin xyz="{origin}"/>'
                    f'<axis xyz="{axis}"/><limit lower="-2" upper="2" effort="1" velocity="1"/></joint>')

        box = '<link name="table"><collision><origin xyz="0 0 -0.05"/><geometry><box size="2 2 0.1"/></geometry></collision></link>'
        table = self.robot(box + link("still", '<sphere radius="0.2"/>') + link("m") + link("ball", '<sphere radius="0.1"/>')
                           + joint("w", "table", "still", "fixed", "0.8 0 0.2") + slide("x", "table", "m", "1 0 0", "0 0 0")
                           + slide("z", "m", "ball", "0 0 1", "0 0 0.1"))
        srdf = self.put("table.srdf", '<robot name="t"><disable_collisions link1="table" link2="still"/></robot>')
        path = self.put("roll.csv", "time,x,z\n0,-0.5,+0.2\n1,-0.5,0\n2,0.8,0\n")  # with a plus sign, as printf may write it
        arguments = ["--primitives", "flat", "--samples", "20", "--srdf", srdf, "--trajectory", path]
        whole = json.loads(self.run_tool(table, *arguments, "--format", "json").stdout)
        verdicts = {(pair["link1"], pair["link2"]): pair["verdict"] for pair in whole["pairs"]}
        self.assertEqual(verdicts, {("table", "ball"): "undecided", ("still", "ball"): "contact", ("table", "still"): None})
        report = whole["trajectory"]
        self.assertEqual((report["verdict"], report["contact"]["link1"], report["contact"]["link2"]), ("contact", "still", "ball"))
        self.assertAlmostEqual(report["contact"]["time"], 1 + (1.3 - math.sqrt(0.08)) / 1.3, delta=1e-6)
        self.assertEqual([(u["link1"], u["link2"]) for u in report["undecided"]], [("table", "ball")])
        self.assertAlmostEqual(report["undecided"][0]["time"], 1, delta=1e-6)
        self.assertEqual(report["free_until"], report["undecided"][0]["time"])
        self.assertIn("not decided: table - ball", self.run_tool(table, *arguments).stdout)
        rows = self.run_tool(table, *arguments, "--format", "csv").stdout.splitlines()
        self.assertRegex(rows[1], r"^,,trajectory: CONTACT of still - ball at 1\.78\d+ s,")
        self.assertEqual({row.count(",") for row in rows}, {22})
        self.assertRegex(next(row for row in rows if row.startswith("still,ball")), r",(1\.99\d*|2),contact$")  # its time and verdict
        self.assertEqual({tuple(row[key] for key in ("link1", "link2", "verdict")) for row in csv.DictReader(rows) if row["link1"]},
                         {(*pair, verdict or "") for pair, verdict in verdicts.items()})
        alone = self.put("alone.csv", "time,x,z\n0,-0.5,0.2\n1,-0.5,0\n2,-0.4,0\n")
        done = self.run_tool(table, "--primitives", "flat", "--srdf", srdf, "--trajectory", alone)
        self.assertEqual(done.returncode, 1)
        self.assertIn("NOT DECIDED for table - ball at 0.99", done.stdout)
        self.assertIn("free before: the distance is the margin to rounding", done.stdout)
        made = self.run_tool(table, "--primitives", "flat", "--srdf", srdf, "--trajectory", alone, "--format", "srdf")
        self.assertEqual(made.returncode, 1)
        self.assertRegex(made.stderr, r"1 now; exit status 1, as the trajectory is not proven free: NOT DECIDED for table - ball at 0\.99\d* s, free "
                                      r"before: the distance is the margin to rounding\n$")

    def test_a_pair_set_aside_does_not_hide_that_the_others_were_not_followed(self):
        # A ball comes down onto a table. Then an arm turns 100,000 times past a post, each time at a distance
        # of 1 mm.
        slide = ('<joint name="z" type="prismatic"><parent link="table"/><child link="ball"/><origin xyz="0 0 0.1"/><axis xyz="0 0 1"/>'
                 '<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>')
        spin = '<joint name="spin" type="continuous"><parent link="table"/><child link="arm"/><origin xyz="0 9 0"/><axis xyz="0 0 1"/></joint>'
        arm = '<link name="arm"><collision><origin xyz="1 0 0"/><geometry><sphere radius="0.1"/></geometry></collision></link>'
        box = '<link name="table"><collision><origin xyz="0 0 -0.05"/><geometry><box size="2 2 0.1"/></geometry></collision></link>'
        robot = self.robot(box + link("ball", '<sphere radius="0.1"/>') + arm + link("post", '<sphere radius="0.1"/>') + slide + spin
                           + joint("w", "table", "post", "fixed", "1.201 9 0"))
        srdf = self.put("table.srdf", '<robot name="t"><disable_collisions link1="table" link2="post"/></robot>')
        path = self.put("spin.csv", "time,z,spin\n0,0.2,0\n1,0,0\n2,0,628318.5\n")
        arguments = [robot, "--primitives", "flat", "--srdf", srdf, "--trajectory", path]
        done = self.run_tool(*arguments)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertRegex(done.stdout, r"NOT DECIDED for table - ball at 0\.99\d* s, free before: the distance is the margin to rounding; "
                                      r"from 1\.\d+ s on the way is so long that a proof takes too many distances")
        report = json.loads(self.run_tool(*arguments, "--format", "json").stdout)["trajectory"]
        self.assertEqual((report["verdict"], report["free_until"]), ("undecided", report["undecided"][0]["time"]))
        self.assertTrue(1 <= report["followed_until"] < 2)
        # Each pair has its own verdict, before and after a contact of another pair.
        for z, collides in ((0, False), (-0.05, True)):
            self.put("spin.csv", f"time,z,spin\n0,0.2,0\n1,{z},0\n2,{z},314159.3\n")
            page = page_data(self.run_tool(*arguments, "--format", "html").stdout)
            open_pairs = [{p["link1"], p["link2"]} for p in page["pairs"] if p["verdict"] == "undecided"]
            for told in (lambda p: p["colliding"], lambda p: p["verdict"] == "contact"):
                self.assertEqual([{p["link1"], p["link2"]} for p in page["pairs"] if told(p)], [{"table", "ball"}] * collides)
            self.assertEqual(len(open_pairs), 2 - collides, page["pairs"])
            self.assertIn({"arm", "post"}, open_pairs)
            self.assertEqual(sum(p["verdict"] == "free" for p in page["pairs"]), 3)

    def test_a_trajectory_that_keeps_clear_is_proven_free_and_drawn(self):
        text = "slide\n0\n0.5\n0.9\n0.2\n"
        done = self.follow("way.csv", text)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("proven free", done.stdout)
        self.assertIsNone(json.loads(self.follow("way.csv", text, "--format", "json").stdout)["trajectory"]["contact"])
        page = self.follow("way.csv", text, "--format", "html").stdout
        self.assertIn('aria-label="Least distance over time"', page)
        said = page_data(page)["trajectory"]  # the text in the page's head
        self.assertEqual((os.path.basename(said["file"]), said["verdict"]), ("way.csv", "proven free"))
        # With the given margin it is not free: 0.1166 m apart at the third way point, minus 0.1.
        self.assertEqual(self.follow("way.csv", text, "--margin", "0.0167").returncode, 1)
        self.assertEqual(self.follow("way.csv", text, "--margin", "0.0165").returncode, 0)

    def test_the_chart_has_the_closest_approach_and_the_contact_however_short(self):
        # There and back within a second of 2000, between the even times of the chart.
        text = "time,slide\n0,0\n1001,0\n1001.5,1\n1002,0\n2000,0\n"
        report = json.loads(self.follow("way.csv", text, "--format", "json").stdout)
        chart = report["trajectory"]["chart"]
        self.assertEqual(chart["time"], sorted(set(chart["time"])))
        self.assertAlmostEqual(min(chart["distance"]), report["summary"]["min_distance"], delta=1e-9)
        self.assertIn(report["trajectory"]["contact"]["time"], chart["time"])
        self.assertRegex(self.follow("way.csv", text).stdout, r"fastest approach of 40[123] samples 1\.\d+ m/s")

    def test_the_chart_tells_a_link_from_an_obstacle_of_its_name(self):
        # A ball leaves the floor, 1 cm above it; then a link called floor comes to 5 mm from the ball.
        ball = '<sphere radius="0.1"/>'
        robot = self.robot(link("root") + link("foot", ball) + link("floor", ball) + joint("up", "root", "foot", "prismatic", axis="0 0 1")
                           + joint("down", "root", "floor", "prismatic", "0 0 1", "0 0 -1"))
        floor = self.put("floor.urdf", '<robot name="ground"><link name="floor"><collision><origin xyz="0 0 -0.16"/><geometry><box size="4 4 0.1"/>'
                                       '</geometry></collision></link></robot>')
        way = self.put("way.csv", "time,up,down\n0,0,0\n1,0.2,0\n2,0.2,0.595\n")
        page = page_data(self.run_tool(robot, "--obstacles", floor, "--trajectory", way, "--samples", "20", "--format", "html").stdout)
        chart = page["trajectory"]["chart"]
        nearest = [page["pairs"][chart["pair"][k]] for k in (0, -1)]
        self.assertEqual([(pair["link2"], pair["obstacle"]) for pair in nearest], [("floor", True), ("floor", False)])
        for k, pair in zip((0, -1), nearest):
            self.assertAlmostEqual(chart["distance"][k], pair["distance"], delta=1e-6)

    def test_the_samples_of_the_chart_stay_apart_where_times_are_large(self):
        page = page_data(self.follow("way.csv", "time,slide\n984287,0\n984287.01,0.5\n", "--format", "html").stdout)
        share = page["trajectory"]["chart"]["share"]
        self.assertGreater(len(set(share)), 400)
        self.assertEqual((share[0], share[-1]), (0, 1))

    def test_a_contact_less_deep_than_the_precision_counts_as_one(self):
        for deepest, free in (("0.919999", True), ("0.92000000001", False), ("0.920000001", False), ("0.92001", False)):
            done = self.follow("way.csv", f"slide\n0\n{deepest}\n0\n", "--format", "json")
            report = json.loads(done.stdout)
            self.assertEqual((report["trajectory"]["verdict"], done.returncode), ("free", 0) if free else ("contact", 1))
            self.assertEqual(report["summary"]["colliding"], 0 if free else 1, deepest)
            self.assertIn("proven free" if free else "1 of them in collision", self.follow("way.csv", f"slide\n0\n{deepest}\n0\n").stdout)

    def test_a_contact_too_short_for_its_time_is_not_free(self):
        # One ball meets another one in the first half. Two more pass through each other in the last nanosecond of a million seconds.
        ball = '<sphere radius="0.05"/>'
        robot = self.robot(link("root") + link("still", ball) + link("moving", ball) + link("other", ball) + link("first", ball)
                           + joint("turn", "root", "still") + joint("slide", "root", "moving", "prismatic", "1 0.06 0", "-1 0 0", (-2, 2))
                           + joint("spin", "root", "other", origin="0 9 0") + joint("meet", "root", "first", "prismatic", "1 9 0", "-1 0 0", (-2, 2)))
        for end in (1.95, 2):
            path = self.put("way.csv", f"time,slide,meet\n0,0,0\n500000,0,1\n999999,0,0\n999999.000000001,{end},0\n")
            done = self.run_tool(robot, "--primitives", "flat", "--samples", "20", "--trajectory", path, "--format", "json")
            pair = next(p for p in json.loads(done.stdout)["pairs"] if (p["link1"], p["link2"]) == ("still", "moving"))
            self.assertEqual(pair["verdict"], "contact")
            self.assertAlmostEqual(pair["distance"], -0.04, delta=1e-6)

    def test_a_contact_late_and_not_deep_is_reported_where_it_is(self):
        # A ball grazes another one, less deep than the precision of a closest approach, in the last nanosecond of a million seconds.
        ball = '<sphere radius="0.05"/>'
        robot = self.robot(link("root") + link("still", ball) + link("moving", ball) + joint("turn", "root", "still")
                           + joint("slide", "root", "moving", "prismatic", "1 0.0999999 0", "-1 0 0", (-2, 2)))
        for end in (1.37, 1.7, 1.95):
            path = self.put("way.csv", f"time,slide\n0,0\n999999,0\n999999.000000001,{end}\n")
            report = json.loads(self.run_tool(robot, "--primitives", "flat", "--samples", "20", "--trajectory", path, "--format", "json").stdout)
            self.assertEqual((report["trajectory"]["verdict"], report["summary"]["causes"]), ("contact", {"meshes meet": 1}))
            self.assertAlmostEqual(report["pairs"][0]["distance"], -1e-7, delta=1e-7)

    def test_the_levels_of_the_chart_stay_in_it_and_apart(self):
        for margin in ("0", "0.001", "-0.001", "0.9", "3", "-3"):
            page = self.follow("way.csv", "slide\n0\n2\n", "--margin", margin, "--format", "html").stdout
            heights = sorted(float(y) for y in re.findall(r'y="([^"]*)" text-anchor="end">[-.0-9]+<', page))
            self.assertEqual(f">margin {float(margin) * 1e3:g} mm<" in page, margin != "0")
            self.assertGreater(len(heights), 2)
            self.assertTrue(heights[0] > 20 and heights[-1] < 240, margin)
            self.assertTrue(all(b - a > 20 for a, b in zip(heights, heights[1:])), margin)

    def test_names_fake_no_line_and_send_the_terminal_nothing(self):
        ball, forged = '<sphere radius="0.05"/>', "p&#10;proven free&#10;&#155;8m"
        robot = self.robot(link("root", ball) + link("m") + link(forged, ball) + joint("a", "root", "m") + joint("b&#9;", "m", forged, origin="1 0 0"))
        told = self.run_tool(robot, "--primitives", "flat", "--samples", "20").stdout
        self.assertIn("root - p?proven free??8m", told)
        self.assertFalse([c for c in told if (ord(c) < 32 or 127 <= ord(c) < 160) and c != "\n"], told)
        escape = self.run_tool(self.robot(link("root&#27;[8m", ball)))
        self.assertIn("'root?[8m', has a control character", escape.stderr)
        self.assertNotIn("\033", escape.stderr)

    def test_a_contact_soon_in_a_long_trajectory_is_not_at_the_start(self):
        told = self.follow("way.csv", "time,slide\n0,0\n0.5,0\n1,1\n900000,1\n").stdout
        self.assertRegex(told, r"CONTACT of \w+ - \w+ at 0\.9\d+ s, at")
        self.assertIn("at the start, at (", self.follow("way.csv", "time,slide\n-5,1\n900000,0\n").stdout)

    def test_a_margin_is_told_beside_what_is_within_it(self):
        pose = self.put("pose.json", '{"slide": 0.9}')  # the balls are 0.0166 m apart
        for margin, count, said in (("0", 0, "0 of them in collision in"), ("0.03", 1, "1 of them in collision (within 30 mm) in")):
            arguments = [self.slider(), "--primitives", "flat", "--samples", "20", "--margin", margin, "--pose", pose]
            summary = json.loads(self.run_tool(*arguments, "--format", "json").stdout)["summary"]
            self.assertEqual((summary["margin"], summary["colliding"]), (float(margin), count))
            self.assertIn(said, self.run_tool(*arguments).stdout)

    def test_a_message_whose_times_are_all_zero_has_none(self):
        points = ",".join('{"positions": [%s], "time_from_start": {"sec": 0, "nanosec": 0}}' % x for x in (0, 2))
        for text in (points, points.replace(', "time_from_start": {"sec": 0, "nanosec": 0}', "")):
            done = self.follow("way.json", '{"joint_names": ["slide"], "points": [%s]}' % text, "--format", "json")
            found = json.loads(done.stdout)["trajectory"]
            self.assertEqual((found["verdict"], found["timed"]), ("contact", False))
            self.assertAlmostEqual(found["contact"]["time"], 0.46, delta=1e-6)

    def test_a_trajectory_that_is_none_is_refused_with_its_place(self):
        for text, said in [("", "is empty"), ("slide\n0\n", "needs two"), ("slide\n0\nx\n", "way.csv:3: got 'x'"),
                           ("slid\n0\n1\n", "no moving joint 'slid'; did you mean 'slide'?"),
                           ("elbow\n0\n1\n", "no moving joint 'elbow'; its joints are turn ... slide"), ("slide,slide\n0,0\n1,1\n", "twice"),
                           ("slide\n0\n1,2\n", "way.csv:3: has 2 values"), ("time\n0\n1\n", "names no joint"),
                           ("slide\n0\nnan\n", "must be from"), ("slide\n0\n1e7\n", "must be from"),
                           ("time,slide\n1,0\n1,1\n", "must grow"), ('{"joints": ["slide"]}', "expected"),
                           ('[{"slide": 0}, {"slide": 1}]', "no object of JSON"), ("0\n1\n2\n", "way.csv:1: got numbers; the first line must name joints"),
                           ('{"joint_names": ["slide"], "points": [[0], [1]]}', 'points[0]: is no object of JSON'),
                           ('{"joint_names": ["slide"]}', 'expected {"joint_names": [names]'),
                           ('{"joint_names": ["slide"], "points": {"b": {"positions": [0]}, "a": {"positions": [1]}}}', '"points" is no list'),
                           ('{"joint_names": ["slide"], "points": [{"positions": [0, 1]}]}', 'points[0] has 2 values, "joint_names" names 1'),
                           ('{"joint_names": ["slide"], "points": [{"positions": [0]}, {"positions": [1], "time_from_start": 1}]}', "1 of 2 points have"),
                           ('{"joint_names": ["slide"], "points": [{"positions": [0], "time_from_start": "0 s"}]}', "time_from_start: expected seconds"),
                           ('{"joint_names": ["time"], "points": [{"positions": [0]}]}', "no moving joint 'time'"),
                           ('{"joints": ["slide"], "point": []}', '"point" is none of "joints", "points", "time"'),
                           ('{"joints": ["slide"], "points": [[0], [1, 2]]}', "points[1]"),
                           ('{"joints": ["slide"], "points": [[0], [1]], "time": [0]}', '"time" has 1')]:
            done = self.follow("way.csv", text)
            self.assertEqual(done.returncode, 2, text)
            self.assertIn(said, done.stderr)
            self.assertEqual(done.stdout, "")
        self.assertEqual(self.run_tool(self.slider(), "--trajectory", "no/such.csv").returncode, 2)
        self.assertEqual(self.follow("way.csv", "slide\n0\n1\n", "--pose", "x").returncode, 2)

    def test_a_margin_below_0_is_warned_of(self):
        for margin, warned in (("0", False), ("-0.01", True)):
            said = self.run_tool(self.slider(), "--primitives", "flat", "--samples", "20", "--margin", margin).stderr
            self.assertEqual("the margin is negative: what overlaps by less than 0.01 m counts as clear" in said, warned, said)
        # With the warning about pairs without a smooth body it is printed below the file's name, which
        # appears once.
        self.assertRegex(said, r"^urdf_collision_report: \S+robot\.urdf:\n  the margin is negative: .*\n  3 checked pairs have no smooth body")

    def test_an_arm_that_comes_no_nearer_has_no_time_of_its_fastest_approach(self):
        done = self.follow("way.csv", "time,slide\n6,0\n7,-1\n", "--format", "json")
        way = json.loads(done.stdout)["trajectory"]
        self.assertEqual((way["steepest_pair"], way["steepest_time"], way["steepest_approach"]), (None, None, 0))

    def test_the_hull_of_an_obstacle_has_all_corners_of_its_mesh(self):
        # A lens so flat that the tip on it is inside its volume. A cube ends 1 mm above the tip.
        ring = [(0.2 * math.cos(math.pi * i / 4), 0.2 * math.sin(math.pi * i / 4), 0) for i in range(8)]
        lens = "".join(f"v {x:.9f} {y:.9f} {z}\n" for x, y, z in ring + [(0, 0, 0.008), (0, 0, -0.05)])
        lens += "".join(f"f {i + 1} {(i + 1) % 8 + 1} 9\nf {(i + 1) % 8 + 1} {i + 1} 10\n" for i in range(8))
        self.put("lens.obj", lens)
        cube = [(x, y, z) for x in (-0.05, 0.05) for y in (-0.05, 0.05) for z in (-0.05, 0.05)]
        self.put("cube.obj", "".join(f"v {x} {y} {z}\n" for x, y, z in cube) + "f 1 2 4\nf 5 6 8\nf 1 3 7\n")
        scene = self.put("scene.urdf", '<robot name="s">' + link("lens", '<mesh filename="lens.obj"/>') + "</robot>")
        robot = self.robot(link("base") + link("arm", '<mesh filename="cube.obj"/>')
                           + '<joint name="j" type="prismatic"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>'
                             '<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>')
        pose = self.put("pose.json", '{"j": 0.059}')
        done = self.run_tool(robot, "--obstacles", scene, "-r", "0.01", "-R", "1", "--pose", pose, "--format", "json")
        (pair,) = json.loads(done.stdout)["pairs"]
        self.assertAlmostEqual(pair["hull_distance"], 1e-3, delta=2e-5)  # 9 mm without the tip
        self.assertIn("1 mesh is not closed, that of 'arm'. Its volume", done.stderr)

    def test_a_clear_posture_exits_with_0_and_states_every_figure(self):
        done = self.humanoid("--pose", "half_sitting", "--format", "json")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads(done.stdout)
        self.assertEqual(report["robot"], "hrp2_style")
        self.assertEqual(len(report["links"]), 31)
        self.assertEqual(report["summary"]["pairs_total"], 465)
        self.assertEqual(report["summary"]["checked"], 130)
        self.assertEqual(report["summary"]["colliding"], 0)
        first = report["pairs"][0]
        self.assertEqual(first["distance"], report["summary"]["min_distance"])
        gap = [b - a for a, b in zip(first["point1"], first["point2"])]
        self.assertAlmostEqual(math.hypot(*gap), first["distance"], delta=1e-12)
        # Along the normal, the smooth gap and both over-covers add up to the hulls' gap. The hulls' distance
        # is larger.
        covered = first["distance"] + first["over_cover1"] + first["over_cover2"]
        self.assertLessEqual(covered, first["hull_distance"] + 1e-12)
        self.assertTrue(first["gradient"])

    def test_collisions_found_by_the_search_exit_with_1(self):
        done = self.humanoid("--format", "json")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertGreater(json.loads(done.stdout)["summary"]["colliding"], 0)

    def test_a_seed_gives_the_same_srdf_and_it_loads_again(self):
        one, two = (self.path(name) for name in ("one.srdf", "two.srdf"))
        for path in (one, two):
            self.humanoid("--format", "srdf", "-o", path)
        with open(one) as a, open(two) as b:
            text = a.read()
            self.assertEqual(text, b.read())
        self.assertEqual(text.count('reason="User"'), 266)
        again = self.run_tool(ROBOT + ".urdf", "--srdf", one, "--samples", "5", "--pose", "zero")
        self.assertIn("checked", again.stdout)

    def test_a_posture_from_a_file_is_the_same_as_from_the_srdf(self):
        pose = self.put("pose.json", json.dumps({"RLEG_JOINT3": 0.5}))
        done = self.humanoid("--pose", pose, "--format", "json")
        self.assertEqual(done.returncode, 0, done.stderr)
        wrong = self.humanoid("--pose", self.put("wrong.json", '{"nobody": 1}'))
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("nobody", wrong.stderr)
        unknown = self.humanoid("--pose", "standing")
        self.assertEqual(unknown.returncode, 2)
        self.assertIn("half_sitting", unknown.stderr)

    def test_csv_has_a_row_for_each_pair(self):
        rows = list(csv.DictReader(io.StringIO(self.humanoid("--pose", "zero", "--format", "csv").stdout)))
        self.assertEqual(len(rows), 465)
        self.assertGreater(float(rows[0]["distance"]), 0)

    def test_html_is_one_file_that_loads_nothing(self):
        done = self.humanoid("--pose", "zero", "--format", "html")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(done.stdout.startswith("<!DOCTYPE html>"))
        for outside in ("http://", "https://", "src=", "<link rel", "@import"):
            self.assertNotIn(outside, done.stdout)

    def test_an_obstacle_is_checked_against_every_moving_body(self):
        scene = self.put("scene.urdf", f'<robot name="scene">{link("ball", chr(60) + "sphere radius=" + chr(34) + "0.1" + chr(34) + "/>")}</robot>')
        done = self.humanoid("--pose", "zero", "--obstacles", scene, "--format", "json")
        pairs = [p for p in json.loads(done.stdout)["pairs"] if p["obstacle"]]
        self.assertEqual(len(pairs), 30)
        self.assertTrue(all(p["checked"] and p["closest"] for p in pairs))
        # Without a posture, the search finds the closest configuration of each pair.
        searched = json.loads(self.humanoid("--obstacles", scene, "--format", "json").stdout)
        hand = {p["link1"]: p for p in searched["pairs"] if p["obstacle"]}["LARM_LINK6"]
        self.assertEqual(hand["reason"], "sometimes")
        self.assertLessEqual(hand["distance"], 0)

    def test_an_obstacle_around_a_body_that_no_joint_moves_is_told(self):
        ball = '<sphere radius="0.05"/>'
        robot = self.robot(link("base", ball) + link("arm", ball) + joint("turn", "base", "arm", origin="0 0 9"))

        def warnings(*places):
            scene = self.put("scene.urdf", '<robot name="scene">' + link("floor") + "".join(
                link(f"ball{i}", ball) + joint(f"to{i}", "floor", f"ball{i}", "fixed", at) for i, at in enumerate(places)) + "</robot>")
            done = self.run_tool(robot, "--samples", "20", "--obstacles", scene, "--format", "json")
            self.assertEqual(done.returncode, 0, done.stderr)  # the checked pairs are clear
            return [w for w in json.loads(done.stdout)["warnings"] if "obstacle" in w]

        self.assertEqual(warnings("0 0 0.09"), [f"{robot}: 'base' meets the obstacle 'ball0'; no joint moves it, so this pair is "
                                                "not checked."])
        self.assertIn("not checked, nor 1 more like it.", warnings("0 0 0", "3 3 3", "0.05 0 0")[0])
        self.assertEqual(warnings("0 0 0.2", "0 9 0"), [])

    def test_json_has_the_keys_that_the_page_on_robots_lists(self):
        report = json.loads(self.humanoid("--pose", "zero", "--format", "json").stdout)
        self.assertLessEqual({"robot", "links", "pairs", "summary"}, set(report))
        self.assertLessEqual({"link1", "link2", "reason", "distance", "point1", "point2", "normal", "gradient", "over_cover1",
                              "over_cover2"}, set(report["pairs"][0]))
        self.assertLessEqual({"pairs_total", "checked", "disabled", "min_distance", "colliding", "ns_per_pair"},
                             set(report["summary"]))
        self.assertGreater(report["summary"]["ns_per_pair"], 0)

    def test_advice_gives_each_link_the_radii_that_its_task_asks_for(self):
        task = "clearance=0.03,acceleration=2,speed=0.2,turning=0.5"
        done = self.humanoid("--pose", "zero", "--advise", task, "--format", "json")
        self.assertEqual(done.returncode, 1, done.stderr)  # some links collide in this posture
        report = json.loads(done.stdout)
        self.assertNotIn("no r and R", str(report["warnings"]))
        for body in report["links"]:
            self.assertLessEqual(body["over_cover_max"], 0.03)
            self.assertLessEqual(body["advised_acceleration"], 2)
            self.assertLessEqual(body["advised_least_clearance"], 0.03)
        boxes = [self.boxes(f"{name}.obj", 0.1, (0, 0, 0)) for name in "ab"]
        small = [self.robot(link("a", boxes[0]) + link("b", boxes[1]) + joint("j", "a", "b", origin="1 0 0")), "--srdf",
                 self.put("none.srdf", '<robot name="small"/>'), "--pose", self.put("pose.json", "{}")]
        self.assertRegex(self.run_tool(*small, "--advise", task).stdout,
                         r"advised r from \S+ to \S+ mm, R from \S+ to \S+ m: shapes add at most [12]\.\d+ m/s\^2")
        tight = self.run_tool(*small, "--advise", task.replace("0.03", "0.01"))
        self.assertIn("no r and R keep 2 of 2 meshes within a clearance of 0.01 m and 2 m/s^2", tight.stderr)
        for arguments, word in ((("--advise", task, "-r", "0.01"), "excludes"), (("--advise", "sped=1"), "clearance="),
                                (("--advise", task, "--over-cover", "0.1"), "excludes")):
            wrong = self.humanoid(*arguments)
            self.assertEqual(wrong.returncode, 2)
            self.assertIn(word, wrong.stderr)
            self.assertEqual(wrong.stdout, "")

    def test_radii_and_budgets_of_all_links_and_of_one(self):
        done = self.humanoid("--pose", "zero", "-r", "0.005", "-R", "20", "--over-cover", "0.02", "--link", "BODY=0.01,5,0.2",
                             "--link", "CHEST_LINK0=0.008,4", "--format", "json")
        self.assertEqual(done.returncode, 0, done.stderr)
        links = {link["name"]: link for link in json.loads(done.stdout)["links"]}
        self.assertLessEqual(links["BODY"]["vertices"], 2)
        self.assertLessEqual(links["CHEST_LINK0"]["over_cover_max"], 0.02)
        for name, link in links.items():
            self.assertLessEqual(link["vertices"], link["vertices_unreduced"])
            if name != "BODY":
                self.assertLessEqual(link["over_cover_max"], 0.02)
        for wrong, words in (("BODY=0.01", "expected NAME=r,R"), ("BODY", "expected NAME=r,R"), ("NOBODY=0.01,5", "NOBODY"),
                             ("BODY=0.01,5,0.001", "budget")):
            done = self.humanoid("--link", wrong)
            self.assertEqual(done.returncode, 2, wrong)
            self.assertIn(words, done.stderr)

    def test_flat_links_and_obstacles_are_smooth_in_a_pair_with_a_smooth_one_only(self):
        cube = self.put("cube.obj", "".join(f"v {x} {y} {z}\n" for x in (0.9, 1.1) for y in (-0.1, 0.1) for z in (0.5, 0.7)))
        scene = self.put("scene.urdf", '<robot name="scene">' + link("crate", f'<mesh filename="{cube}"/>') + "</robot>")
        done = self.humanoid("--pose", "zero", "--obstacles", scene, "--flat", "obstacles", "--flat", "BODY", "--format", "json")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads(done.stdout)
        body = {link["name"]: link for link in report["links"]}["BODY"]
        unknown = ("vertices", "vertices_unreduced", "r", "R", "over_cover_max", "over_cover_mean", "polyhedron")
        self.assertEqual([body[key] for key in unknown], [None] * len(unknown))
        for pair in report["pairs"]:
            flat = pair["link1"] == "BODY" and pair["obstacle"]
            self.assertEqual(pair["continuous"], not flat, pair)
            if pair["obstacle"] and not flat:
                self.assertEqual((pair["status"], pair["over_cover2"]), ("exact", 0))
        wrong = self.humanoid("--flat", "NOBODY")
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("NOBODY", wrong.stderr)

    def test_the_closest_configuration_is_that_of_the_least_distance(self):
        """Two boxes that slide past each other. The search begins where they are apart, and its few samples miss the posture where they meet."""
        box = self.boxes("box.obj", 0.05, (0, 0, 0))
        joints = "".join(f'<joint name="{name}" type="prismatic"><parent link="{parent}"/><child link="{child}"/><axis xyz="{axis}"/>'
                         '<limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
                         for name, parent, child, axis in (("x", "a", "b", "1 0 0"), ("z", "b", "c", "0 0 1")))
        far = link("far", '<sphere radius="0.1"/>') + joint("w", "a", "far", origin="0 9 0")
        urdf = self.robot(link("a", box) + link("b") + link("c", box) + joints + far)
        apart, meeting, way = self.put("apart.json", '{"x": 2, "z": 2}'), self.put("meeting.json", '{"x": 0.01, "z": 0}'), \
            self.put("way.csv", "time,x,z\n0,-1,0\n1,0.01,0\n2,1,0\n")
        never = self.put("never.srdf", '<robot name="small"><disable_collisions link1="a" link2="c" reason="Never"/></robot>')
        search = urdf, "--neutral", apart, "--no-cache", "-q"
        few = *search, "--samples", "5"

        def distance_at(joints):
            found = json.loads(self.run_tool(*few, "--pose", self.put("there.json", json.dumps(joints)), "--format", "json").stdout)
            return found["pairs"][0]["distance"]

        for posture in (["--pose", meeting], ["--trajectory", way]):
            with self.subTest(posture=posture):
                pair = json.loads(self.run_tool(*few, *posture, "--format", "json").stdout)["pairs"][0]
                self.assertLess(pair["distance"], -0.1)
                self.assertEqual(pair["min_distance"], pair["distance"])
                self.assertAlmostEqual(distance_at(pair["closest"]), pair["min_distance"], delta=1e-12)
        told = self.run_tool(*few, "--srdf", never, "--pose", meeting).stdout
        self.assertRegex(told, r"leaves out a - c as Never; found: sometimes, meshes meet, -\d+\.\d+ mm at x=0\.0100 z=0\.0000")
        # In this posture only the volumes are within the margin; many samples find the meshes meeting elsewhere.
        beside = self.put("beside.json", '{"x": 0, "z": 0.16}')
        told = self.run_tool(*search, "--samples", "20000", "--margin", "0.05", "--srdf", never, "--pose", beside).stdout
        self.assertRegex(told, r"leaves out a - c as Never; found: sometimes, meshes meet, -\d+\.\d+ mm at ")

    def wrong_srdf(self, pairs):
        """The arguments for the humanoid with an SRDF that leaves out {pair of links: reason}, and all others but one for the user's
        own reasons, so that the search has only these pairs."""
        with open(ROBOT + ".urdf", encoding="utf-8") as file:
            links = re.findall('<link name="([^"]*)"', file.read())
        known = {frozenset(pair): reason for pair, reason in pairs.items()}
        self.assertLessEqual(frozenset().union(*known), set(links))
        lines = [(a, b, known.get(frozenset((a, b)), "User")) for i, a in enumerate(links) for b in links[:i]][:-1]
        return [ROBOT + ".urdf", "--samples", "200", "--srdf", self.put("wrong.srdf", '<robot name="hrp2_style">' + "".join(
            f'<disable_collisions link1="{a}" link2="{b}" reason="{reason}"/>' for a, b, reason in lines) + "</robot>")]

    def test_a_pair_that_the_srdf_wrongly_leaves_out_comes_with_the_configuration_whatever_the_case_of_the_reason(self):
        reasons = {"LARM_LINK5": ("Never", "Never"), "RARM_LINK5": ("NEVER ", "Never"), "RARM_LINK6": ("never", "Never"),
                   "LARM_LINK6": (" adjacent", "Adjacent")}
        done = self.run_tool(*self.wrong_srdf({("CHEST_LINK1", link): reason for link, (reason, _) in reasons.items()}))
        for link, (_, usual) in reasons.items():
            self.assertIn(f"The SRDF leaves out CHEST_LINK1 - {link} as {usual}; found: sometimes", done.stdout)
        self.assertIn("LARM_JOINT3=", done.stdout)

    def test_top_cuts_every_list_of_the_text_and_says_what_is_left(self):
        links = ["CHEST_LINK1"] + [f"{side}{limb}" for side in "LR" for limb in ("ARM_LINK5", "ARM_LINK6", "LEG_LINK3")]
        arguments = self.wrong_srdf({(a, b): "Never" for i, a in enumerate(links) for b in links[:i]})
        whole, cut = (self.run_tool(*arguments, "--top", top).stdout for top in ("1000", "2"))
        said = whole.count("The SRDF leaves out")
        self.assertGreater(said, 3)
        self.assertEqual(cut.count("The SRDF leaves out"), 2)
        self.assertIn(f"... and {said - 2} more (--top)", cut)
        self.assertNotIn("more (--top)", whole)
        self.assertLessEqual(len(cut.splitlines()), len(whole.splitlines()) - (said - 2))

    def test_a_page_names_files_without_their_folders(self):
        wall = self.put("wall.urdf", '<robot name="scene"><link name="wall"><collision><origin xyz="9 0 0"/><geometry><box size="0.1 1 1"/>'
                                     "</geometry></collision></link></robot>")
        pose, urdf = self.put("pose.json", "{}"), self.folded()  # which has a warning
        done = self.run_tool(urdf, "--format", "html", "--obstacles", wall, "--primitives", "flat")
        self.assertIn("/robot.urdf:", done.stderr)
        page = page_data(done.stdout)
        self.assertTrue(any(warning.startswith("robot.urdf: ") for warning in page["warnings"]), page["warnings"])
        self.assertEqual(page["title"], "collision report")
        self.assertNotIn(os.path.dirname(wall), json.dumps(page))
        above, folder = os.path.split(self.folder)
        near = subprocess.run([PROGRAM, f"{folder}/robot.urdf", "--no-cache", "--format", "html"], capture_output=True, text=True, cwd=above)
        self.assertIn(f"{folder}/robot.urdf:", near.stderr)
        self.assertTrue(any(warning.startswith("robot.urdf: ") for warning in page_data(near.stdout)["warnings"]))
        self.assertNotIn(folder, json.dumps(page_data(near.stdout)))
        posed = page_data(self.run_tool(urdf, "--format", "html", "--pose", pose).stdout)
        self.assertEqual(posed["pose"], "pose.json")
        self.assertEqual(posed["title"], "self-collision report")

    def test_what_only_hulls_make_collide_does_not_hide_behind_contacts(self):
        # Six boxes in the post of another one, and one box in the gap between the posts.
        gate = self.boxes("gate.obj", 0.1, (-0.3, 0, 0), (0.3, 0, 0))
        small = "".join(link(f"in{i}", self.boxes(f"in{i}.obj", 0.01, (0.3 + 0.025 * (i % 2), 0.025 * (i // 2), 0))) for i in range(6))
        robot = self.robot(link("gate", gate) + link("turn") + small + link("gap", self.boxes("gap.obj", 0.05, (0, 0, 0)))
                           + joint("j", "gate", "turn") + "".join(joint(f"j{name}", "turn", name) for name in (*(f"in{i}" for i in range(6)), "gap")))
        arguments = [robot, "--srdf", self.put("none.srdf", '<robot name="small"/>'), "--pose", self.put("pose.json", "{}"), "-r", "0.001"]
        whole, cut = (self.run_tool(*arguments, "--top", top).stdout for top in ("100", "4"))
        for text, contacts in ((whole, 6), (cut, 3)):
            self.assertEqual(text.count("meshes meet  "), contacts, text)
            self.assertRegex(text, r"\n *STP-BV +meshes +cover\b.*\npair .* cause .*\n")
            self.assertRegex(text, r"\nhull only, 1 pair:\ngate - gap +-\d+\.\d{3} +150\.000 +\d+\.\d{3}  hull only  ")
            self.assertIn("\nmeshes meet, 6 pairs:\n" if contacts == 6 else "\nmeshes meet, the 3 closest of 6 pairs:\n", text)
            self.assertNotIn("sometimes  ", text)
        self.assertIn("meshes: the distance of the meshes themselves, 0 where they meet\n-: the volumes are far enough apart\n", whole)
        self.assertIn("\nmeshes: the distance", cut)
        self.assertNotIn("\n-: ", cut)
        clear = self.humanoid("--pose", "half_sitting").stdout  # nothing collides: the text shows hulls, and why pairs are checked
        self.assertRegex(clear, r"\n *STP-BV +hulls +cover\b.*\npair .* reason .*\n")
        self.assertNotRegex(clear, r"\n[a-z ]+, .* pairs?:\n")  # one list
        allowed = self.humanoid("--margin", "-0.5").stdout  # nothing collides, but hulls overlap
        self.assertRegex(allowed, r"\n\w+ - \w+ +-\d+\.\d{3} +overlap ")

    def test_overlapping_primitives_are_a_collision(self):
        box = '<box size="1 1 1"/>'
        urdf = self.robot(link("a", box) + link("b") + link("c", box) + link("d", box)
                          + joint("j1", "a", "b") + joint("j2", "b", "c") + joint("j3", "c", "d")
                          + link("far", box) + joint("j4", "d", "far", origin="9 0 0"))
        report = json.loads(self.run_tool(urdf, "--format", "json", "--samples", "10").stdout)
        reasons = {(p["link1"], p["link2"]): p["reason"] for p in report["pairs"]}
        self.assertEqual(reasons[("a", "d")], "default")

    def test_an_srdf_that_leaves_out_no_pair_is_told(self):
        urdf = self.folded()
        states = self.put("states.srdf", '<robot name="small"><group name="all"/><group_state name="open" group="all">'
                          '<joint name="j2" value="1"/></group_state></robot>')
        told = f"{states}: leaves out no pair of links, so 2 pairs of adjacent or rigidly joined ones are checked too; "
        self.assertIn(told, self.run_tool(urdf, "--srdf", states).stderr)
        self.assertNotIn("leaves out no pair", self.run_tool(urdf).stderr)
        made = self.run_tool(urdf, "--srdf", states, "--format", "srdf", "-o", states)  # this adds the missing pairs
        self.assertNotIn("leaves out no pair", made.stderr)
        self.assertEqual(made.returncode, 1)
        self.assertIn(f"urdf_collision_report: {states} is written: 0 of 3 pairs left out before, 2 now; "
                      "exit status 1, as 3 checked pairs collide\n", made.stderr)
        again = self.run_tool(urdf, "--srdf", states, "--format", "srdf", "--disable-default")
        self.assertIn("urdf_collision_report: 2 of 3 pairs left out before, 3 now; exit status 1, as 1 checked pair collides\n", again.stderr)
        self.assertIn("urdf_collision_report: 2 of 3 pairs left out; exit", self.run_tool(urdf, "--format", "srdf").stderr)
        self.assertEqual(self.run_tool(urdf, "--format", "srdf", "-q").stderr, "")
        self.assertNotIn("leaves out no pair", self.run_tool(urdf, "--srdf", states).stderr)
        # Two arms that no joint makes neighbours: an SRDF without pairs gives no warning.
        ball = '<sphere radius="0.1"/>'
        apart = self.robot(link("root") + link("a", ball) + link("b", ball) + joint("j", "root", "a") + joint("k", "root", "b", origin="9 0 0"))
        none = self.put("none.srdf", '<robot name="small"/>')
        self.assertNotIn("leaves out no pair", self.run_tool(apart, "--srdf", none).stderr)

    def test_neighbours_that_are_checked_are_searched_before_they_are_called_clear(self):
        body = '<collision><origin xyz="0.3 0 0"/><geometry><box size="0.4 0.1 0.1"/></geometry></collision></link>'
        urdf = self.robot(f'<link name="a">{body}<link name="b">{body}<joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
                          '<origin rpy="0 0 2"/><axis xyz="0 0 1"/><limit lower="-3" upper="3" velocity="1" effort="1"/></joint>')
        none = self.put("none.srdf", '<robot name="small"/>')
        run = self.run_tool(urdf, "--srdf", none, "--format", "json")
        self.assertEqual(run.returncode, 1, run.stderr)
        pair = json.loads(run.stdout)["pairs"][0]
        self.assertEqual((pair["reason"], pair["checked"]), ("adjacent", True))
        self.assertLess(pair["min_distance"], 0)

    def test_nothing_checked_is_not_clear(self):
        ball = '<sphere radius="0.1"/>'
        urdf = self.robot(link("a", ball) + link("b", ball) + joint("j", "a", "b"))
        output = self.path("out")
        for form in ("text", "json", "csv", "srdf", "html"):
            done = self.run_tool(urdf, "--format", form, "-o", output)
            self.assertEqual(done.returncode, 2, form)
            self.assertIn("no pair of bodies is checked (1 adjacent)", done.stderr)
            self.assertIn(urdf, done.stderr)
            self.assertFalse(os.path.exists(output))
        alone = self.robot(link("a", ball) + link("b") + joint("j", "a", "b"))
        self.assertIn("no pair of bodies is checked (fewer than two links have a body)", self.run_tool(alone).stderr)
        everything = self.put("all.srdf", '<robot name="small"><disable_collisions link1="a" link2="b" reason="User"/></robot>')
        self.assertEqual(self.run_tool(urdf, "--srdf", everything).returncode, 2)

    def folded(self):
        """A ball, a bar that turns about its middle, and a ball at the bar's end that is folded back into the first one."""
        return self.robot(link("a", '<sphere radius="0.1"/>') + link("b", '<box size="0.02 0.6 0.02"/>') + link("elbow")
                          + link("c", '<sphere radius="0.05"/>') + joint("j1", "a", "b") + joint("j2", "b", "elbow", origin="0 0.3 0")
                          + joint("j3", "elbow", "c", "fixed", "0 -0.25 0"))

    def test_a_default_pair_that_clears_elsewhere_stays_checked_unless_asked_for(self):
        urdf = self.folded()
        report = json.loads(self.run_tool(urdf, "--format", "json").stdout)
        pair = {(p["link1"], p["link2"]): p for p in report["pairs"]}[("a", "c")]
        self.assertEqual((pair["reason"], pair["checked"]), ("default (clears elsewhere)", True))
        self.assertNotIn("Default", self.run_tool(urdf, "--format", "srdf").stdout)
        self.assertIn('link1="a" link2="c" reason="Default"', self.run_tool(urdf, "--format", "srdf", "--disable-default").stdout)
        rows = list(csv.DictReader(io.StringIO(self.run_tool(urdf, "--format", "csv").stdout)))
        self.assertIn("default (clears elsewhere)", [row["reason"] for row in rows])

    def test_a_neutral_posture_in_collision_is_told_with_a_better_one(self):
        urdf = self.folded()
        states = self.put("states.srdf", '<robot name="small"><group name="all"/><group_state name="open" group="all">'
                          '<joint name="j2" value="1"/></group_state></robot>')
        done = self.run_tool(urdf, "--srdf", states)
        self.assertIn("limit nearest to it): a - c; in another posture none does: give --neutral open.", done.stderr)
        again = self.run_tool(urdf, "--srdf", states)  # from the cache
        self.assertEqual(again.stderr, done.stderr)
        self.assertNotIn("neutral", self.run_tool(urdf, "--srdf", states, "--pose", "open").stderr)
        way = self.put("way.csv", "j2\n1\n0.9\n")
        self.assertNotIn("neutral", self.run_tool(urdf, "--srdf", states, "--trajectory", way).stderr)
        again = self.run_tool(urdf, "--srdf", states, "--neutral", "open", "--format", "json")
        self.assertNotIn("neutral", again.stderr)
        self.assertEqual({p["reason"] for p in json.loads(again.stdout)["pairs"]}, {"adjacent", "sometimes"})
        bare = json.loads(self.run_tool(urdf, "--format", "json").stdout)
        whole = self.put("report.json", json.dumps(bare))  # a report may name the posture
        mended = self.run_tool(urdf, "--neutral", whole, "--format", "json")
        self.assertEqual(json.loads(mended.stdout)["neutral"], {"colliding": 0})
        self.assertIn("proposes no neutral posture", self.run_tool(urdf, "--neutral", self.put("good.json", mended.stdout)).stderr)
        self.assertEqual((bare["neutral"]["colliding"], bare["neutral"]["better_colliding"]), (1, 0))
        better = self.put("better.json", json.dumps(bare["neutral"]["better"]))
        self.assertEqual(json.loads(self.run_tool(urdf, "--neutral", better, "--format", "json").stdout)["neutral"]["colliding"], 0)
        self.assertEqual(self.run_tool(urdf, "--neutral", "nowhere").returncode, 2)

    def test_what_cannot_be_read_exits_with_2_and_one_clear_message(self):
        bomb = '<!DOCTYPE r [<!ENTITY a "aa"><!ENTITY b "&a;&a;">]><robot name="x">&b;</robot>'
        cases = {
            "no such file": self.path("nothing.urdf"),
            "form a loop": self.put("loop.urdf", '<robot name="x">' + link("a") + link("b") + joint("j", "a", "b")
                                    + joint("k", "b", "a") + "</robot>"),
            "document type": self.put("bomb.urdf", bomb),
            "tried": self.put("missing.urdf", '<robot name="x">'
                              + link("a", '<mesh filename="package://nobody/a.stl"/>') + "</robot>"),
        }
        for words, path in cases.items():
            output = self.path("out.json")
            done = self.run_tool(path, "-o", output)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn(words, done.stderr)
            self.assertEqual(done.stdout, "")
            self.assertFalse(os.path.exists(output))
        lost = self.run_tool(self.put("lost.urdf", '<robot name="x">' + "".join(
            link(name, f'<mesh filename="package://{package}/{name}.stl"/>') for name, package in (("a", "nobody"), ("b", "nobody"), ("c", "other")))
            + joint("j", "a", "b") + joint("k", "b", "c") + "</robot>"))
        self.assertEqual([lost.stderr.count(words) for words in ("no such file; tried", "Give the folder that holds the package 'nobody'",
                                                                 "Give the folder that holds the package 'other'")], [3, 1, 1])
        for wrong in (["--samples", "0"], ["--format", "pdf"], ["-r", "-1"], ["-o", "/nowhere/x"]):
            self.assertEqual(self.humanoid(*wrong).returncode, 2, wrong)

    def test_ten_thousand_links_without_shapes_are_read_and_nothing_to_check(self):
        chain = link("l0") + "".join(link(f"l{i}") + joint(f"j{i}", f"l{i - 1}", f"l{i}") for i in range(1, 10000))
        done = self.run_tool(self.robot(chain), "--samples", "5")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("no link has a shape", done.stderr)

    def test_ten_thousand_bodies_have_too_many_pairs(self):
        ball = '<sphere radius="0.1"/>'
        chain = link("l0", ball) + "".join(link(f"l{i}", ball) + joint(f"j{i}", f"l{i - 1}", f"l{i}") for i in range(1, 10000))
        done = self.run_tool(self.robot(chain), "--samples", "5")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("49995000 pairs of 10000 bodies", done.stderr)

    def test_meshes_are_compared_with_the_polyhedra_published_for_them(self):
        robot = self.robot(link("a", self.boxes("first.obj", 0.1, (0, 0, 0))) + link("b", self.boxes("second.obj", 0.1, (0, 0, 0)))
                           + joint("j", "a", "b") + link("c", '<box size="1 1 1"/>') + joint("k", "b", "c", origin="9 0 0"))
        os.mkdir(self.path("published"))
        corners = [(x, y, z) for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.1, 0.101)]
        corners.append((0, 0, 0))  # inside, so it is no vertex
        self.put("published/first-ch.txt", "3\n%d 0 0\n" % len(corners) + "".join("%g %g %g\n" % c for c in corners))
        arguments = [robot, "-r", "0.01", "--samples", "5", "--polyhedra", self.path("published")]
        report = json.loads(self.run_tool(*arguments, "--format", "json").stdout)
        found = report["links"][0]["polyhedron"]
        self.assertEqual((found["vertices"], found["without_partner"], found["mesh_without_partner"]), (8, 4, 4))
        self.assertAlmostEqual(found["surface_difference"], 0.001, delta=1e-6)  # the height of the lid, except for its curvature
        self.assertEqual([link["polyhedron"] for link in report["links"][1:]], [None, None])
        text = self.run_tool(*arguments).stdout
        self.assertIn("1 mesh has a published polyhedron", text)
        self.assertRegex(text, r"\na +999\.\d+ +8, +8 +4, +4\n")

    def boxes(self, name, side, *middles):
        return '<mesh filename="file://%s"/>' % self.put(name, box_obj(side, *middles))

    def test_a_collision_is_explained_by_the_meshes(self):
        srdf, pose = self.put("none.srdf", '<robot name="small"/>'), self.put("pose.json", "{}")
        gate = self.boxes("gate.obj", 0.1, (-0.3, 0, 0), (0.3, 0, 0))  # its hull covers the gap of 0.4 m
        far = self.boxes("far.obj", 0.01, (5, 0, 0))
        # By position of the small box: its distance from the gate, and why the volumes meet.
        cases = {(0, 0, 0): (0.15, "hull only"), (0, 0, 0.155): (None, "margin only"), (0.3, 0.14, 0): (0, "meshes meet"),
                 (0.3, 0, 0): (0, "meshes meet"), (0.3, 0.155, 0): (0.005, "margin only"), (0.3, 0, 0.4): (None, "")}
        for middle, (distance, cause) in cases.items():
            robot = self.robot(link("a", gate) + link("b", far) + link("c", self.boxes("small.obj", 0.05, middle))
                               + joint("j", "a", "b") + joint("k", "b", "c"))
            done = self.run_tool(robot, "--srdf", srdf, "--pose", pose, "-r", "0.01", "--samples", "1", "--format", "json")
            report = json.loads(done.stdout)
            pair = next(p for p in report["pairs"] if (p["link1"], p["link2"]) == ("a", "c"))
            self.assertEqual(pair["cause"], cause, middle)
            self.assertEqual(done.returncode, 1 if cause else 0)
            self.assertEqual(report["summary"]["causes"], {cause: 1} if cause else {})
            self.assertEqual(pair["lipschitz"], 50)
            # The true distance is between the volumes' distance and that plus the amounts by which they
            # exceed the meshes.
            self.assertEqual(pair["mesh_distance_most"] is None, bool(cause))
            if not cause:
                apart = 0.4 - 0.15  # along z
                self.assertLessEqual(pair["distance"], apart)
                self.assertGreaterEqual(pair["mesh_distance_most"], apart)
            if distance is not None:
                self.assertAlmostEqual(pair["mesh_distance"], distance, delta=1e-6)  # the file's single precision
            text = self.run_tool(robot, "--srdf", srdf, "--pose", pose, "-r", "0.01", "--samples", "1").stdout
            self.assertIn("1 pair: " + cause if cause else "0 of them in collision", text)
        rows = list(csv.DictReader(io.StringIO(self.run_tool(robot, "--srdf", srdf, "--pose", pose, "--format", "csv").stdout)))
        self.assertLessEqual({"cause", "mesh_distance"}, set(rows[0]))

    def slides_through_a_gate(self):
        """A box that slides through the gap of a gate with two posts and never comes closer to them than 0.15 m."""
        gate = self.boxes("gate.obj", 0.1, (-0.3, 0, 0), (0.3, 0, 0))
        return (self.robot(link("gate", gate) + link("box", self.boxes("box.obj", 0.05, (0, 0, 0)))
                           + link("far", self.boxes("far.obj", 0.1, (5, 0, 0), (5.4, 0, 0)))
                           + joint("slide", "gate", "box", "prismatic", axis="0 0 1") + joint("turn", "gate", "far")),
                "--srdf", self.put("none.srdf", '<robot name="small"/>'), "-r", "0.01", "--samples", "50")

    def test_parts_clear_a_pair_that_only_its_hulls_make_collide(self):
        robot = self.slides_through_a_gate()
        whole = self.run_tool(*robot, "--format", "json")
        self.assertEqual(whole.returncode, 1)
        self.assertEqual(json.loads(whole.stdout)["summary"]["causes"], {"hull only": 1})
        done = self.run_tool(*robot, "--parts", "auto", "--format", "json")
        self.assertEqual(done.returncode, 0, done.stderr)
        report = json.loads(done.stdout)
        pair = next(p for p in report["pairs"] if {p["link1"], p["link2"]} == {"gate", "box"})
        # The post's side is 0.15 m away from the box's. The r of both lies in between, and what a part and
        # its volume exceed.
        covers = sum(l["over_cover_max"] or 0 for l in report["links"] if l["name"] in ("gate:1", "box"))
        self.assertLessEqual(pair["min_distance"], 0.15 - 0.02 + 1e-6)
        self.assertGreater(pair["min_distance"], 0.15 - covers - 1e-3)
        # Only the gate is split, into two parts, and only for this pair: one more row.
        self.assertEqual([l["name"] for l in report["links"] if "part_of" in l], ["gate:1", "gate:2"])
        self.assertEqual([p["by_parts"] for p in report["pairs"] if p is not pair], [False, False])
        rows = report["summary"]["rows"]
        self.assertEqual((rows["whole"], rows["parts"]), (3, 4))
        self.assertEqual(rows["hand_over"], 5)  # one more for the pair that uses parts
        self.assertLessEqual(rows["hand_over_live"], 5)
        text = self.run_tool(*robot, "--parts", "auto").stdout
        self.assertIn("gate in 2 parts", text)
        self.assertRegex(text, r"\nrows of a controller: 3 with whole bodies, \d+\.\d us a tick;\n  4 with parts, \d+\.\d us;\n"
                               r"  5 with hand-over to parts below 0\.1 m, \d of these rows not constant there, \d+\.\d us\n")
        # With everything in parts the result for this pair is the same, with more rows.
        every = json.loads(self.run_tool(*robot, "--parts", "2", "--format", "json").stdout)
        same = next(p for p in every["pairs"] if {p["link1"], p["link2"]} == {"gate", "box"})
        self.assertAlmostEqual(same["min_distance"], pair["min_distance"], delta=1e-6)
        self.assertEqual(every["summary"]["rows"]["parts"], 2 + 4 + 2)
        for wrong in ("1", "65", "some"):
            self.assertEqual(self.run_tool(*robot, "--parts", wrong).returncode, 2)

    def test_a_contact_behind_one_that_parts_clear_has_its_cause(self):
        # A box through the gap of a gate, then two balls that touch less deep than the precision of a closest approach.
        ball = '<sphere radius="0.05"/>'
        robot = self.robot(link("gate", self.boxes("gate.obj", 0.1, (-0.3, 0, 0), (0.3, 0, 0))) + link("box", self.boxes("box.obj", 0.05, (0, 0, 0)))
                           + link("still", ball) + link("moving", ball) + joint("slide", "gate", "box", "prismatic", axis="0 0 1")
                           + joint("turn", "gate", "still", origin="0 9 0") + joint("near", "gate", "moving", "prismatic", "1 9.06 0", "-1 0 0", (-2, 2)))
        done = self.run_tool(robot, "--srdf", self.put("none.srdf", '<robot name="small"/>'), "-r", "0.01", "--samples", "50", "--primitives", "flat",
                             "--parts", "auto", "--trajectory", self.put("way.csv", "slide,near\n1,0\n-1,0\n-1,0.92000000001\n-1,0\n"), "--format", "json")
        report = json.loads(done.stdout)
        self.assertEqual({report["trajectory"]["contact"][link] for link in ("link1", "link2")}, {"still", "moving"})
        self.assertEqual(report["summary"]["causes"], {"meshes meet": 1})

    def test_parts_come_from_the_cache_and_do_not_depend_on_the_number_of_threads(self):
        robot = (*self.slides_through_a_gate(), "--parts", "4", "--format", "json")
        kept = self.path("cache/fcl_stpbv")

        def report(*arguments):
            found = json.loads(self.run_tool(*robot, *arguments).stdout)
            for times in (found["summary"], found["summary"]["rows"]):  # these are measured again each time
                for name in [n for n in times if "us_per" in n or "ns_per" in n]:
                    del times[name]
            return found

        cold = report("--jobs", "1")
        entries = {name: os.stat(os.path.join(kept, name)).st_mtime_ns for name in os.listdir(kept)}
        for ending in (".parts", ".stpbv"):
            self.assertEqual(sum(name.endswith(ending) for name in entries), 3)
        self.assertEqual(report("--jobs", "3"), cold)
        self.assertEqual({name: os.stat(os.path.join(kept, name)).st_mtime_ns for name in os.listdir(kept)}, entries)
        self.assertEqual(report("--jobs", "2", "--no-cache"), cold)

    def test_a_search_is_kept_and_done_again_where_anything_it_reads_changes(self):
        box = self.boxes("box.obj", 0.1, (0.5, 0, 0))

        def arm(limit="1", origin="0 0 0.5"):
            bodies = "".join(link(name, box) for name in "abcd")
            joints = joint("one", "a", "b", origin=origin) + joint("two", "b", "c", origin="0 0 0.5") + joint("three", "c", "d")
            return self.robot((bodies + joints).replace('upper="1"', f'upper="{limit}"'))

        def report(*arguments):
            found = json.loads(self.run_tool(*arguments, "--format", "json").stdout)
            for name in [n for n in found["summary"] if "us_per" in n or "ns_per" in n]:
                del found["summary"][name]
            return found

        kept = self.path("cache/fcl_stpbv")
        entries = lambda: {name: os.stat(os.path.join(kept, name)).st_mtime_ns for name in os.listdir(kept) if name.endswith(".pairs")}
        first = report(arm())
        (entry, written), = entries().items()
        self.assertEqual(report(arm(), "--no-cache"), first)
        self.assertEqual(report(arm()), first)
        self.assertEqual(entries(), {entry: written})
        user = self.put("user.srdf", '<robot name="small"><disable_collisions link1="a" link2="c" reason="User"/></robot>')
        scene = self.put("scene.urdf", '<robot name="scene"><link name="ball"><collision><origin xyz="0 0 2"/><geometry>'
                                       '<sphere radius="0.1"/></geometry></collision></link></robot>')
        none = self.put("none.srdf", '<robot name="small"/>')
        other = self.put("neutral.json", '{"one": 0.5}')
        for count, change in enumerate(([arm(), "--seed", "2"], [arm(), "--samples", "100"], [arm(), "--margin", "0.01"],
                                        [arm(), "-r", "0.01"], [arm(), "--srdf", user], [arm(), "--srdf", none], [arm(), "--obstacles", scene],
                                        [arm(), "--neutral", other], ["2"], ["1", "0 0 0.4"])):
            if not os.path.isabs(change[0]):
                change = [arm(*change)]
            found = report(*change)
            self.assertEqual(len(entries()), count + 2, change)
            self.assertEqual(report(*change, "--no-cache"), found)
        with open(os.path.join(kept, entry), "r+b") as file:
            file.seek(-30, os.SEEK_END)
            file.write(b"9")
        self.assertEqual(report(arm()), first)

    def test_parts_are_not_made_where_meshes_meet(self):
        far = self.boxes("far.obj", 0.01, (5, 0, 0))
        gate = self.boxes("gate.obj", 0.1, (-0.3, 0, 0), (0.3, 0, 0))
        robot = self.robot(link("a", gate) + link("b", far) + link("c", self.boxes("small.obj", 0.05, (0.3, 0, 0)))
                           + joint("j", "a", "b") + joint("k", "b", "c"))
        done = self.run_tool(robot, "--srdf", self.put("none.srdf", '<robot name="small"/>'), "--pose",
                             self.put("pose.json", "{}"), "-r", "0.01", "--samples", "1", "--parts", "auto")
        self.assertEqual(done.returncode, 1)
        self.assertIn("No link needs to be split", done.stdout)

    def test_pairs_that_no_parts_clear_are_named(self):
        # A bar of 6 mm through a ring: the hulls of the parts still cover the hole.
        ring = [(math.cos(a), math.sin(a)) for a in (2 * math.pi * i / 24 for i in range(24))]
        points = [(x * radius, y * radius, z) for radius in (0.0035, 0.1) for z in (-0.05, 0.05) for x, y in ring]
        quads = [(a * 24 + i, a * 24 + (i + 1) % 24, b * 24 + (i + 1) % 24, b * 24 + i)
                 for a, b in ((1, 0), (2, 3), (0, 2), (3, 1)) for i in range(24)]
        tube = self.put("tube.obj", "".join("v %.9g %.9g %.9g\n" % p for p in points)
                        + "".join("f %d %d %d %d\n" % tuple(v + 1 for v in quad) for quad in quads))
        robot = self.robot(link("tube", f'<mesh filename="file://{tube}"/>') + link("far", self.boxes("far.obj", 0.01, (5, 0, 0)))
                           + link("bar", self.boxes("bar.obj", 0.0023, (0, 0, 0))) + joint("j", "tube", "far") + joint("k", "far", "bar"))
        done = self.run_tool(robot, "--srdf", self.put("none.srdf", '<robot name="small"/>'), "--pose",
                             self.put("pose.json", "{}"), "-r", "0.0001", "-R", "5", "--samples", "1", "--parts", "auto")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("  1 pair: hull only\n", done.stdout)
        self.assertIn("No parts clear the pair that collides by its hulls alone: tube - bar\n", done.stdout)
        self.assertNotIn("No link needs to be split", done.stdout)
        self.assertNotIn("rows of a controller", done.stdout)  # parts cost nothing

    def test_primitives_are_covered_where_a_pair_has_no_smooth_body(self):
        urdf = self.robot("".join(link("l%d" % i, shape) for i, shape in enumerate((
            '<box size="0.1 0.2 0.3"/>', '<capsule radius="0.05" length="0.2"/>', '<cylinder radius="0.05" length="0.2"/>',
            '<sphere radius="0.05"/>', '<box size="0.1 0.1 0.1"/>', '<capsule radius="0.02" length="0.1"/>')))
            + "".join(joint("j%d" % i, "l%d" % (i - 1), "l%d" % i) for i in range(1, 6)))
        every = ("--srdf", self.put("none.srdf", '<robot name="small"/>'))  # leaves no pair out
        smooth = json.loads(self.run_tool(urdf, *every, "--samples", "5", "--format", "json").stdout)
        self.assertTrue(all(pair["continuous"] for pair in smooth["pairs"]))
        covers = [link for link in smooth["links"] if link["r"] is not None]
        self.assertTrue(0 < len(covers) < 6)
        self.assertTrue(all(link["over_cover_max"] < 0.03 for link in covers))
        flat = json.loads(self.run_tool(urdf, *every, "--samples", "5", "--primitives", "flat", "--format", "json").stdout)
        self.assertFalse(any(pair["continuous"] for pair in flat["pairs"]))
        self.assertEqual(self.run_tool(urdf, "--primitives", "round").returncode, 2)

    def test_an_R_too_small_for_a_smooth_cover_is_told(self):
        box = '<box size="1 1 1"/>'
        urdf = self.robot(link("a", box) + link("b") + link("c", box) + joint("j", "a", "b", origin="3 0 0")
                          + joint("k", "b", "c", origin="3 0 0"))
        told = "R = 0.2 m is too small for the smooth cover of"
        self.assertIn(told, self.run_tool(urdf, "-R", "0.2", "--samples", "5").stderr)
        for fitting in (("-R", "2"), ("-R", "auto"), (), ("-R", "0.2", "--primitives", "flat")):
            self.assertNotIn("too small", self.run_tool(urdf, *fitting, "--samples", "5").stderr, fitting)

    def test_r_fits_the_link_unless_it_is_given(self):
        thin, thick = self.boxes("thin.obj", 0.005, (0, 0, 0)), self.boxes("thick.obj", 0.5, (0, 0, 0))
        urdf = self.robot(link("thin", thin) + link("thick", thick) + joint("j", "thin", "thick"))
        every = ("--srdf", self.put("none.srdf", '<robot name="small"/>'))  # leaves no pair out
        def radii(*arguments):
            links = json.loads(self.run_tool(urdf, *every, "--samples", "1", "--format", "json", *arguments).stdout)["links"]
            return [(link["r"], link["R"]) for link in links]
        (r1, R1), (r2, R2) = radii()
        self.assertAlmostEqual(r1, 0.0005, delta=1e-9)  # a twentieth of 1 cm
        self.assertEqual(r2, 0.01)
        self.assertEqual(radii("--r", "auto", "--R", "auto"), [(r1, R1), (r2, R2)])
        self.assertEqual(radii("-r", "0.003"), [(0.003, 10)] * 2)
        self.assertEqual(radii("-R", "7"), [(r1, 7), (r2, 7)])
        self.assertEqual(radii("--link", "thin=0.002,5"), [(0.002, 5), (r2, R2)])
        for wrong in ("automatic", "-0.1", "nan", "0.1x"):
            self.assertEqual(self.run_tool(urdf, "-r", wrong).returncode, 2, wrong)

    def test_a_folder_without_a_polyhedron_of_the_robot_is_refused(self):
        for folder in (self.folder, "/nowhere"):
            done = self.humanoid("--polyhedra", folder)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("--polyhedra " + folder, done.stderr)

    @unittest.skipUnless(os.path.isdir(SHARED), "skipped: no ../shared/robots")
    def test_jvrc1s_meshes_and_polyhedra_differ_by_their_last_digit(self):
        jvrc = os.path.join(SHARED, "jvrc_description")
        done = self.run_tool(jvrc + "/urdf/jvrc1.urdf", "--package-path", SHARED, "--pose", self.put("pose.json", "{}"),
                             "--format", "json", "-r", "0.01", "--polyhedra", jvrc + "/convex/jvrc1")
        found = {each["name"]: each["polyhedron"] for each in json.loads(done.stdout)["links"] if each["polyhedron"]}
        self.assertEqual(len(found), 35)
        self.assertLess(max(each["surface_difference"] for each in found.values()), 0.7e-6)
        self.assertEqual(sum(each["mesh_without_partner"] for each in found.values()), 0)
        self.assertEqual(sum(each["without_partner"] for each in found.values()), 5)

    @unittest.skipUnless(os.path.isdir(SHARED), "skipped: no ../shared/robots")
    def test_pairs_that_pandas_srdf_leaves_out_are_ours_too_or_come_with_a_collision(self):
        panda = os.path.join(SHARED, "panda_description")
        done = self.run_tool(panda + "/urdf/panda.urdf", "--srdf", panda + "/srdf/panda.srdf", "--package-path", SHARED,
                             "--samples", "500", "--format", "json")
        for pair in json.loads(done.stdout)["pairs"]:
            if pair["srdf_reason"] in ("Never", "Adjacent"):
                same = pair["reason"].startswith(pair["srdf_reason"].lower())
                self.assertTrue(same or pair["min_distance"] <= 0, pair)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

"""find_posture as a user runs it.

    test_find_posture.py PROGRAM SOURCE_FOLDER
"""
import json
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
FRIDGE = os.path.join(SOURCE, "data/fridge")
ARM = os.path.join(SOURCE, "test/tools/six_joint_arm.urdf")
REACH = os.path.join(SOURCE, "test/tools/reach.json")


class FindPosture(ToolCase):
    def run_tool(self, *arguments):
        return self.run_command(PROGRAM, *arguments)

    def run_task(self, task, *arguments):
        path = self.put("task.json", task if isinstance(task, str) else json.dumps(task))
        return self.run_tool(f"{ROBOT}.urdf", path, "--srdf", f"{ROBOT}.srdf", "--obstacles",
                             f"{FRIDGE}/fridge.urdf", *arguments)

    def read(self, path):
        """What a JSON file holds."""
        with open(path, encoding="utf-8") as file:
            return json.load(file)

    def pick_can(self):
        return self.read(f"{FRIDGE}/pick_can.json")

    def gate_task(self, height, **collisions):
        """A task for a box in the gap of a gate of two posts, or at some height in front of it."""
        mesh = '<mesh filename="%s"/>'
        self.put("gate.obj", box_obj(0.1, (-0.3, 0, 0), (0.3, 0, 0)))
        self.put("box.obj", box_obj(0.05, (0, 0, 0)))
        self.put("far.obj", box_obj(0.05, (9, 0, 0)))
        self.put("gate.urdf", '<robot name="gate">' + link("gate", mesh % "gate.obj") + link("far", mesh % "far.obj") + link("box", mesh % "box.obj")
                 + joint("slide", "gate", "far", "prismatic", axis="0 0 1") + joint("turn", "far", "box", axis="0 0 1") + "</robot>")
        self.put("gate.srdf", '<robot name="gate"/>')
        task = {"base": "fixed", "start": {"joints": {"slide": 1}}, "collisions": collisions,
                "placements": [{"link": "box", "target": {"position": [0, 0, height]}, "free": ["x", "y", "rx", "ry", "rz"]}]}
        self.put("gate.json", json.dumps(task))

    def gate_posture(self, *arguments):
        names = [self.path(name) for name in ("gate.urdf", "gate.json", "gate.srdf")]
        run = self.run_tool(*names[:2], "--srdf", names[2], "-r", "0.01", "--format", "json", *arguments)
        return run.returncode, json.loads(run.stdout or "{}"), run.stderr

    def test_a_link_in_the_way_by_its_hull_alone_is_split(self):
        self.gate_task(0)
        status, whole, _ = self.gate_posture()
        self.assertEqual((status, whole["feasible"], whole["parts"]), (1, False, {}))
        for parts in ("auto", "2", "5"):
            status, split, complaints = self.gate_posture("--parts", parts)
            self.assertEqual(status, 0, complaints)
            self.assertEqual(split["parts"], {"gate": 2})
            self.assertAlmostEqual(split["q"]["slide"], 0, delta=1e-6)
        # The file may request it too, and the command line overrides the file.
        self.gate_task(0, parts="auto")
        self.assertEqual(self.gate_posture()[0], 0)
        self.assertEqual(self.gate_posture("--parts", "none")[0], 1)
        self.gate_task(0, parts=4)
        self.assertEqual(self.gate_posture()[1]["parts"], {"gate": 2})

    def test_an_srdf_that_leaves_out_no_pair_is_told(self):
        self.gate_task(0.5)
        self.assertIn("gate.srdf: leaves out no pair of links, so 2 pairs of adjacent or rigidly joined ones are checked too", self.gate_posture()[2])

    def test_no_link_is_split_where_none_is_in_the_way_or_the_meshes_are(self):
        self.gate_task(0.5, parts="auto")
        status, far, _ = self.gate_posture()
        self.assertEqual((status, far["parts"]), (0, {}))
        task = self.read(self.path("gate.json"))
        task["collisions"]["margin"] = 0.14  # more than the posts leave: 0.15 m minus 2 r
        task["placements"][0]["target"]["position"] = [0, 0, 0]
        self.put("gate.json", json.dumps(task))
        self.assertEqual(self.gate_posture()[0], 1)

    def test_a_start_beyond_the_limits_begins_within_them(self):
        task = self.read(REACH)
        task["start"] = {"joints": {"joint1": 100}}
        path = self.put("reach.json", json.dumps(task))
        run = self.run_tool(ARM, path)
        self.assertEqual(run.returncode, 0, run.stdout)
        self.assertIn(f"{path}: start: the joint 'joint1' is at 100 rad, outside of its limits -3.1 to 3.1 rad; "
                      "the search starts within the limits.", run.stderr)

    def test_a_margin_below_zero_is_warned_of(self):
        self.gate_task(0.5, margin=-0.2)
        status, answer, complaints = self.gate_posture()
        self.assertEqual(status, 0)
        warning = "gate.json: the margin is negative: what overlaps by less than 0.2 m counts as clear."
        self.assertIn(warning, complaints)
        self.assertTrue(any(told.endswith(warning) for told in answer["warnings"]), answer["warnings"])
        self.gate_task(0.5, margin=0)
        self.assertNotIn("negative", self.gate_posture()[2])

    def test_parts_that_are_none_are_refused(self):
        for wrong in (1, 65, 2.5, "some", True, None):
            self.gate_task(0, parts=wrong)
            status, _, complaint = self.gate_posture()
            self.assertEqual(status, 2)
            self.assertIn("gate.json: collisions.parts: expected auto, none or a whole number from 2 to 64", complaint)
        self.gate_task(0)
        for wrong in ("1", "65", "some", "-2"):
            self.assertEqual(self.gate_posture("--parts", wrong)[0], 2)

    def test_the_can_is_picked(self):
        run = self.run_task(self.pick_can(), "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual(run.stderr, "")
        answer = json.loads(run.stdout)
        self.assertTrue({"feasible", "seconds", "iterations", "distance_calls", "gradient_calls", "pairs", "cost", "q",
                         "violations"} <= set(answer))
        self.assertIs(answer["feasible"], True)
        self.assertEqual(answer["violations"], [])
        self.assertEqual(answer["pairs"], 130 + 33)
        self.assertEqual(len(answer["q"]), 36)
        self.assertGreater(answer["distance_calls"], 100)
        self.assertIs(answer["without_collisions"]["feasible"], True)
        self.assertLess(answer["without_collisions"]["cost"], answer["cost"])

    def test_text_says_what_holds_the_posture(self):
        run = self.run_task(self.pick_can())
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertTrue(run.stdout.startswith("feasible"))
        for word in ("without collisions feasible", "163 pairs, 33", "active:", "lower_door", "LARM_JOINT3"):
            self.assertIn(word, run.stdout)

    def test_the_page_shows_the_posture_among_the_obstacles(self):
        out = self.path("page.html")
        run = self.run_task(self.pick_can(), "--format", "html", "-o", out)
        self.assertEqual(run.returncode, 0, run.stderr)
        with open(out, encoding="utf-8") as file:
            page = file.read()
        self.assertTrue(page.startswith("<!DOCTYPE html>") and page.rstrip().endswith("</html>"))
        data = page_data(page)
        self.assertEqual(len(data["pairs"]), 163)
        self.assertEqual(data["summary"]["colliding"], 0)
        self.assertGreaterEqual(data["pairs"][0]["distance"], 0)
        self.assertEqual(len(data["configurations"]), 1)
        self.assertIn("lower_door", [pair["link2"] for pair in data["pairs"] if pair["obstacle"]])
        self.assertIn("upper_door", [body["name"] for body in data["bodies"] if body["obstacle"]])
        asked = self.pick_can()
        self.assertEqual([t["name"] for t in data["targets"]], [p.get("name", p["link"]) for p in asked["placements"]])
        for target, placement in zip(data["targets"], asked["placements"]):
            place = placement["target"].get("position", [0, 0, 0])
            for k in range(3):
                self.assertAlmostEqual(target["target"][4 * k + 3], place[k], delta=1e-6)
                if not placement.get("free"):
                    self.assertAlmostEqual(target["frame"][4 * k + 3], place[k], delta=1e-4)
            self.assertLess(max(target["off"], target["turned"]), 1e-5)
        contacts = asked["stability"]["contacts"]
        self.assertEqual([(c["link"], len(c["points"])) for c in data["contacts"]], [(c["link"], len(c["points"])) for c in contacts])
        for contact in data["contacts"]:
            for point in contact["points"]:
                self.assertAlmostEqual(point[2], 0, delta=1e-4)  # on the floor
        careless = self.run_task(self.pick_can(), "--format", "html", "--ignore-collisions", "-r", "0.01")
        page = page_data(careless.stdout)
        self.assertEqual(page["summary"]["colliding"], 7)
        self.assertRegex(page["pose"], r"^feasible without regard to collisions, 7 of \d+ pairs in collision \(converged\)")
        self.assertEqual(page["title"], "posture for task.json")  # not the folder that it is in
        self.assertTrue(page["skipped"] == [] and page["sampled"] is False)

    def test_the_page_has_a_body_for_each_name_of_its_pairs(self):
        self.gate_task(0, parts=2, margin=0.01)
        names = [self.path(name) for name in ("gate.urdf", "gate.json", "gate.srdf")]
        data = page_data(self.run_tool(*names[:2], "--srdf", names[2], "--format", "html").stdout)
        paired = {name for pair in data["pairs"] for name in (pair["link1"], pair["link2"])}
        self.assertIn("gate:1", paired)
        self.assertLessEqual(paired, {body["owner"] for body in data["bodies"]})
        self.assertEqual(data["summary"]["margin"], 0.01)

    def test_collisions_that_are_ignored_are_reported(self):
        careless = self.run_task(self.pick_can(), "--format", "json", "--ignore-collisions", "-r", "0.01")
        self.assertEqual(careless.returncode, 0, careless.stderr)
        told = [line.split(": ", 1)[1] for line in careless.stderr.splitlines() if "in collision" in line]
        self.assertEqual(len(told), 7)
        text = self.run_task(self.pick_can(), "--ignore-collisions", "-r", "0.01").stdout
        self.assertRegex(text, r"^feasible without regard to collisions, 7 of \d+ pairs in collision \(converged\): ")
        self.assertRegex(self.run_task(self.pick_can(), "-r", "0.01").stdout, r"^feasible \(")
        self.assertEqual([warning for warning in json.loads(careless.stdout)["warnings"] if "in collision" in warning], told)
        self.assertTrue(any("upper_door" in line and re.search(r", -0\.\d+ m$", line) for line in told), told)

    def stands_at(self, position, obstacle, *arguments, base="fixed"):
        """A ball on a slide along x, 1 m above its base, with another ball of the same 5 cm as an obstacle."""
        ball = '<sphere radius="0.05"/>'
        slide = self.put("slide.urdf", '<robot name="r">' + link("base", ball) + link("slider", ball)
                         + joint("s", "base", "slider", "prismatic", "0 0 1") + "</robot>")
        post = self.put("post.urdf", '<robot name="r">' + link("world") + link("post", ball) + joint("p", "world", "post", "fixed", obstacle) + "</robot>")
        task = self.put("stands.json", json.dumps({"base": base, "start": {"base": {"position": position}}, "cost": {"towards": "start"},
                                                   "placements": []}))
        return self.run_tool(slide, task, "--obstacles", post, "--primitives", "flat", *arguments)

    def test_a_fixed_base_stands_where_the_task_puts_it_in_every_format(self):
        run = self.stands_at([5, 0, 2], "5 0.5 3", "--format", "html")
        self.assertEqual(run.returncode, 0, run.stderr)
        distances = {pair["link1"]: pair["distance"] for pair in page_data(run.stdout)["pairs"] if pair["obstacle"]}
        self.assertAlmostEqual(distances["slider"], 0.4, delta=1e-6)
        self.assertAlmostEqual(distances["base"], (1 + 0.25) ** 0.5 - 0.1, delta=1e-6)
        at_origin = self.stands_at([0, 0, 0], "0 0 0", "--format", "json")
        self.assertEqual(at_origin.returncode, 1, at_origin.stderr)
        answer = json.loads(at_origin.stdout)
        self.assertEqual([v["constraint"] for v in answer["conflict"]], ["base - post"])
        self.assertAlmostEqual(answer["conflict"][0]["amount"], 0.1, delta=1e-6)
        self.assertEqual(self.stands_at([0, 0, 1], "0 0 0").returncode, 0)
        planar = self.stands_at([0, 0, 1], "0 0 2", "--format", "html", base="planar")
        self.assertEqual(planar.returncode, 0, planar.stderr)
        self.assertGreaterEqual(min(pair["distance"] for pair in page_data(planar.stdout)["pairs"]), 0)

    def test_what_cannot_be_done_ends_with_1_and_names_why(self):
        task = self.pick_can()
        task["placements"][2]["target"]["position"] = [1.6, 0, 1]
        run = self.run_task(task, "--starts", "2", "--format", "json")
        self.assertEqual(run.returncode, 1, run.stderr)
        answer = json.loads(run.stdout)
        self.assertIs(answer["feasible"], False)
        self.assertEqual(answer["starts"], 2)
        units = {v["constraint"]: v["unit"] for v in answer["conflict"]}
        self.assertEqual(units["left hand x"], "m")
        self.assertEqual({unit for name, unit in units.items() if name.endswith((" rx", " ry", " rz"))} - {"rad"}, set())
        text = self.run_task(task, "--starts", "2").stdout
        self.assertTrue(text.startswith("not feasible"))
        self.assertIn("in conflict; each with its violation at the least-squares compromise:", text)
        self.assertRegex(text, r"\n  left hand x: \d+\.\d{3} mm\n")
        violated = page_data(self.run_task(task, "--starts", "2", "--format", "html").stdout)["violated"]
        for kind, said in (("violations", ": violated by"), ("conflict", ": in conflict, violated by")):
            self.assertTrue(answer[kind])
            for missed in answer[kind]:
                self.assertIn((missed["constraint"], True), [(line.split(":")[0], said in line) for line in violated])

    def test_a_mistake_ends_with_2_and_one_line(self):
        task = self.pick_can()
        task["placements"][2]["link"] = "LARM_LINK9"
        for run, words in ((self.run_task(task), ["task.json: placements[2].link", "'LARM_LINK9'; did you mean 'LARM_LINK0'?"]),
                           (self.run_task("{"), ["task.json", "JSON"]),
                           (self.run_task(self.pick_can(), "-o", self.folder), ["is a folder"]),
                           (self.run_tool(f"{ROBOT}.urdf", f"{FRIDGE}/pick_can.json"), ["start.state", "--srdf"]),
                           (self.run_tool(f"{ROBOT}.urdf", f"{FRIDGE}/pick_can.json", "--srdf", f"{ROBOT}.srdf"),
                            ["collisions.pairs[0].obstacles", "give --obstacles"]),
                           (self.run_tool(f"{ROBOT}.urdf", "nothing.json"), ["nothing.json"])):
            self.assertEqual(run.returncode, 2, run.stdout)
            self.assertEqual(run.stdout, "")
            self.assertEqual(run.stderr.count("\n"), 1, run.stderr)
            for word in words:
                self.assertIn(word, run.stderr)
        empty = self.run_task({"placements": []})
        self.assertEqual((empty.returncode, empty.stdout), (2, ""))
        self.assertIn("task.json: asks for nothing; give a placement", empty.stderr)
        task["placements"][2]["link"] = "\x1b[31mred\r"
        self.assertIn("the robot has no link '?[31mred?'", self.run_task(task).stderr)
        self.assertEqual(self.run_tool().returncode, 2)
        self.assertEqual(self.run_task(self.pick_can(), "--format", "xml").returncode, 2)
        self.assertEqual(self.run_tool("--help").returncode, 0)

    def arm(self, collisions):
        task = self.read(REACH)
        task["collisions"] = collisions
        return self.put("reach.json", json.dumps(task))

    def test_an_arm_is_posed_from_its_bare_urdf(self):
        run = self.run_tool(ARM, REACH, "--format", "json")
        self.assertEqual(run.returncode, 0, run.stderr)
        answer = json.loads(run.stdout)
        self.assertIs(answer["feasible"], True)
        # 21 pairs. Six are adjacent. The flange cannot leave the first part of the wrist. With a smooth
        # cover, the second part cannot leave the forearm.
        self.assertEqual(answer["pairs"], 13)
        flat = self.run_tool(ARM, REACH, "--format", "json", "--primitives", "flat")
        self.assertEqual(json.loads(flat.stdout)["pairs"], 14)

    def test_an_answer_says_how_close_the_closest_pair_is(self):
        run = self.run_tool(ARM, REACH, "--format", "json")
        closest = json.loads(run.stdout)["closest"]
        page = page_data(self.run_tool(ARM, REACH, "--format", "html").stdout)
        pair = page["pairs"][0]  # the closest pair comes first
        self.assertIn(closest["pair"], (f"{pair['link1']} - {pair['link2']}", f"{pair['link2']} - {pair['link1']}"))
        self.assertAlmostEqual(closest["distance"], pair["min_distance"], 8)  # the page rounds
        text = self.run_tool(ARM, REACH).stdout
        self.assertRegex(text, f"closest: {closest['pair']}, {1e3 * abs(closest['distance']):.4g} mm (apart|deep)\n")
        self.assertEqual(closest["distance"] < 0, " mm deep" in text)

    def test_a_base_that_the_task_does_not_name_is_free_and_said_to_be(self):
        task = self.read(REACH)
        for base in (None, "floating", "fixed"):
            task.pop("base", None)
            if base:
                task["base"] = base
            path = self.put("base.json", json.dumps(task))
            run = self.run_tool(ARM, path, "--format", "json")
            self.assertEqual(run.returncode, 0, run.stderr)
            said = [w for w in json.loads(run.stdout)["warnings"] if "how the robot's base moves" in w]
            self.assertEqual(len(said), 0 if base else 1)
            self.assertEqual("how the robot's base moves" in run.stderr, not base)
            self.assertEqual("base/x" in json.loads(run.stdout)["q"], base != "fixed")

    def test_every_pair_has_a_smooth_body_and_r_fits_the_link_as_in_the_report(self):
        def page(*arguments):
            run = self.run_tool(ARM, REACH, "--format", "html", *arguments)
            self.assertEqual(run.returncode, 0, run.stderr)
            return page_data(run.stdout)
        fitted = page()
        self.assertTrue(all(pair["continuous"] for pair in fitted["pairs"]))
        covers = {link["name"]: link["r"] for link in fitted["links"] if link["r"] is not None}
        self.assertTrue(covers)
        self.assertFalse(any(pair["continuous"] for pair in page("--primitives", "flat")["pairs"]))
        fixed = {link["name"]: link["r"] for link in page("-r", "0.002")["links"] if link["r"] is not None}
        self.assertNotEqual(fixed, covers)
        self.assertEqual({link["name"]: link["r"] for link in page("-r", "auto")["links"] if link["r"] is not None}, covers)

    def test_a_task_ignores_pairs_of_links(self):
        def pairs(ignore):
            run = self.run_tool(ARM, self.arm({"ignore": ignore}), "--format", "json")
            self.assertEqual(run.returncode, 0, run.stderr)
            return json.loads(run.stdout)["pairs"]
        self.assertEqual(pairs([{"links": ["base"], "self": ["forearm"]}]), 12)
        self.assertEqual(pairs([{"links": ["forearm"], "self": ["base"]}]), 12)
        self.assertEqual(pairs([{"links": ["base"], "self": []}]), 13 - 5)
        wrong = self.run_tool(ARM, self.arm({"ignore": [{"links": ["base"]}, {"self": ["nobody"]}]}))
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("collisions.ignore[1].self", wrong.stderr)

    def test_nothing_to_check_is_no_answer(self):
        out = self.path("posture.json")
        for none in ({"self": False}, {"ignore": [{"self": []}]}):
            run = self.run_tool(ARM, self.arm(none), "-o", out)
            self.assertEqual(run.returncode, 2)
            self.assertIn("no pair of bodies is checked", run.stderr)
            self.assertIn("six_joint_arm.urdf", run.stderr)
            self.assertFalse(os.path.exists(out))
        self.assertEqual(self.run_tool(ARM, self.arm({"self": False}), "--ignore-collisions").returncode, 0)

    def test_the_scenes_are_what_their_scripts_write(self):
        for scene in "fridge", "ladder":
            run = subprocess.run([sys.executable, "-B", f"{FRIDGE}/../{scene}/make_{scene}.py", "--check"], capture_output=True, text=True)
            self.assertEqual(run.returncode, 0, run.stdout)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])

"""Postures and motions that urdf_collision_report is given: all of them is judged, or it says what is not.

    test_report_postures.py PROGRAM
"""
import json
import os
import sys
import unittest

from small_robot import joint, link
from tool_case import ToolCase

PROGRAM = sys.argv[1]

BALL = '<sphere radius="0.1"/>'

# Two balls that slide towards each other from 1 m apart. They meet after each has moved by at least 0.4 m.
ROBOT = ('<robot name="two">' + link("base") + link("left", BALL) + link("right", BALL) +
         joint("l", "base", "left", "prismatic") + joint("r", "base", "right", "prismatic", "1 0 0") + "</robot>")
WALL = ('<robot name="scene"><link name="wall"><collision><origin xyz="5 0 0"/><geometry><box size="0.1 9 9"/></geometry></collision>'
        "</link></robot>")


def state(name, group, **joints):
    values = "".join(f'<joint name="{joint}" value="{value}"/>' for joint, value in joints.items())
    return f'<group_state name="{name}" group="{group}">{values}</group_state>'


class Postures(ToolCase):
    def setUp(self):
        super().setUp()
        self.urdf = self.put("robot.urdf", ROBOT)

    def report(self, *arguments, status):
        done = self.run_command(PROGRAM, self.urdf, "--no-cache", "--samples", "100", "--format", "json", *arguments)
        self.assertEqual(done.returncode, status, done.stderr)
        return done.stderr if status == 2 else json.loads(done.stdout)

    def colliding(self, *arguments):
        return self.report(*arguments, status=1)

    def srdf(self, body):
        return self.put("robot.srdf", f'<robot name="two">{body}</robot>')

    def test_states_of_one_name_in_two_groups_are_one_posture(self):
        srdf = self.srdf(state("meet", "one", l=0.5) + state("meet", "other", r=-0.4))
        self.colliding("--srdf", srdf, "--pose", "meet")
        srdf = self.srdf(state("meet", "one", l=0.5) + state("meet", "other", l=0.4))
        self.assertIn("'l'", self.report("--srdf", srdf, "--pose", "meet", status=2))

    def test_a_joint_that_the_robot_does_not_have_is_told(self):
        srdf = self.srdf(state("typo", "one", left=0.9))
        warnings = self.report("--srdf", srdf, "--pose", "typo", status=0)["warnings"]
        self.assertTrue(any("'typo'" in w and "'left'" in w for w in warnings), warnings)

    def test_joints_that_a_pose_does_not_name_stay_as_in_the_neutral_posture(self):
        neutral, pose = self.put("neutral.json", '{"r": -0.5}'), self.put("pose.json", '{"l": 0.5}')
        self.colliding("--neutral", neutral, "--pose", pose)
        self.report("--pose", pose, status=0)

    def test_a_virtual_joint_that_moves_the_base_is_refused_beside_obstacles(self):
        joint = '<virtual_joint name="v" type="floating" parent_frame="world" child_link="base"/>'
        scene = self.put("scene.urdf", WALL)
        for value, status in (("5 0 0 0 0 0 1", 2), ("0 0 0 0 0 0 1", 0)):
            srdf = self.srdf(joint + state("away", "one", v=value, l=0.1))
            told = self.report("--srdf", srdf, "--pose", "away", "--obstacles", scene, status=status)
            if status == 2:
                self.assertIn("virtual joint 'v'", told)
            self.report("--srdf", srdf, "--pose", "away", status=0)  # the position of the base changes nothing

    def test_a_name_of_a_state_and_of_a_file_is_refused(self):
        srdf = self.srdf(state("home", "one", l=0.5))
        folder = os.getcwd()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, folder)
        self.put("home", '{"l": -0.5}')
        for option in ("--pose", "--neutral"):
            self.assertIn(f"{option} home: is a state of the SRDF and a file; give ./home",
                          self.report("--srdf", srdf, option, "home", status=2))
        pairs = self.report("--srdf", srdf, "--pose", "./home", status=0)["pairs"]
        self.assertAlmostEqual(pairs[0]["distance"], 1.3, delta=1e-6)  # two balls whose centres are 1.5 m apart
        os.remove("home")
        self.assertAlmostEqual(self.report("--srdf", srdf, "--pose", "home", status=0)["pairs"][0]["distance"], 0.3, delta=1e-6)

    def test_a_posture_in_collision_contradicts_a_never_of_the_search_and_of_the_srdf(self):
        # The balls touch at l = 0.3 only. No descent ends there to rounding, and a proof has no end.
        self.urdf = self.put("passes.urdf", '<robot name="two">' + link("base", '<box size="1 1 1"/>') + link("left", BALL) + link("right", BALL) +
                             joint("l", "base", "left", "prismatic", "0 5 0", "0 1 0", (0, 1)) + joint("r", "base", "right", origin="0.2 5.3 0") + "</robot>")
        never = self.srdf('<disable_collisions link1="left" link2="right" reason="Never"/>')

        def pair(*arguments, status):
            return next(p for p in self.report(*arguments, status=status)["pairs"] if {p["link1"], p["link2"]} == {"left", "right"})
        pose = self.put("pose.json", '{"l": 0.3}')
        self.assertEqual(pair("--srdf", never, status=0)["reason"], "never (sampled)")
        self.assertEqual(pair("--srdf", never, "--pose", pose, status=0)["reason"], "sometimes")
        self.assertEqual(pair("--pose", pose, status=1)["reason"], "sometimes")
        command = PROGRAM, self.urdf, "--no-cache", "--samples", "100", "--pose"
        self.assertIn("leaves out left - right as Never; found: sometimes, meshes meet, 0.000 mm at l=0.3000",
                      self.run_command(*command, pose, "--srdf", never).stdout)
        self.assertNotIn('"Never"', self.run_command(*command, pose, "--format", "srdf").stdout)
        # A collision beyond the limits leaves the search as it is.
        told = self.run_command(*command, self.put("beyond.json", '{"l": 0.3, "r": 3}'), "--srdf", never).stdout
        self.assertIn("leaves out left - right as Never; found: never (sampled) within the limits, meshes meet, 0.000 mm at l=0.3000", told)

    def test_what_leaves_the_limits_is_told(self):
        pose = self.put("pose.json", '{"l": -90, "r": -2}')
        warnings = self.report("--pose", pose, status=0)["warnings"]
        self.assertTrue(any("'l' is at -90 m" in w and "-1 to 1" in w and "1 other" in w for w in warnings), warnings)
        motion = self.put("motion.csv", "l,r\n0,0\n-3,0\n")
        warnings = self.report("--trajectory", motion, status=0)["warnings"]
        self.assertTrue(any("way point 1 (from 0)" in w and "'l'" in w for w in warnings), warnings)
        within = self.put("within.csv", "l,r\n0,0\n-1,0\n")
        self.assertFalse(any("way point" in w for w in self.report("--trajectory", within, status=0)["warnings"]))

    def test_what_follows_another_joint_beyond_its_limits_is_told(self):
        self.urdf = self.put("follows.urdf", ROBOT.replace(
            'name="r" type="prismatic">', 'name="r" type="prismatic"><mimic joint="l" multiplier="-3"/>'))
        warnings = self.report("--pose", self.put("pose.json", '{"l": -0.9}'), status=0)["warnings"]
        self.assertTrue(any("'r' is at 2.7 m" in w and "-1 to 1" in w for w in warnings), warnings)
        warnings = self.report("--pose", self.put("pose.json", '{"l": -0.3}'), status=0)["warnings"]
        self.assertFalse(any("limits" in w for w in warnings), warnings)

    def test_a_posture_takes_the_names_of_coordinates(self):
        self.urdf = self.put("planar.urdf", ROBOT.replace('name="l" type="prismatic"', 'name="l" type="planar"'))
        with_names = self.report("--pose", self.put("pose.json", '{"l/x": 0.1, "l/y": 0.2, "r": 0.1}'), status=0)
        with_list = self.report("--pose", self.put("pose.json", '{"l": [0.1, 0.2, 0], "r": 0.1}'), status=0)
        self.assertEqual(with_names["pairs"], with_list["pairs"])
        for text, told in (('{"l/x": 0.1, "l": [0, 0, 0]}', "give one"), ('{"l/x": [1, 2]}', "is one number"),
                           ('{"l/w": 1}', "no joint 'l/w'"), ('{"r/x": 1}', "no joint 'r/x'")):
            self.assertIn(told, self.report("--pose", self.put("pose.json", text), status=2))

    def test_a_misspelt_joint_is_told_with_the_near_one(self):
        self.urdf = self.put("grip.urdf", ROBOT.replace('name="r" type="prismatic">', 'name="finger2" type="prismatic"><mimic joint="l"/>'))
        for name, told in (("pose.json", '{"fingr2": 0}'), ("motion.csv", "fingr2\n0\n0.1\n")):
            option = "--pose" if name == "pose.json" else "--trajectory"
            self.assertIn("joint 'fingr2'; did you mean 'finger2'?", self.report(option, self.put(name, told), status=2))
        told = self.report("--neutral", self.put("neutral.json", '{"Neutral": {"better": {"l": 0}}}'), status=2)
        self.assertIn("no joint 'Neutral'; did you mean 'neutral'?", told)

    def test_an_answer_of_find_posture_is_a_posture(self):
        fixed = self.put("fixed.json", '{"feasible": true, "q": {"l": 0.5, "r": -0.5}, "pairs": 1}')
        moving = self.put("moving.json", '{"q": {"base/x": 1, "base/rz": 2, "l": 0.5, "r": -0.5}}')
        scene = self.put("scene.urdf", WALL)
        for answer in (fixed, moving):
            self.colliding("--pose", answer)
        self.colliding("--pose", fixed, "--obstacles", scene)
        self.assertIn("places the base", self.report("--pose", moving, "--obstacles", scene, status=2))
        self.assertIn("no joint 'x'", self.report("--pose", self.put("other.json", '{"q": {"x": 1}}'), status=2))
        for text, told in (('{"q": {"l": 0.5}, "r": -0.5}', "'r' is no key of an answer of find_posture; remove it, or give a file of joints' values alone"),
                           ('{"q": {"l": 0.5}, "feasable": true}', "'feasable' is no key of an answer of find_posture; did you mean 'feasible'?"),
                           ('{"neutral": {"better": {"l": 0.5}}, "r": 0}', "'r' is no key of a collision report; remove it"),
                           ('{"neutral": {"beter": {"l": 0.5}}}', "neutral: 'beter' is no key of what a collision report says of it; did you mean 'better'?")):
            self.assertIn(told, self.report("--pose", self.put("beside.json", text), status=2))
        self.urdf = self.put("q.urdf", ROBOT.replace('"l"', '"q"'))  # a joint with this name
        self.colliding("--pose", self.put("own.json", '{"q": 0.5, "r": -0.5}'))

    def test_a_byte_order_mark_is_no_letter_of_a_name(self):
        self.colliding("--trajectory", self.put("motion.csv", "\ufeffl,r\n0,0\n0.5,-0.5\n"))

    def test_a_misspelt_word_of_a_trajectory_is_refused(self):
        motion = self.put("motion.json", '{"joints": ["l"], "points": [[0], [0.1]], "times": [0, 1]}')
        self.assertIn('"times"', self.report("--trajectory", motion, status=2))

    def test_a_column_of_a_joint_without_a_coordinate_is_refused_as_that(self):
        self.urdf = self.put("mimic.urdf", ROBOT.replace('name="l" type="prismatic">', 'name="l" type="prismatic"><mimic joint="r"/>'))
        self.assertIn("'l' follows 'r'", self.report("--trajectory", self.put("motion.csv", "l,r\n0,0\n0.1,0.1\n"), status=2))
        self.urdf = self.put("planar.urdf", ROBOT.replace('name="l" type="prismatic"', 'name="l" type="planar"'))
        self.assertIn("name l/x and", self.report("--trajectory", self.put("motion.csv", "l,r\n0,0\n0.1,0.1\n"), status=2))
        self.assertIn("commas stand", self.report("--trajectory", self.put("motion.csv", "l;r\n0;0\n0.1;0.1\n"), status=2))
        self.assertIn("carriage returns alone", self.report("--trajectory", self.put("motion.csv", "l,r\r0,0\r0.1,0.1\r"), status=2))

    def test_a_joint_named_time_is_not_taken_for_the_time(self):
        self.urdf = self.put("timed.urdf", ROBOT.replace('"r"', '"time"'))
        said = self.report("--trajectory", self.put("motion.csv", "time,l\n0,0\n0.5,0\n"), status=2)
        self.assertIn("'time' is a joint", said)
        # JSON has a separate place for the times.
        points = [[0, 0], [-0.5, 0.5]]
        for text in ({"joints": ["time", "l"], "points": points, "time": [0, 2]},
                     {"joint_names": ["time", "l"], "points": [{"positions": q, "time_from_start": 2.0 * k} for k, q in enumerate(points)]}):
            found = self.colliding("--trajectory", self.put("motion.json", json.dumps(text)))["trajectory"]
            self.assertTrue(found["timed"])
            self.assertAlmostEqual(found["contact"]["time"], 1.6, delta=1e-5)  # both have moved by 0.4 m
        self.urdf = self.put("robot.urdf", ROBOT)
        for name, text in (("motion.json", '{"joints": ["time", "l"], "points": [[0, 0], [1, 0.1]]}'), ("motion.csv", "Time,l\n0,0\n1,0.1\n")):
            self.assertRegex(self.report("--trajectory", self.put(name, text), status=2), "no moving joint '[Tt]ime'")
        self.assertIn("did you mean 'time'?", self.report("--trajectory", self.path("motion.csv"), status=2))

    def test_stamps_of_a_clock_count_from_the_first(self):
        rows = [(0, 0, 0), (0.5, 0.2, -0.1), (2, 0.6, -0.4)]
        plain = self.put("plain.csv", "time,l,r\n" + "".join(f"{t},{l},{r}\n" for t, l, r in rows))
        stamped = self.put("stamped.csv", "time,l,r\n" + "".join(f"{t + 1700000003},{l},{r}\n" for t, l, r in rows))
        expected, found = self.colliding("--trajectory", plain), self.colliding("--trajectory", stamped)
        self.assertEqual(found["trajectory"]["contact"], expected["trajectory"]["contact"])
        self.assertTrue(any("count from its first one, 1700000003 s" in w for w in found["warnings"]), found["warnings"])
        for time in ("1e13", "nan"):
            far = self.put("far.csv", f"time,l,r\n0,0,0\n{time},0.1,0\n")
            self.assertIn("within 1e6 s of the first", self.report("--trajectory", far, status=2))

    def test_joints_that_stand_still_are_told(self):
        door = ('<robot name="scene"><link name="wall"><collision><origin xyz="5 0 0"/><geometry><box size="0.1 9 9"/></geometry>'
                '</collision></link><link name="door"/>' + joint("hinge", "wall", "door", "prismatic") + "</robot>")
        neutral = self.put("neutral.json", "{}")
        warnings = self.report("--obstacles", self.put("scene.urdf", door), "--pose", neutral, status=0)["warnings"]
        self.assertTrue(any("'hinge' stands still" in w for w in warnings), warnings)
        self.urdf = self.put("locked.urdf", ROBOT.replace('lower="-1" upper="1" ', ""))
        warnings = self.report(status=0)["warnings"]
        self.assertTrue(any("'l', 'r' have no range" in w for w in warnings), warnings)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

"""The examples of the documentation beside another robot, and with folders that are not there; their pages, and what the demo prints:
test_examples.py BIN_FOLDER PROJECT"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAMS, PROJECT = (pathlib.Path(a).resolve() for a in sys.argv[1:3])


class Examples(unittest.TestCase):
    def run_in(self, folder, name, *arguments):
        program = PROGRAMS / f"example_{name}"
        if not program.exists():  # the example of IPOPT, if IPOPT is not installed
            self.skipTest(f"{name} was not built")
        return subprocess.run([program, *arguments], cwd=folder, capture_output=True, text=True, timeout=100)

    def test_a_joint_that_the_robot_does_not_have_is_named(self):
        with tempfile.TemporaryDirectory() as folder:
            shutil.copy(PROJECT / "test/tools/six_joint_arm.urdf", f"{folder}/hrp2_style.urdf")
            shutil.copy(PROJECT / "data/hrp2_style/hrp2_style.srdf", folder)
            for name in ("controller", "motion", "ipopt"):
                with self.subTest(name):
                    done = self.run_in(folder, name)
                    self.assertEqual(done.returncode, 1)
                    self.assertRegex(done.stderr, r"hrp2_style.urdf: has no joint '[LR]ARM_JOINT\d' ")

    def test_a_folder_that_is_not_there_is_told_before_the_work(self):
        done = self.run_in(PROJECT / "data/hrp2_style", "controller", "/nowhere")
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertIn("/nowhere/controller.csv: cannot be written", done.stderr)

    def check_page(self, page):
        """Its title is its only main heading, it has a dark scheme, and whatever is wide scrolls by itself."""
        text = page.read_text()
        found = re.findall(r"<h1>(.*?)</h1>", text)
        self.assertEqual(re.findall(r"<title>(.*?)</title>", text), found)
        self.assertEqual(len(found), 1)
        self.assertLess(text.index("<h1"), text.index("<h2"))
        self.assertIn("prefers-color-scheme: dark", text)
        for wide in ("<svg", "<table"):
            self.assertEqual(len(re.findall(wide, text)), len(re.findall(rf'<div class=["\']chart[^>]*>\s*{wide}', text)), wide)
        return text, found[0]

    def test_the_page_of_the_controller(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(self.run_in(PROJECT / "data/hrp2_style", "controller", folder).returncode, 0)
            text, found = self.check_page(pathlib.Path(folder) / "controller.html")
            self.assertEqual(found.count("rad/s²"), 2)
            self.assertIn("10 mm, to be kept", text)

    def test_the_page_of_the_controller_in_python(self):
        module = PROGRAMS.parent / "python"
        if not (module / "fcl_stpbv").is_dir():
            self.skipTest("the Python module was not built")
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(["/usr/bin/python3", "-B", PROJECT / "docs/examples/controller.py", PROJECT, folder], capture_output=True,
                                  text=True, env=dict(os.environ, PYTHONPATH=str(module)), timeout=100)
            self.assertEqual(done.returncode, 0, done.stderr)
            text, found = self.check_page(pathlib.Path(folder) / "controller_py.html")
            self.assertEqual(found.count("rad/s²"), 2)
            self.assertEqual(text.count("<polyline"), 4)
            self.assertIn("10 mm, to be kept", text)

    def test_the_page_of_the_planner_says_one_clearance(self):
        with tempfile.TemporaryDirectory() as folder:
            page = pathlib.Path(folder) / "page.html"
            self.assertEqual(self.run_in(folder, "ompl", PROJECT / "data", "1", page).returncode, 0)
            text, found = self.check_page(page)
            self.assertIn("proven free", found)
            self.assertEqual(re.findall(r"clearance is (\S+ mm)\.", text), re.findall(r"closest: (\S+ mm)", text))
            classes = set(re.findall(r'<polygon class="([^"]*)"', page.read_text()))
            self.assertEqual(classes, {"thing", "start", "between", "end"})

    def test_the_demo_fits_a_terminal_and_begins_with_what_it_found(self):
        done = subprocess.run([PROGRAMS / "demo"], capture_output=True, text=True, timeout=100)
        self.assertEqual(done.returncode, 0)
        lines = done.stdout.splitlines()
        self.assertLessEqual(max(map(len, lines)), 80)
        self.assertIn("mirrored postures: plain FCL is off", lines[3])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

"""The examples of the documentation beside another robot, and with folders that are not there: test_examples.py BIN_FOLDER PROJECT"""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAMS, PROJECT = (pathlib.Path(a).resolve() for a in sys.argv[1:3])


class Examples(unittest.TestCase):
    def run_in(self, folder, name, *arguments):
        program = PROGRAMS / f"example_{name}"
        if not program.exists():  # that of IPOPT, where it is not installed
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


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

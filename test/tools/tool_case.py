"""Tests of a program, each in a folder of its own."""
import os
import subprocess
import tempfile
import unittest


class ToolCase(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        """A cache for the project's robot, which many tests use, so that it is built once. Other robots have a cache of the test's own."""
        shared = tempfile.TemporaryDirectory()
        cls.addClassCleanup(shared.cleanup)
        cls.shared = shared.name

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = os.path.realpath(folder.name)

    def path(self, name):
        return os.path.join(self.folder, name)

    def put(self, name, text):
        """Writes a file of the folder. @return its path"""
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return self.path(name)

    def environment(self, *command):
        cache = self.shared if any(str(word).endswith("hrp2_style.urdf") for word in command) else self.path("cache")
        return dict(os.environ, XDG_CACHE_HOME=cache)

    def run_command(self, *command, timeout=120, **options):
        return subprocess.run(list(map(str, command)), capture_output=True, text=True, env=self.environment(*command), timeout=timeout, **options)

    def shell(self, command, **options):
        return self.run_command("bash", "-c", command, **options)

    def refused(self, done, *says):
        """Checks that a program has refused what it was given, with a message that has these words."""
        self.assertEqual((done.returncode, done.stdout), (2, ""), done)
        for words in says:
            self.assertIn(words, done.stderr)

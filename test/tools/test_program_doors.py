"""The tools and scripts: numbers that are none, unknown options and output that cannot be written are told, with status 2.

    test_program_doors.py BIN_FOLDER PROJECT
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from terminal import shown_on_terminal

BIN, PROJECT = (pathlib.Path(folder).resolve() for folder in sys.argv[1:3])
# Everything that was built, except Catch2's test programs: examples, programs with options, and programs that take a few plain numbers.
BUILT = [path for path in sorted(BIN.iterdir()) if path.is_file() and os.access(path, os.X_OK) and not path.name.startswith("test_")]
EXAMPLES = [path for path in BUILT if path.name.startswith("example_")]
PROGRAMS = [path for path in BUILT if path not in EXAMPLES and b"Options:" in subprocess.run([path, "--help"], capture_output=True, timeout=60).stdout]
SOAKS = [path for path in BUILT if path not in EXAMPLES + PROGRAMS]
# Words that some scripts accept: ctest's options, names of files and folders, and words that a program of the
# project refuses itself.
TAKE = {"nonsense": ("demo", "fuzz", "make_packages"), "--no-such-option": ("test",)}
NO_NUMBERS = ["nan", "-nan", "inf", "-inf", "1e400", "1e-310", "1,5", "1.5x", "x", "", " "]


def run(program, *arguments, **options):
    return subprocess.run([program, *arguments], capture_output="stdout" not in options, text=True, timeout=60, **options)


def entries_of(program):
    """(names, kind of value or "" where it takes none) of all options and places on the command line, from the help. Numbers
    have NUMBER as their kind, given words are the kind themselves, or WORD."""
    for line in run(program, "--help").stdout.splitlines():
        entry = re.match(r"  (\S+)(?: (\S+))?", line)
        if entry and not line.startswith("   "):
            yield entry[1], entry[2] or ""


def numbers_of(program):
    """(option, or None for a positional argument; the number of positional arguments before it)."""
    places = 0
    for name, kind in entries_of(program):
        if "NUMBER" in kind:
            yield (None, places) if name[0] != "-" else (name.split(",")[0], 0)
        places += name[0] != "-"


class Programs(unittest.TestCase):
    def refused(self, done, *says):
        self.assertEqual(done.returncode, 2, done)
        self.assertEqual(done.stdout, "", done)
        for words in says:
            self.assertIn(words, done.stderr)

    def test_help_and_version_go_to_standard_output_and_a_full_one_is_a_failure(self):
        for program in PROGRAMS:
            with self.subTest(program.name):
                for option in ("--help", "--version"):
                    done = run(program, option)
                    self.assertEqual((done.returncode, done.stderr), (0, ""), done)
                    self.assertTrue(done.stdout)
                    self.refused_output(program, option)
                self.assertRegex(run(program, "--version").stdout, rf"^{program.name} \d+\.\d+\.\d+\n$")

    def test_none_of_the_kinds_of_programs_is_missing(self):
        for programs, least in ((EXAMPLES, 9), (PROGRAMS, 9), (SOAKS, 9)):
            self.assertGreaterEqual(len(programs), least, programs)

    def test_soaks_print_their_usage_and_a_full_standard_output_is_a_failure(self):
        for program in SOAKS:
            with self.subTest(program=program.name):
                done = run(program, "--help")
                self.assertEqual((done.returncode, done.stderr), (0, ""), done)
                self.assertIn(program.name, done.stdout)
                self.refused_output(program, "--help")

    def refused_output(self, program, *arguments, **options):
        with open("/dev/full", "w") as full:
            done = run(program, *arguments, stdout=full, stderr=subprocess.PIPE, **options)
        self.assertEqual(done.returncode, 2, done)
        self.assertIn("standard output cannot be written", done.stderr)

    def test_examples_refuse_what_they_do_not_take_and_a_full_standard_output(self):
        for program in EXAMPLES:
            for words in (["--no-such-option"], ["-Z"], ["a", "b", "c", "d"]):
                with self.subTest(program=program.name, words=words):
                    self.refused(run(program, *words), "usage: ")
            if program.name not in ("example_controller", "example_ompl", "example_parts"):  # two write files, one takes ten seconds
                with self.subTest(program=program.name):
                    self.refused_output(program, cwd=PROJECT / "data/hrp2_style")

    def test_a_list_of_benchmarks_that_cannot_be_written_is_a_failure(self):
        self.refused_output(PROJECT / "tools/bench/all", "--list")

    def test_help_fits_the_terminal_or_else_80_columns(self):
        def longest(text):
            return max(len(line) for line in text.splitlines() if len(line.split()) > 1)  # a word is never split
        for program in PROGRAMS:
            with self.subTest(program=program.name):
                text = run(program, "--help").stdout
                self.assertLessEqual(longest(text), 80)
                self.assertNotRegex(text, r"Examples:\n(  .*\n)*   ")  # help2man makes an option of a broken line
                for internal in ("Excludes:", "Needs:", ":NUMBER", "REQUIRED", ":{"):
                    self.assertNotIn(internal, text)
        for columns, least, most in ((50, 40, 50), (90, 80, 90), (200, 90, 100)):  # wider lines are hard to read
            shown = shown_on_terminal(self, [BIN / "mesh_to_stpbv", "--help"], "stdout", columns)
            self.assertTrue(least < longest(shown) <= most, (columns, longest(shown)))

    def test_an_option_that_there_is_not_is_refused(self):
        for program in PROGRAMS:
            for option in ("--no-such-option", "-Z", "--seeed=1"):
                with self.subTest(program=program.name, option=option):
                    self.refused(run(program, option))

    def test_soaks_refuse_what_they_do_not_know_and_numbers_that_are_none(self):
        for program in SOAKS:
            for words in (["--no-such-option"], ["-1"], ["nan"], ["1e400"], ["1x"], [""], ["9" * 30], ["1"] * 2 + ["--no-such-option"]):
                with self.subTest(program=program.name, words=words):
                    self.refused(run(program, *words), "usage: ")

    def test_scripts_refuse_what_they_do_not_know_before_they_do_anything(self):
        scripts = [path for folder in ("tools", "tools/hooks", "data/fridge", "data/hard_cases", "data/hrp2_style", ".ci")
                   for path in sorted((PROJECT / folder).iterdir())
                   if path.is_file() and path.read_bytes()[:2] == b"#!"]
        self.assertGreater(len(scripts), 12)
        for script in scripts:
            for word in ("nonsense", "--no-such-option"):
                if script.name in TAKE.get(word, ()):
                    continue
                with self.subTest(script=script.name, word=word):
                    self.refused(run(*([sys.executable, script] if script.suffix == ".py" else [script]), word, cwd=PROJECT))
        self.refused(run(PROJECT / ".ci/run", "format", "nonsense"), "nonsense")  # before the first stage

    def test_a_number_that_is_none_is_refused_by_every_option_that_takes_one(self):
        tried = 0
        for program in PROGRAMS:
            for option, places in numbers_of(program):
                for value in NO_NUMBERS:
                    with self.subTest(program=program.name, option=option, value=value):
                        tried += 1
                        given = [f"{option}={value}" if option[1] == "-" else option + value] if option else \
                            ["1"] * places + [value]
                        # An empty word after a short option's letter leaves the option without a value.
                        self.refused(run(program, *given), *([option] if option and value.strip() else []))
        self.assertGreater(tried, 100)

    def test_an_empty_value_is_refused_by_every_option_that_takes_one(self):
        tried = 0
        for program in PROGRAMS:
            for names, kind in entries_of(program):
                option = names.split(",")[-1]
                if kind == "" or option[0] != "-":
                    continue
                for given in [option, ""], [option + "=", "1"]:
                    if given[1] and not option.startswith("--"):
                        continue  # after a short option's letter, the sign belongs to its value
                    with self.subTest(program=program.name, given=given):
                        tried += 1
                        self.refused(run(program, *given), option + ": the value is empty")
        self.assertGreater(tried, 150)

    def test_a_word_that_an_option_does_not_know_is_refused(self):
        tried = set()
        for program in PROGRAMS:
            for names, kind in entries_of(program):
                option = names.split(",")[-1]
                if option[0] == "-" and (kind == "WORD" or "|" in kind and "NUMBER" not in kind):
                    with self.subTest(program=program.name, option=option):
                        tried.add((program.name, option))
                        self.refused(run(program, option, "nonsense"), option, "nonsense")
        self.assertLessEqual({("stability", "--method"), ("stability", "--list"), ("speed_accuracy", "--only")}, tried)

    def test_a_name_that_no_file_can_have_is_refused_before_the_work(self):
        tried = 0
        for name, robot in (("control_bench", False), ("parts_benchmark", False), ("proof_boxes", True), ("constraints_benchmark", True),
                            ("robot_bench", True), ("scene_models", True)):
            if (BIN / name).exists():
                with self.subTest(program=name):
                    tried += 1
                    self.refused(run(BIN / name, *["robot.urdf"] * robot, "--name", "a/b"), "--name a/b: ")
        self.assertGreaterEqual(tried, 1)

    def test_a_folder_that_does_not_exist_is_refused_before_the_work_and_not_made(self):
        tried = 0
        with tempfile.TemporaryDirectory() as place:
            for program in PROGRAMS:
                entries = dict(entries_of(program))
                if "-o,--output" not in entries or program.name in ("mesh_to_stpbv", "urdf_to_stpbv", "urdf_collision_report", "find_posture"):
                    continue
                for folder, says in ((place + "/missing", "this folder does not exist; make it first"), (__file__, "is a file, expected a folder")):
                    with self.subTest(program=program.name, folder=folder):
                        tried += 1
                        self.refused(run(program, *["robot.urdf"] * ("ROBOT" in entries), "-o", folder), f"-o {folder}: {says}")
                        self.assertEqual(os.listdir(place), [])
            for script in ("radii", "scale", "posture_grid"):
                with self.subTest(script=script):
                    self.refused(run(PROJECT / "tools/bench" / script, "-o", place + "/missing"), "-o/--output: ", "this folder does not exist; make it first")
        self.assertGreaterEqual(tried, 6)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])

"""Runs the shell commands that the pages show: run_commands.py PROJECT BUILD_FOLDER

A command is a line of an indented block that begins with a program of the project. It runs in a folder of sample files that
have the names the pages use and must end with 0. A block below <!-- not run: REASON --> is listed with its reason instead.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

project, build = (pathlib.Path(a).resolve() for a in sys.argv[1:3])
pages = [project / "README.md", project / "CONTRIBUTING.md", *sorted((project / "docs").glob("*.md")),
         *sorted((project / "data").glob("*/README.md"))]
programs = {path.name for path in (build / "bin").iterdir()} | {".ci/run", "python3"}
programs |= {f"tools/{path.name}" for path in (project / "tools").iterdir()}
programs |= {f"build/release/bin/{name}" for name in list(programs)}


def commands(page):
    """(line number, command, reason not to run it or "") of a page."""
    reason, in_block = "", False
    for number, line in enumerate(page.read_text().splitlines(), 1):
        marked = re.fullmatch(r"<!-- not run: (.*) -->", line)
        if marked:
            reason = marked[1]
        elif line.startswith("    "):
            in_block = True
            if line.split()[0] in programs:
                yield number, line.strip(), reason
        elif line.strip() or in_block:
            reason = reason if not in_block and not line.strip() else ""
            in_block = False


def make_samples(folder):
    robot, fridge, ladder = (project / "data" / name for name in ("hrp2_style", "fridge", "ladder"))
    shutil.copytree(robot, folder, dirs_exist_ok=True)
    shutil.copytree(fridge, folder / "fridge")
    (folder / "data").symlink_to(project / "data")  # for pages whose commands are run in the project's folder
    for source, name in ((robot / "hrp2_style.urdf", "robot.urdf"), (robot / "hrp2_style.srdf", "robot.srdf"),
                         (fridge / "pick_can.json", "pick_can.json"), (fridge / "pick_can.json", "task.json"),
                         (fridge / "fridge.urdf", "fridge.urdf"), (ladder / "ladder.urdf", "ladder.urdf"),
                         (ladder / "climb.json", "climb.json"), (ladder / "climb_grid.json", "climb_grid.json"), (fridge / "fridge.urdf", "scene.urdf"),
                         (project / "test/tools/six_joint_arm.urdf", "arm.urdf"), (project / "test/tools/reach.json", "reach.json")):
        shutil.copy(source, folder / name)
    (folder / "tetra-ch.txt").write_text("3\n4 4 6\n0 0 0\n0.3 0 0\n0 0.3 0\n0 0 0.3\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")


ran, failed = 0, []
with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    make_samples(folder)
    programs_first = f"{build}/bin:{pathlib.Path(sys.executable).parent}:{os.environ['PATH']}"
    environment = {**os.environ, "PATH": programs_first, "PYTHONPATH": f"{build}/python", "XDG_CACHE_HOME": f"{folder}/cache",
                   "ROS_PACKAGE_PATH": name}
    for page in pages:
        for number, command, reason in commands(page):
            where = f"{page.relative_to(project)}:{number}: {command}"
            if reason:
                print(f"{where}\n    not run: {reason}")
                continue
            start = time.monotonic()
            done = subprocess.run(["bash", "-c", command], cwd=folder, env=environment, capture_output=True, text=True, timeout=300)
            ran += 1
            print(f"{where}\n    {'ok' if done.returncode == 0 else 'FAILED'}, {time.monotonic() - start:.1f} s")
            if done.returncode != 0:
                failed.append(where)
                print(done.stdout[-1000:], done.stderr[-1000:])
print(f"{ran} commands run, {len(failed)} failed", *failed, sep="\n")
sys.exit(1 if failed or ran < 8 else 0)

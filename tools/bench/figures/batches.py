"""Runs batches of the module in the build folder, for the benchmarks about them."""
import os
import pathlib
import subprocess

PROJECT = pathlib.Path(__file__).resolve().parents[3]
HRP2 = PROJECT / "data/hrp2_style/hrp2_style"
PYTHON = "/usr/bin/python3"  # Debian's Python, for which the module is built
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(PROJECT / "build/release/python")}


def batch(*arguments):
    subprocess.run([PYTHON, "-m", "fcl_stpbv.batch", *map(str, arguments), "-q"], check=True, env=ENVIRONMENT)


def grid(scene, task):
    """The arguments for a scene's grid of postures."""
    folder = PROJECT / "data" / scene
    return ["postures", f"{HRP2}.urdf", folder / f"{task}.json", "--grid", folder / f"{task}_grid.json", "--srdf", f"{HRP2}.srdf",
            "--obstacles", folder / f"{scene}.urdf"]

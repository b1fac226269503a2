"""Files of measurements in the format of the C++ benchmarks (tools/bench/measurement.h): one row per line."""
import argparse
import json
import pathlib
import re


def processor():
    found = re.search(r"model name\s*:\s*(.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return found[1] if found else "unknown processor"


def folder(text):
    """The folder that -o names, checked before the work."""
    path = pathlib.Path(text)
    if not path.is_dir():
        raise argparse.ArgumentTypeError(f"{text}: is a file, expected a folder" if path.exists() else f"{text}: this folder does not exist; make it first")
    return path


def write(folder, name, command, about, rows, machine=""):
    """Writes NAME.json into the folder, completely or not at all."""
    content = {"command": command, "machine": machine, "spread": 0, "about": about}
    text = "{\n" + "".join(f"{json.dumps(key)}: {json.dumps(value)},\n" for key, value in content.items())
    text += '"rows": [\n' + ",\n".join(map(json.dumps, rows)) + "\n]\n}\n"
    part = folder / f"{name}.part"
    part.write_text(text)
    part.rename(folder / f"{name}.json")

"""Files of measurements in the format of the C++ benchmarks (tools/bench/measurement.h): one row per line."""
import json
import pathlib
import re


def processor():
    found = re.search(r"model name\s*:\s*(.*)", pathlib.Path("/proc/cpuinfo").read_text())
    return found[1] if found else "unknown processor"


def write(folder, name, command, about, rows, machine=""):
    """Writes NAME.json into the folder, completely or not at all."""
    content = {"command": command, "machine": machine, "spread": 0, "about": about}
    text = "{\n" + "".join(f"{json.dumps(key)}: {json.dumps(value)},\n" for key, value in content.items())
    text += '"rows": [\n' + ",\n".join(map(json.dumps, rows)) + "\n]\n}\n"
    folder.mkdir(parents=True, exist_ok=True)
    part = folder / f"{name}.part"
    part.write_text(text)
    part.rename(folder / f"{name}.json")

"""Checks the input and output files of a batch before any work: no output may replace an input or another output."""
import os
import pathlib

import fcl_stpbv
from fcl_stpbv.batch import bundle


def volume_name(mesh):
    return pathlib.Path(mesh).stem + ".stpbv"


def inputs(arguments):
    """All files that a command line reads, except those of --merge."""
    given = vars(arguments)
    urdfs = [given[key] for key in ("robot", "obstacles") if given.get(key)]
    others = [given[key] for key in ("srdf", "grid") if given.get(key)] + given.get("tasks", [])
    meshes = [path for urdf in urdfs for _, path in bundle.robot_meshes(urdf, arguments.package_path)] + given.get("meshes", [])
    return urdfs + others + [part for mesh in meshes for part in bundle.mesh_parts(mesh).values()]


def outputs(arguments):
    """(option, path) of all files that a command line writes."""
    given = vars(arguments)
    srdf = [("--write-srdf", given["write_srdf"])] if given.get("write_srdf") else []
    return [("-o", arguments.output), *srdf, *(("--volumes", pathlib.Path(arguments.volumes, volume_name(mesh))) for mesh in given.get("meshes", []))]


def identity(path):
    """An identity of a file, the same for all its names and links."""
    try:
        found = os.stat(path)
        return found.st_dev, found.st_ino
    except OSError:
        return os.path.realpath(path)


def check(arguments):
    """Raises fcl_stpbv.Error for outputs that are not regular files, that are inputs, or that are the same file."""
    read, merged = ({identity(path) for path in paths} for paths in (inputs(arguments), arguments.merge))
    taken = {}
    for option, path in dict.fromkeys(outputs(arguments)):
        where, place, folder = f"{option} {path}", identity(path), os.path.dirname(os.path.realpath(path))
        if str(path) == "-":
            raise fcl_stpbv.Error(f"{where}: a run goes on from its files, and standard output is none; name a file")
        bundle.require_file(path, where)
        if place in read or (place in merged and option != "-o"):  # a run may continue in a file that it merges
            raise fcl_stpbv.Error(f"{where}: is an input, and writing would replace it; give {option} another name")
        if place in taken:
            raise fcl_stpbv.Error(f"{where}: is the same file as {taken[place]}; give one of them another name")
        if option != "--volumes" and not os.path.isdir(folder):
            raise fcl_stpbv.Error(f"{where}: the folder {folder} does not exist; make it first")
        taken[place] = where

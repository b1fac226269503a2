"""The bundle that is sent to the workers: a dictionary from name to content of all files that jobs need, identified by its digest."""
import hashlib
import html
import json
import os
import pathlib
import re
import tempfile
import urllib.parse

import fcl_stpbv

FILENAME = re.compile(rb"""<!--.*?-->|(filename\s*=\s*)("[^"]*"|'[^']*')""", re.DOTALL)  # comments are passed over


def require_file(path, name=None):
    """Raises fcl_stpbv.Error if the path is a folder, a pipe or a device. A path that does not exist is accepted."""
    if os.path.exists(path) and not os.path.isfile(path):
        raise fcl_stpbv.Error(f"{name or path}: is a folder, a pipe or a device, expected a file")


def read(path, pipe=False):
    """The content of a file; raises fcl_stpbv.Error naming it. With `pipe`, for files that are read only once, it may be a pipe."""
    if not pipe:
        require_file(path)
    try:
        return pathlib.Path(path).read_bytes()
    except OSError as error:
        raise fcl_stpbv.Error(f"{path}: cannot be read: {error.strerror}") from None


def buffer_uris(path):
    """The URIs of a glTF file's buffers. Empty if the file cannot be read; the mesh reader reports that error."""
    try:
        buffers = json.loads(path.read_bytes().decode("utf-8-sig", "surrogateescape"))["buffers"]
        uris = [buffer.get("uri") for buffer in (buffers.values() if isinstance(buffers, dict) else buffers)]  # a dict in glTF 1.0
    except (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError):
        return []
    return [uri for uri in uris if isinstance(uri, str) and not uri.startswith("data:")]


def mesh_parts(path):
    """{name: path} of a mesh and, for a glTF file, its buffers, which are beside it or in folders below; the mesh comes first. The mesh reader
    uses a buffer's name literally. So the name keeps a percent sign, even if the file's name is the decoded one."""
    path = pathlib.Path(path)
    parts = {path.name: path}
    if path.suffix.lower() != ".gltf" or not path.is_file():
        return parts
    folders = [os.path.realpath(path.parent), os.path.dirname(os.path.realpath(path))]  # for a link, also files beside its target
    for uri in buffer_uris(path):
        name = os.path.normpath(uri.replace("\\", "/"))
        for part in (path.parent / name, path.parent / urllib.parse.unquote(name, errors="surrogateescape")):
            inside = os.path.isfile(part) and any(pathlib.Path(os.path.realpath(part)).is_relative_to(folder) for folder in folders)
            if inside and not name.startswith(("/", "../")):
                parts.setdefault(name, part)
    return parts


def mesh_entries(path):
    """(name, content) of a mesh and its buffers, the mesh first."""
    return [(name, read(part)) for name, part in mesh_parts(path).items()]


def robot_meshes(urdf, package_path):
    """The meshes of a robot: their names in the URDF, and their paths."""
    try:
        return fcl_stpbv.mesh_files(str(urdf), [str(folder) for folder in package_path])
    except UnicodeDecodeError:
        raise fcl_stpbv.Error(f"{urdf}: the path of one of its meshes is not UTF-8; rename the file or its folder") from None


def robot_files(role, urdf, package_path):
    """The files of one robot. Its meshes are renamed by their content, so that they are found on any machine."""
    files, places = {}, {}
    for uri, path in robot_meshes(urdf, package_path):
        entries = mesh_entries(path)
        known = digest_of(dict(entries))[:32]
        places[uri] = f"{known}/{entries[0][0]}"
        files.update({f"{role}/{known}/{name}": content for name, content in entries})

    def moved(match):
        if match[1] is None:
            return match[0]
        place = places.get(html.unescape(match[2][1:-1].decode("utf-8", "replace")))
        return match[1] + b'"' + html.escape(place).encode() + b'"' if place else match[0]

    files[f"{role}/robot.urdf"] = FILENAME.sub(moved, read(urdf))
    return files


def digest_of(files):
    """The SHA-256 of all names and contents."""
    total = hashlib.sha256()
    for name in sorted(files):
        total.update(f"{len(name)} {name} {len(files[name])} ".encode("utf-8", "surrogateescape"))
        total.update(files[name])
    return total.hexdigest()


class Unpacked:
    """Context manager: writes the files into a temporary folder, which is removed at the end of the `with` block."""

    def __init__(self, files):
        self.files = files

    def __enter__(self):
        self.folder = tempfile.TemporaryDirectory(prefix="fcl_stpbv_")
        for name, content in self.files.items():
            path = pathlib.Path(self.folder.name, name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        return pathlib.Path(self.folder.name)

    def __exit__(self, *_):
        self.folder.cleanup()

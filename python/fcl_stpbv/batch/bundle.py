"""All files that jobs need, in one dictionary from name to content, known by its digest: what travels to the workers."""
import hashlib
import html
import json
import pathlib
import re
import tempfile

import fcl_stpbv

FILENAME = re.compile(rb"""(filename\s*=\s*)("[^"]*"|'[^']*')""")


def read(path):
    """The content of a file; raises fcl_stpbv.Error naming it."""
    try:
        return pathlib.Path(path).read_bytes()
    except OSError as error:
        raise fcl_stpbv.Error(f"{path}: cannot be read: {error.strerror}") from None


def mesh_entries(path):
    """(name, content) of a mesh, the mesh first, and of the buffers that a glTF file has beside it."""
    path = pathlib.Path(path)
    content = read(path)
    entries = [(path.name, content)]
    if path.suffix.lower() == ".gltf":
        try:
            uris = [buffer.get("uri", "data:") for buffer in json.loads(content).get("buffers", [])]
        except (ValueError, AttributeError):
            uris = []  # the reader of meshes says what is wrong with it
        entries += [(uri, read(path.parent / uri)) for uri in uris if not uri.startswith("data:") and "/" not in uri]
    return entries


def robot_files(role, urdf, package_path):
    """The files of one robot, its meshes named by their content so that they are found anywhere."""
    files, places = {}, {}
    for uri, path in fcl_stpbv.mesh_files(str(urdf), [str(folder) for folder in package_path]):
        entries = mesh_entries(path)
        known = digest_of(dict(entries))[:32]
        places[uri] = f"{known}/{entries[0][0]}"
        files.update({f"{role}/{known}/{name}": content for name, content in entries})

    def moved(match):
        place = places.get(html.unescape(match[2][1:-1].decode("utf-8", "replace")).strip())
        return match[1] + b'"' + html.escape(place).encode() + b'"' if place else match[0]

    files[f"{role}/robot.urdf"] = FILENAME.sub(moved, read(urdf))
    return files


def digest_of(files):
    """The SHA-256 of all names and contents."""
    total = hashlib.sha256()
    for name in sorted(files):
        total.update(f"{len(name)} {name} {len(files[name])} ".encode())
        total.update(files[name])
    return total.hexdigest()


class Unpacked:
    """The files in a folder of their own, as long as the `with` lasts."""

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

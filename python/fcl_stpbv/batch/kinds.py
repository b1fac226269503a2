"""The kinds of batches: which jobs there are, what one job does, and the summary of all.

The process that distributes the jobs makes an object of the kind. Workers only use its class: `open` makes the context for jobs from the
bundle's files, once per worker, and `run` is a pure function of the context, the options and the job. `key` has the types of a job's key,
and `fits` returns whether a record has all that is read from it.
"""
import functools
import hashlib
import pathlib

import fcl_stpbv
from fcl_stpbv.batch import bundle, places, results
from fcl_stpbv.batch.grid import Grid
from fcl_stpbv.batch.pairs import Prove, Sample
from fcl_stpbv.batch.postures import Postures


class Convert:
    """Volumes of meshes. A job is one mesh, which is sent with the job. If a mesh is faulty, only its job fails."""
    name, key = "convert", [str]
    context = None

    def __init__(self, arguments):
        self.options = {key: getattr(arguments, key) for key in ("r", "R", "scale")}
        self.folder, self.files = pathlib.Path(arguments.volumes), {}
        self.groups = list(dict.fromkeys(arguments.meshes))
        contents, self.known = hashlib.sha256(), {}
        for mesh in self.groups:
            self.known[mesh] = self.digest(mesh, self.given(mesh))
            contents.update(self.known[mesh].encode())
        self.options["meshes"] = contents.hexdigest()
        taken = {}
        for mesh in self.groups:
            other = taken.setdefault(pathlib.Path(mesh).stem, mesh)
            if other != mesh:
                raise fcl_stpbv.Error(f"{mesh}: its volume would replace that of {other}; convert them into different folders")
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise fcl_stpbv.Error(f"--volumes {self.folder}: cannot be made: {error.strerror}") from None

    @staticmethod
    def given(mesh):
        """The mesh's files, or an error message."""
        try:
            return bundle.mesh_entries(mesh)
        except fcl_stpbv.Error as error:
            return str(error)

    @staticmethod
    def digest(mesh, given):
        """The digest of a mesh's path and its files, or of the error message."""
        wrong, files = (given, []) if isinstance(given, str) else ("", given)
        return bundle.digest_of({"": repr((mesh, wrong)).encode(), **dict(files)})

    def later(self, mesh):
        """The result of `given`, read when the mesh's job starts, because all meshes together may not fit into memory."""
        given = self.given(mesh)
        if self.digest(mesh, given) != self.known[mesh]:
            raise fcl_stpbv.Error(f"{mesh}: has changed while the batch ran; start it anew, with another -o")
        return given

    @staticmethod
    def open(folder, options):
        return None

    @staticmethod
    def run(nothing, options, job, given):
        if isinstance(given, str):
            raise fcl_stpbv.Error(given)
        with bundle.Unpacked({f"mesh/{name}": content for name, content in given}) as folder:
            path = folder / "mesh" / given[0][0]
            try:
                points = fcl_stpbv.load_points(str(path)) * options["scale"]
                volume = fcl_stpbv.StpBv.build(points, r=options["r"], R=options["R"])
            except fcl_stpbv.Error as error:
                message = str(error).replace(str(path), job[0])
                raise fcl_stpbv.Error(message if job[0] in message else f"{job[0]}: {message}") from None
            try:
                volume.save(str(folder / "volume"))
            except fcl_stpbv.Error as error:
                raise OSError(str(error)) from None  # not a fault of the mesh
            content = (folder / "volume").read_bytes()
        record = {"volume": places.volume_name(path), "sha256": hashlib.sha256(content).hexdigest(), "points": len(points),
                  "vertices": len(volume.vertices), "over_cover": volume.over_cover(points)[0]}
        return record, content

    def keep(self, record, content):
        """Writes a volume to its file, before its job counts as done. An existing file is not replaced; it must be the same."""
        path = self.folder / record["volume"]
        if not path.exists():
            results.write(path, "--volumes", [content])
        elif not self.there(record):
            raise fcl_stpbv.Error(f"--volumes {path}: exists already and is another volume than this batch makes; move it away, or give "
                                  "--volumes another folder")

    def there(self, record):
        path = self.folder / record["volume"]
        return path.exists() and hashlib.sha256(bundle.read(path)).hexdigest() == record["sha256"]

    def fits(self, job, record):
        return record["volume"] == places.volume_name(job[0]) and type(record["sha256"]) is str

    def jobs(self, mesh, done):
        record = done.get((mesh,))
        return [] if record is not None and ("error" in record or self.there(record)) else [((mesh,), functools.partial(self.later, mesh))]

    def summary(self, done):
        failed = sum("error" in record for record in done.values())
        return f"{len(done)} meshes: {len(done) - failed} volumes, {failed} failed"


KINDS = {kind.name: kind for kind in (Prove, Sample, Postures, Grid, Convert)}

"""The kinds of batches: which jobs there are, what one job does, what all of them say together.

A kind is made by the process that hands out the jobs. Its class is what workers know: `open` makes what jobs need from the bundle's
files, once a worker, and `run` is a pure function of that, the options and the job.
"""
import hashlib
import itertools
import math
import pathlib

import fcl_stpbv
from fcl_stpbv.batch import bundle
from fcl_stpbv.batch.grid import Grid
from fcl_stpbv.batch.postures import Postures


class Prove:
    """Proofs that pairs of links never meet. A job looks at some boxes of one pair; what it leaves open is shared out anew among
    twice as many jobs in the pair's next round."""
    name = "prove"

    def __init__(self, arguments):
        urdf, path = arguments.robot, arguments.package_path
        self.options = {key: getattr(arguments, key) for key in ("r", "R", "margin", "budget", "descents", "seed")}
        self.context = fcl_stpbv.PairSearch(urdf, r=arguments.r, R=arguments.R, package_path=path, margin=arguments.margin)
        self.files = bundle.robot_files("robot", urdf, path)
        self.most = arguments.boxes
        self.groups = list(range(len(self.context.pairs)))

    @staticmethod
    def open(folder, options):
        return fcl_stpbv.PairSearch(str(folder / "robot/robot.urdf"), r=options["r"], R=options["R"], margin=options["margin"])

    @staticmethod
    def run(search, options, job, given):
        pair, boxes = given
        if boxes is None:
            met = search.descend(pair, options["seed"], options["descents"])
            if met is not None:
                return {"boxes": 0, "open": [], "collision": met.tolist()}, None
            boxes = search.unproven(pair).open
            if any(not math.isfinite(limit) for box in boxes for limits in box for limit in limits):
                return {"unlimited": True}, None  # planar and floating joints
        proof = search.prove(pair, boxes, options["budget"])
        return {"boxes": proof.boxes, "open": [[lower.tolist(), upper.tolist()] for lower, upper in proof.open],
                "collision": None if proof.collision is None else proof.collision.tolist()}, None

    def follow(self, pair, done):
        """(jobs of the pair's first round that is not done, the verdict so far)."""
        names, boxes, chunks = self.context.pairs[pair], 0, [None]
        for number in itertools.count():
            jobs = [((*names, number, i), (pair, chunk)) for i, chunk in enumerate(chunks)]
            missing = [job for job in jobs if job[0] not in done]
            if missing:
                return missing, "open"
            records = [done[key] for key, _ in jobs]
            if any("error" in record for record in records):
                return [], "failed"
            if any("unlimited" in record for record in records):
                return [], "without limits"
            proof = fcl_stpbv.PairProof([])
            for record in records:
                proof = proof.merge(fcl_stpbv.PairProof(record["open"], record["collision"], record["boxes"]))
            boxes += proof.boxes
            if proof.proven or proof.collision is not None:
                return [], "proven" if proof.proven else "colliding"
            if boxes >= self.most:
                return [], "open"
            left = proof.open
            count = min(len(left), 2 ** (number + 1))
            chunks = [left[i::count] for i in range(count)]

    def jobs(self, pair, done):
        return self.follow(pair, done)[0]

    def summary(self, done):
        verdicts = [self.follow(pair, done)[1] for pair in self.groups]
        boxes = sum(record.get("boxes", 0) for record in done.values())
        counts = ", ".join(f"{verdicts.count(verdict)} {verdict}" for verdict in sorted(set(verdicts)))
        return f"{len(verdicts)} pairs: {counts}; {boxes} boxes"


class Sample:
    """Distances of all pairs in random configurations. A job is a numbered block of them."""
    name = "sample"

    def __init__(self, arguments):
        urdf, path = arguments.robot, arguments.package_path
        self.options = {key: getattr(arguments, key) for key in ("r", "R", "margin", "count", "seed")}
        self.context = fcl_stpbv.PairSearch(urdf, r=arguments.r, R=arguments.R, package_path=path, margin=arguments.margin)
        self.files = bundle.robot_files("robot", urdf, path)
        self.groups = list(range(arguments.blocks))

    open = Prove.open

    @staticmethod
    def run(search, options, job, given):
        found = search.sample(options["seed"], job[0], options["count"])
        return {"collisions": [pair[0] for pair in found], "least": [pair[1] for pair in found]}, None

    def jobs(self, block, done):
        return [] if (block,) in done else [((block,), None)]

    def summary(self, done):
        records = [record for record in done.values() if "error" not in record]
        hit = sum(any(record["collisions"][pair] for record in records) for pair in range(len(self.context.pairs)))
        return (f"{len(records) * self.options['count']} configurations, {len(self.context.pairs)} pairs: {hit} in collision in some of them, "
                f"{len(self.context.pairs) - hit} in none")


class Convert:
    """Volumes of meshes. A job is one mesh, which travels with it; a bad one fails alone."""
    name = "convert"
    context = None

    def __init__(self, arguments):
        self.options = {key: getattr(arguments, key) for key in ("r", "R", "scale")}
        self.folder, self.files = pathlib.Path(arguments.volumes), {}
        self.groups = list(dict.fromkeys(arguments.meshes))
        contents = hashlib.sha256()
        for mesh in self.groups:
            contents.update(repr((mesh, self.given(mesh))).encode())
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
        """The mesh's files, or what is wrong with them."""
        try:
            return bundle.mesh_entries(mesh)
        except fcl_stpbv.Error as error:
            return str(error)

    @staticmethod
    def open(folder, options):
        return None

    @staticmethod
    def run(nothing, options, job, given):
        if isinstance(given, str):
            raise fcl_stpbv.Error(given)
        with bundle.Unpacked(dict(given)) as folder:
            path = folder / given[0][0]
            try:
                points = fcl_stpbv.load_points(str(path)) * options["scale"]
                volume = fcl_stpbv.StpBv.build(points, r=options["r"], R=options["R"])
            except fcl_stpbv.Error as error:
                message = str(error).replace(str(path), job[0])
                raise fcl_stpbv.Error(message if job[0] in message else f"{job[0]}: {message}") from None
            volume.save(str(folder / "volume"))
            content = (folder / "volume").read_bytes()
        record = {"volume": f"{path.stem}.stpbv", "sha256": hashlib.sha256(content).hexdigest(), "points": len(points),
                  "vertices": len(volume.vertices), "over_cover": volume.over_cover()[0]}
        return record, content

    def keep(self, record, content):
        """Puts a volume where it belongs, before its job counts as done."""
        path = self.folder / record["volume"]
        beside = path.with_suffix(".tmp")
        try:
            beside.write_bytes(content)
            beside.replace(path)
        except OSError as error:
            raise fcl_stpbv.Error(f"--volumes {path}: cannot be written: {error.strerror}") from None

    def jobs(self, mesh, done):
        record = done.get((mesh,))
        there = record is not None and ("error" in record or (self.folder / record["volume"]).exists())
        return [] if there else [((mesh,), self.given(mesh))]

    def summary(self, done):
        failed = sum("error" in record for record in done.values())
        return f"{len(done)} meshes: {len(done) - failed} volumes, {failed} failed"


KINDS = {kind.name: kind for kind in (Prove, Sample, Postures, Grid, Convert)}

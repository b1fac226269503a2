"""Two kinds of batches (kinds.py) for a robot's pairs of links, and of links and obstacles: proofs and samples."""
import itertools
import math

import fcl_stpbv
from fcl_stpbv.batch import bundle, results
from fcl_stpbv.batch.results import are_numbers, is_whole


def opened(arguments):
    """(the PairSearch for the robot and the obstacles on the command line, the files that it was made from)."""
    path = arguments.package_path
    search = fcl_stpbv.PairSearch(arguments.robot, arguments.obstacles, r=arguments.r, R=arguments.R, package_path=path, margin=arguments.margin)
    if len(set(search.pairs)) < len(search.pairs):
        raise fcl_stpbv.Error(f"{arguments.obstacles}: an obstacle and a link have names that cannot be told apart; rename one")
    files = bundle.robot_files("robot", arguments.robot, path)
    if arguments.obstacles:
        files.update(bundle.robot_files("scene", arguments.obstacles, path))
    return search, files


def search_in(folder, options):
    """The PairSearch made from the bundle's files."""
    scene = folder / "scene/robot.urdf"
    return fcl_stpbv.PairSearch(str(folder / "robot/robot.urdf"), str(scene) if scene.exists() else None, r=options["r"], R=options["R"],
                                margin=options["margin"])


def length(value):
    """A length (m) as a text, or the word for lengths that fit each link."""
    return value if isinstance(value, str) else f"{value:g} m"


def counted(verdicts):
    return ", ".join(f"{verdicts.count(verdict)} {verdict}" for verdict in sorted(set(verdicts)))


class Prove:
    """Proofs that pairs of links never collide. A job examines some boxes of one pair. The boxes that it leaves open are distributed to twice
    as many jobs in the pair's next round."""
    name, key = "prove", [str, str, int, int]  # the pair, the round, the number of the job in the round

    def __init__(self, arguments):
        self.options = {key: getattr(arguments, key) for key in ("r", "R", "margin", "budget", "descents", "seed")}
        self.context, self.files = opened(arguments)
        self.most, self.srdf = arguments.boxes, arguments.srdf
        self.groups = list(range(len(self.context.pairs)))
        self.dimensions = {names: len(self.context.unproven(pair).open[0][0]) for pair, names in enumerate(self.context.pairs)}
        if self.srdf and not arguments.write_srdf:
            raise fcl_stpbv.Error("--srdf: is for --write-srdf; give that too")
        if arguments.write_srdf:
            if self.srdf:
                bundle.require_file(self.srdf)  # a pipe could not be read again at the end
            self.context.srdf([], self.srdf)  # reports errors in the SRDF before anything is computed

    open = staticmethod(search_in)

    @staticmethod
    def run(search, options, job, given):
        pair, boxes = given
        if boxes is None:
            met = search.descend(pair, options["seed"], options["descents"])
            if met is not None:
                return {"boxes": 0, "open": [], "collision": met.tolist()}, None
            boxes = search.unproven(pair).open
            if any(not math.isfinite(limit) for box in boxes for limits in box for limit in limits):
                return {"unlimited": True}, None  # planar and floating joints have no limits
        proof = search.prove(pair, boxes, options["budget"])
        return {"boxes": proof.boxes, "open": [[lower.tolist(), upper.tolist()] for lower, upper in proof.open],
                "collision": None if proof.collision is None else proof.collision.tolist()}, None

    def fits(self, job, record):
        if "unlimited" in record:
            return record["unlimited"] is True
        dimension, collision, boxes = self.dimensions[tuple(job[:2])], record["collision"], record["open"]
        return (is_whole(record["boxes"]) and (collision is None or are_numbers(collision, len(self.context.names))) and type(boxes) is list
                and all(are_numbers(lower, dimension) and are_numbers(upper, dimension) for lower, upper in boxes))

    def follow(self, pair, done):
        """(the jobs of the pair's first round that is not complete, the verdict so far)."""
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
        verdicts = self.verdicts(done)
        boxes = sum(record.get("boxes", 0) for record in done.values())
        return f"{len(verdicts)} pairs: {counted(verdicts)}; {boxes} boxes"

    def verdicts(self, done):
        return [self.follow(pair, done)[1] for pair in self.groups]

    def write_srdf(self, path, done):
        """Writes an SRDF in which every Never is proven, with a comment that says so."""
        verdicts, links, header = self.verdicts(done), self.context.link_pairs, self.options
        proven = [pair for pair, verdict in enumerate(verdicts) if verdict == "proven"]
        comments = [f"Each Never is proven: for all joint values within their limits the links' volumes (r = {length(header['r'])}, R = {length(header['R'])}) "
                    f"are more than {header['margin']:g} m apart. fcl_stpbv {fcl_stpbv.__version__}, for files with the SHA-256 {bundle.digest_of(self.files)}",
                    f"Of the pairs that are neither adjacent nor rigidly joined: {counted(verdicts[:links])}; all but the proven ones are left to be checked"]
        if links < len(verdicts):
            clear = ", ".join(" and ".join(self.context.pairs[pair]) for pair in proven if pair >= links)
            comments.append(f"Pairs with obstacles have no place in an SRDF. Proven, with the root link where it is: {clear or 'none'}")
        else:
            comments.append("Obstacles were not looked at")
        text = self.context.srdf([pair for pair in proven if pair < links], self.srdf, comments)
        results.write(path, "--write-srdf", [text.encode()])


class Sample:
    """Distances of all pairs in random configurations. A job is a numbered block of them."""
    name, key = "sample", [int]

    def __init__(self, arguments):
        self.options = {key: getattr(arguments, key) for key in ("r", "R", "margin", "count", "seed")}
        self.context, self.files = opened(arguments)
        self.groups = list(range(arguments.blocks))

    open = staticmethod(search_in)

    @staticmethod
    def run(search, options, job, given):
        found = search.sample(options["seed"], job[0], options["count"])
        return {"collisions": [pair[0] for pair in found], "least": [pair[1] for pair in found]}, None

    def fits(self, job, record):
        pairs = len(self.context.pairs)
        return are_numbers(record["collisions"], pairs) and are_numbers(record["least"], pairs)

    def jobs(self, block, done):
        return [] if (block,) in done else [((block,), None)]

    def summary(self, done):
        records = [record for record in done.values() if "error" not in record]
        hit = sum(any(record["collisions"][pair] for record in records) for pair in range(len(self.context.pairs)))
        return (f"{len(records) * self.options['count']} configurations, {len(self.context.pairs)} pairs: {hit} in collision in some of them, "
                f"{len(self.context.pairs) - hit} in none")

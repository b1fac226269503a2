"""The results of a batch: a file of JSON lines. The first line is the header with the options; each other line is a job that is done.

Lines are appended as jobs end, in any order. A run that is continued drops an incomplete last line. If a job has two lines, the later
one counts. At the end the lines are sorted, so the same batch always gives the same bytes, wherever and however often it ran.
"""
import fcntl
import json
import os
import stat
import sys
import uuid

import fcl_stpbv

# The exceptions that reading an invalid line may raise.
DAMAGED = (ValueError, TypeError, LookupError, AttributeError, RecursionError)


def line(record):
    return json.dumps(record, allow_nan=False, separators=(",", ":")) + "\n"


def is_whole(value):
    return type(value) is int and 0 <= value < 2**53


def are_numbers(values, count):
    return type(values) is list and len(values) == count and all(
        type(value) in (int, float) and abs(value) <= sys.float_info.max for value in values)


def parsed(text, kind):
    """The job and the record in a line, checked for all that the kind of batch reads from it; raises one of DAMAGED if it is not valid."""
    record = json.loads(text)
    line(record)  # what is read can be written
    job = record["job"]
    if [type(part) for part in job] != kind.key or not (type(record["error"]) is str if "error" in record else kind.fits(job, record)):
        raise ValueError
    return tuple(job), record


def read(path, header, kind):
    """({job: record}, bytes of whole lines) of a file of results of this batch; raises fcl_stpbv.Error naming it."""
    try:
        with open(path, "rb") as file:
            text = file.read()
    except OSError as error:
        raise fcl_stpbv.Error(f"{path}: cannot be read: {error.strerror}") from None
    whole = text[:text.rfind(b"\n") + 1]
    lines = whole.split(b"\n")[:-1]
    try:
        found = json.loads(lines[0])
        found["batch"]
    except DAMAGED:
        raise fcl_stpbv.Error(f"{path}: does not hold results of a batch; give another file") from None
    require_same(header, found, path)
    jobs = {}
    for number, text in enumerate(lines[1:], 2):
        try:
            job, jobs[job] = parsed(text, kind)
        except DAMAGED:
            raise fcl_stpbv.Error(f"{path}:{number}: is damaged, expected a result of this batch; remove the line, and its job is done "
                                  "again") from None
    return jobs, len(whole)


def require_same(header, other, path):
    """Raises fcl_stpbv.Error if two headers differ: results belong together only if all their inputs are the same."""
    different = sorted(key for key in {*header, *other} if header.get(key) != other.get(key))
    if different:
        raise fcl_stpbv.Error(f"{path}: holds results of another batch, with a different {', '.join(different)}; give another file")


def write(path, option, parts):
    """Writes a file completely or not at all; `option` is the argument with its path. A link stays a link; an existing file's permissions are
    kept."""
    place = os.path.realpath(path)
    beside = os.path.join(os.path.dirname(place), f".fcl_stpbv-{os.getpid()}-{uuid.uuid4().hex}.tmp")
    try:
        with open(beside, "xb") as file:
            if os.path.exists(place):
                with open(place, "r+b") as old:
                    os.fchmod(file.fileno(), stat.S_IMODE(os.fstat(old.fileno()).st_mode))
            file.writelines(parts)
            file.flush()
            os.fsync(file.fileno())
        os.replace(beside, place)
    except OSError as error:
        raise fcl_stpbv.Error(f"{option} {path}: cannot be written: {error.strerror}") from None
    finally:
        if os.path.exists(beside):
            os.unlink(beside)


def merge(paths, header, kind):
    """The jobs of several files of one batch; the order does not matter."""
    jobs = {}
    for path in paths:
        more, _ = read(path, header, kind)
        for job, record in more.items():
            if jobs.setdefault(job, record) != record:
                raise fcl_stpbv.Error(f"{path}: job {list(job)} has another result than in the files before; the machines that ran it "
                                      "do not compute alike")
    return jobs


class ResultFile:
    """A file of results, open for a run: the run continues from its contents, and nobody else writes to it."""

    def __init__(self, path, header, kind):
        self.path, self.header, self.jobs = path, header, {}
        try:
            self.file = None
            while self.file is None or not os.path.samestat(os.fstat(self.file), os.stat(path)):  # a run that ends puts a new file in its place
                if self.file is not None:
                    os.close(self.file)
                self.file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
                fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise fcl_stpbv.Error(f"-o {path}: another run is writing to it; wait for it, or give another file") from None
        except OSError as error:
            raise fcl_stpbv.Error(f"-o {path}: cannot be written: {error.strerror}") from None
        if os.fstat(self.file).st_size == 0:
            self._append(line(header))
            return
        self.jobs, whole = read(path, header, kind)
        os.ftruncate(self.file, whole)

    def add(self, record):
        """Adds a finished job."""
        self.jobs[tuple(record["job"])] = record
        self._append(line(record))

    def _append(self, text):
        data = text.encode()
        try:
            while data:
                data = data[os.write(self.file, data):]
        except OSError as error:
            raise fcl_stpbv.Error(f"-o {self.path}: cannot be written: {error.strerror}") from None

    def close(self, sort):
        if sort:
            write(self.path, "-o", (line(record).encode() for record in [self.header, *(self.jobs[job] for job in sorted(self.jobs))]))
        os.close(self.file)

"""The results of a batch: a file of JSON lines. The first says what was asked for, each other one is a job that is done.

Lines are added whole as jobs end, in any order; a run that goes on drops a line that was cut off, and of two lines of one job the
later counts. At the end they are sorted, so that the same batch gives the same bytes wherever and however often it ran.
"""
import fcntl
import json
import os

import fcl_stpbv


def line(record):
    return json.dumps(record, allow_nan=False, separators=(",", ":")) + "\n"


def read(path):
    """(header, {job: record}, bytes of whole lines) of a file of results; raises fcl_stpbv.Error naming it."""
    try:
        with open(path, "rb") as file:
            text = file.read()
    except OSError as error:
        raise fcl_stpbv.Error(f"{path}: cannot be read: {error.strerror}") from None
    whole = text[:text.rfind(b"\n") + 1]
    try:
        records = [json.loads(part) for part in whole.splitlines()]
        if not (isinstance(records[0], dict) and "batch" in records[0]):
            raise ValueError
        jobs = {tuple(record["job"]): record for record in records[1:]}
    except (ValueError, TypeError, KeyError, IndexError):
        raise fcl_stpbv.Error(f"{path}: does not hold results of a batch; give another file") from None
    return records[0], jobs, len(whole)


def require_same(header, other, path):
    """Results belong together only where all that decides them is the same."""
    different = sorted(key for key in {*header, *other} if header.get(key) != other.get(key))
    if different:
        raise fcl_stpbv.Error(f"{path}: holds results of another batch, with a different {', '.join(different)}; give another file")


def write(path, option, lines):
    """The whole file or nothing; `option` gave its path."""
    beside = f"{path}.{os.getpid()}.tmp"
    try:
        with open(beside, "w", encoding="utf-8") as file:
            file.writelines(lines)
            file.flush()
            os.fsync(file.fileno())
        os.replace(beside, path)
    except OSError as error:
        if os.path.exists(beside):
            os.unlink(beside)
        raise fcl_stpbv.Error(f"{option} {path}: cannot be written: {error.strerror}") from None


def merge(paths):
    """(header, jobs) of several files of one batch; the order does not matter."""
    header, jobs = None, {}
    for path in paths:
        found, more, _ = read(path)
        if header is not None:
            require_same(header, found, path)
        header = found
        for job, record in more.items():
            if jobs.setdefault(job, record) != record:
                raise fcl_stpbv.Error(f"{path}: job {list(job)} has another result than in the files before; the machines that ran it "
                                      "do not compute alike")
    return header, jobs


class ResultFile:
    """Open for a run: continues from what it holds, and nobody else writes to it."""

    def __init__(self, path, header):
        self.path, self.header, self.jobs = path, header, {}
        try:
            self.file = os.open(path, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666)
            fcntl.flock(self.file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise fcl_stpbv.Error(f"-o {path}: another run is writing to it; wait for it, or give another file") from None
        except OSError as error:
            raise fcl_stpbv.Error(f"-o {path}: cannot be written: {error.strerror}") from None
        if os.fstat(self.file).st_size == 0:
            self._append(line(header))
            return
        found, self.jobs, whole = read(path)
        require_same(header, found, path)
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
            write(self.path, "-o", [line(self.header), *(line(self.jobs[job]) for job in sorted(self.jobs))])
        os.close(self.file)

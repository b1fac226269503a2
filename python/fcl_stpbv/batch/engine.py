"""Runs the jobs of a batch, one after the other in this process, or on a Dask cluster. The results are the same."""
import collections
import contextlib
import json
import os
import pickle
import sys
import uuid
import warnings

import fcl_stpbv
from fcl_stpbv.batch.bundle import Unpacked, digest_of
from fcl_stpbv.batch.kinds import KINDS

AHEAD = 4  # jobs handed out for each worker, so that it never waits for the next one
PATIENCE = 15  # s that a scheduler may take to answer


class Stopped(Exception):
    """The run ended early; the results so far are kept."""


class Schedule:
    """The queue of jobs. The next jobs of a group are known only when its previous jobs are done."""

    def __init__(self, kind, results, share):
        self.kind, self.results = kind, results
        ready = [(group, *job) for group in kind.groups for job in kind.jobs(group, results.jobs)]
        part, parts = share
        self.ready = collections.deque(ready[part::parts])
        self.running = collections.Counter(group for group, *_ in self.ready)
        # If other shards have jobs of a group's round, the next round is not known here.
        self.shared = {group for i, (group, *_) in enumerate(ready) if i % parts != part}

    def finish(self, group, key, record, content):
        if content is not None:
            self.kind.keep(record, content)
        self.results.add({"job": list(key), **record})
        self.running[group] -= 1
        if self.running[group] == 0 and group not in self.shared:
            jobs = self.kind.jobs(group, self.results.jobs)
            self.running[group] = len(jobs)
            self.ready.extend((group, *job) for job in jobs)


def outcome(kind, context, options, key, given):
    """Runs one job. Returns its record, and the bytes of the file that it makes, or None. The record of a job that fails has the reason."""
    try:
        return kind.run(context, options, key, given)
    except fcl_stpbv.Error as error:
        return {"error": str(error)}, None


def content_of(given):
    """The input of a job. If it is large, the schedule has a function in its place, which reads it when the job is started."""
    return given() if callable(given) else given


def run_here(schedule, show):
    kind = schedule.kind
    while schedule.ready:
        show(len(schedule.results.jobs), len(schedule.ready))
        group, key, given = schedule.ready.popleft()
        try:
            result = outcome(kind, kind.context, kind.options, key, content_of(given))
        except OSError as error:  # the folder for temporary files is full, which may differ in another run
            raise Stopped(f"{list(key)} has no result: {type(error).__name__}: {error}") from None
        schedule.finish(group, key, *result)


contexts = {}  # contexts of this worker, by what they were made from


def work(name, options, files, digest, version, key, packed):
    """Runs a job on a worker. The worker loads the bundle for its first job."""
    if version != fcl_stpbv.__version__:
        raise RuntimeError(f"a worker has fcl_stpbv {fcl_stpbv.__version__} and not {version}; install the same everywhere")
    kind, known = KINDS[name], (name, digest, json.dumps(options, sort_keys=True))
    context = contexts.get(known)  # one lookup only, because a worker may have several threads
    if context is None:
        # The warnings of loading were shown where the batch began. Adding the same filter again changes
        # nothing.
        warnings.filterwarnings("ignore", category=UserWarning, module=r"fcl_stpbv\.batch\.")
        with Unpacked(pickle.loads(files)) as folder:
            context = kind.open(folder, options)
        contexts.clear()  # only one robot at a time
        contexts[known] = context
    return outcome(kind, context, options, key, pickle.loads(packed))


def same(files):
    return files


async def greet(address):
    """Tests the connection once, because a Client that is refused would keep trying for half a minute."""
    import distributed

    line = await distributed.comm.connect(address, timeout=PATIENCE, **distributed.Security().get_connection_args("client"))
    await line.close()


def local_cluster(workers):
    """A Dask cluster on this machine. If a process does not start, because of limits of the machine or because it is killed, Dask raises
    an exception after a while."""
    import distributed

    # Without these options the scheduler would listen on Dask's usual port even without a dashboard, and warn
    # if that port is taken.
    local = {"dashboard": False, "dashboard_address": "127.0.0.1:0"}
    try:
        return distributed.LocalCluster(workers, threads_per_worker=1, dashboard_address=None, scheduler_kwargs=local, silence_logs="CRITICAL",
                                        extensions={},  # shuffling, which no batch needs; closing it twice ends in a traceback
                                        death_timeout="3m")  # otherwise Dask waits forever for a process that was killed while it started
    except Exception as error:
        while error.__context__:
            error = error.__context__
        why = str(error) or "one does not answer"
        raise fcl_stpbv.Error(f"--jobs {workers}: these processes cannot be started ({why}); give fewer") from None


@contextlib.contextmanager
def connected(scheduler, workers):
    """A Dask client: for the cluster at this address, or for a new one on this machine."""
    import asyncio  # here, as these three take half of the time of a start
    import concurrent.futures
    import logging

    try:
        import dask
        import distributed
    except ImportError:
        raise fcl_stpbv.Error("more than one process needs Dask: install Debian's python3-distributed, or give --jobs 1, "
                              "or share out with --shard") from None
    quiet = {"distributed.worker.daemon": False, "distributed.logging.distributed": "critical", "distributed.admin.tick.limit": "1h",
             "distributed.nanny.pre-spawn-environ.DASK_LOGGING__DISTRIBUTED": "critical"}  # for processes that this program starts, which log while they start
    logging.disable(logging.CRITICAL)  # a broken connection ends in one message of this program, not in Dask's tracebacks
    # If the scheduler disappears during a call, the call ends in either kind of cancellation; the second is
    # not an Exception.
    gone = (distributed.comm.CommClosedError, concurrent.futures.CancelledError, asyncio.CancelledError)
    with dask.config.set(quiet), contextlib.ExitStack() as stack:
        try:
            if not scheduler:
                scheduler = stack.enter_context(local_cluster(workers))
            else:
                asyncio.run(greet(scheduler))
            client = stack.enter_context(distributed.Client(scheduler, timeout=PATIENCE, set_as_default=False))
        except (OSError, ValueError, TypeError, TimeoutError) as error:  # TypeError: tls:// without certificates
            raise fcl_stpbv.Error(f"--scheduler {scheduler}: no Dask scheduler answers there ({error}); "
                                  "start one with dask-scheduler") from None
        try:
            yield client
        except gone:
            raise Stopped("the Dask scheduler is gone") from None


@contextlib.contextmanager
def answering():
    """Context manager for calls to the scheduler. If the scheduler is gone, the error may be that a connection cannot be made again."""
    try:
        yield
    except OSError:
        raise Stopped("the Dask scheduler is gone") from None


def run_on(client, schedule, show):
    """Runs every job on any worker. A job whose worker dies runs again elsewhere, and results that were lost are computed again."""
    import distributed

    kind, run = schedule.kind, uuid.uuid4().hex
    digest = digest_of(kind.files)
    bundle = client.submit(same, pickle.dumps(kind.files), key=f"bundle-{digest}-{run}")
    jobs, failed, most = {}, {}, 0
    done = distributed.as_completed(loop=client.loop)
    while schedule.ready or jobs:
        if schedule.ready and len(jobs) <= most // 2:
            with answering():
                most = max(8, AHEAD * sum(client.nthreads().values()))  # workers come and go
            while schedule.ready and len(jobs) < most:
                group, key, given = schedule.ready.popleft()
                future = client.submit(work, kind.name, kind.options, bundle, digest, fcl_stpbv.__version__, key,
                                       pickle.dumps(content_of(given)), key=f"{kind.name}-{json.dumps(key)}-{run}")
                jobs[future.key] = (group, key)
                done.add(future)
        show(len(schedule.results.jobs), len(jobs) + len(schedule.ready))
        future = next(done)
        if future.status in ("lost", "pending"):  # its worker died with the result, so the result is computed again
            done.add(future)
            continue
        group, key = jobs.pop(future.key)
        if future.status == "finished":
            with answering():
                result = future.result()
            schedule.finish(group, key, *result)
        elif future.status == "error":
            failed[key] = future.exception()
        else:
            raise Stopped("the Dask scheduler is gone")
        future.release()
    if failed:
        key, error = next(iter(failed.items()))
        raise Stopped(f"{len(failed)} jobs have no result, such as {list(key)}: {type(error).__name__}: {error}")


def progress(quiet):
    """Returns a function that shows the progress as one line on the terminal."""
    wanted = not quiet and sys.stderr.isatty()

    def show(done, left):
        if wanted:
            bar = "#" * (30 * done // max(1, done + left))
            sys.stderr.write(f"\r[{bar:<30}] {done} jobs done, {left} known to be left \033[K")

    return show, lambda: wanted and sys.stderr.write("\r\033[K")


def cores():
    return len(os.sched_getaffinity(0))

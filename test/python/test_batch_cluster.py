"""A batch on a real scheduler with two workers, each a process that can be killed."""
import functools
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import time

import pytest

import warm_start

pytest.importorskip("distributed", reason="needs python3-distributed (tools/install_packages)")

DATA = pathlib.Path(os.environ.get("FCL_STPBV_DATA", pathlib.Path(__file__).parents[2] / "data"))
ARM = DATA.parent / "test/tools/six_joint_arm.urdf"
SAMPLE = ["sample", ARM, "--blocks", 60, "--count", 400]


def start(*arguments, program=warm_start.Program, **more):
    return program("fcl_stpbv.batch", *arguments, **more)


def cold_start(module, *arguments):
    """As a user starts it, in an interpreter of its own."""
    return subprocess.Popen([sys.executable, "-B", "-m", module, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def many_jobs(kind, folder):
    """The command of a batch of at least 50 jobs, each long enough for a kill to fall between them."""
    if kind == "sample":
        return SAMPLE
    if kind == "prove":
        return ["prove", ARM, "--budget", 10, "--boxes", 500, "--descents", 1]
    if kind == "convert":
        meshes = [folder / f"{i}.stl" for i in range(60)]
        for mesh in meshes:
            shutil.copy(DATA / "hrp2_style/meshes/LARM_LINK0.stl", mesh)
        meshes[7].write_bytes(b"solid nothing")  # makes its own job fail and no other
        return ["convert", *meshes, "--volumes", folder / "volumes"]
    task = json.loads((ARM.parent / "reach.json").read_text())
    if kind == "grid":
        axes = [{"name": name, "move": {"tool": by}, "from": -0.3, "to": 0.3, "count": count}
                for name, by, count in (("y", [0, 1, 0], 60), ("x", [1, 0, 0], 8))]
        (folder / "grid.json").write_text(json.dumps({"axes": axes}))
        return ["postures", ARM, ARM.parent / "reach.json", "--grid", folder / "grid.json", "--starts", 2]
    tasks = [folder / f"{i}.json" for i in range(30)]
    for i, path in enumerate(tasks):
        task["placements"][0]["target"]["position"] = [0.5 + 0.1 * i, 0, 0.5]  # most are out of reach
        path.write_text(json.dumps(task))
    return ["postures", ARM, *tasks, "--starts", 4]


class Batch:
    """A batch, and its result in one process."""

    def __init__(self, kind, folder):
        self.folder, self.arguments = folder, many_jobs(kind, folder)
        self.status, self.expected, self.volumes = self.run("expected", "--jobs", 1, program=cold_start)
        self.jobs = self.expected.count(b"\n") - 1
        assert self.jobs >= 50

    def start(self, name, *options, **more):
        self.out = self.folder / name
        return start(*self.arguments, *options, "-o", self.out, **more)

    def run(self, name, *options, **more):
        process = self.start(name, *options, **more)
        _, message = process.communicate(timeout=100)
        assert "Traceback" not in message
        return process.returncode, self.out.read_bytes(), self.files()

    def files(self):
        return {path.name: path.read_bytes() for path in (self.folder / "volumes").glob("*")}


@pytest.fixture(scope="module")
def batch_of(tmp_path_factory):
    """Makes the batch of a kind, once."""
    return functools.cache(lambda kind: Batch(kind, tmp_path_factory.mktemp(kind)))


@pytest.fixture(params=["prove", "sample", "postures", "grid", "convert"])
def some(request, batch_of):
    return batch_of(request.param)


@pytest.fixture
def expected(batch_of):
    return batch_of("sample").expected


def wait_for_lines(path, count, process):
    end = time.monotonic() + 60
    while time.monotonic() < end and process.poll() is None:
        if path.exists() and path.read_bytes().count(b"\n") >= count:
            return
        time.sleep(0.01)
    process.kill()
    raise AssertionError(f"no {count} lines: {process.communicate(timeout=10)}")


def test_a_worker_killed_in_the_middle_changes_nothing(cluster, some):
    shutil.rmtree(some.folder / "volumes", ignore_errors=True)
    run = some.start("killed", "--scheduler", cluster.address)
    wait_for_lines(some.out, 5, run)
    cluster.workers[0].send_signal(signal.SIGKILL)
    cluster.workers[0].wait()
    assert some.out.read_bytes().count(b"\n") < some.jobs, "it was not in the middle"
    cluster.workers[0] = cluster.worker()  # restarted now, because the other worker may have ended by itself
    assert run.wait(timeout=100) == some.status, run.communicate()
    assert some.out.read_bytes() == some.expected and some.files() == some.volumes


@pytest.mark.parametrize("some", ["grid", "convert"], indirect=True)  # one that writes no other files, and one that does
def test_a_scheduler_that_dies_costs_no_result_and_a_new_one_goes_on(cluster, some):
    shutil.rmtree(some.folder / "volumes", ignore_errors=True)
    run = some.start("stopped", "--scheduler", cluster.address)
    wait_for_lines(some.out, 5, run)
    for process in (cluster.scheduler, *cluster.workers):
        process.kill()
        process.wait()
    output, message = run.communicate(timeout=60)
    cluster.start_scheduler()
    cluster.workers = [cluster.worker(), cluster.worker()]
    assert run.returncode == 1 and message == "fcl_stpbv.batch: the Dask scheduler is gone; run again to go on\n", message
    done = some.out.read_bytes().count(b"\n") - 1
    assert 0 < done < some.jobs
    assert some.run("stopped", "--scheduler", cluster.address) == (some.status, some.expected, some.volumes)


def test_a_connection_that_cannot_be_made_again_is_a_scheduler_that_is_gone(cluster, tmp_path):
    # The error that Dask raises when it connects again to fetch a result and the scheduler disappears
    # meanwhile.
    broken = ("import sys, distributed, fcl_stpbv.batch.__main__ as batch\n"
              "def result(self): raise OSError('Timed out during handshake')\n"
              "distributed.Future.result = result\n"
              "sys.exit(batch.main())")
    command = [sys.executable, "-B", "-c", broken, *map(str, SAMPLE), "--scheduler", cluster.address, "-o", str(tmp_path / "out")]
    run = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert run.returncode == 1 and run.stderr == "fcl_stpbv.batch: the Dask scheduler is gone; run again to go on\n", run.stderr


def test_a_run_that_is_interrupted_keeps_what_is_done(expected, tmp_path):
    out = tmp_path / "out"
    run = start(*SAMPLE, "--jobs", 1, "-o", out)
    wait_for_lines(out, 5, run)
    second = start(*SAMPLE, "--jobs", 1, "-o", out)
    _, message = second.communicate(timeout=60)
    assert second.returncode == 2 and "another run is writing" in message
    run.send_signal(signal.SIGINT)
    _, message = run.communicate(timeout=60)
    assert run.returncode == 130 and message == "fcl_stpbv.batch: interrupted; run again to go on\n"
    assert expected.startswith(out.read_bytes()[:out.read_bytes().index(b"\n") + 1]) and out.read_bytes().count(b"\n") < 61
    assert start(*SAMPLE, "--jobs", 1, "-o", out).wait(timeout=60) == 0
    assert out.read_bytes() == expected


@pytest.mark.parametrize("address", ["nonsense", "http://127.0.0.1:1", "tls://127.0.0.1:1"])
def test_an_address_that_cannot_be_a_schedulers_is_refused_at_once(address, tmp_path):
    before = time.monotonic()
    run = start(*SAMPLE, "--scheduler", address, "-o", tmp_path / "out")
    _, message = run.communicate(timeout=60)
    assert run.returncode == 2 and f"--scheduler {address}: " in message and message.count("\n") == 1, message
    assert time.monotonic() - before < 15  # Dask alone took 30 s to give up


def test_a_scheduler_that_is_not_there_is_named(tmp_path):
    impatient = "import sys\nfrom fcl_stpbv.batch import __main__ as batch, engine\nengine.PATIENCE = 1\nsys.exit(batch.main())"
    run = subprocess.run([sys.executable, "-B", "-c", impatient, *map(str, SAMPLE), "--scheduler", "tcp://127.0.0.1:1", "-o", str(tmp_path / "out")],
                         capture_output=True, text=True, timeout=60)
    assert run.returncode == 2 and "tcp://127.0.0.1:1" in run.stderr and "Traceback" not in run.stderr


def test_processes_that_the_machine_does_not_grant_are_named(tmp_path):
    command = [sys.executable, "-B", "-m", "fcl_stpbv.batch", *map(str, SAMPLE), "--jobs", "2", "-o", str(tmp_path / "out")]
    run = subprocess.run(command, capture_output=True, text=True, timeout=60,
                         preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (30, 30)))
    assert run.returncode == 2 and run.stderr.count("\n") == 1, run.stderr
    assert run.stderr.startswith("fcl_stpbv.batch: --jobs 2: these processes cannot be started ([Errno 24] Too many open files)")


def test_a_process_that_dies_while_it_starts_is_not_waited_for_for_ever(tmp_path):
    # Dask is not told about a process that is killed then.
    broken = ("import asyncio, sys, distributed, fcl_stpbv.batch.__main__ as batch\n"
              "cluster = distributed.LocalCluster\n"
              "def soon(*workers, death_timeout, **more): return cluster(*workers, death_timeout='1s', **more)\n"
              "async def unheard(self, uid): await asyncio.sleep(1000)\n"
              "distributed.LocalCluster, distributed.nanny.WorkerProcess._wait_until_connected = soon, unheard\n"
              "sys.exit(batch.main())")
    run = subprocess.run([sys.executable, "-B", "-c", broken, *map(str, SAMPLE), "--jobs", "2", "-o", str(tmp_path / "out")],
                         capture_output=True, text=True, timeout=60)
    assert run.returncode == 2 and run.stderr.count("\n") == 1, run.stderr
    assert "--jobs 2: these processes cannot be started (one does not answer)" in run.stderr


def test_what_a_killed_run_leaves_is_cleared_away_in_silence(expected, tmp_path):
    command = [sys.executable, "-B", "-m", "fcl_stpbv.batch", *map(str, SAMPLE), "--jobs", "2", "-o", str(tmp_path / "out")]
    where = {**os.environ, "TMPDIR": str(tmp_path)}
    run = subprocess.Popen(command, env=where, start_new_session=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wait_for_lines(tmp_path / "out", 2, run)
    os.killpg(run.pid, signal.SIGKILL)
    run.communicate(timeout=10)
    assert list((tmp_path / "dask-worker-space").glob("worker-*"))
    again = subprocess.run([*command, "-q"], env=where, capture_output=True, text=True, timeout=100)
    assert (again.returncode, again.stderr) == (0, "") and (tmp_path / "out").read_bytes() == expected

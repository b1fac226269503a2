"""A Dask cluster of a scheduler and two workers, each a process that can be killed; it starts when a test first asks for it."""
import socket

import pytest

import warm_start


class Cluster:
    def __init__(self, folder):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.address, self.folder, self.processes = f"tcp://127.0.0.1:{self.port}", folder, []
        self.start_scheduler()
        self.workers = [self.worker(), self.worker()]

    def start_scheduler(self):
        self.scheduler = self.add("distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", self.port, "--no-dashboard")

    def worker(self):
        return self.add("distributed.cli.dask_worker", self.address, "--no-nanny", "--nthreads", 1, "--no-dashboard",
                        "--local-directory", self.folder)

    def add(self, *arguments):
        process = warm_start.Program(*arguments)
        self.processes.append(process)
        return process

    def stop(self):
        for process in self.processes:
            process.kill()
            process.wait()


@pytest.fixture(scope="session")
def cluster(tmp_path_factory):
    pytest.importorskip("distributed", reason="needs python3-distributed (tools/install_packages)")
    cluster = Cluster(tmp_path_factory.mktemp("cluster"))
    yield cluster
    cluster.stop()


@pytest.fixture(params=["here", "there"])
def here_or_there(request):
    """Options of a batch: it does its jobs in its own process, or others do them."""
    return ["--jobs", 1] if request.param == "here" else ["--scheduler", request.getfixturevalue("cluster").address]

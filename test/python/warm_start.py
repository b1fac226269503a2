"""Starts of Python programs without the imports: each is a fork of one process that has imported what they import.

A fork has its parent's seed for the hashes of strings. What results are compared with comes from starts of its own (subprocess), so that a result
that depends on the order of a set is still seen.
"""
import atexit
import contextlib
import functools
import gc
import importlib
import json
import os
import runpy
import select
import signal
import socket
import subprocess
import sys
import tempfile

IMPORTED = ["numpy", "fcl_stpbv.batch.engine", "fcl_stpbv.batch.places", "click", "distributed", "distributed.http.scheduler", "distributed.http.worker"]


@functools.cache
def _channel():
    """To the process that forks, which starts when it is first asked for and ends when this end is closed."""
    channel, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    # A process of Dask tries to reach one that was killed for this long; the default is 30 s.
    environment = {**os.environ, "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "3s"}
    server = subprocess.Popen([sys.executable, "-B", __file__, str(other.fileno())], pass_fds=[other.fileno()], stdin=subprocess.DEVNULL, env=environment)
    other.close()
    atexit.register(server.wait)
    atexit.register(channel.close)  # before, as the last one comes first
    return channel


class Program:
    """`python -B -m MODULE ARGUMENT ...`, as subprocess.Popen with its output in files."""

    def __init__(self, module, *arguments, env=None, cwd=None, new_session=False):
        self.returncode: int | None = None
        self.files = [tempfile.TemporaryFile(), tempfile.TemporaryFile()]
        self.status, theirs = socket.socketpair()
        request = {"module": module, "arguments": list(map(str, arguments)), "env": dict(os.environ if env is None else env),
                   "cwd": str(cwd or os.getcwd()), "new_session": new_session}
        socket.send_fds(_channel(), [json.dumps(request).encode()], [file.fileno() for file in self.files] + [theirs.fileno()])
        theirs.close()
        self.pid = self._number()

    def _number(self):
        return int.from_bytes(self.status.recv(4), "little", signed=True)

    def wait(self, timeout=None):
        if self.returncode is None:
            if not select.select([self.status], [], [], timeout)[0]:
                raise subprocess.TimeoutExpired("a fork", timeout)
            self.returncode = self._number()
        return self.returncode

    def poll(self):
        with contextlib.suppress(subprocess.TimeoutExpired):
            return self.wait(0)

    def communicate(self, timeout=None):
        try:
            self.wait(timeout)
        except subprocess.TimeoutExpired:
            self.kill()
            raise
        for file in self.files:
            file.seek(0)
        return [file.read().decode() for file in self.files]

    def send_signal(self, number):
        if self.poll() is None:
            os.kill(self.pid, number)

    def kill(self):
        self.send_signal(signal.SIGKILL)


def run(module, *arguments, timeout, **more):
    """Runs a program to its end: what subprocess.run returns."""
    program = Program(module, *arguments, **more)
    output, message = program.communicate(timeout)
    return subprocess.CompletedProcess([module, *arguments], program.wait(), output, message)


def _tell(status, number):
    status.send(number.to_bytes(4, "little", signed=True))


def _forked(channel):
    """Forks for each request. Returns the request in a new process, whose streams, folder and environment are those asked for."""
    while True:
        message, descriptors, *_ = socket.recv_fds(channel, 1 << 20, 3)
        with contextlib.suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG if message else 0)[0]:
                pass
        if not message:
            os._exit(0)
        if os.fork() != 0:
            for descriptor in descriptors:
                os.close(descriptor)
            continue
        channel.close()
        status = socket.socket(fileno=descriptors.pop())
        request, child = json.loads(message), os.fork()
        if child != 0:  # waits for it and tells how it ended
            _tell(status, child)
            _tell(status, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
            os._exit(0)
        status.close()
        signal.signal(signal.SIGINT, signal.default_int_handler)
        for stream, descriptor in enumerate(descriptors, 1):
            os.dup2(descriptor, stream)
            os.close(descriptor)
        if request["new_session"]:
            os.setsid()
        os.chdir(request["cwd"])
        sys.path[0] = request["cwd"]  # as with -m
        os.environ.clear()
        os.environ.update(request["env"])
        tempfile.tempdir = None  # which depends on the environment
        return request


def main():
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C in a terminal, which the tests see too
    for name in IMPORTED:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    gc.freeze()  # else each fork looks through all that was imported when it ends
    request = _forked(socket.socket(fileno=int(sys.argv[1])))
    sys.argv = [request["module"], *request["arguments"]]
    runpy.run_module(request["module"], run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    main()

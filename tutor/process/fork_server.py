"""The fork server: a process that has imported what rclpy imports, from which supervisors and programs are forked.

Starting Python, numpy and the messages is half of the CPU time of a node's start. A program that is forked from here is
a process of its own all the same, with its own arguments, environment, folder, streams, session and command line; it
ends and reports exceptions as `python FILE` does, and sees a module only once it imports it (see `preloaded`). It
differs in the frames of this file below its own in a dump of its stacks, and in that the programs of one server share
the seed of `hash`. What could make a difference beyond that is run by exec, as without a server: see `_can_run`.

Run by file path with the interpreter and the environment of the learners' programs; its arguments are the file
descriptor of its socket, the names of the modules to import, and padding that makes room for other command lines, as
the variable `PADDING` does for other environments.
Each message carries four descriptors: the supervisor's control socket, and the program's stdin, stdout and stderr. The
answer goes to the control socket: the supervisor's pid, with its pidfd. End of stream ends the server.
"""

from __future__ import annotations

import builtins
import contextlib
import ctypes
import faulthandler
import gc
import importlib.machinery
import os
import select
import signal
import socket
import sys
from types import ModuleType
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

    from tutor.process.preloaded import Preloaded, is_shadowed, preload
    from tutor.process.supervisor import PR_SET_DUMPABLE, Supervisor
else:  # run by file path
    from preloaded import Preloaded, is_shadowed, preload
    from supervisor import PR_SET_DUMPABLE, Supervisor

SUPERVISOR = os.path.join(os.path.dirname(os.path.abspath(__file__)), "supervisor.py")
"""What the command line of a supervisor shows."""

REAP_S = 0.5
"""How long a supervisor that has ended remains a zombie."""

READ_AT_START = (b"PYTHON", b"LD_", b"LC_", b"LANG")
"""The beginnings of variables that Python or the loader reads only at its start."""


class ForkServer:
    """Forks a supervisor for each message."""

    def __init__(self, control: socket.socket, preloaded: Preloaded) -> None:
        self._control = control
        self._preloaded = preloaded
        self._path = sys.path[:]
        with open("/proc/self/environ", "rb") as file:
            given = file.read().split(b"\0")
        self._env = dict(variable.split(b"=", 1) for variable in given if variable)
        self._set_at_start = {k: v for k, v in os.environb.items() if k not in self._env}  # LC_CTYPE, see PEP 538
        self._loaded = preloaded.top_level.union(name.partition(".")[0] for name in sys.modules)

    def serve(self) -> list[bytes] | None:
        """Handle messages until the end of the stream. Returns the command line to run in a forked program."""
        owner, server = os.getppid(), os.getpid()
        while True:
            children = _reap(os.WNOHANG)
            if not select.select([self._control], [], [], REAP_S if children else None)[0]:
                continue
            message, descriptors, _, _ = socket.recv_fds(self._control, 16, 4)
            if not message:
                _reap(0)
                return None
            if (pid := os.fork()) == 0:
                self._control.close()
                return self._supervise(descriptors, owner, server)
            pidfd = os.pidfd_open(pid)
            with socket.socket(fileno=descriptors[0]) as control, contextlib.suppress(BrokenPipeError):
                socket.send_fds(control, [b"%d" % pid], [pidfd])
            for descriptor in (pidfd, *descriptors[1:]):
                os.close(descriptor)

    def _supervise(self, descriptors: list[int], owner: int, server: int) -> list[bytes] | None:
        """Be a supervisor until its program has ended. Returns its command line in the program."""
        os.setsid()
        os.chdir("/")
        control, *streams = descriptors
        for number, stream in enumerate(streams):
            os.dup2(stream, number)
            os.close(stream)
        _show(b" ".join(map(os.fsencode, [sys.executable, SUPERVISOR])))
        supervisor = Supervisor(control, owner, parent=server, can_run=self._can_run)
        supervisor.run()
        return supervisor.forked_argv

    def _can_run(self, argv: list[bytes], environment: dict[bytes, bytes]) -> bool:
        """Whether a command can be run here just as well as by exec; make it the environment then."""
        python, *words = argv
        if os.fsencode(sys.orig_argv[0]) != python or not words or not words[0].endswith(b".py") or os.isatty(0):
            return False
        folder = os.path.dirname(os.fsdecode(words[0]))
        path = [entry for entry in environment.get(b"PYTHONPATH", b"").split(b":") if entry]
        known = [entry for entry in self._env.get(b"PYTHONPATH", b"").split(b":") if entry]
        added = [os.fsdecode(entry) for entry in path[: len(path) - len(known)]]
        if path[len(added) :] != known or not all(map(os.path.isabs, [folder, *added, *map(os.fsdecode, known)])):
            return False
        if _read_at_start(environment) != _read_at_start(self._env):
            return False
        if os.path.islink(words[0]) or not os.access(words[0], os.R_OK) or is_shadowed(self._loaded, [folder, *added]):
            return False
        sys.path[:] = [folder, *added, *self._path]
        os.environb.clear()
        os.environb.update({**self._set_at_start, **environment})
        return True


def _reap(options: int) -> bool:
    """Reap the children that have ended. Return whether any is left."""
    try:
        while os.waitpid(-1, options)[0]:
            pass
    except ChildProcessError:
        return False
    return True


def _read_at_start(environment: dict[bytes, bytes]) -> dict[bytes, bytes]:
    return {k: v for k, v in environment.items() if v and k.startswith(READ_AT_START) and k != b"PYTHONPATH"}


def run_program(argv: list[bytes], preloaded: Preloaded) -> None:
    """Run `python FILE ARGUMENTS...` in this process, which has just been forked. Returns at its end, or exits."""
    for descriptor in sorted(map(int, os.listdir("/proc/self/fd")))[3:]:
        with contextlib.suppress(OSError):  # that of the list itself
            os.close(descriptor)
    for number in (signal.SIGPIPE, signal.SIGXFSZ):  # as Python does at its start
        signal.signal(number, signal.SIG_IGN)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    if faulthandler.is_enabled():  # its handlers have been reset
        faulthandler.disable()
        faulthandler.enable()
    if random := preloaded.modules.get("numpy.random"):  # unlike Python's own, it is seeded once, at its import
        random.seed()
    libc = ctypes.CDLL(None)
    libc.prctl(PR_SET_DUMPABLE, 1, 0, 0, 0)
    _show(b" ".join(argv), os.environb)
    if tempfile := sys.modules.get("tempfile"):
        vars(tempfile)["tempdir"] = None  # it may have cached another folder
    sys.orig_argv[:] = map(os.fsdecode, argv)
    sys.argv[:] = sys.orig_argv[1:]
    sys.meta_path.insert(0, preloaded)
    main = ModuleType("__main__")
    main.__dict__.update(__builtins__=builtins, __annotations__={}, __loader__=importlib.machinery.BuiltinImporter)
    sys.modules["__main__"] = main
    libc.fopen.restype = ctypes.c_void_p
    file = ctypes.c_void_p(libc.fopen(argv[1], b"rb"))
    if ctypes.pythonapi.PyRun_SimpleFileExFlags(file, argv[1], 1, None) == 0:
        return
    if not isinstance(sys.last_exc, KeyboardInterrupt):  # after that, the interpreter kills itself by SIGINT
        sys.exit(1)


def _show(command_line: bytes, environment: Mapping[bytes, bytes] | None = None) -> None:
    """Set what /proc/PID/cmdline and environ show, as setproctitle(3) does: both are memory of this process."""
    with open("/proc/self/stat", "rb") as file:
        fields = file.read().rpartition(b")")[2].split()
    start, end, environment_start, environment_end = map(int, fields[45:49])
    room = end - start - 2
    ctypes.memmove(start, command_line[:room].ljust(room + 1, b"\0") + b".", room + 2)
    if environment is not None:
        text = b"\0".join(b"%b=%b" % variable for variable in environment.items())
        room = environment_end - environment_start
        ctypes.memmove(environment_start, text[: room - 1].ljust(room, b"\0"), room)


def _main() -> None:
    """Import the modules, and serve. Returns at the end of the server, of a supervisor, and of a program."""
    control, names, _ = sys.argv[1:]
    del sys.path[0], sys.modules["preloaded"], sys.modules["process_table"], sys.modules["supervisor"]
    preloaded = preload(names.split(","))
    if len(os.listdir("/proc/self/task")) > 1:
        return  # the other threads would be missing in what is forked
    os.close(os.pidfd_open(os.getpid()))  # fails if the system has none
    null = os.open(os.devnull, os.O_RDWR)
    for stream in range(3):
        os.dup2(null, stream)
    os.close(null)
    server = ForkServer(socket.socket(fileno=int(control)), preloaded)
    ctypes.CDLL(None).prctl(PR_SET_DUMPABLE, 0, 0, 0, 0)
    gc.collect()
    gc.freeze()
    if (argv := server.serve()) is not None:
        run_program(argv, preloaded)


if __name__ == "__main__":
    _main()

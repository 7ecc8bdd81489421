"""Programs that are forked from a process that has imported their modules behave as those that Python starts."""

from __future__ import annotations

import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.process.conftest import LIMIT_S, until
from tutor.process import LearnerProcess, fork_link, supervisor
from tutor.process.fork_link import ForkedSupervisor, ForkServerLink
from tutor.process.spawner import DIRECTLY, Spawner

PACKAGE = {
    "pack/__init__.py": "",
    "pack/part.py": "value = 1",
    "pack/other.py": "import pack.part\nfrom pack import third",
    "pack/third.py": "import pack.part as part",
    "pack/broken.py": "import nothing_of_this_name",
}
MODULES = ("pack.other", "pack.broken", "no_such_module", "numpy", "tempfile", "yaml")
FOREVER = "while True:\n    time.sleep(0.1)"  # a signal that comes just before a sleep is only handled after it

_ADDRESS = re.compile(r"0x[0-9a-f]{6,}|(?<=started )\d+")


@dataclass
class Result:
    """What a program did, and whether it was forked."""

    forked: bool
    code: int | None
    signal: int | None
    output: list[tuple[str, str]]


class Programs:
    """Runs programs, forked and not."""

    def __init__(self, folder: Path, server: ForkServerLink, env: dict[str, str]) -> None:
        self.folder = folder
        self.server = server
        self.env = env

    async def start(self, file: Path, *arguments: str, fork: bool, env: dict[str, str]) -> LearnerProcess:
        return await LearnerProcess.start(
            [sys.executable, str(file), *arguments],
            env={**self.env, **env},
            cwd=self.folder,
            spawner=Spawner(self.server) if fork else DIRECTLY,
        )

    async def run(
        self,
        source: str,
        *arguments: str,
        fork: bool = True,
        env: dict[str, str] | None = None,
        interrupt: bool = False,
    ) -> Result:
        """Run a program to its end. `interrupt`: press Ctrl+C once it has printed "ready"."""
        file = self.folder / "program.py"
        file.write_text(source)
        async with await self.start(file, *arguments, fork=fork, env=env or {}) as process:
            if interrupt:
                await until(lambda: [line for line in process.output if line.text == "ready"], "the program is ready")
                process.interrupt()
            ended = await process.wait(LIMIT_S)
            assert ended is not None
            forked = isinstance(process._link._supervisor, ForkedSupervisor)
            return Result(
                forked,
                ended.code,
                ended.signal,
                [(line.stream, _ADDRESS.sub("…", line.text)) for line in process.output],
            )

    async def texts(self, source: str, *arguments: str, env: dict[str, str] | None = None) -> list[str]:
        """Return what a forked program prints."""
        result = await self.run(source, *arguments, env=env)
        assert result.forked
        return [text for _, text in result.output]


@pytest.fixture(scope="module")
def env(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The environment of the programs and of their server, whose Python path has `PACKAGE`."""
    home = tmp_path_factory.mktemp("home")
    for name, text in PACKAGE.items():
        (home / name).parent.mkdir(exist_ok=True)
        (home / name).write_text(text)
    return {
        "PATH": os.environ["PATH"],
        "HOME": str(home),
        "PYTHONPATH": str(home),
        "PYTHONUNBUFFERED": "1",
        "PYTHONFAULTHANDLER": "1",
        "PYTHONDONTWRITEBYTECODE": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1",
    }


@pytest.fixture(scope="module")
def server(env: dict[str, str]) -> Iterator[ForkServerLink]:
    with ForkServerLink(Path(sys.executable), env, MODULES) as server:
        yield server


@pytest.fixture
def programs(tmp_path: Path, server: ForkServerLink, env: dict[str, str]) -> Programs:
    return Programs(tmp_path, server, env)


SAME = {
    "surroundings": """
import os, signal, sys, threading
print(sys.argv, sys.orig_argv, sys.path, sys.executable, sys.flags, sys.warnoptions, os.getcwd())
print(dict(sorted((k, v) for k, v in os.environ.items() if k != "ROS_TUTOR_RUN")))
print(__name__, __file__, __doc__, __spec__, __package__, __cached__, type(__loader__), sorted(globals()))
print([(int(n), str(signal.getsignal(n))) for n in sorted(signal.valid_signals()) if signal.getsignal(n)])
print(os.getpid() == os.getpgrp() == os.getsid(0), signal.pthread_sigmask(signal.SIG_BLOCK, []))
print(sorted(os.listdir("/proc/self/fd")), threading.enumerate(), os.isatty(0), sys.stdin.read())
print([stream.__class__ for stream in (sys.stdin, sys.stdout, sys.stderr)], sys.stdout.encoding, sys.stdin.seekable())
""",
    "exception": "def f():\n    raise ValueError('no')\ntry:\n    1 / 0\nexcept ZeroDivisionError:\n    f()",
    "syntax error": "x = 1\ndef f(:\n    pass",
    "wrong encoding": "# coding: nonsense\nprint(1)",
    "null byte": "print(1)\nx = '\0'",
    "exit code": "import sys\nsys.exit(7)",
    "exit text": "raise SystemExit('why')",
    "exit at once": "import os\nprint('x', end='')\nos._exit(3)",
    "killed": "import os, signal\nos.kill(os.getpid(), signal.SIGKILL)",
    "hook": "import sys\nsys.excepthook = lambda *a: print('hook', a[0])\nraise KeyError(1)",
    "broken hook": "import sys\nsys.excepthook = lambda *a: 1 / 0\nraise KeyError(1)",
    "exception at exit": "import atexit\natexit.register(lambda: 1 / 0)\nprint('end')",
    "threads and atexit": """
import atexit, threading, time
atexit.register(print, "atexit")
threading.Thread(target=lambda: (time.sleep(0.2), print("thread"))).start()
threading.Thread(target=time.sleep, args=(600,), daemon=True).start()
print("end")
""",
    "exception in a thread": "import threading\nthreading.Thread(target=lambda: 1 / 0).start()",
    "unclosed": "def f():\n    raise OSError\nclass A:\n    def __del__(self):\n        f()\na = A()\nprint('end')",
    "warning": "import warnings\nwarnings.warn('old', DeprecationWarning)\n'\\d'",
    "finalizers": "class A:\n    def __del__(self): print('gone', __name__)\na = A()\nb = [a]\nb.append(b)",
    "main module": "import __main__, sys\nx = 1\nprint(__main__.x, sys.modules['__main__'] is __main__)",
    "child processes": """
import multiprocessing, os, subprocess, sys
def show():
    print(sys.argv, __name__, os.path.basename(__file__), multiprocessing.parent_process() is not None, flush=True)
if __name__ == "__main__":
    for method in ("fork", "spawn", "forkserver"):
        child = multiprocessing.get_context(method).Process(target=show)
        child.start()
        child.join()
        print(method, child.exitcode)
    print(subprocess.run([sys.executable, "-c", "import sys; print(sys.path[1:])"], capture_output=True, text=True))
""",
    "run again": """
import os, sys
print(sys.argv)
if sys.argv[-1] != "more":
    os.execv(sys.executable, [sys.executable, *sys.argv, "more"])
""",
    "modules": """
import sys
print([name for name in sys.modules if name.split(".")[0] in ("pack", "numpy", "yaml")])
import pack
print([hasattr(pack, name) for name in ("part", "other", "third")])
import pack.third
print([hasattr(pack, name) for name in ("part", "other", "third")], sorted(n for n in sys.modules if "pack." in n))
from pack import other
print([hasattr(pack, name) for name in ("part", "other", "third")], other.third is pack.third, pack.part.value)
print(pack.__spec__, other.__spec__, other.__file__, type(other.__loader__))
import pack.broken
""",
    "forgotten import": "import pack\nprint(pack.part.value)",
    "libraries": "import numpy, yaml\nprint(numpy.linalg.det(numpy.eye(2)), yaml.safe_load('[1, {a: b}]'), numpy.fft)",
    "own module": "import helper\nprint(helper.value, helper.__file__)",
    "temporary folder": "import tempfile\nprint(tempfile.gettempdir())",
    "unicode": "print('é', input())",
}


@pytest.mark.parametrize("name", SAME)
async def test_a_forked_program_does_what_one_does_that_python_starts(programs: Programs, name: str) -> None:
    (programs.folder / "helper.py").write_text("value = 'of the folder'")
    env = {"EXTRA": "1 ü", "TMPDIR": str(programs.folder)}
    results = [
        await programs.run(SAME[name], "--ros-args", "-p", "a:=ü b", fork=fork, env=env) for fork in (True, False)
    ]
    assert [result.forked for result in results] == [True, False]
    forked, started = results
    assert (forked.code, forked.signal) == (started.code, started.signal)
    assert sorted(forked.output) == sorted(started.output)


async def test_ctrl_c_ends_a_forked_program_by_its_signal_or_is_handled(programs: Programs) -> None:
    wait = f"os.write(1, b'ready\\n')\n{FOREVER}"
    waits = f"import atexit, os, time\natexit.register(print, 'bye')\n{wait}"
    handled = waits.replace(wait, "try:\n    time.sleep(0)\n    " + wait.replace("\n", "\n    "))
    handled += "\nexcept KeyboardInterrupt:\n    print('handled')"
    for source in (waits, handled):
        results = [await programs.run(source, fork=fork, interrupt=True) for fork in (True, False)]
        assert [result.forked for result in results] == [True, False]
        forked, started = results
        assert (forked.code, forked.signal) == (started.code, started.signal)
        assert _without_frames(forked) == _without_frames(started)


async def test_on_ctrl_c_the_main_thread_preempts_no_other(programs: Programs) -> None:
    """The thread of rclpy that wakes the main thread then shuts the context down first."""
    forever = FOREVER.replace("\n", "\n    ")
    source = f"import os, time\ntry:\n    os.write(1, b'ready\\n')\n    {forever}\n"
    source += "except KeyboardInterrupt:\n    print(os.sched_getscheduler(0) == os.SCHED_BATCH)"
    for fork in (True, False):
        result = await programs.run(source, fork=fork, interrupt=True)
        assert result.forked == fork
        assert result.output[-1] == ("stdout", "True")


def _without_frames(result: Result) -> list[tuple[str, str]]:
    return sorted((stream, text) for stream, text in result.output if not text.startswith("  "))


async def test_a_fatal_signal_dumps_the_stacks(programs: Programs) -> None:
    texts = await programs.texts("import os, signal\ndef f():\n    os.kill(os.getpid(), signal.SIGABRT)\nf()")
    assert texts[0] == "Fatal Python error: Aborted"
    frames = [re.sub(r".*/", "", text) for text in texts if text.startswith("  File ")]
    assert frames[:2] == ['program.py", line 3 in f', 'program.py", line 4 in <module>']
    assert all(frame.startswith("fork_server.py") for frame in frames[2:])


async def test_forked_programs_have_different_random_numbers(programs: Programs) -> None:
    source = "import random, numpy, tempfile, uuid\nprint(random.random(), tempfile.mktemp(), uuid.uuid4())\n"
    source += "print(numpy.random.rand())"
    first, second = [await programs.texts(source) for _ in range(2)]
    assert not {*" ".join(first).split()} & {*" ".join(second).split()}


async def test_the_system_shows_the_command_line_and_the_environment_of_the_program(programs: Programs) -> None:
    source = "print([each for each in open('/proc/self/environ').read().split('\\0') if each])"
    env = {"A": "b" * 100, "C": "d"}
    (environ,) = await programs.texts(source, env=env)
    assert all(f"'{name}={value}'" in environ for name, value in (programs.env | env).items())
    assert "PADDING" not in environ

    source = "import os\nprint(open('/proc/self/cmdline').read())"
    text = f"{sys.executable} {programs.folder}/program.py --ros-args"
    assert await programs.texts(source, "--ros-args") == [text + "\0"]
    parents = source.replace("self", "{os.getppid()}").replace("'/", "f'/")
    assert (await programs.texts(parents))[0].rstrip("\0").endswith("/supervisor.py")
    long = "x" * 9000
    assert (await programs.texts(source, long))[0].startswith(f"{sys.executable} {programs.folder}/program.py xxx")


@pytest.mark.parametrize(
    ("case", "expected"),
    [
        ("a module of the folder", ["mine"]),
        ("a package of the folder", ["mine"]),
        ("another path", ["theirs"]),
        ("added path", ["theirs"]),
        ("another setting", ["False"]),
        ("a link", ["the folder of the file"]),
    ],
)
async def test_what_could_make_a_difference_is_not_forked(
    programs: Programs, case: str, expected: Sequence[str]
) -> None:
    folder, elsewhere = programs.folder, programs.folder / "elsewhere"
    (elsewhere / "yaml").mkdir(parents=True)
    (elsewhere / "yaml" / "__init__.py").write_text("name = 'theirs'")
    source, env = "import yaml\nprint(yaml.name)", {}
    match case:
        case "a module of the folder":
            (folder / "yaml.py").write_text("name = 'mine'")
        case "a package of the folder":
            (folder / "yaml").mkdir()
            (folder / "yaml" / "__init__.py").write_text("name = 'mine'")
        case "another path":
            env = {"PYTHONPATH": str(elsewhere)}
        case "added path":
            env = {"PYTHONPATH": f"{elsewhere}:{programs.env['PYTHONPATH']}"}
        case "another setting":
            source, env = "import sys\nprint(sys.dont_write_bytecode)", {"PYTHONDONTWRITEBYTECODE": ""}
        case "a link":
            (elsewhere / "program.py").touch()
            (elsewhere / "helper.py").write_text("name = 'the folder of the file'")
            (folder / "program.py").symlink_to(elsewhere / "program.py")
            source = "import helper\nprint(helper.name)"
    result = await programs.run(source, env=env)
    assert [text for _, text in result.output] == expected


async def test_a_path_that_a_program_adds_counts(programs: Programs) -> None:
    (programs.folder / "lib" / "yaml").mkdir(parents=True)
    (programs.folder / "lib" / "yaml" / "__init__.py").write_text("name = 'mine'")
    source = "import sys\nsys.path.insert(0, 'lib')\nimport yaml\nprint(yaml.name)"
    assert await programs.texts(source) == ["mine"]


async def test_a_missing_file_and_other_arguments_are_left_to_python(programs: Programs) -> None:
    for argv in (["/no/such.py"], ["-c", "print(1)"], ["-V"]):
        async with await LearnerProcess.start(
            [sys.executable, *argv], env=programs.env, cwd=programs.folder, spawner=Spawner(programs.server)
        ) as process:
            assert await process.wait(LIMIT_S) is not None
            text = process.output[0].text
            assert text in ("1", sys.version.split()[0].join(["Python ", ""])) or "can't open file" in text


async def test_a_program_whose_executable_is_missing_cannot_be_started(programs: Programs) -> None:
    from tutor.errors import StartError

    with pytest.raises(StartError, match="No such file"):
        await LearnerProcess.start(
            ["/no/such"], env=programs.env, cwd=programs.folder, spawner=Spawner(programs.server)
        )


@pytest.mark.parametrize("stop", [signal.SIGKILL, signal.SIGSTOP])
async def test_programs_start_without_a_server_that_is_gone_or_hangs(
    programs: Programs, stop: signal.Signals, monkeypatch: pytest.MonkeyPatch
) -> None:
    programs.server = ForkServerLink(Path(sys.executable), programs.env, ["yaml"])
    file = programs.folder / "long.py"
    file.write_text(f"import os, time\nos.write(1, b'ready\\n')\n{FOREVER}")
    assert await programs.texts("print(1)") == ["1"]  # it has been started
    async with await programs.start(file, fork=True, env={}) as process:
        monkeypatch.setattr(fork_link, "_FORK_LIMIT_S", 0.3)
        os.kill(programs.server._process.pid, stop)
        for _ in range(2):
            result = await programs.run("print(1)")
            assert (result.forked, result.output) == (False, [("stdout", "1")])
        assert process.exit is None
        process.interrupt()
        assert await process.wait(LIMIT_S) is not None
    assert not process.survivors()


def test_a_supervisor_that_was_given_up_writes_nothing_into_the_programs_output() -> None:
    ours, theirs = socket.socketpair()
    theirs.send(b"4711")  # its pid: we close our end before we read it, as after a fork that takes too long
    with theirs:
        process = subprocess.Popen(
            [sys.executable, "-I", "-S", supervisor.__file__, str(theirs.fileno()), str(os.getpid())],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            pass_fds=(theirs.fileno(),),
        )
    ours.close()
    assert process.communicate(timeout=LIMIT_S)[0] == b""
    assert process.returncode == 0


async def test_the_end_of_the_owner_ends_what_was_forked(programs: Programs) -> None:
    file = programs.folder / "long.py"
    file.write_text("import os, time\nprint(f'{os.getpid()} {os.getppid()}')\ntime.sleep(600)")
    owner = programs.folder / "owner.py"
    owner.write_text(
        f"""
import asyncio, os, sys
from pathlib import Path
from tutor.process import LearnerProcess
from tutor.process.fork_link import ForkServerLink
from tutor.process.spawner import Spawner
async def main():
    server = ForkServerLink(Path(sys.executable), {programs.env!r}, ["yaml"])
    process = await LearnerProcess.start(
        [sys.executable, {str(file)!r}], env={programs.env!r}, cwd=Path("."), spawner=Spawner(server)
    )
    while not process.output:
        await asyncio.sleep(0.01)
    print(process.output[0].text, server._process.pid, type(process._link._supervisor).__name__, flush=True)
    await process.wait(None)
asyncio.run(main())
"""
    )
    root = str(Path(fork_link.__file__).parents[2])
    env = {"PYTHONPATH": root}
    async with await programs.start(owner, fork=False, env=env) as process:
        await until(
            lambda: [line for line in process.output if len(line.text.split()) == 4], "the owner has started a program"
        )
        *pids, kind = process.output[0].text.split()
        assert kind == "ForkedSupervisor"
        os.kill(process.pid, signal.SIGKILL)
        deadline = time.monotonic() + LIMIT_S
        while any(Path(f"/proc/{pid}").exists() for pid in pids):
            assert time.monotonic() < deadline
            time.sleep(0.01)

"""Runs launch files as processes, with our launch or the real one, in a folder with a package `demo`."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from tests.bundled_ros.launching.case import IMPORTS, Case, launch_file
from tests.fork_server import Forked, ForkServer, fork_server
from tutor.process.process_table import processes

RUN = """\
import sys
from tutor.bundled_ros.launching import run
options, arguments = sys.argv[2].split(), sys.argv[3:]
sys.exit(run(sys.argv[1], arguments, "show" in options, noninteractive="terminal" not in options))
"""

PRELOAD = f"""\
import sys
from tutor.bundled_ros.launching.runner import install_substitutes
install_substitutes()
import difflib, yaml, launch.frontend, launch_ros
{IMPORTS}
"""
"""Imports what most launch files need, for a fork server."""

PRINT_ARGV = """\
#!/bin/sh
line=argv
for word; do
  case $word in
    */launch_params_*) line="$line <params>"; files="$files $word" ;;
    *) line="$line <$word>" ;;
  esac
done
echo "$line"
for file in $files; do sed 's/ !!python.tuple//; s/^/param /' "$file"; done
"""

LOOP = "echo ready\nwhile :; do sleep 0.05; done\n"

PROGRAMS = {
    "talker": PRINT_ARGV,
    "listener": PRINT_ARGV,
    "waiter": f"#!/bin/sh\ntrap 'echo interrupted; exit 0' INT\ntrap 'echo terminated; exit 0' TERM\n{LOOP}",
    "stubborn": f"#!/bin/sh\ntrap '' INT\ntrap 'echo terminated; exit 0' TERM\n{LOOP}",
    "immortal": f"#!/bin/sh\ntrap '' INT TERM\n{LOOP}",
    "failing": "#!/bin/sh\nexit 3\n",
}

LIMIT_S = 60.0
ORPHAN_GRACE_S = 5.0


@dataclass(frozen=True)
class Ran:
    """The exit code and output of a launch. `lines` include stderr, with placeholders for pids and folders."""

    code: int
    lines: tuple[str, ...]
    has_orphans: bool
    """Whether a process that it started was still alive ORPHAN_GRACE_S after its exit."""

    @property
    def printed(self) -> dict[str, tuple[str, ...]]:
        """The lines that each process printed, by the name of the process."""
        printed: dict[str, tuple[str, ...]] = {}
        for line in self.lines:
            if found := re.match(r"\[([\w.+-]+-\d+)\] (.*)", line):
                printed[found[1]] = (*printed.get(found[1], ()), found[2])
        return printed

    @property
    def log(self) -> tuple[str, ...]:
        """The launch's own messages."""
        return tuple(line for line in self.lines if re.match(r"\[(INFO|WARNING|ERROR)\]", line))


@contextmanager
def launch_server() -> Iterator[ForkServer]:
    """Run a fork server for launchers during the block."""
    with fork_server(PRELOAD, _environment("")) as server:
        yield server


class Launcher:
    """A folder with an ament prefix that contains the package `demo`.

    `server` forks the launches, except for real ones. Without it, each is a new process.
    """

    def __init__(self, folder: Path, server: ForkServer | None = None) -> None:
        self.folder = folder
        self._server = server
        self.prefix = folder / "prefix"
        for path, text in PROGRAMS.items():
            self._write(f"prefix/lib/demo/{path}", text).chmod(0o755)
        self._write("prefix/share/ament_index/resource_index/packages/demo", "")
        inner = "LogInfo(msg=['in the package, ', ThisLaunchFileDir()])"
        self._write("prefix/share/demo/launch/inner.launch.py", launch_file(inner))

    def _write(self, name: str, text: str) -> Path:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        return path

    def run_case(self, case: Case, python_path: str) -> Ran:
        """Run a case. `python_path` is where to import the real launch from; empty for ours."""
        path = self._write("main.launch.py", case.text)
        for name, text in case.files.items():
            self._write(name, text)
        return self.run(
            path,
            case.arguments,
            python_path=python_path,
            environment=case.environment,
            interrupt_at=case.interrupt_at,
        )

    def run(
        self,
        path: Path | str,
        arguments: Sequence[str] = (),
        *,
        options: str = "",
        python_path: str = "",
        environment: Mapping[str, str] | None = None,
        interrupt_at: str = "",
        signals: Sequence[int] = (signal.SIGINT,),
        to_all: bool = False,
        ignoring_sigint: bool = False,
    ) -> Ran:
        """Run a launch file.

        At the first line that contains `interrupt_at`, send the signals: to the launch alone, or with `to_all` to its
        whole process group, as a terminal does. `ignoring_sigint` starts it as a shell starts background jobs.
        """
        prefixes = [str(self.prefix), *filter(None, [os.environ.get("AMENT_PREFIX_PATH")])]
        environ = {
            **_environment(python_path),
            "AMENT_PREFIX_PATH": os.pathsep.join(prefixes),
            "ROS_LOG_DIR": str(self.folder / "log"),
            **(environment or {}),
        }
        words = ["-c", RUN, str(path), options, *arguments]
        read_output, output = os.pipe()
        process: Forked | subprocess.Popen[bytes]
        with open(os.devnull) as nothing, open(output, "w"):
            if self._server and not python_path and not ignoring_sigint:
                process = self._server.start(
                    words, env=environ, cwd=self.folder,
                    stdin=nothing.fileno(), stdout=output, stderr=output, new_session=True,
                )  # fmt: skip
            else:
                process = subprocess.Popen(
                    [sys.executable, "-P", *words],
                    env=environ,
                    cwd=self.folder,
                    stdin=nothing,
                    stdout=output,
                    stderr=output,
                    start_new_session=True,
                    preexec_fn=(lambda: signal.signal(signal.SIGINT, signal.SIG_IGN)) if ignoring_sigint else None,
                )
        watchdog = threading.Timer(LIMIT_S, os.killpg, (process.pid, signal.SIGKILL))
        watchdog.start()
        lines = []
        with open(read_output) as shown:
            for line in shown:
                lines.append(line.rstrip("\n"))
                if interrupt_at and interrupt_at in line:
                    interrupt_at = ""
                    for number in signals:
                        (os.killpg if to_all else os.kill)(process.pid, number)
        code = process.wait(LIMIT_S)
        watchdog.cancel()
        return Ran(code, tuple(self._mask(line) for line in lines), has_orphans(process.pid))

    def _mask(self, line: str) -> str:
        for folder, placeholder in ((self.prefix, "$PREFIX"), (self.folder, "$DIR")):
            line = line.replace(str(folder), placeholder)
        line = re.sub(r"\bpid \[\d+\]", "pid [N]", line)
        return re.sub(r"\[pid \d+", "[pid N", line)


def _environment(python_path: str) -> dict[str, str]:
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("ROS_", "OVERRIDE_LAUNCH"))}
    return {**kept, "PYTHONPATH": python_path}


def has_orphans(group: int) -> bool:
    """Return whether a process of this group outlives its leader by ORPHAN_GRACE_S; if so, kill the group."""
    deadline = time.monotonic() + ORPHAN_GRACE_S
    while time.monotonic() < deadline:
        # Zombies do not count: where the tests are the new parent of orphans, nothing has reaped these yet.
        if not any(each.alive for each in processes().values() if each.group == group):
            return False
        time.sleep(0.01)
    os.killpg(group, signal.SIGKILL)
    return True

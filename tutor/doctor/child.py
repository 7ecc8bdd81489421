"""Probes in child processes, so that a broken ROS cannot crash the doctor."""

from __future__ import annotations

import json
import selectors
import subprocess
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tutor import private_folders
from tutor.errors import ProbeFailed
from tutor.ros.domain import reserve_domain
from tutor.ros.environment import RosEnvironment, learner_env

PROBE = Path(__file__).resolve().parent.parent / "ros" / "probe.py"


def run_probe(ros: RosEnvironment, environ: Mapping[str, str], program: str, limit_s: float) -> dict[str, Any]:
    """Run one program of the probe to completion and return the JSON object it prints. Raises ProbeFailed."""
    with private_folders.temporary("doctor") as folder:
        env = learner_env(ros, domain_id=0, log_dir=folder, package_root=None, isolated=True, environ=environ)
        try:
            done = subprocess.run(
                [ros.python, PROBE, program],
                env=env, cwd=folder, capture_output=True, text=True, errors="replace", timeout=limit_s, check=False,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            raise ProbeFailed(f"no answer within {limit_s:.0f} s") from None
        except OSError as error:
            raise ProbeFailed(f"{ros.python} cannot be run: {error.strerror}") from error
    if done.returncode != 0:
        raise ProbeFailed(_output_tail(done.returncode, done.stderr))
    answer: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return answer


def first_message_ms(ros: RosEnvironment, environ: Mapping[str, str], limit_s: float) -> float:
    """Measure discovery between two processes on a reserved domain.

    Returns the time from the start of the publisher's process to the subscriber's first message, in milliseconds.
    Raises ProbeFailed or NoFreeDomain.
    """
    with private_folders.temporary("doctor") as folder, reserve_domain() as domain:
        env = learner_env(ros, domain_id=domain, log_dir=folder, package_root=None, isolated=True, environ=environ)
        deadline = time.monotonic() + limit_s
        with _running(ros, env, folder, "listen") as listener:
            _read_line(listener, deadline, "the subscriber did not start")
            started = time.monotonic()
            with _running(ros, env, folder, "talk"):
                _read_line(listener, deadline, "no message arrived")
                return (time.monotonic() - started) * 1000


@contextmanager
def _running(
    ros: RosEnvironment, env: Mapping[str, str], folder: Path, program: str
) -> Iterator[subprocess.Popen[str]]:
    with tempfile.TemporaryFile("w+", errors="replace") as stderr_file:
        try:
            process = subprocess.Popen(
                [ros.python, PROBE, program, "/ros_tutor_doctor"],
                env=env, cwd=folder, stdout=subprocess.PIPE, stderr=stderr_file, text=True, errors="replace",
            )  # fmt: skip
        except OSError as error:
            raise ProbeFailed(f"{ros.python} cannot be run: {error.strerror}") from error
        try:
            yield process
        except ProbeFailed as failure:
            if process.poll() not in (None, 0):
                stderr_file.seek(0)
                raise ProbeFailed(_output_tail(process.returncode, stderr_file.read())) from failure
            raise
        finally:
            process.kill()
            process.communicate()


def _read_line(process: subprocess.Popen[str], deadline: float, failure: str) -> str:
    """Read the next line of a process. Raises ProbeFailed(`failure`) if it exits, or prints nothing by `deadline`."""
    assert process.stdout is not None
    with selectors.DefaultSelector() as selector:
        selector.register(process.stdout, selectors.EVENT_READ)
        if not selector.select(max(0.0, deadline - time.monotonic())):
            raise ProbeFailed(f"{failure} in time")
    line = process.stdout.readline()
    if not line:
        process.wait(timeout=5)
        raise ProbeFailed(failure)
    return line


def _output_tail(code: int, stderr: str) -> str:
    lines = [line.strip() for line in stderr.splitlines() if line.strip()]
    ending = f"killed by signal {-code}" if code < 0 else f"exit code {code}"
    return f"{lines[-1]} ({ending})" if lines else ending

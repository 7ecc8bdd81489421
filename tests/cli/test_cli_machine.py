"""Constrained machines, as in a classroom: no home, nothing writable, no shared memory, few file descriptors."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest

from tutor.cli import main

LIMIT_S = 100.0
CLONE = Path(__file__).resolve().parents[2]
RUN = (sys.executable, "-I", "-m", "tutor")
CHECK = ("check", "i1.3", str(CLONE / "lessons" / "i1_3" / "solution"), "--criterion", "services")
UNPRIVILEGED = ("setpriv", "--inh-caps=-all", "--bounding-set=-all") if os.getuid() == 0 else ()
SMALL_SHM = """
mount -t tmpfs -o size=1m tmpfs /dev/shm
exec "$@"
"""
FULL_SHM = f"""
{SMALL_SHM.strip().splitlines()[0]} && head -c 2M /dev/zero > /dev/shm/full 2>/dev/null
exec "$@"
"""


def run_command(*command: str, **changed: str) -> subprocess.CompletedProcess[str]:
    env = {**os.environ, **changed}
    return subprocess.run(command, env=env, capture_output=True, text=True, timeout=LIMIT_S, check=False)


def succeeds(*command: str) -> bool:
    try:
        return run_command(*command).returncode == 0
    except OSError:
        return False


@pytest.fixture
def read_only(tmp_path: Path) -> Path:
    if not succeeds(*UNPRIVILEGED, "true"):
        pytest.skip("setpriv is missing: root can write everywhere")
    path = tmp_path / "read-only"
    path.mkdir(mode=0o555)
    return path


def test_a_check_needs_no_writable_home_or_temporary_folder(read_only: Path) -> None:
    result = run_command(*UNPRIVILEGED, *RUN, *CHECK, HOME=str(read_only), TMPDIR=str(read_only))
    assert (result.returncode, result.stderr) == (0, ""), result.stdout + result.stderr
    assert not any(read_only.iterdir())


def test_a_check_needs_no_home_at_all() -> None:
    result = run_command("env", "-u", "HOME", *RUN, *CHECK)
    assert (result.returncode, result.stderr) == (0, ""), result.stdout + result.stderr


def test_the_clone_starts_where_uv_can_write_nothing(read_only: Path) -> None:
    result = run_command(*UNPRIVILEGED, str(CLONE / "ros-tutor"), "list", HOME=str(read_only), TMPDIR=str(read_only))
    assert (result.returncode, "Sensor Publisher" in result.stdout) == (0, True), result.stderr


def with_shared_memory(shm_script: str) -> tuple[str, ...]:
    """The prefix of a command that is to run with such a /dev/shm, in a mount namespace of its own."""
    in_namespace = ("unshare", "--mount", "--map-root-user", "sh", "-c", shm_script, "sh")
    if not succeeds(*in_namespace, "true"):
        pytest.skip("this kernel allows this user no mount namespace")
    return in_namespace


@pytest.mark.parametrize(("words", "code"), [(CHECK, 3), (("ros2", "topic", "list"), 1)], ids=["check", "ros2"])
def test_full_shared_memory_is_reported_in_one_line(words: tuple[str, ...], code: int) -> None:
    result = run_command(*with_shared_memory(FULL_SHM), *RUN, *words)
    assert (result.returncode, result.stdout) == (code, ""), result.stderr
    assert "/dev/shm is full (1 MB)" in result.stderr
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.parametrize(
    ("shm_script", "message", "works"),
    [
        (FULL_SHM, "/dev/shm is full (1 MB), so ROS cannot be loaded.", False),
        (SMALL_SHM, "/dev/shm has 1 MB of 1 MB", True),
    ],
    ids=["full", "small"],
)
def test_the_doctor_has_a_finding_for_full_and_for_small_shared_memory(
    shm_script: str, message: str, works: bool
) -> None:
    result = run_command(*with_shared_memory(shm_script), *RUN, "doctor")
    assert result.returncode == (0 if works else 3), result.stdout + result.stderr
    output = " ".join(result.stdout.split())
    assert message in output
    assert output.count("docker run --shm-size=1g") == 1
    assert ("First fix the shared memory, see above." in output) is not works
    assert "reinstall" not in output


@pytest.mark.parametrize("limit", [40, 200])
def test_too_few_file_descriptors_are_an_error_of_the_machine(limit: int) -> None:
    lower_limit = lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (limit, limit))  # noqa: E731
    command = [*RUN, "check", "i1.1", "--solution", "--format", "json"]
    result = subprocess.run(
        command, capture_output=True, text=True, timeout=LIMIT_S, check=False, preexec_fn=lower_limit
    )
    assert result.returncode == 3, result.stderr
    assert f"only {limit} files may be open" in result.stderr
    assert not result.stdout or json.loads(result.stdout)["verdict"] == "error"


def test_a_soft_limit_on_file_descriptors_is_raised_where_allowed() -> None:
    lower_limit = lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (40, 1024))  # noqa: E731
    result = subprocess.run(
        [*RUN, *CHECK], capture_output=True, text=True, timeout=LIMIT_S, check=False, preexec_fn=lower_limit
    )
    assert result.returncode == 0, result.stdout + result.stderr


def test_a_named_pipe_as_progress_file_or_output_blocks_nothing(tmp_path: Path) -> None:
    workspace = ("--workspace", str(tmp_path / "ws"))
    assert main([*workspace, "start", "i1.1"]) == 0
    progress = tmp_path / "ws" / ".ros-tutor" / "progress.json"
    assert progress.is_file()
    progress.unlink()
    os.mkfifo(progress)
    result = run_command(*RUN, *workspace, "list")
    assert (result.returncode, "is kept as" in result.stderr) == (0, True), result.stderr
    os.mkfifo(tmp_path / "report")
    result = run_command(
        *RUN, *workspace, "checklist", "export", "--format", "json", "--output", str(tmp_path / "report")
    )
    assert (result.returncode, "Traceback" in result.stderr) == (3, False), result.stderr


INTERRUPTS_DURING_IMPORT = """
import os, runpy, signal, sys

class Press:
    def find_spec(self, name, *_):
        if name == "tutor.cli":
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Press())
runpy.run_module("tutor", run_name="__main__")
"""


def test_ctrl_c_while_the_program_is_being_imported_prints_no_traceback() -> None:
    result = run_command(sys.executable, "-c", INTERRUPTS_DURING_IMPORT)
    assert (result.returncode, result.stdout, result.stderr) == (130, "", "")

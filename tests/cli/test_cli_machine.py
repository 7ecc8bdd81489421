"""Machines as a class has them: no home, nothing that can be written to, no shared memory."""

from __future__ import annotations

import json
import os
import resource
import subprocess
import sys
from pathlib import Path

import pytest

LIMIT_S = 100.0
CLONE = Path(__file__).resolve().parents[2]
RUN = (sys.executable, "-I", "-m", "tutor")
CHECK = ("check", "i1.3", str(CLONE / "lessons" / "i1_3" / "solution"), "--criterion", "services")
UNPRIVILEGED = ("setpriv", "--inh-caps=-all", "--bounding-set=-all") if os.getuid() == 0 else ()
SMALL = """
mount -t tmpfs -o size=1m tmpfs /dev/shm
exec "$@"
"""
FULL = f"""
{SMALL.strip().splitlines()[0]} && head -c 2M /dev/zero > /dev/shm/full 2>/dev/null
exec "$@"
"""


def ran(*command: str, **changed: str) -> subprocess.CompletedProcess[str]:
    env = {**os.environ, **changed}
    return subprocess.run(command, env=env, capture_output=True, text=True, timeout=LIMIT_S, check=False)


def can(*command: str) -> bool:
    try:
        return ran(*command).returncode == 0
    except OSError:
        return False


@pytest.fixture
def read_only(tmp_path: Path) -> Path:
    if not can(*UNPRIVILEGED, "true"):
        pytest.skip("setpriv is missing: root can write everywhere")
    path = tmp_path / "read-only"
    path.mkdir(mode=0o555)
    return path


@pytest.mark.parametrize("variables", [("HOME",), ("HOME", "TMPDIR")], ids=" ".join)
def test_a_check_needs_no_home_and_no_temporary_folder_of_the_users(read_only: Path, variables: list[str]) -> None:
    found = ran(*UNPRIVILEGED, *RUN, *CHECK, **dict.fromkeys(variables, str(read_only)))
    assert (found.returncode, found.stderr) == (0, ""), found.stdout + found.stderr
    assert not any(read_only.iterdir())


def test_a_check_needs_no_home_at_all() -> None:
    found = ran("env", "-u", "HOME", *RUN, *CHECK)
    assert (found.returncode, found.stderr) == (0, ""), found.stdout + found.stderr


def test_the_clone_starts_where_uv_can_keep_nothing(read_only: Path) -> None:
    found = ran(*UNPRIVILEGED, str(CLONE / "ros-tutor"), "list", HOME=str(read_only), TMPDIR=str(read_only))
    assert (found.returncode, "Sensor Publisher" in found.stdout) == (0, True), found.stderr


def with_shared_memory(as_here: str) -> tuple[str, ...]:
    """The beginning of a command that is to find such a /dev/shm."""
    apart = ("unshare", "--mount", "--map-root-user", "sh", "-c", as_here, "sh")
    if not can(*apart, "true"):
        pytest.skip("the kernel gives no mount namespace to this user")
    return apart


@pytest.mark.parametrize(("words", "code"), [(CHECK, 3), (("ros2", "topic", "list"), 1)], ids=["check", "ros2"])
def test_full_shared_memory_is_told_in_a_sentence(words: tuple[str, ...], code: int) -> None:
    found = ran(*with_shared_memory(FULL), *RUN, *words)
    assert (found.returncode, found.stdout) == (code, ""), found.stderr
    assert "/dev/shm is full (1 MB)" in found.stderr
    assert len(found.stderr.splitlines()) == 1


@pytest.mark.parametrize(
    ("as_here", "said", "works"),
    [
        (FULL, "/dev/shm is full (1 MB), so ROS cannot be loaded.", False),
        (SMALL, "/dev/shm has 1 MB of 1 MB", True),
    ],
    ids=["full", "small"],
)
def test_the_doctor_has_a_finding_for_full_and_for_little_shared_memory(as_here: str, said: str, works: bool) -> None:
    found = ran(*with_shared_memory(as_here), *RUN, "doctor")
    assert found.returncode == (0 if works else 3), found.stdout + found.stderr
    about = " ".join(found.stdout.split())
    assert said in about
    assert about.count("docker run --shm-size=1g") == 1
    assert ("First fix the shared memory, see above." in about) is not works
    assert "reinstall" not in about


@pytest.mark.parametrize("most", [40, 200])
def test_too_few_descriptors_are_an_error_of_the_machine(most: int) -> None:
    few = lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))  # noqa: E731
    command = [*RUN, "check", "i1.1", "--solution", "--format", "json"]
    found = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT_S, check=False, preexec_fn=few)
    assert found.returncode == 3, found.stderr
    assert f"only {most} files may be open" in found.stderr
    assert not found.stdout or json.loads(found.stdout)["verdict"] == "error"


def test_where_more_descriptors_are_allowed_they_are_used() -> None:
    few = lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (40, 1024))  # noqa: E731
    command = [*RUN, "check", "i1.3", "--solution", "--format", "json"]
    found = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT_S, check=False, preexec_fn=few)
    assert found.returncode == 0, found.stdout + found.stderr


def test_a_pipe_as_progress_file_or_output_holds_nothing_up(tmp_path: Path) -> None:
    workspace = ("--workspace", str(tmp_path / "ws"))
    assert ran(*RUN, *workspace, "start", "i1.1").returncode == 0
    progress = tmp_path / "ws" / ".ros-tutor" / "progress.json"
    assert progress.is_file()
    progress.unlink()
    os.mkfifo(progress)
    found = ran(*RUN, *workspace, "list")
    assert (found.returncode, "is kept as" in found.stderr) == (0, True), found.stderr
    os.mkfifo(tmp_path / "report")
    found = ran(*RUN, *workspace, "checklist", "export", "--format", "json", "--output", str(tmp_path / "report"))
    assert (found.returncode, "Traceback" in found.stderr) == (3, False), found.stderr


PRESSES_EARLY = """
import os, runpy, signal, sys

class Press:
    def find_spec(self, name, *_):
        if name == "tutor.cli":
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Press())
runpy.run_module("tutor", run_name="__main__")
"""


def test_ctrl_c_while_the_program_is_being_imported_is_not_a_traceback() -> None:
    found = ran(sys.executable, "-c", PRESSES_EARLY)
    assert (found.returncode, found.stdout, found.stderr) == (130, "", "")

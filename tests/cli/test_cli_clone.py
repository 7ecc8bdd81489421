"""A clone under the usual tools of a Python developer."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from tutor.ros.bytecode import _is_compiled

CLONE = Path(__file__).resolve().parents[2]


def test_a_plain_uv_sync_keeps_ros() -> None:
    """The ROS wheels are also recorded under second names, which look to uv like packages that nothing requires."""
    uv = next((path for path in (CLONE / ".uv-tool/bin/uv", shutil.which("uv")) if path and Path(path).exists()), None)
    if uv is None:
        pytest.skip("there is no uv")
    environ = {name: value for name, value in os.environ.items() if name not in ("VIRTUAL_ENV", "UV_PYTHON")}
    command = [uv, "sync", "--frozen", "--offline", "--dry-run"]
    result = subprocess.run(command, cwd=CLONE, env=environ, capture_output=True, text=True, timeout=60, check=False)
    assert result.returncode == 0, result.stderr
    removed = re.findall(r"^ - (\S+)==(\S+)", result.stderr, re.MULTILINE)
    records = {f"{name.replace('-', '_')}-{version}.dist-info" for name, version in removed}
    site_packages = Path(sysconfig.get_path("purelib"))
    assert records <= {each.name for each in site_packages.glob("*.dist-info")}, result.stderr


def test_our_modules_are_compiled_but_files_that_learners_get_a_copy_of_are_not() -> None:
    """Our programs write no bytecode, so without this every start would compile all of it again."""
    if Path(sys.prefix) != CLONE / ".venv":
        pytest.skip("this is not the clone's own environment")
    command = [str(CLONE / ".ci/uv"), "run", "--quiet", "--frozen", "--offline", "python", "-I", "-c", ""]
    subprocess.run(command, cwd=CLONE, check=True, timeout=60)
    modules = [*CLONE.glob("tutor/**/*.py"), *CLONE.glob("checks/**/*.py")]
    copied = [each for each in modules if {"template", "share"} & set(each.parts)]
    assert [each for each in modules if each not in copied and not _is_compiled(each)] == []
    assert copied
    assert [each for each in copied if _is_compiled(each)] == []


PROGRAMS = {"ros-tutor": ["ros-tutor", "list"], "run-tests": ["run-tests", "--version"]}


def run_without_space(program: str, script: str, **variables: str) -> subprocess.CompletedProcess[str]:
    """Run a program of the clone after a shell script that takes the space away, in a mount namespace of its own."""
    given = {name: value for name, value in os.environ.items() if not name.startswith(("UV_", "XDG_"))}
    name, *arguments = PROGRAMS[program]
    command = ["unshare", "-rm", "sh", "-c", f'{script}; exec "$@"', "sh", str(CLONE / name), *arguments]
    return subprocess.run(
        command, env={**given, **variables}, cwd="/", capture_output=True, text=True, timeout=60, check=False
    )


needs_own_mounts = pytest.mark.skipif(
    subprocess.run(["unshare", "-rm", "true"], capture_output=True, check=False).returncode != 0,
    reason="this machine allows no mount namespaces",
)


@needs_own_mounts
@pytest.mark.parametrize("program", PROGRAMS)
@pytest.mark.parametrize("temporary", ["/tmp", "HOME"])
def test_a_home_without_space_does_not_matter(program: str, temporary: str, tmp_path: Path) -> None:
    home = str(tmp_path)
    fill = f"mount -t tmpfs -o size=16k full {home} && ! head -c 99999 /dev/zero 2>/dev/null >{home}/file || exit 99"
    result = run_without_space(program, fill, HOME=home, TMPDIR=temporary.replace("HOME", home))
    assert result.returncode == 0, result.stderr
    assert "error" not in result.stderr


@needs_own_mounts
@pytest.mark.parametrize("program", PROGRAMS)
def test_without_space_anywhere_one_sentence_says_so(program: str, tmp_path: Path) -> None:
    result = run_without_space(program, "trap '' XFSZ; ulimit -f 0", HOME=str(tmp_path))
    assert result.returncode == 3, result.stderr
    (line,) = result.stderr.splitlines()
    assert line.startswith(f"ros-tutor: neither {tmp_path}/.cache/uv nor a temporary folder can be written")

"""The zip of `ros-tutor autograder gradescope`, run as Gradescope runs it."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.grade import container
from tests.grade.autograders import SOLUTION, WRONG, errors_in, make_archive, unzip

pytestmark = pytest.mark.timeout(900)  # on a busy machine: ros-tutor is installed, and runs whole checks

METADATA = {"users": [{"email": "ada@example.org", "name": "Ada"}], "assignment": {"due_date": None}}

SNOOPS = """
import os, sys

PRIVATE = ["/autograder/submission_metadata.json", f"/proc/{os.getppid()}/environ"]
OTHERS = ["/autograder/results/results.json", "/autograder/run_autograder", "/autograder/source/settings.json"]
for paths, mode in ((PRIVATE, "r"), (OTHERS, "a")):
    for path in paths:
        try:
            open(path, mode).close()
        except OSError:
            continue
        sys.exit(f"{path} can be opened with {mode}")
"""
"""A submission that passes unless it can read or write what it should not."""


def lay_out(archive: Path, folder: Path) -> Path:
    """Lay out an /autograder as Gradescope does before setup.sh."""
    unzip(archive, folder / "source")
    shutil.copy(folder / "source" / "run_autograder", folder / "run_autograder")
    for name in ("submission", "results"):
        (folder / name).mkdir()
    (folder / "submission_metadata.json").touch()
    folder.chmod(0o755)
    return folder


COMPILE = """
import ros_tutor, sys
sys.path[:0] = ros_tutor.__path__
from tutor.ros.bytecode import compile_ros_modules
from tutor.ros.environment import detect
compile_ros_modules(detect())
"""


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_archive(tmp_path_factory.mktemp("made") / "autograder.zip")


@pytest.fixture(scope="module")
def image(archive: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """The /autograder of an image that Gradescope has built of the zip."""
    if not container.is_possible():
        pytest.skip("this machine allows no containers (bubblewrap)")
    folder = lay_out(archive, tmp_path_factory.mktemp("image"))
    set_up = ["bash", str(container.ROOT / "source" / "setup.sh")]
    for offline in ("1", "0"):  # from uv's cache, if everything is in there
        env = {"UV_OFFLINE": offline, "UV_COMPILE_BYTECODE": "0"}  # which alone would take 15 s of CPU
        done = container.run(folder, set_up, network=True, env=env)
        if done.returncode == 0:
            break
    else:
        if re.search("dns error|failed to fetch|connect", done.stderr, re.IGNORECASE):
            pytest.skip("this machine has no package index")
        pytest.fail(done.stdout + done.stderr)
    compiled = container.run(folder, [str(container.ROOT / "ros-tutor/venv/bin/python"), "-I", "-c", COMPILE])
    assert compiled.returncode == 0, compiled.stderr
    yield folder
    shutil.rmtree(folder)  # 250 MB


def grade(image: Path, submission: Path, folder: Path) -> tuple[subprocess.CompletedProcess[str], dict[str, Any]]:
    """Run a container of the image for a submission, as Gradescope's harness does; return the results too."""
    (folder / "results").mkdir()
    (folder / "metadata.json").write_text(json.dumps(METADATA))
    shutil.copytree(submission, folder / "submission")
    more = {
        container.ROOT / "submission": folder / "submission",
        container.ROOT / "results": folder / "results",
        container.ROOT / "submission_metadata.json": folder / "metadata.json",
    }
    ran = container.run(image, ["/autograder/run_autograder"], more=more)
    assert [path.name for path in (folder / "results").iterdir()] == ["results.json"], ran.stderr
    return ran, json.loads((folder / "results" / "results.json").read_text())


def test_right(image: Path, tmp_path: Path) -> None:
    """All points, although the submission looks for what it could change."""
    submission = tmp_path / "handed-in"
    shutil.copytree(SOLUTION, submission)
    file = submission / "temperature_publisher.py"
    if container.IS_ROOT:
        shebang, rest = file.read_text().split("\n", 1)
        docstring, rest = rest.split("\n", 1)
        file.write_text("\n".join([shebang, docstring, SNOOPS, rest]))
    ran, results = grade(image, submission, tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert (results["score"], {test["status"] for test in results["tests"]}) == (10, {"passed"}), results["output"]
    assert sum(test.get("max_score", 0) for test in results["tests"]) == pytest.approx(10, abs=0.05)
    assert "isolated by nothing but this machine" in ran.stderr


def test_wrong(image: Path, tmp_path: Path) -> None:
    """Partial credit, and exit code 0: a learner's failure is not the autograder's."""
    ran, results = grade(image, WRONG, tmp_path)
    assert ran.returncode == 0, ran.stderr
    failed = [test for test in results["tests"] if test["status"] == "failed"]
    assert [test["name"].split(":")[0] for test in failed] == ["i1.1 rate"], results["output"]
    assert 8 < results["score"] < 9
    assert "next step" in failed[0]["output"]


def test_empty(image: Path, tmp_path: Path) -> None:
    (tmp_path / "nothing").mkdir()
    ran, results = grade(image, tmp_path / "nothing", tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert results["score"] == 0
    assert {test["status"] for test in results["tests"]} == {"failed"}
    assert "nothing was handed in" in results["output"]


def test_an_autograder_error_where_ros_tutor_is_missing(archive: Path, tmp_path: Path) -> None:
    if not container.is_possible():
        pytest.skip("this machine allows no containers (bubblewrap)")
    image = lay_out(archive, tmp_path / "image")
    ran, results = grade(image, SOLUTION, tmp_path)
    assert ran.returncode == 0, ran.stderr
    assert errors_in(results)
    assert "nothing was judged" in ran.stdout

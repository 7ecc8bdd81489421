"""The script of `ros-tutor autograder classroom50`, run as Classroom 50 runs it."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from tests.grade import container
from tests.grade.autograders import CLASSROOM, OWN_COURSE, POINTS, make

pytestmark = pytest.mark.timeout(900)  # on a busy machine: each of these installs ros-tutor

PRIVATE = {"GITHUB_TOKEN": "secret", "GITHUB_OUTPUT": "/dev/null", "SECRET": "secret"}
WRONG_GREETER = 'raise SystemExit("not today")\n'
READS_ENVIRONMENT = f"import os, sys\n\nif found := {set(PRIVATE)} & set(os.environ):\n    sys.exit(str(found))\n"


def pythons() -> list[str]:
    """The oldest and the newest Python of pyenv that the script must work with, or else our own."""
    found = []
    for python in Path.home().glob(".pyenv/versions/3.*/bin/python3"):
        minor = int(python.parts[-3].split(".")[1])
        if minor >= 9:
            found.append((minor, str(python)))
    ordered = [python for _, python in sorted(found)] or [sys.executable]
    return [ordered[0], ordered[-1]]


@pytest.fixture(scope="module")
def script(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("bundle")
    (folder / "points.toml").write_text(POINTS)
    words = ("--exercise", "h1.1", "--points", folder / "points.toml", "--lessons", OWN_COURSE)
    made = make("classroom50", folder / "autograder.py", *words)
    assert made.returncode == 0, made.stderr
    return folder / "autograder.py"


def check_out(folder: Path, files: Mapping[str, str]) -> Path:
    """Return a git checkout as a submission is one, with settings of a learner's for uv that lead nowhere."""
    repository = folder / "checkout"
    repository.mkdir()
    index = '[[index]]\nurl = "http://127.0.0.1:9/simple"\ndefault = true\n'
    for name, text in {**files, ".classroom50.yaml": "classroom: cs\n", "uv.toml": index}.items():
        path = repository / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    (folder / "elsewhere").write_text("mine")
    (repository / "result.json").symlink_to(folder / "elsewhere")
    git = ["git", "-C", str(repository), "-c", "user.name=ada", "-c", "user.email=ada@example.org"]
    for words in (["init", "-q"], ["add", "-A"], ["commit", "-q", "-m", "my work"]):
        subprocess.run([*git, *words], check=True)
    return repository


def run_script(script: Path, python: str, repository: Path) -> subprocess.CompletedProcess[str]:
    """Run the script as Classroom 50's runner does."""
    temporary = repository.parent / "temporary"
    temporary.mkdir(exist_ok=True)
    env = {name: os.environ[name] for name in ("HOME", "LANG", "UV_CACHE_DIR") if name in os.environ}
    path = f"{container.UV}:{os.environ['PATH']}:{sys.base_prefix}/bin"
    env |= {**CLASSROOM, **PRIVATE, "RUNNER_TEMP": str(temporary), "PATH": path}
    for offline in ("1", "0"):
        ran = subprocess.run(
            [python, str(script)],
            cwd=repository,
            env={**env, "UV_OFFLINE": offline},
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )
        if "cannot be installed" not in ran.stderr:
            break
    else:
        pytest.skip("this machine has no package index")
    assert list(temporary.iterdir()) == []
    return ran


def read_result(repository: Path) -> dict[str, Any]:
    """Read result.json, and check what Classroom 50's own runner checks before it publishes it."""
    result: dict[str, Any] = json.loads((repository / "result.json").read_text())
    assert not (repository / "result.json").is_symlink()
    assert (repository.parent / "elsewhere").read_text() == "mine"
    assert result["schema"] == "classroom50/result/v1"
    keys = ("classroom", "assignment", "assignment_type", "owner", "submission", "commit", "release", "review")
    named = {"submission": "SUBMISSION_TAG", "commit": "COMMIT_URL", "release": "RELEASE_URL", "review": "REVIEW_URL"}
    assert {key: result[key] for key in keys} == {key: CLASSROOM[named.get(key, key.upper())] for key in keys}
    for scored in (result, *result["tests"]):
        assert type(scored["score"]) is type(scored["max-score"]) is int
        assert 0 <= scored["score"] <= scored["max-score"]
    assert all(test["test-name"] and isinstance(test["passed"], bool) for test in result["tests"])
    return result


def test_right_with_the_oldest_python(script: Path, tmp_path: Path) -> None:
    """All points, in the learner's own workspace, without what belongs to the runner in the environment."""
    solution = (OWN_COURSE / "lessons/h1_1/solution/greeter.py").read_text()
    repository = check_out(
        tmp_path, {"workspace/h1_1/greeter.py": solution.replace("\n\n", f"\n\n{READS_ENVIRONMENT}", 1)}
    )
    ran = run_script(script, pythons()[0], repository)
    assert ran.returncode == 0, ran.stderr
    result = read_result(repository)
    assert (result["score"], result["max-score"]) == (4, 4), result
    body = (repository / "release-body.md").read_text()
    assert body.startswith("**4 of 4 points**\n\n# ros-tutor: passed\n")


def test_wrong_with_the_newest_python(script: Path, tmp_path: Path) -> None:
    repository = check_out(tmp_path, {"greeter.py": WRONG_GREETER})
    ran = run_script(script, pythons()[-1], repository)
    assert ran.returncode == 0, ran.stderr
    result = read_result(repository)
    assert (result["score"], result["max-score"]) == (0, 4), result
    assert [(test["test-name"], test["passed"]) for test in result["tests"]] == [("h1.1 greets", False)]
    body = (repository / "release-body.md").read_text()
    assert body.startswith("**0 of 4 points**\n\n# ros-tutor: failed\n")
    assert "next step" in body


def test_empty(script: Path, tmp_path: Path) -> None:
    repository = check_out(tmp_path, {"README.md": "# my work\n"})
    ran = run_script(script, pythons()[-1], repository)
    assert ran.returncode == 0, ran.stderr
    result = read_result(repository)
    assert (result["score"], result["max-score"]) == (0, 4), result
    assert "there is no greeter.py" in (repository / "release-body.md").read_text()

"""Autograders as `ros-tutor autograder` makes them, and what they judge in tests."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

CLONE = Path(__file__).resolve().parents[2]
SOLUTION = CLONE / "lessons" / "i1_1" / "solution"
WRONG = CLONE / "tests" / "submissions" / "i1_1" / "wrong" / "rate-as-period"
OWN_COURSE = CLONE / "tests" / "courses" / "greeting"
POINTS = '["h1.1"]\npoints = 4\n'

CLASSROOM = {
    "CLASSROOM": "cs-principles",
    "ASSIGNMENT": "hello",
    "ASSIGNMENT_TYPE": "individual",
    "SUBMISSION_TAG": "submit/2026-11-21T18-03-04Z-a1b2c3d",
    "COMMIT_URL": "https://github.com/cs/cs-principles-hello-ada/commit/a1b2c3d",
    "RELEASE_URL": "https://github.com/cs/cs-principles-hello-ada/releases/tag/submit%2F2026-11-21T18-03-04Z-a1b2c3d",
    "REVIEW_URL": "https://github.com/cs/cs-principles-hello-ada/compare/0000000...a1b2c3d",
    "USERNAME": "ada",
    "OWNER": "ada",
}


def make(system: str, output: Path, *words: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-I", "-B", "-m", "tutor", "autograder", system, "--output", output, *words]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)


def make_archive(path: Path) -> Path:
    """Make the zip for Gradescope that judges i1.1."""
    made = make("gradescope", path, "--exercise", "i1.1")
    assert made.returncode == 0, made.stderr
    return path


def unzip(archive: Path, folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run(["unzip", "-q", archive, "-d", folder], check=True)  # zipfile would drop the executable bits


def errors_in(results: Mapping[str, Any]) -> bool:
    """Whether the results say that the autograder failed, and show a learner no total."""
    visible, hidden = results["tests"]
    assert (visible["name"], visible["status"], visible["visibility"]) == ("Autograder error", "failed", "visible")
    return bool(results["score"] == 0 and hidden["visibility"] == "hidden")

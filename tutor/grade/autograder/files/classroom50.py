"""Judges the submission in the current folder with ros-tutor, as Classroom 50 runs it. Made by `ros-tutor autograder`.

It belongs in CLASSROOM/autograders/ASSIGNMENT/autograder.py, works with Python 3.9 and later, and needs a network: uv,
CPython and ROS 2 are fetched where they are missing. It writes result.json and release-body.md. Exit code 0: the
submission was judged, whatever the verdict; else something kept ros-tutor from it, and the last lines printed say what.
"""

from __future__ import annotations

import base64
import io
import json
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile

BUNDLE = ""

# What the judging process is given: a submission must not find a token in its environment.
PASSED_ON = (
    *("PATH", "HOME", "LANG", "LC_ALL", "TZ", "TMPDIR"),
    *("CLASSROOM", "ASSIGNMENT", "ASSIGNMENT_TYPE", "SUBMISSION_TAG"),
    *("COMMIT_URL", "RELEASE_URL", "REVIEW_URL", "USERNAME", "OWNER"),
)


def main() -> int:
    """Install ros-tutor, judge, and write the result."""
    work = tempfile.mkdtemp(prefix="ros-tutor-", dir=os.environ.get("RUNNER_TEMP") or None)
    try:
        return judge(os.path.join(work, "bundle"), os.path.join(work, "home"))
    finally:
        shutil.rmtree(work, ignore_errors=True)


def judge(bundle: str, home: str) -> int:
    """Judge the current folder; return the exit code."""
    with zipfile.ZipFile(io.BytesIO(base64.b64decode(BUNDLE))) as archive:
        archive.extractall(bundle)
    installed = subprocess.run([sys.executable, "-I", os.path.join(bundle, "install.py"), home], cwd=bundle)
    if installed.returncode != 0:
        return 3
    python = os.path.join(home, "venv", "bin", "python")
    command = [python, "-I", "-B", "-X", "utf8", "-m", "ros_tutor.tutor.run_module"]
    command += ["tutor.grade.autograder", "classroom50"]
    command += ["--bundle", bundle, "--submission", os.getcwd()]
    env = {name: os.environ[name] for name in PASSED_ON if name in os.environ}
    judged = subprocess.run(command, cwd=bundle, env=env, stdout=subprocess.PIPE)
    if judged.returncode != 0:
        return 3
    for name, text in json.loads(judged.stdout).items():
        if os.path.lexists(name):  # a link of the learner's, for example
            os.remove(name)
        with open(name, "w", encoding="utf-8") as file:
            file.write(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())

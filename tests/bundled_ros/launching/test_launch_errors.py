"""Which part of an error's traceback is shown: the learner's own."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from tutor.bundled_ros.ros2 import starting
from tutor.ros.environment import detect, learner_env

pytestmark = pytest.mark.process


@pytest.mark.parametrize(
    ("body", "own"),
    [
        ("pass", ()),
        ("return launch.LaunchDescription([None.x])", ("_launch.py", "None.x")),
    ],
)
def test_only_the_learners_frames_are_shown(tmp_path: Path, body: str, own: tuple[str, ...]) -> None:
    """None of them is the file that runs our modules."""
    file = tmp_path / "my_launch.py"
    file.write_text(f"import launch\ndef generate_launch_description():\n    {body}\n")
    ros = detect()
    env = learner_env(ros, domain_id=0, log_dir=tmp_path, package_root=None, isolated=True, environ=os.environ)
    command = [*starting.ros2_command(ros, env), "launch", str(file)]
    done = subprocess.run(command, env=env, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
    shown = [line.strip() for line in (done.stdout + done.stderr).splitlines()]
    assert done.returncode == 1
    assert any("Caught exception in launch" in line for line in shown)
    frames = [line for line in shown if line.startswith("File ")]
    assert len(frames) == bool(own)
    assert all(word in "\n".join(shown) for word in own)
    assert "run_module" not in "\n".join(shown)

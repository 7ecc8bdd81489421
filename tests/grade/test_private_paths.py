"""A learner is not told where on the teacher's machine the submission was judged."""

from __future__ import annotations

import os
import sys
import tempfile
from dataclasses import replace

import pytest

from tests.grade import made
from tutor.grade.private_paths import clean, without_private_paths
from tutor.report import json_report

FOLDER = "/tmp/ros-tutor-1000/grade.a1b2_3cd/submission"


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        (f'File "{FOLDER}/node.py", line 3, in <module>', 'File "node.py", line 3, in <module>'),
        (f"{FOLDER}/my_pkg/node.py:7: {FOLDER}/helper.py", "my_pkg/node.py:7: helper.py"),
        (f"[Errno 13] Permission denied: '{FOLDER}'", "[Errno 13] Permission denied: '.'"),
        ("/scratch/job 7/x", "/scratch/job 7/x"),
        ("/scratch/slurm-7/ros-tutor-12-ab/grade.x_y/submission/node.py", "node.py"),
        (f"{tempfile.gettempdir()}/ros-tutor-0/grade.ab/submission/a.py", "a.py"),
        ("log files are below /tmp/ros-tutor-0/check.k3/2026-11-28-vm-31371", "log files are below …"),
        (
            "from 'rclpy.parameter' (/home/t/.venv/lib/python3.12/site-packages/rclpy/parameter.py)",
            "from 'rclpy.parameter' (…/site-packages/rclpy/parameter.py)",
        ),
        ('File "/usr/lib/python3.12/threading.py", line 9', 'File "…/python3.12/threading.py", line 9'),
        ("/chatter and /sensor/temperature: 3/4 of 10 m/s", "/chatter and /sensor/temperature: 3/4 of 10 m/s"),
        ("subprocess.run(['/usr/bin/python3'])", "subprocess.run(['/usr/bin/python3'])"),
        ("no path at all", "no path at all"),
    ],
)
def test_paths_in_texts(text: str, shown: str) -> None:
    assert without_private_paths(text) == shown


def test_the_home_and_the_installation_of_whoever_grades() -> None:
    home = os.path.expanduser("~")
    assert without_private_paths(f"cannot open {home}/data.csv") == "cannot open ~/data.csv"
    assert without_private_paths(f"{home}-other/data.csv") == f"{home}-other/data.csv"
    assert sys.prefix not in without_private_paths(f"{sys.prefix}/bin/ros2: not found")


def test_a_whole_report_is_cleaned_and_otherwise_as_it_was() -> None:
    path = f"{FOLDER}/temperature_publisher.py"
    verdict = replace(made.RATE, observed=f"from {path}", cause=f"it is in {path}", evidence=(f'File "{path}"',))
    report = made.failing(made.ADA, verdict=verdict).report
    cleaned = clean(report)
    assert "ros-tutor-1000" not in json_report.render(cleaned)
    assert "it is in temperature_publisher.py" in json_report.render(cleaned)
    assert clean(cleaned) == cleaned
    plain = made.failing(made.ADA).report
    assert clean(plain) == plain

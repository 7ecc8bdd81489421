"""Message types are found by name."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from tutor.ros.environment import detect, learner_env

CODE = """
import sys
from tutor.ros.interfaces import interface_class
from tutor.errors import UnknownType
for name in ("this.msg/msg/X", "this/msg/X", "antigravity/msg/X", "os/path/join", "../msg/X", "std_msgs/msg/X"):
    try:
        interface_class(name)
    except UnknownType:
        print(name)
print("this" in sys.modules, "antigravity" in sys.modules, interface_class("std_msgs/msg/Float64").__name__)
"""


def test_a_package_without_interfaces_is_unknown_and_not_imported() -> None:
    ran = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=True)
    assert ran.stdout.splitlines() == [
        "this.msg/msg/X",
        "this/msg/X",
        "antigravity/msg/X",
        "os/path/join",
        "../msg/X",
        "std_msgs/msg/X",
        "False False Float64",
    ]


FEEDBACK = """
from tutor.ros.interfaces import interface_class
print(*interface_class("example_interfaces/action/Fibonacci_FeedbackMessage").__slots__[:2])
"""


def test_the_feedback_of_an_action_has_a_type(tmp_path: Path) -> None:
    env = learner_env(detect(), domain_id=0, log_dir=tmp_path, package_root=None, isolated=False)
    ran = subprocess.run([sys.executable, "-c", FEEDBACK], env=env, capture_output=True, text=True, check=False)
    assert ran.stdout.splitlines() == ["_goal_id _feedback"], ran.stderr

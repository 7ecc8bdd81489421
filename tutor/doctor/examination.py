"""Runs all examinations in parallel."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from tutor.doctor import isolation, machine, ros2, terminal
from tutor.doctor.finding import Finding
from tutor.ros.environment import detect

Examination = Callable[[], Finding]


def examine(workspace: Path | None, environ: Mapping[str, str] = os.environ) -> tuple[Finding, ...]:
    """Examine this machine and return the findings in display order. Takes a few seconds.

    `workspace` is where the learner's files are or will be; None skips its examinations. Changes nothing, except that a
    workspace without a ROS domain gets one, and leaves no process behind.
    """
    ros = detect(environ)
    examinations: list[tuple[str, Examination]] = [
        ("Python", machine.python_version),
        ("ROS 2", lambda: ros2.which_ros(ros)),
        ("ROS variables", lambda: ros2.variables(ros)),
        ("ROS packages", lambda: ros2.wheels(ros)),
        ("Shared memory", machine.shared_memory_room),
        ("rclpy", lambda: ros2.rclpy_import(ros, environ)),
        ("example_interfaces", lambda: ros2.example_interfaces(ros, environ)),
        ("Loopback network", machine.loopback),
        ("Loopback multicast", machine.loopback_multicast),
        ("Discovery", lambda: ros2.discovery(ros, environ)),
        ("Isolation", isolation.support),
        ("Temporary files", machine.temporary_files),
        ("Terminal", lambda: terminal.capabilities(environ)),
    ]
    if workspace is not None:
        examinations[-1:-1] = [
            ("Workspace", lambda: machine.workspace(workspace)),
            ("ROS domain", lambda: ros2.own_domain(workspace, environ)),
        ]
    with ThreadPoolExecutor(len(examinations)) as pool:
        return tuple(pool.map(lambda examination: _run_guarded(*examination), examinations))


def _run_guarded(name: str, examination: Examination) -> Finding:
    try:
        return examination()
    except Exception as error:  # contain the failure: the other findings must still be reported
        text = f"This could not be examined: {type(error).__name__}: {error}"
        return Finding(name, False, text, "This is a fault of ros-tutor itself: please report it, with this line.")

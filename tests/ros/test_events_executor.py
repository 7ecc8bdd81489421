"""The bundled rclpy's experimental EventsExecutor runs callbacks, as the real one does."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tutor.ros.bundled_interfaces import startup_folder
from tutor.ros.environment import RosEnvironment, detect, learner_env

LIMIT_S = 30.0

TICKS_TWICE = """
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.experimental import EventsExecutor

rclpy.init()
node = rclpy.create_node("ticker")
executor = EventsExecutor()
future = rclpy.Future()
executor.add_node(node)
ticks = []

def tick():
    ticks.append(1)
    print("tick", flush=True)
    if len(ticks) == 2:
        {last}

node.create_timer(0.05, tick)
try:
    {spin}
except ExternalShutdownException:
    pass
"""


@pytest.mark.parametrize(
    ("spin", "last"),
    [
        ("executor.spin()", "rclpy.shutdown()"),
        ("rclpy.spin(node, executor=executor)", "rclpy.shutdown()"),
        ("executor.spin_until_future_complete(future)", "future.set_result(None)"),
        ("while len(ticks) < 2: executor.spin_once_until_future_complete(future)", "pass"),
    ],
)
def test_a_wait_without_a_limit_runs_callbacks(tmp_path: Path, spin: str, last: str) -> None:
    assert run(tmp_path, TICKS_TWICE.format(spin=spin, last=last), isolated=True) == "tick\ntick\n"


def test_a_run_outside_checks_has_it_too(tmp_path: Path) -> None:
    program = TICKS_TWICE.format(spin="executor.spin()", last="rclpy.shutdown()")
    assert run(tmp_path, program, isolated=False) == "tick\ntick\n"


def test_the_users_own_sitecustomize_still_runs(tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text("print('mine')")
    assert run(tmp_path, "import sitecustomize", isolated=True, PYTHONPATH=str(tmp_path)) == "mine\n"


def test_a_sourced_ros_is_left_as_it_is(tmp_path: Path) -> None:
    ros = RosEnvironment("system", "jazzy", Path(sys.executable), "rmw_fastrtps_cpp")
    environ = {"PYTHONPATH": f"{startup_folder()}:/opt/ros/jazzy/lib/python3.12/site-packages"}
    env = learner_env(ros, domain_id=1, log_dir=tmp_path, package_root=None, isolated=True, environ=environ)
    assert str(startup_folder()) not in env["PYTHONPATH"]


def run(folder: Path, program: str, *, isolated: bool, **variables: str) -> str:
    ros = detect({})
    env = learner_env(
        ros,
        domain_id=71,
        log_dir=folder,
        package_root=None,
        isolated=isolated,
        environ={**os.environ, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST", **variables},
    )
    done = subprocess.run([ros.python, "-c", program], env=env, capture_output=True, text=True, timeout=LIMIT_S)
    assert done.returncode == 0, done.stderr
    return done.stdout

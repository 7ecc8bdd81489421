"""The number of DDS participants on this machine is known in every environment that we create."""

from __future__ import annotations

import subprocess
import sys
from contextlib import AbstractContextManager
from pathlib import Path

import pytest

from tests.ros.ordinary_domain import ordinary_domain
from tutor.ros.domain import reserve_domain
from tutor.ros.environment import detect, learner_env

COUNT = """
import os, rclpy
from tutor.ros.domain import participants_here
domain = int(os.environ["ROS_DOMAIN_ID"])
contexts = [rclpy.Context() for _ in range(3)]
nodes, counts = [], []
for context in contexts:
    rclpy.init(context=context)
    nodes.append(rclpy.create_node("one", context=context))
    counts.append(participants_here(domain))
for context in contexts:
    context.try_shutdown()
print(counts)
"""


def count_participants(folder: Path, domain: AbstractContextManager[int], *, isolated: bool, **variables: str) -> str:
    with domain as domain_id:
        env = learner_env(detect(), domain_id=domain_id, log_dir=folder, package_root=None, isolated=isolated)
        ran = subprocess.run(
            [sys.executable, "-c", COUNT],
            env={**env, **variables},
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
        )
    assert ran.returncode == 0, ran.stderr
    return ran.stdout.strip()


@pytest.mark.parametrize("isolated", [False, True], ids=["a learner's terminal", "a check"])
def test_participants_are_counted(tmp_path: Path, *, isolated: bool) -> None:
    domain = reserve_domain() if isolated else ordinary_domain()
    assert count_participants(tmp_path, domain, isolated=isolated) == "[1, 2, 3]"


def test_with_a_users_own_profile_the_count_is_unknown(tmp_path: Path) -> None:
    own = tmp_path / "own.xml"
    own.write_text("<dds/>")
    variables = {"FASTRTPS_DEFAULT_PROFILES_FILE": str(own), "FASTDDS_DEFAULT_PROFILES_FILE": str(own)}
    assert count_participants(tmp_path, ordinary_domain(), isolated=False, **variables) == "[None, None, None]"

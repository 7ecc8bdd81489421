"""What a user has: ros-tutor as a program, an environment of their own, and an ordinary ROS domain."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

from tests.ros.ordinary_domain import ordinary_domain
from tests.ros2cli.bench import Bench
from tutor.ros.discovery import PROFILE

TUTOR = [sys.executable, "-P", "-c", "import sys; from tutor.cli import main; sys.exit(main())"]


@contextmanager
def on_an_ordinary_domain(bench: Bench) -> Iterator[Bench]:
    """Yield the bench on an ordinary ROS domain, such as users have.

    A DDS profile of the user's keeps the traffic within the tests.
    """
    profile = bench.folder / "profile.xml"
    profile.write_bytes(PROFILE.read_bytes())
    own_profile = {name: str(profile) for name, value in bench.env.items() if value == str(PROFILE)}
    with ordinary_domain() as domain:
        yield replace(bench, env={**bench.env, **own_profile, "ROS_DOMAIN_ID": str(domain)})


def user_env(bench: Bench, **more: str) -> dict[str, str]:
    """The environment of a user's terminal, on the bench's domain."""
    names = ("PATH", "LANG", "ROS_DOMAIN_ID", "HOME", "TMPDIR")
    kept = {name: bench.env[name] for name in names if name in bench.env}
    discovery = {
        name: value
        for name, value in bench.env.items()
        if name.startswith(("FAST", "ROS_AUTOMATIC", "ROS_TUTOR_GROUP"))
    }
    return {**kept, **discovery, "SHELL": shutil.which("bash") or "", "TERM": "dumb", **more}

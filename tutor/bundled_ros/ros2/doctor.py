"""A short `ros2 doctor`; `ros-tutor doctor` checks this machine in more depth."""

from __future__ import annotations

import argparse
import os
import platform
import sys
from collections.abc import Callable, Iterator
from importlib.metadata import PackageNotFoundError, version

from tutor.bundled_ros.ros2.domain import Domain, join_domain
from tutor.bundled_ros.ros2.parsing import Verb, flag
from tutor.errors import CommandError
from tutor.ros_model import is_standard_topic


def _doctor(arguments: argparse.Namespace) -> int:
    """Print the problems and how many checks passed. Return 1 if one failed, 2 for an unsupported option."""
    if arguments.report_failed:
        print("ros2 doctor: --report-failed is not supported here; use --report", file=sys.stderr)
        return 2
    if arguments.report:
        for title, facts in _report():
            print(f"\n   {title}")
            for name, value in facts:
                print(f"{name:<20}: {value}")
        return 0
    failed: list[str] = []
    for name, check in _CHECKS.items():
        wrong = False
        for warning in check():
            print(f"UserWarning: {warning}")
            wrong = wrong or arguments.include_warnings
        if wrong:
            failed.append(name)
    if failed:
        print(f"\n{len(failed)}/{len(_CHECKS)} check(s) failed\n\nFailed modules: {' '.join(failed)}")
        return 1
    print(f"\nAll {len(_CHECKS)} checks passed\n")
    return 0


def _report() -> Iterator[tuple[str, list[tuple[str, str]]]]:
    yield (
        "PLATFORM INFORMATION",
        [
            ("system", platform.system()),
            ("platform info", platform.platform()),
            ("release", platform.release()),
            ("processor", platform.machine()),
        ],
    )
    yield "ROS 2 INFORMATION", [("distribution name", _distribution()), ("rclpy", _rclpy_version())]
    yield "RMW MIDDLEWARE", [("middleware name", _middleware())]
    with join_domain(argparse.Namespace()) as domain:
        domain.wait_for_discovery()
        yield (
            "TOPIC LIST",
            [
                (name, f"{', '.join(types)}, {publishers} publishers, {subscribers} subscribers")
                for name, types, publishers, subscribers in _topics(domain)
            ],
        )


def _distribution() -> str:
    return os.environ.get("ROS_DISTRO") or "jazzy"


def _rclpy_version() -> str:
    try:
        return version("ros-rclpy")
    except PackageNotFoundError:
        return "unknown"


def _middleware() -> str:
    from rclpy.utilities import get_rmw_implementation_identifier

    return str(get_rmw_implementation_identifier())


def _topics(domain: Domain) -> list[tuple[str, list[str], int, int]]:
    """Return (name, types, publisher count, subscription count) of each topic that is not one of ROS's own."""
    return [
        (name, types, domain.node.count_publishers(name), domain.node.count_subscribers(name))
        for name, types in domain.node.get_topic_names_and_types()
        if not is_standard_topic(name)
    ]


def _check_network() -> Iterator[str]:
    text = os.environ.get("ROS_DOMAIN_ID", "0") or "0"
    if not text.isdecimal() or int(text) > 232:
        yield f"ROS_DOMAIN_ID is {text}: it must be a number from 0 to 232"


def _check_middleware() -> Iterator[str]:
    try:
        with join_domain(argparse.Namespace()):
            pass
    except (CommandError, RuntimeError) as error:
        yield f"no node can be made: {error}"


def _check_topics() -> Iterator[str]:
    with join_domain(argparse.Namespace()) as domain:
        domain.wait_for_discovery()
        for name, _, publishers, subscribers in _topics(domain):
            if not subscribers:
                yield f"Publisher without subscriber detected on {name}."
            elif not publishers:
                yield f"Subscriber without publisher detected on {name}."


_CHECKS: dict[str, Callable[[], Iterator[str]]] = {
    "network": _check_network,
    "middleware": _check_middleware,
    "topic": _check_topics,
}

_VERB = Verb(
    _doctor,
    flag("--report", "-r", help="what is here, without judging it"),
    flag("--include-warnings", "-iw", help="warnings count as failures"),
    flag("--report-failed", "-rf", help="not supported here"),
)
GRAMMAR = {"doctor": _VERB, "wtf": _VERB}

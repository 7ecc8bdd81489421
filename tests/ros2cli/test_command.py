"""The command-line grammar of ros2, and its exit codes."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.ros2cli import bench as bench_module
from tests.ros2cli.bench import Bench
from tutor.bundled_ros.ros2.command import build_parser
from tutor.bundled_ros.ros2.parsing import LazyParser

USAGE = """\
usage: ros2 [-h] [--use-python-default-buffering]
            Call `ros2 <command> -h` for more detailed usage. ...
"""
TOPIC_USAGE = """\
usage: ros2 topic [-h] [--include-hidden-topics]
                  Call `ros2 topic <command> -h` for more detailed usage. ...
"""


@pytest.fixture
def bench(tmp_path: Path) -> Iterator[Bench]:
    """A bench that starts each command as a new process, as a shell does."""
    with bench_module.bench(tmp_path) as provided:
        yield provided


@pytest.mark.parametrize("words", [[], ["topic"], ["topic", "-h"], ["topic", "list", "--help"]])
def test_help_is_on_stdout(bench: Bench, words: list[str]) -> None:
    ran = bench.ros2(*words)
    assert ran.stdout.startswith("usage: ros2 ")
    assert (ran.stderr, ran.code) == ("", 0)


def test_wrong_words_are_reported_as_by_ros2cli(bench: Bench) -> None:
    wrong_command, wrong_verb = bench.ros2("topik", "list"), bench.ros2("topic", "frobnicate")
    assert (wrong_command.code, wrong_verb.code) == (2, 2)
    assert wrong_command.stderr.startswith(
        f"{USAGE}ros2: error: argument Call `ros2 <command> -h` for more detailed usage.: invalid choice: 'topik' "
    )
    assert wrong_verb.stderr.startswith(
        f"{TOPIC_USAGE}ros2 topic: error: argument Call `ros2 topic <command> -h` for more detailed usage.: "
        "invalid choice: 'frobnicate' (choose from "
    )
    unknown_option = bench.ros2("topic", "list", "--bogus")
    assert (unknown_option.stderr, unknown_option.code) == (f"{USAGE}ros2: error: unrecognized arguments: --bogus\n", 2)


@pytest.mark.parametrize("command", ["bag", "component", "test", "extensions"])
def test_a_command_that_only_an_installed_ros2_has_says_so_in_one_line(bench: Bench, command: str) -> None:
    ran = bench.ros2(command, "--help")
    assert (ran.stdout, ran.code, ran.stderr.count("\n")) == ("", 2, 1)
    assert ran.stderr.startswith(f"ros2: `ros2 {command}` needs an installed ROS 2; ")


def test_every_command_and_verb_has_a_help_text_without_importing_rclpy() -> None:
    def programs(parser: LazyParser) -> Iterator[str]:
        parser.fill()
        assert parser.format_help().startswith(f"usage: {parser.prog} [-h]")
        assert parser.description
        yield parser.prog
        for action in parser._actions:
            for below in action.choices.values() if isinstance(action, argparse._SubParsersAction) else ():
                yield from programs(below)

    loaded = set(sys.modules)  # by a test of the engine in the same process, maybe rclpy as well
    found = set(programs(build_parser()))
    assert {"ros2 run", "ros2 topic", "ros2 topic hz", "ros2 param set", "ros2 pkg create", "ros2 wtf"} <= found
    assert "rclpy" not in set(sys.modules) - loaded


def test_wtf_is_doctor(bench: Bench) -> None:
    assert bench.ros2("wtf", "--report") == bench.ros2("doctor", "--report")


def test_there_is_no_daemon(bench: Bench) -> None:
    assert bench.ros2("daemon", "status").stdout == "The daemon is not running\n"

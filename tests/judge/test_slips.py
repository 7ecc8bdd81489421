"""Slips that raise nothing: how the learner's source reveals them, and the step."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.checks.builders import trace
from tutor.judge.causes import slips
from tutor.judge.rewriting.node import node_file
from tutor.judge.trace import Trace


def node(text: str) -> Trace:
    return replace(trace(), sources={"node.py": text})


@pytest.mark.parametrize(
    ("text", "step"),
    [
        ("self.on = str(p.value) == 'true'", "line 1 becomes: self.on = p.value"),
        ("\nif p.value == 'True':\n  pass", "line 2 becomes: if p.value:"),
        ("self.on = p.value != 'false'", "becomes: self.on = p.value"),
        ("self.on = 'false' == p.value", "becomes: self.on = not p.value"),
    ],
)
def test_a_boolean_compared_with_text(text: str, step: str) -> None:
    assert step in (slips.fix_bool_compared_with_text(node(text)) or "")


@pytest.mark.parametrize(
    "text", ["x = str(p.value).lower() == 'true'", "if p.name == 'true': pass", "x = p.value == 'a'"]
)
def test_valid_comparisons_are_not_reported(text: str) -> None:
    assert slips.fix_bool_compared_with_text(node(text)) is None


@pytest.mark.parametrize(
    "text",
    [
        "p = Parameter('use_sim_time', Parameter.Type.BOOL, True)",
        "p = {'a': True, 'use_sim_time': True}",
        "p = {'name': 'use_sim_time', 'value': True}",
        "n.declare_parameter('use_sim_time', value=True)",
    ],
)
def test_simulated_time_is_switched_off(text: str) -> None:
    found = slips.diagnose_simulated_time(node_file(text))
    assert found is not None
    head, _, tail = text.rpartition("True")
    assert found.hint == f"line 1 becomes: {head}False{tail}"


@pytest.mark.parametrize("text", ["p = Parameter('use_sim_time', value=False)", "n.get_parameter('use_sim_time')"])
def test_real_time_is_not_reported(text: str) -> None:
    assert slips.diagnose_simulated_time(node_file(text)) is None


@pytest.mark.parametrize(
    ("text", "step"),
    [
        ("os.environ['ROS_DOMAIN_ID'] = '42'\n", "remove line 1: os.environ['ROS_DOMAIN_ID'] = '42'"),
        ("rclpy.init(args=args, domain_id=42)", "line 1 becomes: rclpy.init(args=args)"),
    ],
)
def test_a_domain_of_its_own_is_named(text: str, step: str) -> None:
    found = slips.diagnose_other_domain(node_file(text))
    assert found is not None
    assert found.hint == step


@pytest.mark.parametrize("text", ["print(os.environ['ROS_DOMAIN_ID'])", "rclpy.init(args=args)"])
def test_the_domain_of_the_environment_is_not_reported(text: str) -> None:
    assert slips.diagnose_other_domain(node_file(text)) is None

"""Programs that run, and whose node is nowhere to be seen."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import EVERY_SYMPTOM, Case, Evidence, Found, found, mistake
from tutor.mistakes.examples import in_run
from tutor.ros_model import Graph

_AFTER_CTRL_C = (Symptom.DOES_NOT_END, Symptom.ENDS_BADLY)
_WHILE_RUNNING = tuple(symptom for symptom in EVERY_SYMPTOM if symptom not in _AFTER_CTRL_C)


@mistake(
    "another-domain",
    explains=(Symptom.ENDED, Symptom.NO_MESSAGES, Symptom.NOTHING_RECEIVED, Symptom.SERVICE_MISSING, Symptom.NO_ANSWER),
    says="{line} puts the node into another ROS domain, where nothing else sees it: {code}",
    do="Leave the choice of the domain to whoever starts the node.",
)
def another_domain(case: Case) -> Iterator[Found]:
    """The program chooses a ROS domain of its own.

    Nodes see each other only within one domain, which the environment variable ROS_DOMAIN_ID chooses. A program that
    sets that variable, or passes domain_id, leaves the domain that everybody else is in.

    Bad:

        os.environ['ROS_DOMAIN_ID'] = '7'

    Good:

        domain = os.environ.get('ROS_DOMAIN_ID')

    See it: `ros2 node list` does not show the node.
    """
    for file in case.files:
        for node in file.nodes:
            match node:
                case ast.Assign(targets=[ast.Subscript(slice=ast.Constant(value="ROS_DOMAIN_ID"))]):
                    yield found(file, node)
                case ast.Call(keywords=keywords) if any(keyword.arg == "domain_id" for keyword in keywords):
                    yield found(file, node)


@mistake(
    "no-node",
    explains=_WHILE_RUNNING,
    evidence=Evidence.SYMPTOM,
    says="the program runs, but has made no ROS node{output}",
    do="Call rclpy.init() and make the node first: a loop above them keeps the program from getting there.",
    example=in_run(Symptom.NO_MESSAGES, graph=Graph()),
)
def no_node(case: Case) -> Iterator[Found]:
    """The program runs, but there is no node.

    A node appears in the graph once its constructor has run, after rclpy.init(). Until then, a program that waits,
    prints or computes is just a program.

    Bad:

        while True:
            print('ding')

    Good:

        rclpy.init()
        node = rclpy.create_node('bell')
        rclpy.spin(node)

    See it: `ros2 node list`.
    """
    if case.trace.exit is None and not case.trace.graph.nodes:
        yield Found({"output": ", and prints endlessly" if case.trace.dropped_lines else ""})

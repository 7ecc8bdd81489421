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
    explains=_WHILE_RUNNING,
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
    for file in () if case.trace.graph.nodes else case.files:
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
    says="{what}",
    do="{do}",
    example=in_run(Symptom.NO_MESSAGES, graph=Graph()),
)
def none_seen(case: Case) -> Iterator[Found]:
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
    if case.trace.exit is not None or case.trace.graph.nodes:
        return
    what = "the launch runs, but nothing that it starts has made a ROS node"
    do = "Start programs that are ROS nodes: a Node, with its package and executable, for each."
    if case.symptom not in (Symptom.NOT_LAUNCHED, Symptom.WRONG_NAMES, Symptom.NOT_CONNECTED):
        output = ", and prints endlessly" if case.trace.dropped_lines else ""
        what = f"the program runs, but has made no ROS node{output}"
        do = "Call rclpy.init() and make the node first: a loop above them keeps the program from getting there."
    yield Found({"what": what, "do": do})

"""Nodes: their names, and how many there are."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.examples import in_run
from tutor.ros_model import Graph


@mistake(
    "second-node-of-the-same-name",
    explains=(Symptom.WRONG_RATE, Symptom.WRONG_ANSWER, Symptom.STANDS_STILL, Symptom.CHANGE_IGNORED),
    evidence=Evidence.RUN,
    says="there are {count} nodes called {name}, and all of them are running",
    do="Make only one node: see whether the class is instantiated, or the program started, twice.",
    example=in_run(Symptom.WRONG_RATE, graph=Graph(("/lamp", "/lamp"))),
)
def same_name(case: Case) -> Iterator[Found]:
    """Two nodes have one name.

    ROS lets any number of nodes have the same name; it warns, and goes on. All of them publish, and a tool that asks
    "the" node for its parameters gets an answer from any of them.

    Bad:

        first = Lamp()
        second = Lamp()

    Good:

        lamp = Lamp()

    See it: `ros2 node list` warns of nodes that share a name.
    """
    nodes = case.trace.graph.nodes
    for name in sorted({node for node in nodes if nodes.count(node) > 1}):
        yield Found({"name": name, "count": nodes.count(name)})

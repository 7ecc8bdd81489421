"""Remappings of a launch file that do not do what they should."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.launch_case import REMAP, endpoints_of, last_part, remappings_of, value_of
from tutor.ros_model import Graph, TopicEndpoint

_NAMES = (Symptom.WRONG_NAMES,)


@mistake(
    "remapping-the-wrong-way-round",
    explains=_NAMES,
    evidence=Evidence.RUN,
    says="{source} is remapped to {target}, so {target} keeps its name",
    do="Write the name in the node's code first, then the new one.",
    example=in_run(
        Symptom.WRONG_NAMES,
        moves="topic",
        argument="topic",
        wanted="/dong",
        command_lines=("bell --ros-args -r dong:=ring",),
    ),
)
def swapped(case: Case) -> Iterator[Found]:
    """A remapping is the wrong way round.

    A remapping is a pair: the name that the node's code uses, and the one to use instead.

    Bad:

        remappings=[('doorbell', 'ring')]

    Good:

        remappings=[('ring', 'doorbell')]

    See it: `ros2 topic list`.
    """
    for source, target in remappings_of(case) if case.about("moves") == "topic" else ():
        if last_part(source) == value_of(case):
            yield Found({"source": source, "target": target})


@mistake(
    "remapping-without-effect",
    explains=_NAMES,
    evidence=Evidence.RUN,
    says="{what}",
    do="Remap exactly the name that the node's code uses, once.",
    example=in_run(
        Symptom.WRONG_NAMES,
        moves="topic",
        argument="topic",
        wanted="/dong",
        command_lines=("bell --ros-args -r horn:=dong",),
        graph=Graph(("/bell",), (TopicEndpoint("/ring", "t", "/bell"),)),
    ),
)
def without_effect(case: Case) -> Iterator[Found]:
    """A remapping changes nothing.

    Only the exact name in the node's code is remapped, and the first rule that fits is taken. A rule with a leading
    slash is for the name outside any namespace.

    Bad:

        remappings=[('rings', 'doorbell')]

    Good:

        remappings=[('ring', 'doorbell')]

    See it: `ros2 node info NODE`.
    """
    for command in case.about("command_lines", ()):
        rules = [(found["source"], found["target"]) for found in REMAP.finditer(command)]
        for place, (source, target) in enumerate(rules):
            earlier = next((other for name, other in rules[:place] if name == source), target)
            if earlier != target and last_part(target) == value_of(case):
                yield Found(
                    {"what": f"{source} is remapped to {earlier} first, then to {target}: the first rule counts"}
                )
    targets = {last_part(target) for _, target in remappings_of(case)}
    names = sorted({endpoint.topic for endpoint in endpoints_of(case) if last_part(endpoint.topic) not in targets})
    for source, target in remappings_of(case) if names else ():
        if last_part(target) != value_of(case):
            continue
        if source.startswith("/") and any(name.endswith(source) and name != source for name in names):
            yield Found({"what": f"the remapping is from {source}, and in the namespace the topic is {names[0]}"})
        elif not any(last_part(name) == last_part(source) for name in names):
            yield Found({"what": f"{source} is remapped to {target}, but the node uses {', '.join(names)}"})


@mistake(
    "something-added-to-the-name",
    name="wrong topic",
    explains=_NAMES,
    evidence=Evidence.RUN,
    says="{node} uses {topic}: something is added to the value {value}",
    do="Remap to the argument's value alone.",
    example=in_run(
        Symptom.WRONG_NAMES,
        moves="topic",
        argument="topic",
        wanted="/dong",
        graph=Graph(("/bell",), (TopicEndpoint("/dong_ring", "t", "/bell"),)),
    ),
)
def altered(case: Case) -> Iterator[Found]:
    """A name is made of the argument and something else.

    The value of an argument is the whole name. A prefix or suffix that the launch file adds makes another name of it.

    Bad:

        remappings=[('ring', [LaunchConfiguration('sound'), '_ring'])]

    Good:

        remappings=[('ring', LaunchConfiguration('sound'))]

    See it: `ros2 topic list`.
    """
    value = value_of(case)
    for endpoint in endpoints_of(case) if value and case.about("moves") == "topic" else ():
        last = last_part(endpoint.topic)
        if value in last and value != last:
            yield Found({"node": endpoint.node, "topic": endpoint.topic, "value": value})

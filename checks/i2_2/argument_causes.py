"""I2.2: why the arguments `topic` and `namespace` do not have their effect."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from checks.i2_2 import source_causes, steps
from checks.i2_2.causes import diagnose_launch, list_endpoints, list_nodes, with_imported_names
from checks.i2_2.facts import (
    ARGUMENTS,
    NAMESPACE,
    LaunchRun,
    is_namespace_doubled,
    publishers,
    shared_topics,
    subscriptions,
    topics_in_use,
)
from checks.i2_2.launch_file import Launch, launch
from checks.i2_2.processes import ended_processes
from tutor.judge.verdict import Cause
from tutor.ros_model import Graph, TopicEndpoint

_REMAP = re.compile(r"(?:-r|--remap) (?P<source>[^\s:=]+):=(?P<target>\S+)")


@with_imported_names
def diagnose_topic(default_run: LaunchRun, seen: LaunchRun, wanted: str) -> Cause:
    """Why, with another topic given, one of the nodes does not use `wanted`, or the default topic is still used."""
    if (cause := _diagnose_broken(seen)) is not None:
        return cause
    graph, name, launch_file = seen.trace.graph, _original_topic(default_run), launch(seen.trace)
    senders = [each for each in publishers(graph) if each.topic == wanted]
    receivers = [each for each in subscriptions(graph) if each.topic == wanted]
    in_source = source_causes.diagnose_in_source(seen, "topic")
    if not senders and not receivers:
        return (
            in_source
            or _diagnose_altered_topic(launch_file, graph, wanted)
            or _diagnose_ignored_argument(seen, "topic", wanted, default_run)
            or _diagnose_remapping(seen, wanted)
            or source_causes.diagnose_topic_argument(launch_file, name)
            or Cause(
                "topic hard-coded",
                f"neither node uses {wanted}: the remappings do not depend on the argument",
                steps.remap_nodes(launch_file, name) or f"give both nodes {steps.remapping(launch_file.source, name)}",
            )
        )
    if not senders or not receivers:
        present, others, verb = (
            (senders, subscriptions(graph), "subscribes to")
            if senders
            else (receivers, publishers(graph), "publishes on")
        )
        stray = [each for each in others if each.node not in {one.node for one in present}] or others
        where = ", ".join(sorted({f"{each.node} {verb} {each.topic}" for each in stray})) or "the other node is missing"
        return (
            in_source
            or _diagnose_other_namespace(launch_file, stray, wanted)
            or _diagnose_remapping(seen, wanted)
            or Cause(
                "remapping missing on one node",
                f"only {present[0].node} uses {wanted}; {where}",
                steps.remap_nodes(launch_file, name)
                or "give the other node the same remappings=[...], from the name that its own code uses",
            )
        )
    still_used = sorted(shared_topics(default_run.trace.graph) & topics_in_use(graph))
    if still_used:
        users = sorted({each.node for each in (*publishers(graph), *subscriptions(graph)) if each.topic in still_used})
        return Cause(
            "default topic still used",
            f"{', '.join(users)} still {'uses' if len(users) == 1 else 'use'} {', '.join(still_used)}",
            steps.remap_nodes(launch_file, name) or "give every node that uses the topic the same remappings=[...]",
        )
    return Cause(
        "no messages",
        f"both nodes are on {wanted}, but nothing is sent there",
        "start both by hand with this topic, and look at their output",
    )


@with_imported_names
def diagnose_namespace(default_run: LaunchRun, seen: LaunchRun) -> Cause:
    """Why, with a namespace given, one of the nodes or their topic is not in it."""
    if (cause := _diagnose_broken(seen)) is not None:
        return cause
    namespace, launch_file = seen.arguments.get("namespace", NAMESPACE), launch(seen.trace)
    graph, under = seen.trace.graph, f"/{namespace}/"
    endpoints = [*publishers(graph), *subscriptions(graph)]
    twice = next(
        (name for each in endpoints for name in (each.node, each.topic) if is_namespace_doubled(name, namespace)), None
    )
    if twice is not None:
        return Cause(
            "namespace applied twice",
            f"{twice} has the prefix {under[:-1]} twice",
            "use one of the two: namespace=LaunchConfiguration('namespace') for each node, or a PushRosNamespace",
        )
    within = [each for each in endpoints if each.node.startswith(under)]
    outside = [each for each in endpoints if not each.node.startswith(under)]
    in_source = source_causes.diagnose_in_source(seen, "namespace")
    if not within:
        return (
            in_source
            or _diagnose_ignored_argument(seen, "namespace", namespace)
            or source_causes.diagnose_namespace_argument(launch_file)
            or Cause(
                "namespace not used",
                f"{list_nodes(outside)}: no node is under {under[:-1]}",
                steps.put_into_namespace(launch_file)
                or "give both nodes namespace=LaunchConfiguration('namespace'), or put them behind a PushRosNamespace",
            )
        )
    if outside and not _are_two_nodes(within):
        return (
            in_source
            or source_causes.diagnose_namespace_argument(launch_file)
            or Cause(
                "namespace missing on one node",
                f"{list_nodes(within)} is under {under[:-1]}, {list_nodes(outside)} is not",
                steps.put_into_namespace(launch_file)
                or "give the other node the same namespace=LaunchConfiguration('namespace')",
            )
        )
    absolute = [each for each in within if not each.topic.startswith(under)]
    if absolute:
        slash = next((target for _, target in _remappings(seen) if target.startswith("/")), None)
        because = f"the remapping to {slash} begins with a slash" if slash else "its name begins with a slash"
        return Cause(
            "absolute topic",
            f"the nodes are under {under[:-1]}, but {absolute[0].node} uses {absolute[0].topic}: {because}",
            steps.remap_nodes(launch_file, _original_topic(default_run))
            or "a name that begins with / takes no namespace",
        )
    topic = seen.arguments.get("topic")
    if topic is not None:
        return diagnose_topic(default_run, seen, f"{under}{topic}")
    return Cause(
        "nodes apart",
        f"{list_endpoints(endpoints)}: no node subscribes to what another one publishes",
        "give both nodes the same namespace and the same remappings",
    )


def _diagnose_other_namespace(launch_file: Launch, stray: Sequence[TopicEndpoint], wanted: str) -> Cause | None:
    """Find a node that uses the given topic, but within a namespace of its own."""
    for each in stray:
        namespace = each.node.rpartition("/")[0]
        if namespace and f"{namespace}/{wanted.rpartition('/')[2]}" == each.topic != wanted:
            return Cause(
                "namespace of its own",
                f"{each.node} is in the namespace {namespace}, and so it uses {each.topic} in place of {wanted}",
                steps.put_into_namespace(launch_file)
                or "give both nodes the same namespace=LaunchConfiguration('namespace')",
            )
    return None


def _diagnose_broken(seen: LaunchRun) -> Cause | None:
    """Why a process ended, or no node came up, with these arguments."""
    if seen.trace.exit is not None or ended_processes(seen.trace.output) or not seen.trace.graph.nodes:
        return diagnose_launch(seen.trace)
    return None


def _diagnose_altered_topic(launch_file: Launch, graph: Graph, wanted: str) -> Cause | None:
    """Find a topic whose base name contains the given value, but is not equal to it."""
    base_name = wanted.rsplit("/", 1)[-1]
    for each in (*publishers(graph), *subscriptions(graph)):
        last = each.topic.rsplit("/", 1)[-1]
        if base_name in last and base_name != last:
            return Cause(
                "wrong topic",
                f"{each.node} uses {each.topic}: something is added to the argument's value, {base_name}",
                "remap to LaunchConfiguration('topic') alone",
            )
    return None


def _diagnose_ignored_argument(
    seen: LaunchRun, argument: str, value: str, default_run: LaunchRun | None = None
) -> Cause | None:
    """Find out why the argument's value reaches no node at all; None if it reaches one."""
    launch_file = launch(seen.trace)
    base_name = value.rsplit("/", 1)[-1]
    # `ros2 launch` itself always has the value.
    nodes = [command for command in seen.command_lines if seen.trace.file not in command]
    if any(base_name in command for command in nodes):
        return None
    name = _original_topic(default_run) if default_run is not None else "chatter"
    source = launch_file.source
    right = f"namespace={steps.value(source, argument)}" if argument == "namespace" else steps.remapping(source, name)
    declared = seen.trace.launch_arguments
    others = [name for name in declared if name not in ARGUMENTS]
    if argument not in declared and others:
        return Cause(
            "wrong argument name",
            f"{argument}:={base_name} changes nothing; the arguments are called {', '.join(declared)}",
            steps.rename_similar_argument(launch_file, argument, others)
            or f"name it exactly '{argument}', in DeclareLaunchArgument and in LaunchConfiguration",
        )
    if argument not in declared:
        return Cause(
            "argument missing",
            f"{argument}:={base_name} changes nothing: no such argument is declared",
            f"put {steps.declaration(argument)} first into the list in LaunchDescription([...]), and give every "
            f"Node(...) {right}",
        )
    if argument == "namespace":
        return source_causes.diagnose_namespace_argument(launch_file) or Cause(
            "namespace not used",
            f"the argument {argument} is declared, but its value reaches no node",
            steps.put_into_namespace(launch_file) or f"give every Node(...) {right}",
        )
    return source_causes.diagnose_topic_argument(launch_file, name) or Cause(
        "topic hard-coded",
        f"the argument {argument} is declared, but its value reaches no node",
        steps.remap_nodes(launch_file, name) or f"give every Node(...) {right}",
    )


def _original_topic(default_run: LaunchRun) -> str:
    """The topic name in the nodes' own code: the source of a remapping without arguments, else the topic itself."""
    topics = shared_topics(default_run.trace.graph) or topics_in_use(default_run.trace.graph)
    for source, target in _remappings(default_run):
        if any(topic.rsplit("/", 1)[-1] == target.rsplit("/", 1)[-1] for topic in topics):
            return source.rsplit("/", 1)[-1]
    return min(topics, default="/chatter").rsplit("/", 1)[-1]


def _diagnose_remapping(seen: LaunchRun, wanted: str) -> Cause | None:
    """Find a remapping to the topic that has no effect, since its node does not use the source name."""
    base_name = wanted.rsplit("/", 1)[-1]
    swapped = [(source, target) for source, target in _remappings(seen) if source.rsplit("/", 1)[-1] == base_name]
    if swapped:
        source, target = swapped[0]
        return Cause(
            "remapping the wrong way round",
            f"{source} is remapped to {target}, so {target} keeps its name",
            steps.remap_nodes(launch(seen.trace), target) or "first the name in the node's code, then the new one",
        )
    for earlier, (source, target) in _overridden_rules(seen):
        if target.rsplit("/", 1)[-1] == base_name:
            return Cause(
                "remapping without effect",
                f"{source} is remapped to {earlier} first, then to {target}; the first rule that fits is applied",
                steps.remap_nodes(launch(seen.trace), source) or f"remove the rule from {source} to {earlier}",
            )
    remapped_to = {target.rsplit("/", 1)[-1] for _, target in _remappings(seen)}
    for source, target in _remappings(seen):
        if target.rsplit("/", 1)[-1] != base_name or source.startswith("__"):
            continue
        endpoints = [*publishers(seen.trace.graph), *subscriptions(seen.trace.graph)]
        unremapped = [each for each in endpoints if each.topic.rsplit("/", 1)[-1] not in remapped_to]
        names = sorted({each.topic for each in unremapped})
        if not names:
            continue
        if source.startswith("/") and any(name.endswith(source) and name != source for name in names):
            return Cause(
                "absolute remapping",
                f"the remapping from {source} applies to exactly this name; in the namespace, the topic is {names[0]}",
                steps.remap_nodes(launch(seen.trace), source[1:])
                or "without the slash, the name is taken within the namespace",
            )
        if not any(name.rsplit("/", 1)[-1] == source.rsplit("/", 1)[-1] for name in names):
            return Cause(
                "remapping from an unused name",
                f"{source} is remapped to {target}, but the node uses {', '.join(names)}",
                steps.remap_nodes(launch(seen.trace), names[0].rsplit("/", 1)[-1])
                or f"remap {names[0].rsplit('/', 1)[-1]} instead",
            )
    return None


def _remappings(seen: LaunchRun) -> list[tuple[str, str]]:
    """The remappings on the nodes' command lines, as (source, target)."""
    return [rule for command in seen.command_lines for rule in _rules(command)]


def _rules(command: str) -> list[tuple[str, str]]:
    return [(found["source"], found["target"]) for found in _REMAP.finditer(command)]


def _overridden_rules(seen: LaunchRun) -> Iterator[tuple[str, tuple[str, str]]]:
    """The remappings, as (source, target), that an earlier one of the same node overrides, each after its target."""
    for command in seen.command_lines:
        rules = _rules(command)
        for place, rule in enumerate(rules):
            earlier = next((target for source, target in rules[:place] if source == rule[0]), rule[1])
            if earlier != rule[1]:
                yield earlier, rule


def _are_two_nodes(endpoints: Sequence[TopicEndpoint]) -> bool:
    return len({each.node for each in endpoints}) > 1

"""I2.2: the verdict on each criterion."""

from __future__ import annotations

from dataclasses import replace

from checks.i2_2.argument_causes import diagnose_namespace, diagnose_topic
from checks.i2_2.causes import (
    diagnose_launch,
    diagnose_missing,
    diagnose_pair,
    diagnose_program,
    diagnose_simulation_time,
)
from checks.i2_2.facts import (
    NAMESPACE,
    SECOND_NAMESPACE,
    LaunchRun,
    Pair,
    find_pair,
    has_pair_in_namespace,
    logs_of_messages,
    pairs,
    pairs_in_namespace,
    pairs_on_topic,
    publishers,
    shared_namespaces,
    shared_topics,
    subscriptions,
    topics_in_use,
)
from checks.i2_2.processes import by_stream, ended_processes, writers, written_by
from tutor.judge import causes, ending
from tutor.judge.trace import OutputLine
from tutor.judge.verdict import Cause, Verdict, failed, passed
from tutor.judge.wording import counted


def judge_starts(seen: LaunchRun) -> Verdict:
    expected = "one command, without arguments, starts two nodes: one that publishes and one that subscribes"
    found = find_pair(seen.trace.graph)
    nodes = seen.trace.graph.nodes
    observed = counted(len(nodes), "node") + (f": {', '.join(nodes)}" if nodes else "")
    if found is None:
        return failed(expected, observed, diagnose_missing(seen), causes.output_tail(seen.trace))
    return passed(expected, observed, _describe_pair(found))


def judge_topic(default_run: LaunchRun, seen: LaunchRun) -> Verdict:
    name = seen.arguments["topic"]
    expected = f"with topic:={name}, both nodes use /{name}, and the default topic is unused"
    spaces = shared_namespaces(default_run.trace.graph)
    found = pairs_on_topic(seen.trace.graph, name, spaces)
    if _has_moved(default_run, seen, found) and _has_messages(default_run, seen, found):
        return passed(expected, _describe_graph(seen), _describe_pair(found[0]))
    wanted = next(
        (f"{space}/{name}" for space in spaces if f"{space}/{name}" in topics_in_use(seen.trace.graph)), f"/{name}"
    )
    return failed(
        expected, _describe_graph(seen), diagnose_topic(default_run, seen, wanted), causes.output_tail(seen.trace)
    )


def judge_namespace(
    default_run: LaunchRun, elsewhere: LaunchRun, alone: LaunchRun, both: LaunchRun, another: LaunchRun | None = None
) -> Verdict:
    """Judge `namespace`. `another`: a launch in a second namespace, if everything is in the first one by default."""
    expected = f"with {alone.typed}, both nodes and the topic are under /{NAMESPACE}"
    within = pairs_in_namespace(alone.trace.graph)
    # Nodes that share no topic even without a namespace, or ignore the topic argument, fail other criteria.
    right = has_pair_in_namespace(alone.trace.graph)
    if another is not None:
        right = bool(within)
        if not (
            right and _has_moved(default_run, another, pairs_in_namespace(another.trace.graph, space=SECOND_NAMESPACE))
        ):
            expected = f"with {another.typed}, both nodes and the topic are under /{SECOND_NAMESPACE}"
            cause = diagnose_namespace(default_run, another)
            return failed(expected, _describe_graph(another), cause, causes.output_tail(another.trace))
    elif shared_topics(default_run.trace.graph):
        right = _has_moved(default_run, alone, within) and _has_messages(default_run, alone, within)
    if not right:
        return failed(
            expected, _describe_graph(alone), diagnose_namespace(default_run, alone), causes.output_tail(alone.trace)
        )
    topic = both.arguments["topic"]
    expected = f"with {both.typed}, both nodes and /{NAMESPACE}/{topic} are under /{NAMESPACE}"
    if pairs_on_topic(elsewhere.trace.graph, elsewhere.arguments["topic"], shared_namespaces(default_run.trace.graph)):
        found = pairs_in_namespace(both.trace.graph, topic)
        right = _has_moved(default_run, both, found) and _has_messages(default_run, both, found)
    else:
        right = has_pair_in_namespace(both.trace.graph)
    if not right:
        return failed(
            expected, _describe_graph(both), diagnose_namespace(default_run, both), causes.output_tail(both.trace)
        )
    expected = f"with namespace:={NAMESPACE}, alone and with a topic, both nodes and the topic are under /{NAMESPACE}"
    return passed(expected, _describe_graph(both), [*_describe_pair(within[0])] if within else ())


def judge_communicates(seen: LaunchRun) -> Verdict:
    expected = "without arguments, the subscriber gets what the publisher sends"
    found = pairs(seen.trace.graph)
    if not found:
        return failed(expected, _describe_graph(seen), diagnose_pair(seen), causes.output_tail(seen.trace))
    reasons: list[tuple[Pair, Cause]] = []
    for pair in found:
        reason = _diagnose_delivery(seen, pair)
        if reason is None:
            topic = pair[0].topic
            count = len(seen.trace.samples_on(topic))
            logs = logs_of_messages(pair, seen.trace.logs, seen.trace.samples_on(topic))
            observed = f"{counted(count, 'message')} on {topic}" if count else f"connected on {topic}"
            return passed(expected, observed, [*_describe_pair(pair), *(str(log) for log in logs[:2])])
        reasons.append((pair, diagnose_program(seen, reason)))
    pair, reason = reasons[0]
    return failed(expected, _describe_graph(seen), reason, causes.output_tail(seen.trace))


def _diagnose_delivery(seen: LaunchRun, pair: Pair) -> Cause | None:
    """Why the messages of this pair do not arrive; None where they do."""
    publisher, subscription = pair
    if publisher.type != subscription.type:
        return Cause(
            "wrong type",
            f"on {publisher.topic}, {publisher.node} sends {publisher.type}, "
            f"and {subscription.node} wants {subscription.type}",
            "choose two programs whose messages have the same type",
        )
    if (cause := causes.diagnose_incompatible_qos(publisher, subscription)) is not None:
        return cause
    if not seen.trace.samples_on(publisher.topic) and publisher.topic not in seen.hidden:
        return (
            diagnose_launch(seen.trace)
            or diagnose_simulation_time(seen, publisher.node)
            or Cause(
                "no messages",
                f"{publisher.node} publishes nothing on {publisher.topic}",
                "start it alone, and look at its output",
            )
        )
    alive = subscription.node in seen.answering
    mute = subscription.node not in seen.trace.graph.parameter_nodes
    logged = logs_of_messages(pair, seen.trace.logs, seen.trace.samples_on(publisher.topic))
    if seen.disconnected:
        return diagnose_launch(seen.trace) or Cause(
            "a node that ends",
            f"{publisher.node} and {subscription.node} were connected, but one of them is gone",
            "see the last lines of its output",
        )
    if alive or (mute and seen.trace.exit is None) or (logged and not ended_processes(seen.trace.output)):
        return None
    return diagnose_launch(seen.trace) or Cause(
        "no spin",
        f"{subscription.node} has a subscription, but answers no request: its callbacks are never run",
        "call rclpy.spin(node) in the program, and let no callback block",
    )


def judge_shutdown(seen: LaunchRun) -> Verdict:
    expected = "one Ctrl+C ends the whole launch within 5 s, and no process is left"
    ended = seen.ending
    if ended is not None:
        # `ros2 launch` relays its nodes' output with a prefix on each line.
        ended = replace(ended, output=_without_prefixes(ended.output))
    # The launch file itself has nothing to do with how its programs end.
    programs = {name: text for name, text in seen.trace.sources.items() if name != seen.trace.file}
    verdict = ending.judge_ending(replace(seen.trace, sources=programs), ended, shown_by="communicates")
    if ended is not None and ended.exit is None:
        left = [command[:200] for command in ended.survivors]
        return replace(verdict, expected=expected, evidence=(*left[:6], *(line.text for line in ended.output[-6:])))
    if ended is None:
        return verdict
    if not verdict.passed:
        return replace(verdict, expected=expected)
    if ended.survivors:
        return failed(
            expected,
            f"ended {ended.took_s:.2f} s after Ctrl+C with {ended.exit}; {len(ended.survivors)} left",
            Cause(
                "process left behind",
                f"still there: {ended.survivors[0][:200]}",
                f"start it with Node or ExecuteProcess, which end it, and not by Python code in {seen.trace.file}",
            ),
            [command[:200] for command in ended.survivors[:6]],
        )
    return passed(expected, f"{verdict.observed}; no process is left")


def _without_prefixes(output: tuple[OutputLine, ...]) -> tuple[OutputLine, ...]:
    return tuple(line for process in (None, *writers(output)) for line in by_stream(written_by(output, process)))


def _has_moved(default_run: LaunchRun, seen: LaunchRun, found: list[Pair]) -> bool:
    """Whether pairs were found, and at least one topic that is shared without arguments is no longer in use."""
    before = shared_topics(default_run.trace.graph)
    return bool(found) and (not before or bool(before - topics_in_use(seen.trace.graph)))


def _has_messages(default_run: LaunchRun, seen: LaunchRun, found: list[Pair]) -> bool:
    """Whether messages arrive on the pairs' topics, or none arrive even without arguments (judged elsewhere)."""
    if not any(default_run.trace.samples.values()):
        return True
    return any(publisher.topic in seen.hidden or bool(seen.trace.samples_on(publisher.topic)) for publisher, _ in found)


def _describe_graph(seen: LaunchRun) -> str:
    graph = seen.trace.graph
    if not graph.nodes:
        return "no node" + (f"; the launch ended with {seen.trace.exit}" if seen.trace.exit else "")
    ends = [f"{each.node} publishes on {each.topic}" for each in publishers(graph)]
    ends += [f"{each.node} subscribes to {each.topic}" for each in subscriptions(graph)]
    return "; ".join(sorted(set(ends))) or f"nodes without topics: {', '.join(graph.nodes)}"


def _describe_pair(pair: Pair) -> list[str]:
    publisher, subscription = pair
    return [
        f"{publisher.node} publishes on {publisher.topic}",
        f"{subscription.node} subscribes to {subscription.topic}",
    ]

"""I2.2: the verdict on each criterion."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

from checks.i2_2.facts import (
    NAMESPACE,
    SECOND_NAMESPACE,
    LaunchRun,
    Pair,
    find_pair,
    has_pair_in_namespace,
    is_namespace_doubled,
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
from tutor.judge import ending, tracebacks
from tutor.judge.bench import NeedsInstalledRos
from tutor.judge.launch_output import by_stream, ended_processes, find_refusal, writers, written_by
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import OutputLine, Trace
from tutor.judge.tracebacks import Traceback
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import counted, output_tail
from tutor.ros_model import incompatible_policies

_UNSUPPORTED = re.compile(r"(?<!\S)\S+ is not supported by the launch files that run without an installed ROS 2[^\n]*")
_NEEDS_ROS = re.compile(r"`ros2 \w+` needs an installed ROS 2")


def _seen(symptom: Symptom, run: LaunchRun, *, says: str = "", do: str = "", **about: Any) -> Observation:
    """What was seen in a launch.

    Raises NeedsInstalledRos if it needs a feature that our substitute for `launch` does not have.
    """
    trace = run.trace
    reject_unsupported(trace)
    broken = trace.exit is not None or bool(ended_processes(trace.output)) or not trace.graph.nodes
    raised = find_exception(trace) if broken or symptom is not Symptom.WRONG_NAMES else None
    return symptom.seen(trace, says=says, do=do, raised=raised, command_lines=run.command_lines, **about)


def reject_unsupported(trace: Trace) -> None:
    """Raise NeedsInstalledRos if the launch has failed for the want of an installed ROS 2."""
    for line in written_by(trace.output, None):
        if found := _UNSUPPORTED.search(line.text):
            raise NeedsInstalledRos(found[0])
    for ended in ended_processes(trace.output)[:1]:
        words = [line.text for line in ended.output if line.text.strip()][-1:]
        if words and (found := _NEEDS_ROS.search(words[0])):
            raise NeedsInstalledRos(found[0])


def find_exception(trace: Trace) -> Traceback | None:
    """The exception that kept the launch file from being loaded, or else one that a program of the launch left."""
    own = written_by(trace.output, None)
    if raised := tracebacks.find_tracebacks(by_stream(own)):
        return raised[-1]
    if (refusal := find_refusal(own, trace)) is not None:
        return refusal
    ended = ended_processes(trace.output)
    if ended:
        return ended[0].traceback
    left = [tracebacks.find_tracebacks(by_stream(written_by(trace.output, each))) for each in writers(trace.output)]
    return next((found[-1] for found in left if found), None)


def judge_starts(seen: LaunchRun) -> Verdict:
    expected = "one command, without arguments, starts two nodes: one that publishes and one that subscribes"
    found = find_pair(seen.trace.graph)
    nodes = seen.trace.graph.nodes
    observed = counted(len(nodes), "node") + (f": {', '.join(nodes)}" if nodes else "")
    if found is None:
        return failed(expected, observed, _seen(Symptom.NOT_LAUNCHED, seen), output_tail(seen.trace))
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
    return failed(expected, _describe_graph(seen), _wrong_topic(default_run, seen, wanted), output_tail(seen.trace))


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
            cause = _wrong_namespace(default_run, another)
            return failed(expected, _describe_graph(another), cause, output_tail(another.trace))
    elif shared_topics(default_run.trace.graph):
        right = _has_moved(default_run, alone, within) and _has_messages(default_run, alone, within)
    if not right:
        return failed(expected, _describe_graph(alone), _wrong_namespace(default_run, alone), output_tail(alone.trace))
    topic = both.arguments["topic"]
    expected = f"with {both.typed}, both nodes and /{NAMESPACE}/{topic} are under /{NAMESPACE}"
    if pairs_on_topic(elsewhere.trace.graph, elsewhere.arguments["topic"], shared_namespaces(default_run.trace.graph)):
        found = pairs_in_namespace(both.trace.graph, topic)
        right = _has_moved(default_run, both, found) and _has_messages(default_run, both, found)
    else:
        right = has_pair_in_namespace(both.trace.graph)
    if not right:
        return failed(expected, _describe_graph(both), _wrong_namespace(default_run, both), output_tail(both.trace))
    expected = f"with namespace:={NAMESPACE}, alone and with a topic, both nodes and the topic are under /{NAMESPACE}"
    return passed(expected, _describe_graph(both), [*_describe_pair(within[0])] if within else ())


def judge_communicates(seen: LaunchRun) -> Verdict:
    expected = "without arguments, the subscriber gets what the publisher sends"
    found = pairs(seen.trace.graph)
    if not found:
        return failed(expected, _describe_graph(seen), _seen(Symptom.NOT_CONNECTED, seen), output_tail(seen.trace))
    reasons: list[Observation] = []
    for pair in found:
        reason = _diagnose_delivery(seen, pair)
        if reason is None:
            topic = pair[0].topic
            count = len(seen.trace.samples_on(topic))
            logs = logs_of_messages(pair, seen.trace.logs, seen.trace.samples_on(topic))
            observed = f"{counted(count, 'message')} on {topic}" if count else f"connected on {topic}"
            return passed(expected, observed, [*_describe_pair(pair), *(str(log) for log in logs[:2])])
        reasons.append(reason)
    return failed(expected, _describe_graph(seen), reasons[0], output_tail(seen.trace))


def _diagnose_delivery(seen: LaunchRun, pair: Pair) -> Observation | None:
    """What is seen of messages of this pair that do not arrive; None where they do."""
    publisher, subscription = pair
    if publisher.type != subscription.type:
        return _seen(
            Symptom.NOT_CONNECTED,
            seen,
            says=f"on {publisher.topic}, {publisher.node} sends {publisher.type}, and {subscription.node} wants "
            f"{subscription.type}",
            do="Choose two programs whose messages have the same type.",
        )
    if any(incompatible_policies(publisher.qos, subscription.qos)):
        return _seen(Symptom.NOT_CONNECTED, seen, topic=publisher.topic)
    if not seen.trace.samples_on(publisher.topic) and publisher.topic not in seen.hidden:
        return _seen(
            Symptom.NOT_CONNECTED,
            seen,
            says=f"{publisher.node} publishes nothing on {publisher.topic}",
            do="Start it alone, and look at its output.",
            silent=publisher.node,
        )
    alive = subscription.node in seen.answering
    mute = subscription.node not in seen.trace.graph.parameter_nodes
    logged = logs_of_messages(pair, seen.trace.logs, seen.trace.samples_on(publisher.topic))
    if seen.disconnected:
        return _seen(
            Symptom.NOT_CONNECTED,
            seen,
            says=f"{publisher.node} and {subscription.node} were connected, but one of them is gone",
            do="See in the last lines of the output which program has ended, and why.",
        )
    if alive or (mute and seen.trace.exit is None) or (logged and not ended_processes(seen.trace.output)):
        return None
    return _seen(
        Symptom.NOT_CONNECTED,
        seen,
        says=f"{subscription.node} has a subscription, but answers no request: its callbacks are never run",
        do="Let the program spin its node, and let no callback block.",
    )


def _wrong_topic(default_run: LaunchRun, seen: LaunchRun, wanted: str) -> Observation:
    """With another topic given, one of the nodes does not use `wanted`, or the default topic is still used."""
    graph = seen.trace.graph
    still_used = sorted(shared_topics(default_run.trace.graph) & topics_in_use(graph))
    users = sorted({each.node for each in (*publishers(graph), *subscriptions(graph)) if each.topic in still_used})
    unheard = not still_used and wanted in shared_topics(graph)
    return _seen(
        Symptom.WRONG_NAMES,
        seen,
        says=f"both nodes are on {wanted}, but nothing is sent there" if unheard else "",
        do="Start both by hand with this topic, and look at their output." if unheard else "",
        argument="topic",
        wanted=wanted,
        still_used=tuple(still_used),
        users=tuple(users),
    )


def _wrong_namespace(default_run: LaunchRun, seen: LaunchRun) -> Observation:
    """With a namespace given, one of the nodes or their topic is not in it."""
    namespace, topic = seen.arguments.get("namespace", NAMESPACE), seen.arguments.get("topic")
    endpoints = (*publishers(seen.trace.graph), *subscriptions(seen.trace.graph))
    under = f"/{namespace}/"
    within = {each.node for each in endpoints if each.node.startswith(under)}
    if topic is not None and endpoints and all(f"{each.node}/".startswith(under) for each in endpoints):
        in_it = all(each.topic.startswith(under) for each in endpoints)
        if len(within) > 1 and in_it and not any(is_namespace_doubled(each.topic, namespace) for each in endpoints):
            return _wrong_topic(default_run, seen, f"{under}{topic}")
    return _seen(Symptom.WRONG_NAMES, seen, argument="namespace", wanted=namespace)


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
            Symptom.DOES_NOT_END.seen(replace(seen.trace, sources=programs), left_behind=ended.survivors[0][:120]),
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

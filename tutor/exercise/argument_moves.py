"""Forms: a launch argument moves a pair of nodes to another topic, or into a namespace."""

from __future__ import annotations

from dataclasses import dataclass

from tutor.exercise.form import Exercise, Form
from tutor.exercise.launch_graph import (
    Pair,
    describe_pair,
    has_pair_in_namespace,
    is_namespace_doubled,
    pairs_in_namespace,
    pairs_on_topic,
    publishers,
    shared_namespaces,
    shared_topics,
    subscriptions,
    topics_in_use,
)
from tutor.exercise.launch_run import Launch, LaunchInAnother, LaunchRun, LaunchWith
from tutor.exercise.launch_symptoms import seen_in_launch
from tutor.judge.check import Criterion
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.verdict import Verdict, failed, passed
from tutor.judge.wording import output_tail


@dataclass(frozen=True)
class ArgumentMovesTopic(Form):
    """With a launch argument that names a topic, both nodes of a pair use that topic, and the default one is unused.

    The name that we give is random, without a slash, and is taken within the namespace that the nodes have anyway.
    `argument`: its name. The exercise's program must be a `LaunchFile`:

        ArgumentMovesTopic("topic", "topic", after=starts)
    """

    argument: str

    def criterion(self, exercise: Exercise) -> Criterion:
        return self.judged(self.judge, Launch(exercise.launch_file), self.launch(exercise))

    def launch(self, exercise: Exercise) -> LaunchWith:
        """The launch with another topic."""
        return LaunchWith(exercise.launch_file, topic=self.argument)

    def judge(self, default_run: LaunchRun, seen: LaunchRun) -> Verdict:
        """Judge a launch with another topic."""
        name = seen.arguments[self.argument]
        expected = f"with {seen.typed}, both nodes use /{name}, and the default topic is unused"
        found, spaces = self.moved(default_run, seen), shared_namespaces(default_run.trace.graph)
        if _has_moved(default_run, seen, found) and _has_messages(default_run, seen, found):
            return passed(expected, seen.describe(), describe_pair(found[0]))
        wanted = next(
            (f"{space}/{name}" for space in spaces if f"{space}/{name}" in topics_in_use(seen.trace.graph)), f"/{name}"
        )
        cause = self.wrong_topic(default_run, seen, wanted)
        return failed(expected, seen.describe(), cause, output_tail(seen.trace))

    def moved(self, default_run: LaunchRun, seen: LaunchRun) -> list[Pair]:
        """The pairs on the topic that the argument names."""
        spaces = shared_namespaces(default_run.trace.graph)
        return pairs_on_topic(seen.trace.graph, seen.arguments[self.argument], spaces)

    def wrong_topic(self, default_run: LaunchRun, seen: LaunchRun, wanted: str) -> Observation:
        """With another topic given, one of the nodes does not use `wanted`, or the default topic is still used."""
        graph = seen.trace.graph
        still_used = sorted(shared_topics(default_run.trace.graph) & topics_in_use(graph))
        users = sorted(
            {endpoint.node for endpoint in (*publishers(graph), *subscriptions(graph)) if endpoint.topic in still_used}
        )
        unheard = not still_used and wanted in shared_topics(graph)
        return seen_in_launch(
            Symptom.WRONG_NAMES,
            seen,
            says=f"both nodes are on {wanted}, but nothing is sent there" if unheard else "",
            do="Start both by hand with this topic, and look at their output." if unheard else "",
            moves="topic",
            argument=self.argument,
            wanted=wanted,
            still_used=tuple(still_used),
            users=tuple(users),
        )


@dataclass(frozen=True)
class ArgumentMovesNamespace(Form):
    """With a launch argument that names a namespace, both nodes of a pair and their topic are under it.

    `argument`: its name. `and_topic`: a criterion whose argument is also given, in another launch; the topic that it
    names must then be under the namespace. `to`: the namespace that we give, and another for a launch file that puts
    everything into the first one by default. The exercise's program must be a `LaunchFile`:

        ArgumentMovesNamespace("namespace", "namespace", and_topic=topic, after=starts)
    """

    argument: str
    and_topic: ArgumentMovesTopic | None = None
    to: tuple[str, str] = ("robot1", "robot2")

    def criterion(self, exercise: Exercise) -> Criterion:
        file, topic, (first, other) = exercise.launch_file, self.and_topic, self.to
        return self.judged(
            self.judge,
            Launch(file),
            topic.launch(exercise) if topic is not None else None,
            LaunchWith(file, namespace=self.argument, to=first),
            LaunchWith(file, topic.argument, self.argument, first) if topic is not None else None,
            LaunchInAnother(LaunchWith(file, namespace=self.argument, to=other), first),
        )

    def judge(
        self,
        default_run: LaunchRun,
        elsewhere: LaunchRun | None,
        alone: LaunchRun,
        both: LaunchRun | None,
        another: LaunchRun | None = None,
    ) -> Verdict:
        """Judge launches with another topic (`elsewhere`), in the namespace, and with both, and one in another one.

        `another`: None unless everything is in the first one by default.
        """
        first, other = self.to
        within = pairs_in_namespace(alone.trace.graph, first)
        if another is not None:
            moved = pairs_in_namespace(another.trace.graph, other)
            if not (within and _has_moved(default_run, another, moved)):
                return self._outside(default_run, another)
        # Nodes that share no topic even without a namespace, or ignore the topic argument, fail other criteria.
        elif not self._is_inside(default_run, alone, connected=bool(shared_topics(default_run.trace.graph))):
            return self._outside(default_run, alone)
        given = f"with {alone.typed}"
        if self.and_topic is not None and elsewhere is not None and both is not None:
            given += ", alone and with a topic"
            name = both.arguments[self.and_topic.argument]
            connected = bool(self.and_topic.moved(default_run, elsewhere))
            if not self._is_inside(default_run, both, name, connected=connected):
                return self._outside(default_run, both, f"/{first}/{name}")
        expected = f"{given}, both nodes and the topic are under /{first}"
        return passed(expected, (both or alone).describe(), describe_pair(within[0]) if within else ())

    def _is_inside(self, default_run: LaunchRun, seen: LaunchRun, name: str = "", *, connected: bool) -> bool:
        """Whether a pair is in the first namespace, on the topic `name` if given.

        `connected`: whether it must share that topic, and its messages must arrive.
        """
        if not connected:
            return has_pair_in_namespace(seen.trace.graph, self.to[0])
        found = pairs_in_namespace(seen.trace.graph, self.to[0], name)
        return _has_moved(default_run, seen, found) and _has_messages(default_run, seen, found)

    def _outside(self, default_run: LaunchRun, seen: LaunchRun, topic: str = "the topic") -> Verdict:
        namespace = seen.arguments[self.argument]
        expected = f"with {seen.typed}, both nodes and {topic} are under /{namespace}"
        cause = self._wrong_namespace(default_run, seen, namespace)
        return failed(expected, seen.describe(), cause, output_tail(seen.trace))

    def _wrong_namespace(self, default_run: LaunchRun, seen: LaunchRun, namespace: str) -> Observation:
        """With a namespace given, one of the nodes or their topic is not in it."""
        endpoints = (*publishers(seen.trace.graph), *subscriptions(seen.trace.graph))
        under = f"/{namespace}/"
        within = {endpoint.node for endpoint in endpoints if endpoint.node.startswith(under)}
        topic = self.and_topic
        if topic is not None and topic.argument in seen.arguments and len(within) > 1:
            all_in = all(endpoint.node.startswith(under) and endpoint.topic.startswith(under) for endpoint in endpoints)
            if all_in and not any(is_namespace_doubled(endpoint.topic, namespace) for endpoint in endpoints):
                return topic.wrong_topic(default_run, seen, f"{under}{seen.arguments[topic.argument]}")
        return seen_in_launch(Symptom.WRONG_NAMES, seen, moves="namespace", argument=self.argument, wanted=namespace)


def _has_moved(default_run: LaunchRun, seen: LaunchRun, found: list[Pair]) -> bool:
    """Whether pairs were found, and at least one topic that is shared without arguments is no longer in use."""
    before = shared_topics(default_run.trace.graph)
    return bool(found) and (not before or bool(before - topics_in_use(seen.trace.graph)))


def _has_messages(default_run: LaunchRun, seen: LaunchRun, found: list[Pair]) -> bool:
    """Whether messages arrive on the pairs' topics, or none arrive even without arguments (judged elsewhere)."""
    if not any(default_run.trace.samples.values()):
        return True
    return any(publisher.topic in seen.hidden or bool(seen.trace.samples_on(publisher.topic)) for publisher, _ in found)

"""Causes between a publisher and a subscription: the name, the type, the QoS, or an inactive node."""

from __future__ import annotations

import ast
import difflib
from collections.abc import Iterable, Sequence
from dataclasses import replace

from tutor.judge.causes import names, period_slips, slips
from tutor.judge.causes.blocking import diagnose_blocked
from tutor.judge.causes.lifecycle import diagnose_lifecycle
from tutor.judge.causes.logged_exceptions import diagnose_logged_exception
from tutor.judge.causes.process import diagnose_no_answer, diagnose_process, node_names
from tutor.judge.causes.spinning import diagnose_spin_in_constructor, diagnose_untimed_spin_once
from tutor.judge.causes.unawaited import diagnose_unawaited
from tutor.judge.causes.uncalled import diagnose_awaited_service, diagnose_uncalled_setup
from tutor.judge.causes.unserved import diagnose_unserved
from tutor.judge.edits import (
    Edit,
    remove_keyword,
    replace_node,
    replace_nodes,
)
from tutor.judge.rewriting.node import NodeFile, argument, find_in_files, node_file, started_node
from tutor.judge.source import SourceFile
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.verdict import Cause
from tutor.ros_model import ServiceEndpoint, TopicEndpoint, incompatible_policies

_PUBLISH = "publish from a timer's callback, and keep the timer in self"


def diagnose_no_messages(
    trace: Trace, topic: str, type_name: str, *, answers: bool, stuck: Sequence[Frame] = (), step: str = ""
) -> Cause:
    """Why no message of `type_name` arrived on `topic`.

    `answers`: one of the learner's nodes answered a request; if none did, `stuck` is a stack dump. `step`: how to fix
    publisher, timer and callback as a whole, if the check knows.
    """
    if (cause := diagnose_process(trace) or diagnose_lifecycle(trace)) is not None:
        return cause
    publishers = trace.graph.publishers
    here = [endpoint for endpoint in publishers if endpoint.topic == topic]
    if any(endpoint.type == type_name for endpoint in here):
        if not answers:
            cause = diagnose_no_answer(trace, stuck)
            return replace(cause, hint=step) if step and cause == diagnose_blocked(trace, stuck) else cause
        return _diagnose_idle_publisher(trace, topic, step)
    if (cause := _diagnose_misplaced(trace, publishers, topic, type_name, "create_publisher")) is not None:
        # Another package's type of the same name has the same fields, in most cases: the import alone is wrong.
        suits = any(endpoint.topic == topic and _class(endpoint.type) == _class(type_name) for endpoint in publishers)
        return replace(cause, hint=step) if cause.name == names.WRONG_TYPE and step and not suits else cause
    file = started_node(trace)
    return (
        find_in_files(trace, slips.diagnose_bare_topic_names)
        or diagnose_spin_in_constructor(file)
        or diagnose_uncalled_setup(file, "create_publisher")
        or diagnose_awaited_service(trace)
        or Cause(
            "no publisher",
            f"{node_names(trace)} is up, but has no publisher on {topic}",
            step or f"create one in __init__: self.create_publisher({_class(type_name)}, '{topic}', 10)",
        )
    )


def _diagnose_idle_publisher(trace: Trace, topic: str, step: str) -> Cause:
    """Why an existing publisher sends nothing, or nothing more."""
    found = (
        diagnose_unawaited(trace) or diagnose_logged_exception(trace) or diagnose_unused_publisher(trace, topic, step)
    )
    seen = "it sends no more" if trace.samples_on(topic) else "nothing arrives from it"
    return found or Cause("no messages", f"there is a publisher on {topic}, but {seen}", step or _PUBLISH)


def diagnose_unused_publisher(trace: Trace, topic: str, step: str = "") -> Cause | None:
    """Whether the source shows why an existing publisher never sends anything: nothing calls it, or too rarely."""
    slip = (
        find_in_files(
            trace,
            period_slips.diagnose_period_unit,
            period_slips.diagnose_milliseconds,
            period_slips.diagnose_no_autostart,
            slips.diagnose_simulated_time,
        )
        or diagnose_unserved(trace)
        or find_in_files(trace, diagnose_spin_in_constructor, diagnose_untimed_spin_once)
    )
    file = started_node(trace)
    if (cause := slip or diagnose_uncalled_setup(file, "create_timer")) is not None:
        return cause
    if file.publisher and not file.calls("publish"):
        text = f"there is a publisher on {topic}, but nothing calls publish()"
    elif file.publisher and not file.timers:
        text = f"there is a publisher on {topic}, but no timer calls what publishes"
    else:
        return None
    return Cause("no messages", text, step or _PUBLISH)


def diagnose_nothing_received(
    trace: Trace, ours: TopicEndpoint, *, answers: bool, stuck: Sequence[Frame] = ()
) -> Cause:
    """Why the learner's node received nothing from our publisher `ours`; see `diagnose_no_messages` for the rest."""
    if (cause := diagnose_process(trace) or diagnose_lifecycle(trace)) is not None:
        return cause
    subscriptions = trace.graph.subscriptions
    here = [each for each in subscriptions if (each.topic, each.type) == (ours.topic, ours.type)]
    if here:
        mismatched = [cause for each in here if (cause := diagnose_incompatible_qos(ours, each)) is not None]
        if len(mismatched) == len(here):
            return replace(mismatched[0], hint=_use_plain_depth(trace, ours.topic) or mismatched[0].hint)
        if not answers:
            return diagnose_no_answer(trace, stuck)
        return diagnose_unserved(trace) or Cause(
            "callback does nothing",
            f"there is a subscription on {ours.topic}, but its messages have no effect",
            "is the right callback given to create_subscription, and the subscription kept in self?",
        )
    return (
        _diagnose_misplaced(trace, subscriptions, ours.topic, ours.type, "create_subscription")
        or find_in_files(trace, slips.diagnose_bare_topic_names, diagnose_spin_in_constructor)
        or diagnose_uncalled_setup(started_node(trace), "create_subscription")
        or Cause(
            "no subscription",
            f"{node_names(trace)} is up, but has no subscription on {ours.topic}",
            f"create one in __init__: self.create_subscription({_class(ours.type)}, '{ours.topic}', self.callback, 10)",
        )
    )


def _use_plain_depth(trace: Trace, topic: str) -> str | None:
    """The step that gives the subscription on `topic` the depth 10 for its QoS."""

    def in_file(file: NodeFile) -> str | None:
        made = [each for each in file.calls("create_subscription") if _may_name(argument(each, 1, "topic"), topic)]
        given = [qos for each in made if (qos := argument(each, 3, "qos_profile")) is not None]
        return file.step([replace_node(file.text, given[0], "10")]) if given else None

    return find_in_files(trace, in_file)


def _may_name(code: ast.expr | None, topic: str) -> bool:
    """Whether this expression may name the topic: unless it is a literal for another one, namespaces aside."""
    return not isinstance(code, ast.Constant) or f"/{topic}".endswith(f"/{code.value!s}")


def diagnose_incompatible_qos(publisher: TopicEndpoint, subscription: TopicEndpoint) -> Cause | None:
    """Whether the subscription requests more than the publisher offers, so that the two are not matched."""
    mismatch = next(incompatible_policies(publisher.qos, subscription.qos), None)
    if mismatch is None:
        return None
    return Cause(names.INCOMPATIBLE_QOS, f"on {publisher.topic} {mismatch}", mismatch.hint)


def diagnose_incompatible_service(services: Iterable[ServiceEndpoint]) -> Cause | None:
    """Whether one of the learner's service servers or clients has a QoS that the default does not match."""
    for service in services:
        for policy, own, unmatched, default in (
            ("reliability", service.reliability, "best_effort", "reliable"),
            ("durability", service.durability, "transient_local", "volatile"),
        ):
            if own == unmatched:
                return Cause(
                    names.INCOMPATIBLE_QOS,
                    f"{service.name} was made with {policy} {own}, but the other side is {default}, the default of "
                    "services: they are not connected",
                    "leave qos_profile out: the default of services is right",
                )
    return None


def use_default_service_qos(file: SourceFile) -> list[Edit]:
    """Edits that leave the QoS profile of services and service clients at its default."""
    calls = file.calls("create_service", "create_client")
    given = [each for each in calls if any(keyword.arg == "qos_profile" for keyword in each.keywords)]
    return [remove_keyword(file.text, each, "qos_profile") for each in given]


def diagnose_wrong_topic(
    endpoints: Iterable[TopicEndpoint], topic: str, create: str = "create_publisher", file: NodeFile | None = None
) -> Cause:
    """The endpoint exists under another name, from which the kind of mistake follows."""
    file = file or node_file("")
    found = sorted({endpoint.topic for endpoint in endpoints})
    name = min(found, key=lambda each: -difflib.SequenceMatcher(None, each, topic).ratio())
    verb = "go to" if create == "create_publisher" else "are taken from"
    return Cause(
        names.WRONG_TOPIC,
        f"messages of this type {verb} {', '.join(found)}, not {verb.split()[-1]} {topic}: "
        f"{_naming_mistake(name, topic)}",
        _rename_topic(file, create, topic, name) or f"use exactly '{topic}' in {create}",
    )


def _rename_topic(file: NodeFile, create: str, topic: str, name: str) -> str | None:
    """The step that corrects the topic in the line that creates the endpoint."""
    last = name.rsplit("/", 1)[-1]
    made = file.calls(create, create.replace("create_", "create_lifecycle_"))
    given = [topic_arg for each in made if (topic_arg := argument(each, 1, "topic")) is not None]
    literal = [each for each in given if isinstance(each, ast.Constant) and str(each.value).endswith(last)]
    return next(
        (step for each in literal or given if (step := file.step([replace_node(file.text, each, repr(topic))]))), None
    )


def _naming_mistake(name: str, wanted: str) -> str:
    if name.endswith(wanted):
        return (
            "it has a namespace or the node's name in front: a name that begins with ~ or has no / in front is relative"
        )
    if name.strip("/") == wanted.strip("/").replace("/", "_") or name.replace("/", "") == wanted.replace("/", ""):
        return "the slash between its parts is missing, or there is one too many"
    if wanted.endswith(name):
        return "the first part of the name is missing"
    if name.casefold() == wanted.casefold():
        return "upper and lower case make different names"
    return "the name is spelled differently"


def _diagnose_misplaced(
    trace: Trace, endpoints: Sequence[TopicEndpoint], topic: str, type_name: str, create: str
) -> Cause | None:
    here = [endpoint for endpoint in endpoints if endpoint.topic == topic]
    if here:
        return Cause(
            names.WRONG_TYPE,
            f"{topic} has the type {here[0].type}, not {type_name}",
            _replace_type(started_node(trace), here[0].type, type_name)
            or f"give {create} the type {_class(type_name)}: from {type_name.split('/')[0]}.msg import "
            f"{_class(type_name)}",
        )
    elsewhere = [endpoint for endpoint in endpoints if endpoint.type == type_name] or [
        endpoint for endpoint in endpoints if difflib.get_close_matches(endpoint.topic, [topic], cutoff=0.6)
    ]
    return diagnose_wrong_topic(elsewhere, topic, create, started_node(trace)) if elsewhere else None


def _replace_type(file: NodeFile, wrong: str, type_name: str) -> str | None:
    """The step that replaces a wrong message type throughout the file. The types are like "std_msgs/msg/String"."""
    own, imported = file.import_name(_class(type_name), _module(type_name))
    there = file.imported_name(_class(wrong), _module(wrong)) or _class(wrong)
    used = [each for each in file.nodes if isinstance(each, ast.Name | ast.Attribute) and ast.unparse(each) == there]
    return file.step([*imported, *replace_nodes(file.text, *((each, own) for each in used if there != own))])


def _module(type_name: str) -> str:
    return type_name.rpartition("/")[0].replace("/", ".")


def _class(type_name: str) -> str:
    return type_name.rsplit("/", 1)[-1]

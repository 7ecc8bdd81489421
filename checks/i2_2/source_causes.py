"""I2.2: what the launch file's source shows about a fault that was observed in the launch."""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence

from checks.i2_2 import steps
from checks.i2_2.facts import LaunchRun
from checks.i2_2.launch_file import Launch
from checks.i2_2.reading import Call, Source
from checks.i2_2.rewriting import prepend_to_list
from tutor.judge.causes.parameter_slips import diagnose_dropped_arguments
from tutor.judge.edits import remove_lines, replace_node, replace_nodes
from tutor.judge.rewriting.node import NodeFile, argument, find_in_files
from tutor.judge.verdict import Cause
from tutor.ros_model import Graph

_OWN_GROUP = "it only affects what comes after it in the same list"


def commands(source: Source) -> list[Call]:
    """The ExecuteProcess(...) calls, if the file uses no Node(...)."""
    used = [node for node in steps.nodes(source) if not node.kept or source.uses(node.kept)]
    return [] if used else source.calls("ExecuteProcess")


def diagnose_split_command(launch_file: Launch) -> Cause | None:
    """Find a command given as a single string, which launch takes for the name of a program."""
    source = launch_file.source
    for call in source.calls("ExecuteProcess"):
        try:
            words = ast.literal_eval(call.named.get("cmd", ""))
        except (SyntaxError, ValueError):
            continue
        if isinstance(words, list) and len(words) == 1 and " " in str(words[0]) and "shell" not in call.named:
            return Cause(
                "command in one piece",
                f"line {call.line}: cmd={call.named['cmd']} asks for a program that is called '{words[0]}', spaces "
                "included",
                steps.rewrite_launch_file(launch_file)
                or "\n".join(
                    f"line {each.line}: cmd={each.named['cmd'][2:-2].split()!r}"
                    for each in source.calls("ExecuteProcess")
                    if len(each.named.get("cmd", "").split(",")) == 1
                ),
            )
    return None


def _diagnose_command(launch_file: Launch, cause: str, rule: str) -> Cause | None:
    started = commands(launch_file.source)
    if not started:
        return None
    return Cause(
        cause,
        f"the command in line {started[0].line} has no remapping in it",
        f"in {_lines(started)}, at the end of cmd=[...]: '--ros-args', '-r', {rule}",
    )


def diagnose_topic_argument(launch_file: Launch, name: str) -> Cause | None:
    """Find how the file uses the topic argument, if not in a remapping from `name`."""
    source = launch_file.source
    if (
        cause := _diagnose_command(launch_file, "topic hard-coded", f"['{name}:=', {steps.value(source, 'topic')}]")
    ) is not None:
        return cause
    right, wanted = steps.remapping(source, name), steps.value(source, "topic")
    used = re.compile(rf"(?<!['\w]){re.escape(wanted)}(?!['\w])|LaunchConfiguration\('topic'")
    for node in steps.nodes(source):
        for keyword in ("parameters", "arguments", "ros_arguments"):
            if used.search(node.named.get(keyword, "")):
                what = "a parameter" if keyword == "parameters" else "an argument"
                return Cause(
                    f"topic given as {what}",
                    f"the Node in line {node.line} gets {keyword}={node.named[keyword]}: the program has no such "
                    f"{what.split()[-1]}, and keeps using '{name}'; a topic is renamed by a remapping",
                    steps.remap_nodes(launch_file, name, keyword) or right,
                )
    for node in steps.nodes(source):
        for keyword in ("arguments", "ros_arguments"):
            if ":=" in node.named.get(keyword, ""):
                return Cause(
                    "topic hard-coded",
                    f"the Node in line {node.line} has {keyword}={node.named[keyword]}: a fixed text, not the "
                    "argument's value",
                    steps.remap_nodes(launch_file, name, keyword) or right,
                )
    for call in source.calls("SetRemap"):
        return Cause(
            "remapping without effect",
            f"{call.where}: {_OWN_GROUP}, and other nodes keep their topic",
            steps.remap_nodes(launch_file, name) or right,
        )
    for node in steps.nodes(source):
        if "'topic'" in node.named.get("remappings", "") and not used.search(node.named["remappings"]):
            return Cause(
                "topic hard-coded",
                f"the Node in line {node.line} has remappings={node.named['remappings']}: 'topic' in quotation marks "
                "is the text topic, not the argument's value",
                steps.remap_nodes(launch_file, name) or right,
            )
    return None


def diagnose_namespace_argument(launch_file: Launch) -> Cause | None:
    """Find how the file uses the namespace argument, if not every node is in the namespace."""
    source = launch_file.source
    wanted = steps.value(source, "namespace")
    if (cause := _diagnose_command(launch_file, "namespace not used", f"['__ns:=/', {wanted}]")) is not None:
        return cause
    right = f"namespace={wanted}"
    pushed = next(iter(source.calls("PushRosNamespace", "PushROSNamespace")), None)
    if pushed is not None:
        return Cause(
            "namespace not used",
            f"{pushed.where}: {_OWN_GROUP}",
            steps.put_into_namespace(launch_file) or right,
        )
    used = re.compile(rf"(?<!['\w]){re.escape(wanted)}(?!['\w])|LaunchConfiguration\('namespace'")
    for node in steps.nodes(source):
        fixed = node.named.get("namespace", "")
        if fixed and not used.search(fixed):
            return Cause(
                "namespace not used",
                f"the Node in line {node.line} has namespace={fixed}, which is a fixed text",
                steps.put_into_namespace(launch_file) or right,
            )
        for keyword in ("parameters", "arguments", "ros_arguments", "name", "remappings"):
            if not fixed and used.search(node.named.get(keyword, "")):
                return Cause(
                    "namespace not used",
                    f"the Node in line {node.line} has the namespace in {keyword}={node.named[keyword]}: that does "
                    "not put the node into it",
                    steps.put_into_namespace(launch_file, keyword) or right,
                )
    return None


def diagnose_missing_node(launch_file: Launch, missing: str) -> Cause | None:
    """Find why a node that the file describes is not started. `missing`: "publisher" or "subscriber"."""
    source = launch_file.source
    for node in steps.nodes(source):
        if "condition" in node.named:
            return Cause(
                f"no {missing}",
                f"the Node in line {node.line} has condition={node.named['condition']}, which is not met",
                f"leave condition=... out of the Node in line {node.line}",
            )
        if node.kept and not source.uses(node.kept):
            description = next(iter(source.calls("LaunchDescription")), node)
            return Cause(
                f"no {missing}",
                f"{node.kept} (line {node.line}) is created, but is not in the list passed to LaunchDescription",
                launch_file.step(prepend_to_list(launch_file, node.kept))
                or f"put {node.kept} into the list in LaunchDescription([...]), line {description.line}",
            )
    for call in source.calls("OnProcessExit", "TimerAction", "OnExecutionComplete", "OnShutdown"):
        outer = next((each for each in source.calls("RegisterEventHandler") if call.code in each.code), call)
        inner = call.named.get("on_exit") or call.named.get("actions") or call.named.get("on_completion") or ""
        when = {
            "OnProcessExit": "only when another process has ended",
            "TimerAction": f"only after {call.argument(0, 'period')} s",
        }.get(call.name, "only later")
        return Cause(
            f"no {missing}",
            f"line {call.line}: the contents of {call.name} are started {when}",
            f"put {inner.strip('[]') or 'the node'} itself into the list in LaunchDescription([...]), instead of "
            f"{outer.name}(...) in line {outer.line}",
        )
    return None


def _lines(calls: Sequence[Call]) -> str:
    numbers = sorted({call.line for call in calls})
    return f"line{'s' if len(numbers) > 1 else ''} {' and '.join(map(str, numbers))}"


def diagnose_simulation_time(launch_file: Launch, graph: Graph, node: str) -> Cause | None:
    """Whether a node waits for the clock of a simulation that does not run."""
    if not any(each.topic == "/clock" and each.node == node for each in graph.subscriptions):
        return None
    if any(each.topic == "/clock" for each in graph.publishers):
        return None
    found = [value for each in launch_file.file.nodes if (value := _value_of(each, "use_sim_time")) is not None]
    step = launch_file.step(replace_nodes(launch_file.file.text, *((each, "False") for each in found)))
    text = f"{node} has use_sim_time set, so its timers wait for a simulator's /clock, and there is none"
    return Cause("simulated time", text, step or "set use_sim_time to False")


def _value_of(node: ast.AST, name: str) -> ast.expr | None:
    """The value given together with a name: in a dict, or as the next argument."""
    match node:
        case ast.Dict(keys=keys, values=values):
            pairs = list(zip(keys, values, strict=True))
        case ast.Call(args=[first, second]):
            pairs = [(first, second)]
        case _:
            return None
    return next((value for key, value in pairs if isinstance(key, ast.Constant) and key.value == name), None)


def diagnose_in_source(seen: LaunchRun, name: str) -> Cause | None:
    """Whether a program drops the arguments of ROS, or the launch file overwrites this one."""
    return find_in_files(
        seen.trace,
        diagnose_dropped_arguments,
        lambda file: _diagnose_set_argument(file, name),
        _diagnose_setting_in_group,
    )


def _diagnose_setting_in_group(file: NodeFile) -> Cause | None:
    """Whether a configuration is set in a group, which restores it at its end, and read outside of the group."""
    for group in file.calls("GroupAction"):
        inside = list(ast.walk(group))
        if any(each.arg == "scoped" for each in group.keywords):
            continue
        for call in (each for each in file.calls("SetLaunchConfiguration") if each in inside):
            name = argument(call, 0, "name")
            reads = [each for each in file.calls("LaunchConfiguration") if each not in inside and each.args]
            if name is None or not any(ast.unparse(each.args[0]) == ast.unparse(name) for each in reads):
                continue
            scoped = [*group.keywords, ast.keyword("scoped", ast.Constant(False))]
            step = file.step([replace_node(file.text, group, ast.unparse(ast.Call(group.func, group.args, scoped)))])
            text = f"line {call.lineno} sets {ast.unparse(name)} in a group, and the end of the group takes it back"
            return Cause("setting lost with its group", text, step) if step else None
    return None


def _diagnose_set_argument(file: NodeFile, name: str) -> Cause | None:
    """Whether the launch file itself sets the argument to a constant."""
    for call in file.calls("SetLaunchConfiguration"):
        given = [*call.args, *(each.value for each in call.keywords if each.arg in ("name", "value"))]
        has_condition = any(each.arg == "condition" for each in call.keywords)
        values = [each.value for each in given if isinstance(each, ast.Constant)]
        lines = file.text.splitlines()[call.lineno - 1 : call.end_lineno]
        alone = lines[0].strip().startswith("SetLaunchConfiguration(") and lines[-1].rstrip().endswith("),")
        if len(values) != 2 or values[0] != name or has_condition or not alone:
            continue
        step = file.step([remove_lines(file.text, call.lineno, call.end_lineno or 0)])
        text = (
            f"line {call.lineno} sets {name} for all that is evaluated from then on, such as actions of event handlers"
        )
        return Cause("argument overwritten", text, step) if step else None
    return None

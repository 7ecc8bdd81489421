"""I2.2: the next step in the words of the learner's own file: its lines, and the names that it gives to values.

The source only chooses the words; what is wrong has been seen of the launch.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence
from dataclasses import replace

from checks.i2_2.reading import Call, Source
from checks.i2_2.rewriting import (
    DEFAULTS,
    Launch,
    Program,
    add_node_argument,
    fix_imports,
    prepend_to_list,
    remove_exits,
    rename_argument,
    rename_function,
    replace_keyword,
    return_description,
    return_opaque_actions,
    rewrite_description,
)
from tutor.judge.edits import replace_node
from tutor.judge.rewriting.node import argument as argument_of
from tutor.judge.step_parsing import NotAnEdit, apply_step
from tutor.judge.verdict import Cause

_NO_IMPORT = re.compile(r"\b(?:ImportError|ModuleNotFoundError)\b")
_OWN_GROUP = "it acts on what comes after it in the same list only"


def nodes(source: Source) -> list[Call]:
    """Where the file describes its nodes."""
    return source.calls("Node", "LifecycleNode")


def rewrite_launch_file(there: Launch) -> str | None:
    """The step that rewrites the launch description, with the file's own programs, or with those of the demos."""
    return there.step(rewrite_description(there), rewrite_description(there, there.demo))


def with_applicable_step(there: Launch, cause: Cause, programs: Sequence[Program] = ()) -> Cause:
    """The cause with a step that can be followed: where it is in words, the launch description is rewritten."""
    try:
        apply_step(cause.hint, {there.path: there.file.text, **there.others})
    except NotAnEdit:
        step = there.step(fix_imports(there)) if _NO_IMPORT.search(cause.text) else None
        step = step or (there.step(rewrite_description(there, programs)) if programs else rewrite_launch_file(there))
        return replace(cause, hint=step or cause.hint)
    return cause


def value(source: Source, argument: str) -> str:
    """How the file calls the argument's value: its variable, or the substitution itself."""
    written = f"LaunchConfiguration('{argument}'"
    for target, set_to in source.assignments():
        if set_to.startswith(written) and set_to.endswith(")") and target.isidentifier():
            return target
    return f"{written})"


def declaration(argument: str) -> str:
    """The declaration that such an argument needs."""
    return f"DeclareLaunchArgument('{argument}', default_value='{DEFAULTS.get(argument, '')}')"


def diagnose_undeclared_argument(there: Launch, argument: str) -> Cause:
    """A launch configuration is read that is not there, or not yet."""
    source = there.source
    name = "launch argument not declared"
    early = next((call for call in source.calls("perform") if call.within == "generate_launch_description"), None)
    if early is not None:
        kept = f"{early.kept} = " if early.kept else ""
        return Cause(
            "value read too early",
            f"{early.where} asks for the value while the launch is only being described: there is none yet",
            rewrite_launch_file(there)
            or f"line {early.line}: {kept}{early.code.rpartition('.perform')[0]}, without .perform(...)",
        )
    declared = _declared(source, argument)
    listed = next(iter(source.calls("LaunchDescription")), None)
    where = f" (line {listed.line})" if listed else ""
    if not declared:
        others = [call for call in source.calls("DeclareLaunchArgument") if not _is_read(source, call)]
        text = f"LaunchConfiguration('{argument}') is read, but no argument '{argument}' is declared"
        if others:
            other = others[0].argument(0, "name")
            hint = _renamed(there, other.strip("'\""), argument) or f"name it '{argument}'"
            return Cause(name, f"{text}; line {others[0].line} declares {other}, which nothing reads", hint)
        every = [each for each in dict.fromkeys([argument, *_read_bare(source)]) if not _declared(source, each)]
        return Cause(
            name,
            text,
            there.step(prepend_to_list(there, *map(there.declaration, every)))
            or f"begin the list in LaunchDescription([...]){where} with: {', '.join(map(declaration, every))}",
        )
    made = declared[0]
    if made.kept and not source.uses(made.kept):
        left_out = [
            call.kept for call in source.calls("DeclareLaunchArgument") if call.kept and not source.uses(call.kept)
        ]
        return Cause(
            name,
            f"line {made.line} makes the argument '{argument}', but it is not in the launch description",
            there.step(prepend_to_list(there, *left_out))
            or f"begin the list in LaunchDescription([...]){where} with: {', '.join(left_out)}",
        )
    return Cause(
        name,
        f"the argument '{argument}' is declared (line {made.line}) after the nodes that read its value",
        f"move it to the front of the list in LaunchDescription([...]){where}: what is listed first is done first",
    )


def diagnose_missing_default(there: Launch, argument: str) -> Cause:
    """A declared argument has no default, and none was given."""
    bare = [call for call in there.calls("DeclareLaunchArgument") if argument_of(call, 1, "default_value") is None]
    names = [argument_of(call, 0, "name") for call in bare]
    edits = [
        replace_node(there.file.text, call, there.declaration(str(name.value)))
        for call, name in zip(bare, names, strict=True)
        if isinstance(name, ast.Constant)
    ]
    return Cause(
        "argument without a default",
        f"'{argument}' has no default_value, so that a launch without arguments is refused",
        there.step(edits) or declaration(argument),
    )


def _declared(source: Source, argument: str) -> list[Call]:
    return [call for call in source.calls("DeclareLaunchArgument") if call.argument(0, "name") == f"'{argument}'"]


def _read_bare(source: Source) -> list[str]:
    """The names that are read without a default of their own."""
    reads = [call for call in source.calls("LaunchConfiguration") if "default" not in call.named]
    return [call.argument(0, "variable_name").strip("'\"") for call in reads]


def step_for_other_program(there: Launch, keyword: str, wrong: str, right: str) -> str | None:
    """The step where a package or an executable is not called so, and `right` is."""
    return there.step(replace_keyword(there, keyword, wrong, right))


def step_for_empty_description(there: Launch) -> str | None:
    """The step where a launch description has nothing to start in it."""
    made = [node.kept for node in nodes(there.source) if node.kept and not there.source.uses(node.kept)]
    return there.step(
        remove_exits(there), return_opaque_actions(there), prepend_to_list(there, *made) if made else None
    )


def step_for_missing_return(there: Launch) -> str | None:
    """The step where generate_launch_description() returns nothing."""
    return there.step(return_description(there))


def step_for_other_function(there: Launch) -> str | None:
    """The step where no function is called generate_launch_description."""
    return there.step(rename_function(there))


def step_for_other_name(there: Launch, argument: str, others: Sequence[str]) -> str | None:
    """The step where an argument is called otherwise."""
    near = [other for other in others if len(others) == 1 or argument[:2] in other]
    return next((step for each in near if (step := _renamed(there, each, argument))), None)


def _renamed(there: Launch, other: str, right: str) -> str | None:
    return there.step(rename_argument(there, other, right))


def remap_nodes(there: Launch, name: str, *without: str) -> str | None:
    """The step that gives every node the remapping, and leaves out other arguments."""
    same = _declares(there, "topic") and len({each.topic for each in there.programs()}) < 2
    values = (value(there.source, "topic"), there.value("topic")) if same else ()
    return there.step(*(add_node_argument(there, "remappings", f"[('{name}', {each})]", *without) for each in values))


def put_into_namespace(there: Launch, *without: str) -> str | None:
    """The step that puts every node into the namespace, and leaves out other arguments."""
    values = (value(there.source, "namespace"), there.value("namespace")) if _declares(there, "namespace") else ()
    return there.step(*(add_node_argument(there, "namespace", each, *without) for each in values))


def _declares(there: Launch, argument: str) -> bool:
    return bool(there.declared(argument)) and not there.file.calls("PushRosNamespace", "PushROSNamespace", "SetRemap")


def step_for_early_text(there: Launch, name: str) -> str | None:
    """The step where a substitution was made part of a text."""
    source = there.source
    known = {target for target, set_to in source.assignments() if "LaunchConfiguration(" in set_to}
    for parts in source.texts():
        names = [part for part in parts if part in known or "LaunchConfiguration(" in part]
        if names:
            return remap_nodes(there, name)
    return None


def remapping(source: Source, name: str) -> str:
    """What every node is to be given."""
    return f"remappings=[('{name}', {value(source, 'topic')})]"


def with_own_names(source: Source, cause: Cause) -> Cause:
    """The cause with what the file calls these classes, and with the import of what it does not have yet."""
    missing = []

    def named(text: str) -> str:
        return _CLASS.sub(lambda found: source.own(found[0]), text)

    for name, module in _MODULES.items():
        known = source.own(name) != name or source.imports(name) or source.imports("*") or "import " in cause.hint
        if source.readable and not known and re.search(rf"(?<![\w.']){name}\(", cause.hint):
            missing.append(f"from {module} import {name}")
    top = f"\nat the top of the file: {'; '.join(missing)}" if missing else ""
    return Cause(cause.name, named(cause.text), named(cause.hint) + top)


_MODULES = {"LaunchConfiguration": "launch.substitutions", "DeclareLaunchArgument": "launch.actions"}
_CLASS = re.compile(r"(?<![\w.'])(?:LaunchConfiguration|DeclareLaunchArgument|LaunchDescription|Node|SetRemap)(?=\()")


def commands(source: Source) -> list[Call]:
    """The processes that are started by a command instead of a Node(...)."""
    used = [node for node in nodes(source) if not node.kept or source.uses(node.kept)]
    return [] if used else source.calls("ExecuteProcess")


def diagnose_split_command(there: Launch) -> Cause | None:
    """Whether a command is given as one text, which is taken for the name of a program."""
    source = there.source
    for call in source.calls("ExecuteProcess"):
        try:
            words = ast.literal_eval(call.named.get("cmd", ""))
        except (SyntaxError, ValueError):
            continue
        if isinstance(words, list) and len(words) == 1 and " " in str(words[0]) and "shell" not in call.named:
            return Cause(
                "command in one piece",
                f"line {call.line}: cmd={call.named['cmd']} asks for a program that is called '{words[0]}', blanks "
                "included",
                rewrite_launch_file(there)
                or "\n".join(
                    f"line {each.line}: cmd={each.named['cmd'][2:-2].split()!r}"
                    for each in source.calls("ExecuteProcess")
                    if len(each.named.get("cmd", "").split(",")) == 1
                ),
            )
    return None


def _diagnose_command(there: Launch, cause: str, rule: str) -> Cause | None:
    started = commands(there.source)
    if not started:
        return None
    return Cause(
        cause,
        f"the command in line {started[0].line} has no remapping in it",
        f"in {_lines(started)}, at the end of cmd=[...]: '--ros-args', '-r', {rule}",
    )


def diagnose_topic_argument(there: Launch, name: str) -> Cause | None:
    """What the file does with the topic, where nothing of it reaches a node as a remapping from `name`."""
    source = there.source
    if (cause := _diagnose_command(there, "topic hard-coded", f"['{name}:=', {value(source, 'topic')}]")) is not None:
        return cause
    right, wanted = remapping(source, name), value(source, "topic")
    used = re.compile(rf"(?<!['\w]){re.escape(wanted)}(?!['\w])|LaunchConfiguration\('topic'")
    for node in nodes(source):
        for keyword in ("parameters", "arguments", "ros_arguments"):
            if used.search(node.named.get(keyword, "")):
                what = "a parameter" if keyword == "parameters" else "an argument"
                return Cause(
                    f"topic given as {what}",
                    f"the Node in line {node.line} gets {keyword}={node.named[keyword]}: the program knows no such "
                    f"{what.split()[-1]}, and goes on using '{name}'; a topic gets another name by a remapping",
                    remap_nodes(there, name, keyword) or right,
                )
    for node in nodes(source):
        for keyword in ("arguments", "ros_arguments"):
            if ":=" in node.named.get(keyword, ""):
                return Cause(
                    "topic hard-coded",
                    f"the Node in line {node.line} has {keyword}={node.named[keyword]}: a fixed text, not the "
                    "argument's value",
                    remap_nodes(there, name, keyword) or right,
                )
    for call in source.calls("SetRemap"):
        return Cause(
            "remapping without effect",
            f"{call.where}: {_OWN_GROUP}, and a node that is not there keeps its topic",
            remap_nodes(there, name) or right,
        )
    for node in nodes(source):
        if "'topic'" in node.named.get("remappings", "") and not used.search(node.named["remappings"]):
            return Cause(
                "topic hard-coded",
                f"the Node in line {node.line} has remappings={node.named['remappings']}: 'topic' in quotation marks "
                "is the text topic, not the argument's value",
                remap_nodes(there, name) or right,
            )
    return None


def diagnose_namespace_argument(there: Launch) -> Cause | None:
    """What the file does with the namespace, where not every node is in it."""
    source = there.source
    wanted = value(source, "namespace")
    if (cause := _diagnose_command(there, "namespace not used", f"['__ns:=/', {wanted}]")) is not None:
        return cause
    right = f"namespace={wanted}"
    pushed = next(iter(source.calls("PushRosNamespace", "PushROSNamespace")), None)
    if pushed is not None:
        return Cause(
            "namespace not used",
            f"{pushed.where}: {_OWN_GROUP}",
            put_into_namespace(there) or right,
        )
    used = re.compile(rf"(?<!['\w]){re.escape(wanted)}(?!['\w])|LaunchConfiguration\('namespace'")
    for node in nodes(source):
        fixed = node.named.get("namespace", "")
        if fixed and not used.search(fixed):
            return Cause(
                "namespace not used",
                f"the Node in line {node.line} has namespace={fixed}, which is a fixed text",
                put_into_namespace(there) or right,
            )
        for keyword in ("parameters", "arguments", "ros_arguments", "name", "remappings"):
            if not fixed and used.search(node.named.get(keyword, "")):
                return Cause(
                    "namespace not used",
                    f"the Node in line {node.line} has the namespace in {keyword}={node.named[keyword]}: that puts no "
                    "node into it",
                    put_into_namespace(there, keyword) or right,
                )
    return None


def diagnose_missing_node(there: Launch, wanted: str) -> Cause | None:
    """Why one of the nodes that the file describes, the `wanted` one, is not started."""
    source = there.source
    for node in nodes(source):
        if "condition" in node.named:
            return Cause(
                f"no {wanted}",
                f"the Node in line {node.line} has condition={node.named['condition']}, which is not met",
                f"leave condition=... out of the Node in line {node.line}",
            )
        if node.kept and not source.uses(node.kept):
            listed = next(iter(source.calls("LaunchDescription")), node)
            return Cause(
                f"no {wanted}",
                f"{node.kept} (line {node.line}) is described, but is not in the list that LaunchDescription is given",
                there.step(prepend_to_list(there, node.kept))
                or f"put {node.kept} into the list in LaunchDescription([...]), line {listed.line}",
            )
    for call in source.calls("OnProcessExit", "TimerAction", "OnExecutionComplete", "OnShutdown"):
        outer = next((each for each in source.calls("RegisterEventHandler") if call.code in each.code), call)
        inner = call.named.get("on_exit") or call.named.get("actions") or call.named.get("on_completion") or ""
        when = {
            "OnProcessExit": "only when another process has ended",
            "TimerAction": f"only after {call.argument(0, 'period')} s",
        }.get(call.name, "only later")
        return Cause(
            f"no {wanted}",
            f"line {call.line}: what {call.name} holds is started {when}",
            f"put {inner.strip('[]') or 'the node'} itself into the list in LaunchDescription([...]), instead of "
            f"{outer.name}(...) in line {outer.line}",
        )
    return None


def _lines(calls: Sequence[Call]) -> str:
    numbers = sorted({call.line for call in calls})
    return f"line{'s' if len(numbers) > 1 else ''} {' and '.join(map(str, numbers))}"


def _is_read(source: Source, declared: Call) -> bool:
    argument = declared.argument(0, "name")
    return any(call.argument(0, "variable_name") == argument for call in source.calls("LaunchConfiguration"))

"""I2.2: next steps that refer to lines and names of the learner's own file.

The source only determines the wording; the fault itself was observed in the launch.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Sequence
from dataclasses import replace

from checks.i2_2.reading import Call, Source, summands
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
from tutor.judge.edits import Edit, replace_node, replace_nodes
from tutor.judge.rewriting.node import argument as argument_of
from tutor.judge.step_parsing import NotAnEdit, apply_step
from tutor.judge.verdict import Cause

_NO_IMPORT = re.compile(r"\b(?:ImportError|ModuleNotFoundError)\b")
_OWN_GROUP = "it only affects what comes after it in the same list"


def nodes(source: Source) -> list[Call]:
    """The calls that describe a node."""
    return source.calls("Node", "LifecycleNode")


def rewrite_launch_file(launch_file: Launch) -> str | None:
    """The step that rewrites the launch description, with the file's own programs or else with the demo nodes."""
    return launch_file.step(rewrite_description(launch_file), rewrite_description(launch_file, launch_file.demo))


def with_applicable_step(launch_file: Launch, cause: Cause, programs: Sequence[Program] = ()) -> Cause:
    """The cause with a hint that is an edit: a hint in prose is replaced by a rewritten launch description."""
    try:
        apply_step(cause.hint, {launch_file.path: launch_file.file.text, **launch_file.others})
    except NotAnEdit:
        step = launch_file.step(fix_imports(launch_file)) if _NO_IMPORT.search(cause.text) else None
        step = step or (
            launch_file.step(rewrite_description(launch_file, programs))
            if programs
            else rewrite_launch_file(launch_file)
        )
        return replace(cause, hint=step or cause.hint)
    return cause


def value(source: Source, argument: str) -> str:
    """The file's expression for the argument's value: a variable, or the substitution itself."""
    written = f"LaunchConfiguration('{argument}'"
    for target, set_to in source.assignments():
        if set_to.startswith(written) and set_to.endswith(")") and target.isidentifier():
            return target
    return f"{written})"


def declaration(argument: str) -> str:
    """The code that declares the argument."""
    return f"DeclareLaunchArgument('{argument}', default_value='{DEFAULTS.get(argument, '')}')"


def diagnose_undeclared_argument(launch_file: Launch, argument: str) -> Cause:
    """The cause where a launch configuration is read that does not exist, or does not exist yet."""
    source = launch_file.source
    name = "launch argument not declared"
    early = next((call for call in source.calls("perform") if call.within == "generate_launch_description"), None)
    if early is not None:
        kept = f"{early.kept} = " if early.kept else ""
        return Cause(
            "value read too early",
            f"{early.where} asks for the value while the launch is only being described: there is none yet",
            rewrite_launch_file(launch_file)
            or f"line {early.line}: {kept}{early.code.rpartition('.perform')[0]}, without .perform(...)",
        )
    declared = _find_declarations(source, argument)
    description = next(iter(source.calls("LaunchDescription")), None)
    where = f" (line {description.line})" if description else ""
    if not declared:
        others = [call for call in source.calls("DeclareLaunchArgument") if not _is_read(source, call)]
        text = f"LaunchConfiguration('{argument}') is read, but no argument '{argument}' is declared"
        if others:
            other = others[0].argument(0, "name")
            hint = _rename_argument(launch_file, other.strip("'\""), argument) or f"name it '{argument}'"
            return Cause(name, f"{text}; line {others[0].line} declares {other}, which nothing reads", hint)
        undeclared = [
            each
            for each in dict.fromkeys([argument, *_names_without_default(source)])
            if not _find_declarations(source, each)
        ]
        return Cause(
            name,
            text,
            launch_file.step(prepend_to_list(launch_file, *map(launch_file.declaration, undeclared)))
            or f"begin the list in LaunchDescription([...]){where} with: {', '.join(map(declaration, undeclared))}",
        )
    made = declared[0]
    if made.kept and not source.uses(made.kept):
        left_out = [
            call.kept for call in source.calls("DeclareLaunchArgument") if call.kept and not source.uses(call.kept)
        ]
        return Cause(
            name,
            f"line {made.line} makes the argument '{argument}', but it is not in the launch description",
            launch_file.step(prepend_to_list(launch_file, *left_out))
            or f"begin the list in LaunchDescription([...]){where} with: {', '.join(left_out)}",
        )
    return Cause(
        name,
        f"the argument '{argument}' is declared (line {made.line}) after the nodes that read its value",
        f"move it to the front of the list in LaunchDescription([...]){where}: its entries are executed in order",
    )


def diagnose_missing_default(launch_file: Launch, argument: str) -> Cause:
    """The cause where a declared argument has no default, and no value was given."""
    bare = [
        call for call in launch_file.calls("DeclareLaunchArgument") if argument_of(call, 1, "default_value") is None
    ]
    names = [argument_of(call, 0, "name") for call in bare]
    edits = [
        replace_node(launch_file.file.text, call, launch_file.declaration(str(name.value)))
        for call, name in zip(bare, names, strict=True)
        if isinstance(name, ast.Constant)
    ]
    return Cause(
        "argument without a default",
        f"'{argument}' has no default_value, so that a launch without arguments is refused",
        launch_file.step(edits) or declaration(argument),
    )


def _find_declarations(source: Source, argument: str) -> list[Call]:
    return [call for call in source.calls("DeclareLaunchArgument") if call.argument(0, "name") == f"'{argument}'"]


def _names_without_default(source: Source) -> list[str]:
    """The names that are read without a default in the LaunchConfiguration."""
    reads = [call for call in source.calls("LaunchConfiguration") if "default" not in call.named]
    return [call.argument(0, "variable_name").strip("'\"") for call in reads]


def rename_program(launch_file: Launch, keyword: str, wrong: str, right: str) -> str | None:
    """The step that replaces the name of a package or an executable by `right`."""
    return launch_file.step(replace_keyword(launch_file, keyword, wrong, right))


def step_for_empty_description(launch_file: Launch) -> str | None:
    """The step where the launch description is empty."""
    made = [node.kept for node in nodes(launch_file.source) if node.kept and not launch_file.source.uses(node.kept)]
    return launch_file.step(
        remove_exits(launch_file),
        return_opaque_actions(launch_file),
        prepend_to_list(launch_file, *made) if made else None,
    )


def add_return(launch_file: Launch) -> str | None:
    """The step that makes generate_launch_description() return the description."""
    return launch_file.step(return_description(launch_file))


def rename_launch_function(launch_file: Launch) -> str | None:
    """The step that names the function generate_launch_description, if none is called that."""
    return launch_file.step(rename_function(launch_file))


def rename_similar_argument(launch_file: Launch, argument: str, others: Sequence[str]) -> str | None:
    """The step that renames a similar argument among `others` to `argument`."""
    near = [other for other in others if len(others) == 1 or argument[:2] in other]
    return next((step for each in near if (step := _rename_argument(launch_file, each, argument))), None)


def _rename_argument(launch_file: Launch, other: str, right: str) -> str | None:
    return launch_file.step(rename_argument(launch_file, other, right))


def remap_nodes(launch_file: Launch, name: str, *without: str) -> str | None:
    """The step that gives every node the remapping from `name`, and drops the arguments in `without`."""
    same = _declares(launch_file, "topic") and len({each.topic for each in launch_file.programs()}) < 2
    values = (value(launch_file.source, "topic"), launch_file.value("topic")) if same else ()
    return launch_file.step(
        *(add_node_argument(launch_file, "remappings", f"[('{name}', {each})]", *without) for each in values)
    )


def put_into_namespace(launch_file: Launch, *without: str) -> str | None:
    """The step that puts every node into the namespace, and drops the arguments in `without`."""
    values = (
        (value(launch_file.source, "namespace"), launch_file.value("namespace"))
        if _declares(launch_file, "namespace")
        else ()
    )
    return launch_file.step(*(add_node_argument(launch_file, "namespace", each, *without) for each in values))


def _declares(launch_file: Launch, argument: str) -> bool:
    return bool(launch_file.declared(argument)) and not launch_file.file.calls(
        "PushRosNamespace", "PushROSNamespace", "SetRemap"
    )


def step_for_early_text(launch_file: Launch, name: str) -> str | None:
    """The step where a substitution was made part of a string."""
    source = launch_file.source
    known = {target for target, set_to in source.assignments() if "LaunchConfiguration(" in set_to}
    if (step := launch_file.step(_lists_instead_of_sums(launch_file, known))) is not None:
        return step
    for parts in source.texts():
        names = [part for part in parts if part in known or "LaunchConfiguration(" in part]
        if names:
            return remap_nodes(launch_file, name)
    return None


def _lists_instead_of_sums(launch_file: Launch, substitutions: Collection[str]) -> list[Edit]:
    """Make lists of sums of text and substitutions outside the description of a node, such as in a LogInfo."""
    file = launch_file.file
    within = {id(each) for call in file.calls("Node", "LifecycleNode") for each in ast.walk(call)}
    swaps: list[tuple[ast.expr, str]] = []
    for each in file.nodes:
        if not isinstance(each, ast.BinOp) or isinstance(next(file.ancestors(each), None), ast.BinOp):
            continue
        parts = summands(each)
        has_substitution = any(part in substitutions or "LaunchConfiguration(" in part for part in parts)
        if has_substitution and id(each) not in within:
            swaps.append((each, f"[{', '.join(parts)}]"))
    return replace_nodes(file.text, *swaps)


def remapping(source: Source, name: str) -> str:
    """The keyword argument that every node needs for the remapping from `name`."""
    return f"remappings=[('{name}', {value(source, 'topic')})]"


def with_own_names(source: Source, cause: Cause) -> Cause:
    """The cause with the file's own names for classes, and with the imports that the file lacks."""
    missing = []

    def with_own(text: str) -> str:
        return _CLASS_NAME.sub(lambda found: source.own(found[0]), text)

    for name, module in _MODULES.items():
        known = source.own(name) != name or source.imports(name) or source.imports("*") or "import " in cause.hint
        if source.readable and not known and re.search(rf"(?<![\w.']){name}\(", cause.hint):
            missing.append(f"from {module} import {name}")
    imports = f"\nat the top of the file: {'; '.join(missing)}" if missing else ""
    return Cause(cause.name, with_own(cause.text), with_own(cause.hint) + imports)


_MODULES = {"LaunchConfiguration": "launch.substitutions", "DeclareLaunchArgument": "launch.actions"}
_CLASS_NAME = re.compile(
    r"(?<![\w.'])(?:LaunchConfiguration|DeclareLaunchArgument|LaunchDescription|Node|SetRemap)(?=\()"
)


def commands(source: Source) -> list[Call]:
    """The ExecuteProcess(...) calls, if the file uses no Node(...)."""
    used = [node for node in nodes(source) if not node.kept or source.uses(node.kept)]
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
                rewrite_launch_file(launch_file)
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
        cause := _diagnose_command(launch_file, "topic hard-coded", f"['{name}:=', {value(source, 'topic')}]")
    ) is not None:
        return cause
    right, wanted = remapping(source, name), value(source, "topic")
    used = re.compile(rf"(?<!['\w]){re.escape(wanted)}(?!['\w])|LaunchConfiguration\('topic'")
    for node in nodes(source):
        for keyword in ("parameters", "arguments", "ros_arguments"):
            if used.search(node.named.get(keyword, "")):
                what = "a parameter" if keyword == "parameters" else "an argument"
                return Cause(
                    f"topic given as {what}",
                    f"the Node in line {node.line} gets {keyword}={node.named[keyword]}: the program has no such "
                    f"{what.split()[-1]}, and keeps using '{name}'; a topic is renamed by a remapping",
                    remap_nodes(launch_file, name, keyword) or right,
                )
    for node in nodes(source):
        for keyword in ("arguments", "ros_arguments"):
            if ":=" in node.named.get(keyword, ""):
                return Cause(
                    "topic hard-coded",
                    f"the Node in line {node.line} has {keyword}={node.named[keyword]}: a fixed text, not the "
                    "argument's value",
                    remap_nodes(launch_file, name, keyword) or right,
                )
    for call in source.calls("SetRemap"):
        return Cause(
            "remapping without effect",
            f"{call.where}: {_OWN_GROUP}, and other nodes keep their topic",
            remap_nodes(launch_file, name) or right,
        )
    for node in nodes(source):
        if "'topic'" in node.named.get("remappings", "") and not used.search(node.named["remappings"]):
            return Cause(
                "topic hard-coded",
                f"the Node in line {node.line} has remappings={node.named['remappings']}: 'topic' in quotation marks "
                "is the text topic, not the argument's value",
                remap_nodes(launch_file, name) or right,
            )
    return None


def diagnose_namespace_argument(launch_file: Launch) -> Cause | None:
    """Find how the file uses the namespace argument, if not every node is in the namespace."""
    source = launch_file.source
    wanted = value(source, "namespace")
    if (cause := _diagnose_command(launch_file, "namespace not used", f"['__ns:=/', {wanted}]")) is not None:
        return cause
    right = f"namespace={wanted}"
    pushed = next(iter(source.calls("PushRosNamespace", "PushROSNamespace")), None)
    if pushed is not None:
        return Cause(
            "namespace not used",
            f"{pushed.where}: {_OWN_GROUP}",
            put_into_namespace(launch_file) or right,
        )
    used = re.compile(rf"(?<!['\w]){re.escape(wanted)}(?!['\w])|LaunchConfiguration\('namespace'")
    for node in nodes(source):
        fixed = node.named.get("namespace", "")
        if fixed and not used.search(fixed):
            return Cause(
                "namespace not used",
                f"the Node in line {node.line} has namespace={fixed}, which is a fixed text",
                put_into_namespace(launch_file) or right,
            )
        for keyword in ("parameters", "arguments", "ros_arguments", "name", "remappings"):
            if not fixed and used.search(node.named.get(keyword, "")):
                return Cause(
                    "namespace not used",
                    f"the Node in line {node.line} has the namespace in {keyword}={node.named[keyword]}: that does "
                    "not put the node into it",
                    put_into_namespace(launch_file, keyword) or right,
                )
    return None


def diagnose_missing_node(launch_file: Launch, missing: str) -> Cause | None:
    """Find why a node that the file describes is not started. `missing`: "publisher" or "subscriber"."""
    source = launch_file.source
    for node in nodes(source):
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


def _is_read(source: Source, declared: Call) -> bool:
    argument = declared.argument(0, "name")
    return any(call.argument(0, "variable_name") == argument for call in source.calls("LaunchConfiguration"))

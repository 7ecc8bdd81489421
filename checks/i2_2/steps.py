"""I2.2: the next step in the words of the learner's own file: its lines, and the names that it gives to values.

The source only chooses the words; what is wrong has been seen of the launch.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Sequence

from tutor.judge.reading import Call, Source
from tutor.judge.verdict import Cause

DEFAULTS = {"topic": "chatter", "namespace": ""}
_OWN_GROUP = "it acts on what comes after it in the same list only"


def nodes(source: Source) -> list[Call]:
    """Where the file describes its nodes."""
    return source.calls("Node", "LifecycleNode")


def value(source: Source, argument: str) -> str:
    """How the file calls the argument's value: its variable, or the substitution itself."""
    written = f"LaunchConfiguration('{argument}'"
    for each in source.assignments():
        if each.value.startswith(written) and each.value.endswith(")") and each.target.isidentifier():
            return each.target
    return f"{written})"


def declaration(argument: str) -> str:
    """The declaration that such an argument needs."""
    return f"DeclareLaunchArgument('{argument}', default_value='{DEFAULTS.get(argument, '')}')"


def undeclared(source: Source, argument: str) -> Cause:
    """A launch configuration is read that is not there, or not yet."""
    name = "launch argument not declared"
    early = next((call for call in source.calls("perform") if call.within == "generate_launch_description"), None)
    if early is not None:
        kept = f"{early.kept} = " if early.kept else ""
        return Cause(
            "value read too early",
            f"{early.where} asks for the value while the launch is only being described: there is none yet",
            f"line {early.line}: {kept}{early.code.rpartition('.perform')[0]}, without .perform(...)",
        )
    declared = _declared(source, argument)
    listed = next(iter(source.calls("LaunchDescription")), None)
    where = f" (line {listed.line})" if listed else ""
    if not declared:
        others = [call for call in source.calls("DeclareLaunchArgument") if not _is_read(source, call)]
        text = f"LaunchConfiguration('{argument}') is read, but no argument '{argument}' is declared"
        if others:
            other = others[0].argument(0, "name")
            hint = others[0].instead(other, repr(argument))
            return Cause(name, f"{text}; line {others[0].line} declares {other}, which nothing reads", hint)
        every = [each for each in dict.fromkeys([argument, *_read_bare(source)]) if not _declared(source, each)]
        return Cause(
            name,
            text,
            f"begin the list in LaunchDescription([...]){where} with: {', '.join(map(declaration, every))}",
        )
    made = declared[0]
    if made.kept and not source.uses(made.kept):
        left_out = [
            call.kept for call in source.calls("DeclareLaunchArgument") if call.kept and not source.uses(call.kept)
        ]
        return Cause(
            name,
            f"line {made.line} makes the argument '{argument}', but it is not in the launch description",
            f"begin the list in LaunchDescription([...]){where} with: {', '.join(left_out)}",
        )
    return Cause(
        name,
        f"the argument '{argument}' is declared (line {made.line}) after the nodes that read its value",
        f"move {_late(source, made)} to the front of the list in LaunchDescription([...]){where}: what is "
        "listed first is done first",
    )


def without_default(source: Source, argument: str) -> Cause:
    """A declared argument has no default, and none was given."""
    bare = [call for call in source.calls("DeclareLaunchArgument") if "default_value" not in call.named]
    short = [(call.line, call.argument(0, "name").strip("'\"")) for call in bare if len(call.given) < 2]
    return Cause(
        "argument without a default",
        f"'{argument}' has no default_value, so that a launch without arguments is refused",
        "\n".join(f"line {line}: {declaration(name)}" for line, name in short) or declaration(argument),
    )


def _declared(source: Source, argument: str) -> list[Call]:
    return [call for call in source.calls("DeclareLaunchArgument") if call.argument(0, "name") == f"'{argument}'"]


def _read_bare(source: Source) -> list[str]:
    """The names that are read without a default of their own."""
    reads = [call for call in source.calls("LaunchConfiguration") if "default" not in call.named]
    return [call.argument(0, "variable_name").strip("'\"") for call in reads]


def _late(source: Source, made: Call) -> str:
    """All declarations that are listed after a node, each as it is called there."""
    order = " ".join(call.code for call in source.calls("LaunchDescription", "add_action"))

    def place(call: Call) -> int:
        found = re.search(rf"\b{re.escape(call.kept)}\b", order) if call.kept else None
        return found.start() if found else order.find(call.code)

    first = min((place(node) for node in nodes(source) if place(node) >= 0), default=0)
    late = [call for call in source.calls("DeclareLaunchArgument") if place(call) > first]
    return " and ".join(call.kept or call.code for call in late or [made])


def no_program(source: Source, keyword: str, wrong: str, right: str) -> str | None:
    """The step where a package or an executable is not called so, and `right` is."""
    for node in source.calls("Node", "LifecycleNode", "ExecuteProcess", "ComposableNode"):
        if node.named.get(keyword, "").strip("'\"") == wrong and right:
            return f"in the Node in line {node.line}: {keyword}='{right}'"
    return None


def nothing_listed(source: Source) -> str | None:
    """The step where a launch description has nothing to start in it."""
    for call in source.calls("OpaqueFunction"):
        name = call.argument(0, "function").rpartition(".")[2]
        return f"line {call.line}: let {name if name.isidentifier() else 'the function'} return the list of nodes"
    made = [node.kept for node in nodes(source) if node.kept and not source.uses(node.kept)]
    listed = next(iter(source.calls("LaunchDescription")), None)
    if not made or listed is None:
        return None
    return f"line {listed.line}: put {' and '.join(made)} into the list in LaunchDescription([...])"


def not_returned(source: Source) -> str | None:
    """The step where generate_launch_description() returns nothing."""
    made = next(iter(source.calls("LaunchDescription")), None)
    if made is None:
        return None
    if made.kept:
        return f"end generate_launch_description() with: return {made.kept}"
    return f"line {made.line}: put return in front of LaunchDescription([...])"


def other_name(source: Source, argument: str, others: Sequence[str]) -> str | None:
    """The step where an argument is called otherwise."""
    for other in others:
        lines = [
            str(call.line)
            for call in source.calls("DeclareLaunchArgument", "LaunchConfiguration")
            if call.given and call.given[0] == f"'{other}'"
        ]
        if lines and (len(others) == 1 or argument[:2] in other):
            return f"write '{argument}' instead of '{other}', in line {' and '.join(lines)}"
    return None


def text_too_early(source: Source) -> str | None:
    """The step where a substitution was made part of a text."""
    known = {each.target for each in source.assignments() if "LaunchConfiguration(" in each.value}
    for each in source.texts():
        names = [part for part in each.parts if part in known or "LaunchConfiguration(" in part]
        if names:
            # In a namespace, a name with a slash in front would stay outside.
            alone = names[0] if list(each.parts) == ["'/'", names[0]] else f"[{', '.join(each.parts)}]"
            return f"line {each.line}: write {alone} instead of {each.code}"
    return None


def remapping(source: Source, name: str) -> str:
    """What every node is to be given."""
    return f"remappings=[('{name}', {value(source, 'topic')})]"


def right_remapping(source: Source, name: str) -> str:
    """The step where a remapping is there, but not the right one."""
    call = next(iter(source.calls("SetRemap")), None)
    if call is not None:
        return f"line {call.line}: {call.name}('{name}', {value(source, 'topic')})"
    right = remapping(source, name)
    rights = (right, f"remappings=[('{name}', LaunchConfiguration('topic'))]")
    wrong = [node for node in nodes(source) if f"remappings={node.named.get('remappings')}" not in rights]
    return f"in {_lines(wrong or nodes(source), 'remappings')}: {right}"


def pairs(source: Source) -> str | None:
    """The step where remappings are given that are no list of pairs."""
    found = []
    for node in nodes(source):
        written = node.named.get("remappings", "")
        right = _as_pairs(written)
        if right not in (written, ""):
            found.append(f"line {node.lines['remappings']}: remappings={right}")
    return "\n".join(dict.fromkeys(found)) or None


def _as_pairs(written: str) -> str:
    """A list of pairs in round brackets, of what seems to be meant as one; empty where it is not clear what is."""
    try:
        given = ast.parse(written, mode="eval").body
    except SyntaxError:
        return ""
    match given:
        case ast.Dict(keys=keys, values=values):
            made = list(zip(keys, values, strict=True))
        case ast.List(elts=elements) | ast.Tuple(elts=elements):
            inner = [each.elts for each in elements if isinstance(each, ast.List | ast.Tuple) and len(each.elts) == 2]
            if len(inner) == len(elements):
                made = [(first, second) for first, second in inner]
            elif len(elements) == 2 and not inner:
                made = [(elements[0], elements[1])]
            else:
                return ""
        case _:
            return ""
    return f"[{', '.join(f'({ast.unparse(old)}, {ast.unparse(new)})' for old, new in made if old is not None)}]"


def in_own_names(source: Source, cause: Cause) -> Cause:
    """The cause with what the file calls these classes, and with the import of what it does not have yet."""
    missing = []

    def named(text: str) -> str:
        return _CLASS.sub(lambda found: source.own(found[0]), text)

    for name, module in _MODULES.items():
        known = source.own(name) != name or source.imports(name) or source.imports("*")
        if source.text and not known and re.search(rf"(?<![\w.']){name}\(", cause.hint):
            missing.append(f"from {module} import {name}")
    top = f"\nat the top of the file: {'; '.join(missing)}" if missing else ""
    return Cause(cause.name, named(cause.text), named(cause.hint) + top)


_MODULES = {"LaunchConfiguration": "launch.substitutions", "DeclareLaunchArgument": "launch.actions"}
_CLASS = re.compile(r"(?<![\w.'])(?:LaunchConfiguration|DeclareLaunchArgument|LaunchDescription|Node|SetRemap)(?=\()")


def other_node(source: Source, keyword: str, right: str) -> str | None:
    """The step where one Node lacks what another one has."""
    without = [node for node in nodes(source) if keyword not in node.named]
    return f"in the Node in line {without[0].line}: {right}" if 0 < len(without) < len(nodes(source)) else None


def commands(source: Source) -> list[Call]:
    """The processes that are started by a command instead of a Node(...)."""
    used = [node for node in nodes(source) if not node.kept or source.uses(node.kept)]
    return [] if used else source.calls("ExecuteProcess")


def one_word(source: Source) -> Cause | None:
    """Whether a command is given as one text, which is taken for the name of a program."""
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
                "\n".join(
                    f"line {each.line}: cmd={each.named['cmd'][2:-2].split()!r}"
                    for each in source.calls("ExecuteProcess")
                    if len(each.named.get("cmd", "").split(",")) == 1
                ),
            )
    return None


def _in_command(source: Source, cause: str, rule: str) -> Cause | None:
    started = commands(source)
    if not started:
        return None
    return Cause(
        cause,
        f"the command in line {started[0].line} has no remapping in it",
        f"in {_lines(started)}, at the end of cmd=[...]: '--ros-args', '-r', {rule}",
    )


def topic(source: Source, name: str) -> Cause | None:
    """What the file does with the topic, where nothing of it reaches a node as a remapping from `name`."""
    if (cause := _in_command(source, "topic hard-coded", f"['{name}:=', {value(source, 'topic')}]")) is not None:
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
                    f"in {_lines(nodes(source), keyword)}, instead of {keyword}=...: {right}",
                )
    for node in nodes(source):
        for keyword in ("arguments", "ros_arguments"):
            if ":=" in node.named.get(keyword, ""):
                return Cause(
                    "topic hard-coded",
                    f"the Node in line {node.line} has {keyword}={node.named[keyword]}: a fixed text, not the "
                    "argument's value",
                    f"in {_lines(nodes(source), keyword)}, instead of {keyword}=...: {right}",
                )
    for call in source.calls("SetRemap"):
        return Cause(
            "remapping without effect",
            f"{call.where}: {_OWN_GROUP}, and a node that is not there keeps its topic",
            f"remove line {call.line}, and give {_each(source)} {right}",
        )
    for node in nodes(source):
        if "'topic'" in node.named.get("remappings", "") and not used.search(node.named["remappings"]):
            return Cause(
                "topic hard-coded",
                f"the Node in line {node.line} has remappings={node.named['remappings']}: 'topic' in quotation marks "
                "is the text topic, not the argument's value",
                f"in {_lines(nodes(source), 'remappings')}: {right}",
            )
    return None


def namespace(source: Source) -> Cause | None:
    """What the file does with the namespace, where not every node is in it."""
    wanted = value(source, "namespace")
    if (cause := _in_command(source, "namespace not used", f"['__ns:=/', {wanted}]")) is not None:
        return cause
    right = f"namespace={wanted}"
    pushed = next(iter(source.calls("PushRosNamespace", "PushROSNamespace")), None)
    if pushed is not None:
        return Cause(
            "namespace not used",
            f"{pushed.where}: {_OWN_GROUP}",
            f"remove line {pushed.line}, and give {_each(source)} {right}",
        )
    used = re.compile(rf"(?<!['\w]){re.escape(wanted)}(?!['\w])|LaunchConfiguration\('namespace'")
    for node in nodes(source):
        fixed = node.named.get("namespace", "")
        if fixed and not used.search(fixed):
            return Cause(
                "namespace not used",
                f"the Node in line {node.line} has namespace={fixed}, which is a fixed text",
                f"in {_lines(nodes(source), 'namespace')}: {right}",
            )
        for keyword in ("parameters", "arguments", "ros_arguments", "name", "remappings"):
            if not fixed and used.search(node.named.get(keyword, "")):
                return Cause(
                    "namespace not used",
                    f"the Node in line {node.line} has the namespace in {keyword}={node.named[keyword]}: that puts no "
                    "node into it",
                    f"give {_each(source)} {right}, and leave it out of {keyword}=...",
                )
    return None


def missing(source: Source, wanted: str) -> Cause | None:
    """Why one of the nodes that the file describes, the `wanted` one, is not started."""
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
                f"line {listed.line}: put {node.kept} into the list in LaunchDescription([...])",
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


def twice(source: Source) -> str | None:
    """The step where a namespace is applied by two means."""
    pushed = next(iter(source.calls("PushRosNamespace", "PushROSNamespace")), None)
    if pushed is None or not any("namespace" in node.named for node in nodes(source)):
        return None
    return f"remove line {pushed.line}, {pushed.code}: each Node has its namespace=... already"


def second_of_a_kind(source: Source, wanted: str) -> str | None:
    """The step where both nodes run the same program: `wanted` is "subscriber" or "publisher"."""
    programs = [node.named.get("executable", "") for node in nodes(source)]
    if len(programs) < 2 or len(set(programs)) > 1:
        return None
    pairs = {
        ("'talker'", "subscriber"): "'listener'",
        ("'listener'", "publisher"): "'talker'",
        ("'minimal_publisher'", "subscriber"): "'minimal_subscriber'",
        ("'minimal_subscriber'", "publisher"): "'minimal_publisher'",
    }
    other = pairs.get((programs[0], wanted))
    last = nodes(source)[-1]
    return f"in the Node in line {last.line}: executable={other} instead of {programs[0]}" if other else None


def _each(source: Source) -> str:
    found = nodes(source)
    return f"every Node(...) ({_lines(found)})" if found else "every Node(...)"


def _lines(calls: Sequence[Call], keyword: str = "") -> str:
    """The lines of the calls; of this argument in them, where they have it."""
    numbers = sorted({str(call.lines.get(keyword, call.line)) for call in calls}, key=int)
    if not numbers:
        return "every Node(...)"
    return f"line{'s' if len(numbers) > 1 else ''} {' and '.join(numbers)}"


def _is_read(source: Source, declared: Call) -> bool:
    argument = declared.argument(0, "name")
    return any(call.argument(0, "variable_name") == argument for call in source.calls("LaunchConfiguration"))

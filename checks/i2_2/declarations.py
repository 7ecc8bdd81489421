"""I2.2: why an argument of the launch file has no value.

The source only determines the wording; the fault itself was observed in the launch.
"""

from __future__ import annotations

import ast

from checks.i2_2 import steps
from checks.i2_2.launch_file import Launch
from checks.i2_2.reading import Call, Source
from checks.i2_2.rewriting import prepend_to_list
from tutor.judge.edits import replace_node
from tutor.judge.rewriting.node import argument as argument_of
from tutor.judge.verdict import Cause


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
            steps.rewrite_launch_file(launch_file)
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
            hint = steps.rename_argument_step(launch_file, other.strip("'\""), argument) or f"name it '{argument}'"
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
            or f"begin the list in LaunchDescription([...]){where} with: "
            + ", ".join(map(steps.declaration, undeclared)),
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
        launch_file.step(edits) or steps.declaration(argument),
    )


def _find_declarations(source: Source, argument: str) -> list[Call]:
    return [call for call in source.calls("DeclareLaunchArgument") if call.argument(0, "name") == f"'{argument}'"]


def _names_without_default(source: Source) -> list[str]:
    """The names that are read without a default in the LaunchConfiguration."""
    reads = [call for call in source.calls("LaunchConfiguration") if "default" not in call.named]
    return [call.argument(0, "variable_name").strip("'\"") for call in reads]


def _is_read(source: Source, declared: Call) -> bool:
    argument = declared.argument(0, "name")
    return any(call.argument(0, "variable_name") == argument for call in source.calls("LaunchConfiguration"))

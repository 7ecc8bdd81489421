"""What launch itself refuses: arguments, remappings, names, packages and executables."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found, found_at, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.launch_case import LAUNCH, at_call, launch_file, line_of, output_of, says_itself

_NO_PACKAGE = re.compile(r"package '(?P<name>[^']*)' not found", re.IGNORECASE)
_NO_PROGRAM = re.compile(r"executable '(?P<name>[^']*)' not found (?:in|on)[^\n]*")
_NO_VALUE = re.compile(r"launch configuration '(?P<name>[^']*)' does not exist")
_NO_DEFAULT = re.compile(r"missing required argument '(?P<name>[^']*)'")
_INVALID_RULE = re.compile(r"Couldn't parse remap rule: '-r [^\s:=]+:=(?P<target>[^']+)'")
_NOT_PAIRS = re.compile(r"TypeError: Expected 'remap_rule'|remap_rule.*(?:tuple|unpack)")
_NOT_TEXT = re.compile(
    r"TypeError: (?:can only concatenate str|sequence item|unsupported operand)[^\n]*"
    r"(?:LaunchConfiguration|Substitution)"
)
_UNRESOLVED = re.compile(r"<launch\S* object at 0x")


@mistake(
    "value-read-too-early",
    explains=LAUNCH,
    evidence=Evidence.PROCESS,
    says="{line} asks for the value of {name} while the launch is only described: there is none yet: {code}",
    do="Leave it to launch to ask for the value when it runs.",
    example=in_run(Symptom.NOT_LAUNCHED, **output_of("launch configuration 'sound' does not exist")),
)
def read_too_early(case: Case) -> Iterator[Found]:
    """The value of a launch argument is read while the launch is described.

    generate_launch_description() only says what shall happen. Arguments get their values afterwards, when launch
    executes the description; whatever needs one gets the LaunchConfiguration itself, and asks it then.

    Bad:

        def generate_launch_description():
            sound = LaunchConfiguration('sound').perform(LaunchContext())
            return LaunchDescription([Node(package='house', executable='bell', namespace=sound)])

    Good:

        def generate_launch_description():
            sound = LaunchConfiguration('sound')
            return LaunchDescription([Node(package='house', executable='bell', namespace=sound)])

    See it: `ros2 launch FILE --print`.

    Lesson: i2.2, on launch arguments.
    """
    if (said := says_itself(_NO_VALUE, case)) is None:
        return
    for call in launch_file(case).calls("perform"):
        if call.within == "generate_launch_description":
            yield at_call(case, call, name=said["name"])


@mistake(
    "launch-argument-not-declared",
    explains=LAUNCH,
    evidence=Evidence.PROCESS,
    says="{what}",
    do="{do}",
    example=in_run(Symptom.NOT_LAUNCHED, **output_of("launch configuration 'sound' does not exist")),
)
def not_declared(case: Case) -> Iterator[Found]:
    """A launch configuration is read that does not exist.

    LaunchConfiguration('sound') stands for the value that DeclareLaunchArgument('sound') sets. The entries of a launch
    description are executed in order, so the declaration comes first; a declaration that is not in the list has no
    effect.

    Bad:

        return LaunchDescription([
            Node(package='house', executable='bell', namespace=LaunchConfiguration('sound')),
        ])

    Good:

        return LaunchDescription([
            DeclareLaunchArgument('sound', default_value='ding'),
            Node(package='house', executable='bell', namespace=LaunchConfiguration('sound')),
        ])

    See it: `ros2 launch FILE --show-args`.

    Lesson: i2.2, on launch arguments.
    """
    if (said := says_itself(_NO_VALUE, case)) is None:
        return
    name, file = said["name"], launch_file(case)
    for call in file.calls("DeclareLaunchArgument"):
        if call.argument(0, "name") == f"'{name}'":
            late = f"the argument {name} is declared (line {call.line}) after what reads it"
            left_out = f"line {call.line} makes the argument {name}, but it is not in the launch description"
            first = "Put the arguments at the start of the launch description, before what reads them."
            yield at_call(case, call, what=left_out if call.kept and not file.uses(call.kept) else late, do=first)
    others = [call.argument(0, "name") for call in file.calls("DeclareLaunchArgument")]
    more = f"; those declared are {', '.join(others)}" if others else ""
    first = "Declare the argument, under this name, at the start of the launch description."
    yield Found({"what": f"the value of {name} is read, but no argument {name} is declared{more}", "do": first})


@mistake(
    "argument-without-a-default",
    explains=LAUNCH,
    evidence=Evidence.PROCESS,
    says="the argument {name} has no default_value, so launch refuses to start without it",
    do="Give its declaration a default_value.",
    example=in_run(Symptom.NOT_LAUNCHED, **output_of("missing required argument 'sound'")),
)
def no_default(case: Case) -> Iterator[Found]:
    """A launch argument has no default.

    An argument without a default_value has to be given every time; without it, launch starts nothing.

    Bad:

        DeclareLaunchArgument('sound')

    Good:

        DeclareLaunchArgument('sound', default_value='ding')

    See it: `ros2 launch FILE --show-args`.
    """
    if said := says_itself(_NO_DEFAULT, case):
        declarations = launch_file(case).calls("DeclareLaunchArgument")
        named = [call for call in declarations if said["name"] in call.argument(0, "name")]
        yield at_call(case, next(iter(named), None), name=said["name"])


@mistake(
    "remappings-not-a-list-of-pairs",
    explains=LAUNCH,
    evidence=Evidence.PROCESS,
    says="remappings takes a list of pairs, but got something else",
    do="Write each remapping as a pair in parentheses, and put the pairs into a list.",
    example=in_run(Symptom.NOT_LAUNCHED, **output_of("TypeError: Expected 'remap_rule' to be ...")),
)
def not_pairs(case: Case) -> Iterator[Found]:
    """Remappings are not a list of pairs.

    Each remapping is a pair: the name in the node's code, and the new one. A node may have several, so remappings takes
    a list of them.

    Bad:

        Node(package='house', executable='bell', remappings=('ring', 'doorbell'))

    Good:

        Node(package='house', executable='bell', remappings=[('ring', 'doorbell')])

    See it: the error of `ros2 launch FILE`.
    """
    if says_itself(_NOT_PAIRS, case):
        given = [call for call in launch_file(case).calls("Node") if "remappings" in call.named]
        yield at_call(case, next(iter(given), None))


@mistake(
    "substitution-made-text-too-early",
    explains=LAUNCH,
    evidence=Evidence.PROCESS,
    says="a substitution such as LaunchConfiguration is turned into text before its value is known{where}",
    do="Pass the substitution itself, or a list of it and the other parts: launch joins them when it runs.",
    example=in_run(Symptom.NOT_LAUNCHED, **output_of("<launch.substitutions.LaunchConfiguration object at 0x7f>")),
)
def early_text(case: Case) -> Iterator[Found]:
    """A substitution is put into a text.

    While the file is being read, LaunchConfiguration('sound') is an object that stands for a later value. An f-string
    or str() turns the object itself into text, <launch.substitutions… object at 0x…>, and + raises a TypeError.

    Bad:

        Node(package='house', executable='bell', namespace='house/' + LaunchConfiguration('room'))

    Good:

        Node(package='house', executable='bell', namespace=['house/', LaunchConfiguration('room')])

    See it: `ros2 node list` with names that contain "object at".
    """
    if says_itself(_NOT_TEXT, case):
        for raised in case.exceptions:
            if raised.line is not None:
                yield found_at(raised.line, where=f", in line {raised.line.line}: {raised.line.code}")
    elif not any(_UNRESOLVED.search(line.text) for line in case.trace.output):
        return
    file = case.file
    values = [file.assigned_to(call) for call in file.calls("LaunchConfiguration")]
    for node in file.nodes:
        if isinstance(node, ast.FormattedValue) and ast.unparse(node.value) in filter(None, values):
            yield found(file, node, where=f", in line {node.lineno}: {file.line(node.lineno)}")
    yield Found({"where": ""})


@mistake(
    "invalid-name",
    explains=LAUNCH,
    evidence=Evidence.PROCESS,
    says="{name} is not a valid name in ROS: only letters, digits and _ are, and no digit comes first",
    do="Choose another name.",
    example=in_run(Symptom.NOT_LAUNCHED, **output_of("Couldn't parse remap rule: '-r ring:=door-bell'")),
)
def invalid_name(case: Case) -> Iterator[Found]:
    """A name is not allowed in ROS.

    Names of nodes, topics and namespaces consist of letters, digits and underscores, with slashes between their parts.
    No part begins with a digit.

    Bad:

        remappings=[('ring', 'door-bell')]

    Good:

        remappings=[('ring', 'door_bell')]

    See it: the error of `ros2 launch FILE`.
    """
    if said := _INVALID_RULE.search("\n".join(line.text for line in case.trace.output)):
        yield Found({"name": said["target"].strip("/")})


@mistake(
    "package-not-found",
    explains=LAUNCH,
    evidence=Evidence.PROCESS,
    says="there is no package {name}",
    do="Check the spelling of package=, and whether the package is there (ros2 pkg list).",
    example=in_run(Symptom.NOT_LAUNCHED, **output_of("package 'hous' not found, searching: ...")),
)
def no_package(case: Case) -> Iterator[Found]:
    """A package is not found.

    Node(package=…) needs the name of a ROS package that is installed, or built and sourced in this terminal.

    Bad:

        Node(package='hous', executable='bell')

    Good:

        Node(package='house', executable='bell')

    See it: `ros2 pkg list`.
    """
    if said := says_itself(_NO_PACKAGE, case):
        calls = [call for call in launch_file(case).calls("Node") if said["name"] in call.argument(0, "package")]
        yield at_call(case, next(iter(calls), None), name=said["name"])


@mistake(
    "executable-not-found",
    explains=LAUNCH,
    evidence=Evidence.PROCESS,
    says="{said}",
    do="Check the spelling of executable= (ros2 pkg executables PACKAGE).",
    example=in_run(Symptom.NOT_LAUNCHED, **output_of("executable 'bel' not found in the package 'house'")),
)
def no_program(case: Case) -> Iterator[Found]:
    """A package has no such executable.

    An executable is a console script from setup.py, or an installed program, under its name there: without .py, and not
    the node's name.

    Bad:

        Node(package='house', executable='bell.py')

    Good:

        Node(package='house', executable='bell')

    See it: `ros2 pkg executables PACKAGE`.
    """
    if said := says_itself(_NO_PROGRAM, case):
        calls = [call for call in launch_file(case).calls("Node") if said["name"] in call.argument(1, "executable")]
        yield at_call(case, next(iter(calls), None), said=line_of(said))

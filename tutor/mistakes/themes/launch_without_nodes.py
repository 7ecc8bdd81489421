"""Launches in which no node comes up: no description, nothing in it, or programs that end."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from tutor.judge.launch_output import by_stream, ended_processes
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Exit
from tutor.mistakes.entry import Case, Evidence, Found, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.launch_case import ERROR, LAUNCH, at_call, launch_file, line_of, output_of, says_itself
from tutor.ros_model import Graph

_NO_FUNCTION = re.compile(r"required function '?generate_launch_description|no attribute '?generate_launch_description")
_NOTHING_RETURNED = re.compile(r"NoneType|return(?:s|ed)? (?:None|nothing)")


@mistake(
    "no-generate-launch-description",
    name="no generate_launch_description",
    explains=LAUNCH,
    evidence=Evidence.PROCESS,
    says="the file has no function generate_launch_description, which launch calls",
    do="Give the function exactly this name.",
    example=in_run(Symptom.NOT_LAUNCHED, **output_of("no attribute 'generate_launch_description'")),
)
def no_function(case: Case) -> Iterator[Found]:
    """A launch file has no generate_launch_description().

    launch imports the file and calls the function of this name; everything else in the file serves it.

    Bad:

        def launch_description():
            return LaunchDescription([])

    Good:

        def generate_launch_description():
            return LaunchDescription([])

    See it: the error of `ros2 launch FILE`.
    """
    if says_itself(_NO_FUNCTION, case):
        yield Found()


@mistake(
    "nothing-returned",
    explains=LAUNCH,
    evidence=Evidence.RUN,
    says="generate_launch_description() returns nothing",
    do="Return the LaunchDescription at the end of it.",
    example=in_run(Symptom.NOT_LAUNCHED, **output_of("AttributeError: 'NoneType' object has no attribute 'visit'")),
)
def nothing_returned(case: Case) -> Iterator[Found]:
    """generate_launch_description() returns nothing.

    A function without a return gives None, so launch has nothing to start.

    Bad:

        def generate_launch_description():
            LaunchDescription([bell])

    Good:

        def generate_launch_description():
            return LaunchDescription([bell])

    See it: the error of `ros2 launch FILE`.
    """
    functions = case.file.functions_named("generate_launch_description")
    silent = bool(functions) and not any(
        isinstance(node, ast.Return) and node.value is not None for node in ast.walk(functions[-1])
    )
    if says_itself(_NOTHING_RETURNED, case) and (silent or not functions):
        yield Found()


@mistake(
    "node-that-ends",
    name="a node that ends",
    explains=LAUNCH,
    evidence=Evidence.RUN,
    says="{process} has ended on its own with exit code {code}{words}",
    do="Start this program on its own, and look at its output.",
    example=in_run(
        Symptom.NOT_LAUNCHED, output=["[ERROR] [bell-1]: process has died [pid 7, exit code 1, cmd 'bell']."]
    ),
)
def node_ends(case: Case) -> Iterator[Found]:
    """A program of a launch ends on its own.

    A launch goes on when one of its nodes ends. What that program wrote last, after its name in the launch's output,
    says why.

    Bad:

        Node(package='house', executable='bell_test')

    Good:

        Node(package='house', executable='bell')

    See it: `ros2 run PACKAGE EXECUTABLE`.
    """
    for ended in ended_processes(case.trace.output)[:1]:
        words = [line.text for line in by_stream(ended.output) if line.text.strip()][-1:]
        said = f": {words[0][:120]}" if words else ""
        yield Found({"process": ended.process, "code": ended.code, "words": said})


@mistake(
    "command-in-one-piece",
    explains=LAUNCH,
    says="{line} asks for a program whose name is the whole command, spaces included: {code}",
    do="Give cmd= a list that has each word of the command as an entry of its own.",
)
def split_command(case: Case) -> Iterator[Found]:
    """A command is given as a single text.

    ExecuteProcess takes the first entry of cmd as the program. A whole command line in one entry is the name of a
    program that does not exist.

    Bad:

        ExecuteProcess(cmd=['ros2 run house bell'])

    Good:

        ExecuteProcess(cmd=['ros2', 'run', 'house', 'bell'])

    See it: the error of `ros2 launch FILE`.
    """
    for call in launch_file(case).calls("ExecuteProcess"):
        try:
            words = ast.literal_eval(call.named.get("cmd", ""))
        except (SyntaxError, ValueError):
            continue
        if isinstance(words, list) and len(words) == 1 and " " in str(words[0]) and "shell" not in call.named:
            yield at_call(case, call)


@mistake(
    "error-in-the-launch",
    explains=LAUNCH,
    evidence=Evidence.SYMPTOM,
    says="{error}",
    do="Start it with ros2 launch yourself, and follow what it says.",
    example=in_run(Symptom.NOT_LAUNCHED, **output_of("[ERROR] [launch]: Caught exception in launch: no bell")),
)
def error(case: Case) -> Iterator[Found]:
    """Launch reports an error.

    When launch cannot do something, it says so in a line with [ERROR] [launch], and ends.

    Bad:

        IncludeLaunchDescription('no_such_file.py')

    Good:

        IncludeLaunchDescription('house.launch.py')

    See it: `ros2 launch FILE --debug`.
    """
    if said := says_itself(ERROR, case):
        yield Found({"error": line_of(said)})


@mistake(
    "nothing-to-launch",
    explains=LAUNCH,
    evidence=Evidence.SYMPTOM,
    says="the launch ends on its own after {after_s:.1f} s, and has started nothing",
    do="Put what should be started into the list of the LaunchDescription.",
    example=in_run(Symptom.NOT_LAUNCHED, exit=Exit(0, None, 0.5), graph=Graph()),
)
def nothing(case: Case) -> Iterator[Found]:
    """A launch description is empty.

    launch starts what is in the list of the LaunchDescription, and ends when none of it is left.

    Bad:

        bell = Node(package='house', executable='bell')
        return LaunchDescription()

    Good:

        bell = Node(package='house', executable='bell')
        return LaunchDescription([bell])

    See it: `ros2 launch FILE --print`.
    """
    if case.trace.exit is not None and not case.trace.graph.nodes:
        yield Found({"after_s": case.trace.exit.after_s})

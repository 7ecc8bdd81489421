"""Packages of message types: not built, without a type, or with other fields than agreed on."""

from __future__ import annotations

import re
from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.mistakes.entry import Case, Evidence, Found, found_at, mistake
from tutor.mistakes.examples import in_run
from tutor.mistakes.exceptions import EXPLAINED_WHILE_RUNNING

_NO_MODULE = re.compile(r"^No module named '(?P<package>\w+)")


@mistake(
    "file-not-in-cmakelists",
    name="file not listed in CMakeLists.txt",
    explains=[Symptom.NOT_BUILT],
    evidence=Evidence.PROCESS,
    says="{file} is there, but CMakeLists.txt does not list it, so no type is made of it",
    do="Add it to the files in rosidl_generate_interfaces().",
    example=in_run(
        Symptom.NOT_BUILT, package="bell_interfaces", type="msg/Ding", unlisted="msg/Ding.msg", reason="", others=""
    ),
)
def file_not_listed(case: Case) -> Iterator[Found]:
    """A file of a message type is not listed in CMakeLists.txt.

    Only the files in the call of rosidl_generate_interfaces become types. Others may lie beside them; nothing is said
    of them, and nothing is made of them.

    Bad:

        rosidl_generate_interfaces(${PROJECT_NAME} "msg/Dong.msg")

    Good:

        rosidl_generate_interfaces(${PROJECT_NAME} "msg/Dong.msg" "msg/Ding.msg")

    See it: `ros2 interface package bell_interfaces`.
    """
    if case.about("unlisted"):
        yield Found({"file": case.about("unlisted")})


@mistake(
    "interfaces-not-built",
    name="interface package not built",
    explains=[Symptom.NOT_BUILT],
    evidence=Evidence.PROCESS,
    says="{reason}",
    do="{step}",
    example=in_run(
        Symptom.NOT_BUILT, package="bell_interfaces", reason="msg/Ding.msg:1: there is no type double", others=""
    ),
)
def interfaces_not_built(case: Case) -> Iterator[Found]:
    """A package of message types is not built.

    Python cannot import a .msg file. From each, a build makes a class for Python and code that turns it into bytes; a
    single line that cannot be read stops the build of the whole package, and then none of its types can be imported.

    Bad:

        # msg/Ding.msg
        double volume

    Good:

        # msg/Ding.msg
        float64 volume

    See it: `ros-tutor run` names the file, the line and the reason; `ros2 interface show` shows what is built.
    """
    reason = case.about("reason", "")
    package = case.about("package", "the package")
    if case.about("unlisted"):
        return
    if not reason or case.about("others"):
        others = case.about("others")
        step = (
            f"Name it {package} in package.xml and CMakeLists.txt."
            if others
            else f"Put the package {package} into src."
        )
        yield Found({"reason": f"there is no interface package {package}", "step": step})
        return
    step = case.seen.do or "Correct this place; ros-tutor then builds the package again."
    if case.about("has"):
        step = f"Add the file; the package has only {case.about('has')}."
    yield Found({"reason": reason, "step": step})


@mistake(
    "types-not-built",
    name="import of a package that is not built",
    explains=EXPLAINED_WHILE_RUNNING - {Symptom.NOT_BUILT, Symptom.OTHER_TYPES},
    evidence=Evidence.PROCESS,
    says="{package} is in your workspace, but it is not built: {reason}",
    do="Correct this place; the import then works.",
    example=in_run(
        Symptom.ENDED,
        output=(
            "Traceback (most recent call last):",
            '  File "/ws/node.py", line 1, in <module>',
            "    from bell_interfaces.msg import Ding",
            "ModuleNotFoundError: No module named 'bell_interfaces'",
        ),
        unbuilt={"bell_interfaces": "src/bell_interfaces/msg/Ding.msg:1: there is no type double"},
    ),
)
def types_not_built(case: Case) -> Iterator[Found]:
    """A program imports a type from a package of the workspace that is not built.

    The package is found, and the program is not to blame: there is a mistake in what the package is made from.

    Bad:

        from bell_interfaces.msg import Ding

    Good:

        from bell_interfaces.msg import Ding

    See it: `ros2 interface package bell_interfaces`. The import is right; a file of the package is not.
    """
    unbuilt = {**case.trace.unbuilt, **case.about("unbuilt", {})}
    for raised in case.exceptions:
        matched = _NO_MODULE.search(raised.traceback.message)
        if matched and matched["package"] in unbuilt:
            yield found_at(raised.line, package=matched["package"], reason=unbuilt[matched["package"]])


@mistake(
    "other-fields",
    name="other fields than agreed on",
    explains=[Symptom.OTHER_TYPES],
    evidence=Evidence.PROCESS,
    says="{difference}",
    do="Compare the definition with the one in the task, line by line: types, names and order.",
    example=in_run(Symptom.OTHER_TYPES, says="msg/Ding has no field volume, only volumes"),
)
def other_fields(case: Case) -> Iterator[Found]:
    """A message type has other fields than was agreed on.

    A definition is a contract: both ends are built from it. Types, names and order of the fields decide which bytes are
    sent and how they are read, so a type of the same name with other fields is another type.

    Bad:

        # msg/Ding.msg
        float64 volumes

    Good:

        # msg/Ding.msg
        float64 volume

    See it: `ros2 interface show bell_interfaces/msg/Ding`.
    """
    yield Found({"difference": case.seen.says})

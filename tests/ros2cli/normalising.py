"""Takes out of an output what differs from run to run: times, ids, paths, measured figures, the number of samples."""

from __future__ import annotations

import re
from collections.abc import Mapping

TRACEBACK = "TRACEBACK"

_REPLACED = [
    (r"\x1b\[[0-9;]*m", ""),
    (r"\[\d{10}\.\d{9}\]", "[TIME]"),
    # A workspace that is not built has its package in src, one that is, in install.
    (r"\$WORKSPACE/(install/my_package/lib/python3\.12/site-packages|src/my_package)/my_package/", "$PACKAGE/"),
    (r"\$WORKSPACE/(install/my_package/lib|src)/my_package/", "$PROGRAMS/"),
    (r"/\S*/ros2-overlay\.\w+/prefix/lib/my_package/", "$PROGRAMS/"),
    (r"(\$WORKSPACE|/\S*/ros2-overlay\.\w+/prefix)/share/my_package\b", "$PACKAGE"),
    (r"\$WORKSPACE/(install/my_package(/share/my_package)?|src/my_package)(?=['\"\s]|$)", "$PACKAGE"),
    (r"searching: \[[^\]]*\]", "searching: [PREFIXES]"),
    (r"(✓ '<)\S+( object at)", r"\1HANDLER\2"),  # launch's handlers are closures there, objects of ours here
    (r"A message was lost!!!\n\s*total count change:\d+\n\s*total count: \d+---\n", ""),
    (r"\b\d{19}\b", "NANOSECONDS"),
    (r"\b(sec|nanosec)(: |=)\d+", r"\1\2N"),
    (r"(publication_sequence_number|reception_sequence_number): (\d+|null)", r"\1: N"),
    (r"('(publication|reception)_sequence_number'): (\d+|None)", r"\1: N"),
    (r"^NANOSECONDS,NANOSECONDS,(\d+|None),(\d+|None),", "NANOSECONDS,NANOSECONDS,N,N,"),  # the same with --csv
    (r"^1\d{9},\d{1,9},", "N,N,"),  # a stamp
    (r"-?\d+\.\d+ °C", "FLOAT °C"),
    (r"\bpid \[\d+\]", "pid [PID]"),
    (r"\[pid \d+", "[pid PID"),
    # How a node of a launch ends depends on what it is doing when Ctrl+C comes.
    (r"\[(INFO|ERROR)\] (\[\S+\]: process has) (died|finished cleanly) .*", r"\2 ended"),
    (r"process id \d+", "process id PID"),
    (r"_ros2cli_\w+", "_ros2cli_PID"),
    (r"0x[0-9a-f]{6,}", "ADDRESS"),
    (r"GID: [0-9a-f.]+", "GID: ID"),
    (r"-?\d+\.\d{4,}(e[+-]?\d+)?", "FLOAT"),  # measured, or drawn at random
    (r"b(['\"])\\x00\\x01\\x00\\x00.*\1", "b'BYTES'"),  # Python chooses the other quotes where a ' is in it
    (r"All log files can be found below \S+", "All log files can be found below FOLDER"),
    (r"^\s*\^C", ""),
]
_COUNTED = [
    (r"(average rate|min|max|std dev|window|mean|average delay): -?[\d.]+", r"\1: N"),
    (r"\b[\d.]+ [KM]?B/s from \d+ messages", "N B/s from N messages"),
    (r"(Message size mean|min|max): [\d.]+ [KM]?B", r"\1: N B"),
    (r"#\d+", "#N"),
    (r"(Hello World: )\d+", r"\1N"),
    (r"Half #N|Hello #N", "PREFIX #N"),
]
_COMMANDS_OF_PLUGINS = frozenset(
    (
        "bag",
        "component",
        "control",
        "doctor",
        "extension_points",
        "extensions",
        "lifecycle",
        "multicast",
        "security",
        "wtf",
    )
)
"""Commands that an installation has or lacks: each is of a package of its own, or of use to plug-ins only."""

_PACKAGES_OF_ONE = re.compile(
    r"\s*(ament_copyright|ament_lint|composition_interfaces|launch|launch_\w+|osrf_pycommon|ros2\w+|rosidl_runtime_py)\b"
)
"""A line of a list of packages, or of what they have, that begins with a package which the wheels lack."""

_CHOICES = re.compile(r"(?<=\(choose from )[^()]+(?=\))")
_LISTS = re.compile(r"ros2 (pkg list|interface (list|packages))\b")
_MEASURES = re.compile(r"ros2 topic (hz|bw|delay)\b")
_NOT_YET = re.compile(
    r"stdout: WARNING: topic \[\S+\] does not appear to be published yet$|stdout: waiting for service to become"
)
_ASKS = "stdout: requester: making request"


def normalise(text: str, paths: Mapping[str, str], *, streams: bool) -> list[str]:
    """The lines that must agree.

    `paths` maps folders of this machine to the names that they have in the records. Of a command that streams, the
    number of samples depends on the moment of Ctrl+C, so each different line counts once, where it first came.
    """
    for folder, name in sorted(paths.items(), key=lambda item: -len(item[0])):
        text = text.replace(folder, name)
    for pattern, instead in [*_REPLACED, *_COUNTED]:
        text = re.sub(pattern, instead, text, flags=re.MULTILINE)
    lines = _fold_usage(_fold_tracebacks(text.replace("\r\n", "\n").split("\n")))
    lines = [line.rstrip() for line in lines]
    while lines and not lines[-1]:
        lines.pop()
    return list(dict.fromkeys(lines)) if streams else lines


def of_both(command: str, lines: list[str]) -> list[str]:
    """A list of what is installed, without the packages that only one of the two installations has."""
    return [line for line in lines if not (_LISTS.match(command) and _PACKAGES_OF_ONE.match(line))]


def without_early_warning(command: str, lines: list[str]) -> list[str]:
    """Of two runs of the real one, one says that a live topic or service is not there yet: not told apart."""
    goes_on = (_MEASURES.match(command) and len(lines) > 1) or any(line.startswith(_ASKS) for line in lines)
    return [line for line in lines if not (goes_on and _NOT_YET.match(line))]


def _fold_tracebacks(lines: list[str]) -> list[str]:
    """A traceback becomes one word: what its lines say depends on the code that it is of.

    Those of several processes of a launch may be mixed; each has its own `[name-1] ` in front.
    """
    folded: list[str] = []
    within: set[str] = set()
    for line in lines:
        start = re.match(r"((?:\[[\w.]+-\d+\] )?).*Traceback \(most recent call last\):", line)
        of = re.match(r"\[[\w.]+-\d+\] ", line)
        prefix = of[0] if of else ""
        if start:
            within.add(prefix)
            folded.append(prefix + TRACEBACK)
        elif prefix in within:
            if not line.removeprefix(prefix).startswith(" "):  # the exception's own line ends it
                within.discard(prefix)
        else:
            folded.append(line)
    return folded


def _fold_usage(lines: list[str]) -> list[str]:
    """A usage is one line, wherever it was wrapped; the help below it is everyone's own."""
    folded: list[str] = []
    usage: list[str] = []
    for line in lines:
        if line.startswith("usage: "):
            usage = [line]
        elif usage and line.startswith(" "):
            usage.append(line.strip())
        else:
            if usage:
                folded.append(re.sub(r"\s+", " ", " ".join(usage)))
                usage = []
            folded.append(line)
    if usage:
        folded.append(re.sub(r"\s+", " ", " ".join(usage)))
    return _without_help(folded)


def _without_help(lines: list[str]) -> list[str]:
    if "Commands:" in lines and lines[0].startswith("usage: "):
        words = [
            line.split()[0] for line in lines[lines.index("Commands:") + 1 :] if line.startswith("  ") and line.strip()
        ]
        return [lines[0], "Commands:", *(word for word in words if word not in ("Call", *_COMMANDS_OF_PLUGINS))]
    return [_CHOICES.sub(_without_plugins, line) for line in lines]


def _without_plugins(found: re.Match[str]) -> str:
    names = (name for name in found[0].split(", ") if name.strip("'") not in _COMMANDS_OF_PLUGINS)
    return ", ".join(names)

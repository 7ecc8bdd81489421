"""Masks what differs from run to run in an output: times, ids, paths, measurements, the number of samples."""

from __future__ import annotations

import re
from collections.abc import Mapping

TRACEBACK = "TRACEBACK"

_VOLATILE = [
    (r"\x1b\[[0-9;]*m", ""),
    (r"\[\d{10}\.\d{9}\]", "[TIME]"),
    # The package is in src in an unbuilt workspace, and in install in a built one.
    (r"\$WORKSPACE/(install/my_package/lib/python3\.12/site-packages|src/my_package)/my_package/", "$PACKAGE/"),
    (r"\$WORKSPACE/(install/my_package/lib|src)/my_package/", "$PROGRAMS/"),
    (r"/\S*/ros2-overlay\.\w+/prefix/lib/my_package/", "$PROGRAMS/"),
    (r"(\$WORKSPACE|/\S*/ros2-overlay\.\w+/prefix)/share/my_package\b", "$PACKAGE"),
    (r"\$WORKSPACE/(install/my_package(/share/my_package)?|src/my_package)(?=['\"\s]|$)", "$PACKAGE"),
    (r"searching: \[[^\]]*\]", "searching: [PREFIXES]"),
    (r"(✓ '<)\S+( object at)", r"\1HANDLER\2"),  # the real launch's handlers are closures, ours are objects
    (r"A message was lost!!!\n\s*total count change:\d+\n\s*total count: \d+---\n", ""),
    (r"\b\d{19}\b", "NANOSECONDS"),
    (r"\b(sec|nanosec)(: |=)\d+", r"\1\2N"),
    (r"(publication_sequence_number|reception_sequence_number): (\d+|null)", r"\1: N"),
    (r"('(publication|reception)_sequence_number'): (\d+|None)", r"\1: N"),
    (r"^NANOSECONDS,NANOSECONDS,(\d+|None),(\d+|None),", "NANOSECONDS,NANOSECONDS,N,N,"),  # the same with --csv
    (r"^1\d{9},\d{1,9},", "N,N,"),  # a time stamp
    (r"-?\d+\.\d+ °C", "FLOAT °C"),
    (r"\bpid \[\d+\]", "pid [PID]"),
    (r"\[pid \d+", "[pid PID"),
    # How a launched node ends depends on what it is doing when Ctrl+C arrives.
    (r"\[(INFO|ERROR)\] (\[\S+\]: process has) (died|finished cleanly) .*", r"\2 ended"),
    (r"process id \d+", "process id PID"),
    (r"_ros2cli_\w+", "_ros2cli_PID"),
    (r"0x[0-9a-f]{6,}", "ADDRESS"),
    (r"GID: [0-9a-f.]+", "GID: ID"),
    (r"-?\d+\.\d{4,}(e[+-]?\d+)?", "FLOAT"),  # measured or random
    (r"b(['\"])\\x00\\x01\\x00\\x00.*\1", "b'BYTES'"),  # Python uses double quotes if it contains a '
    (r"All log files can be found below \S+", "All log files can be found below FOLDER"),
    (r"^\s*\^C", ""),
]
_MEASURED = [
    (r"(average rate|min|max|std dev|window|mean|average delay): -?[\d.]+", r"\1: N"),
    (r"\b[\d.]+ [KM]?B/s from \d+ messages", "N B/s from N messages"),
    (r"(Message size mean|min|max): [\d.]+ [KM]?B", r"\1: N B"),
    (r"#\d+", "#N"),
    (r"(Hello World: )\d+", r"\1N"),
    (r"Half #N|Hello #N", "PREFIX #N"),
]
_PLUGIN_COMMANDS = frozenset(
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
"""Commands that an installation may lack: each comes in a package of its own, or is useful to plug-ins only."""

_MISSING_PACKAGES = re.compile(
    r"\s*(ament_copyright|ament_lint|composition_interfaces|launch|launch_\w+|osrf_pycommon|ros2\w+|rosidl_runtime_py)\b"
)
"""Matches a line that starts with a package which the wheels lack, in a list of packages or of their contents."""

_CHOICES = re.compile(r"(?<=\(choose from )[^()]+(?=\))")
_LISTS = re.compile(r"ros2 (pkg list|interface (list|packages))\b")
_MEASURES = re.compile(r"ros2 topic (hz|bw|delay)\b")
_EARLY_WARNING = re.compile(
    r"stdout: WARNING: topic \[\S+\] does not appear to be published yet$|stdout: waiting for service to become"
)
_REQUEST = "stdout: requester: making request"


def normalise(text: str, paths: Mapping[str, str], *, streams: bool) -> list[str]:
    """Return the lines that must agree.

    `paths` maps folders on this machine to their names in the records. How many samples a streaming command prints
    depends on when Ctrl+C arrives, so only the first of several equal lines is kept.
    """
    for folder, name in sorted(paths.items(), key=lambda item: -len(item[0])):
        text = text.replace(folder, name)
    for pattern, replacement in [*_VOLATILE, *_MEASURED]:
        text = re.sub(pattern, replacement, text, flags=re.MULTILINE)
    lines = _fold_usage(_fold_tracebacks(text.replace("\r\n", "\n").split("\n")))
    lines = [line.rstrip() for line in lines]
    while lines and not lines[-1]:
        lines.pop()
    return list(dict.fromkeys(lines)) if streams else lines


def drop_missing_packages(command: str, lines: list[str]) -> list[str]:
    """Drop the packages that only one of the two installations has from a list of what is installed."""
    return [line for line in lines if not (_LISTS.match(command) and _MISSING_PACKAGES.match(line))]


def drop_early_warning(command: str, lines: list[str]) -> list[str]:
    """Drop the warning that a live topic or service does not exist yet: the real `ros2` prints it in some runs only."""
    goes_on = (_MEASURES.match(command) and len(lines) > 1) or any(line.startswith(_REQUEST) for line in lines)
    return [line for line in lines if not (goes_on and _EARLY_WARNING.match(line))]


def _fold_tracebacks(lines: list[str]) -> list[str]:
    """Replace each traceback by one word, as its lines depend on the code that raised it.

    Tracebacks of several launched processes may be interleaved; each process has its own prefix, `[name-1] `.
    """
    folded: list[str] = []
    open_tracebacks: set[str] = set()
    for line in lines:
        start = re.match(r"((?:\[[\w.]+-\d+\] )?).*Traceback \(most recent call last\):", line)
        tag = re.match(r"\[[\w.]+-\d+\] ", line)
        prefix = tag[0] if tag else ""
        if start:
            open_tracebacks.add(prefix)
            folded.append(prefix + TRACEBACK)
        elif prefix in open_tracebacks:
            if not line.removeprefix(prefix).startswith(" "):  # the line of the exception is the last
                open_tracebacks.discard(prefix)
        else:
            folded.append(line)
    return folded


def _fold_usage(lines: list[str]) -> list[str]:
    """Join a wrapped usage into one line, and drop the help below it, whose wording may differ."""
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
    return _drop_help(folded)


def _drop_help(lines: list[str]) -> list[str]:
    if "Commands:" in lines and lines[0].startswith("usage: "):
        words = [
            line.split()[0] for line in lines[lines.index("Commands:") + 1 :] if line.startswith("  ") and line.strip()
        ]
        return [lines[0], "Commands:", *(word for word in words if word not in ("Call", *_PLUGIN_COMMANDS))]
    return [_CHOICES.sub(_drop_plugins, line) for line in lines]


def _drop_plugins(found: re.Match[str]) -> str:
    names = (name for name in found[0].split(", ") if name.strip("'") not in _PLUGIN_COMMANDS)
    return ", ".join(names)

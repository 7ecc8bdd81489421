"""What was seen in a launch that did not do what it should, for the catalogue of mistakes."""

from __future__ import annotations

import re
from typing import Any

from tutor.exercise.launch_run import LaunchRun
from tutor.judge import tracebacks
from tutor.judge.bench import NeedsInstalledRos
from tutor.judge.launch_output import by_stream, ended_processes, find_refusal, writers, written_by
from tutor.judge.symptom import Observation, Symptom
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Traceback

_UNSUPPORTED = re.compile(r"(?<!\S)\S+ is not supported by the launch files that run without an installed ROS 2[^\n]*")
_NEEDS_ROS = re.compile(r"`ros2 \w+` needs an installed ROS 2")


def seen_in_launch(symptom: Symptom, run: LaunchRun, *, says: str = "", do: str = "", **about: Any) -> Observation:
    """What was seen in a launch that did not do what it should.

    Raises NeedsInstalledRos if it needs a feature that our substitute for `launch` does not have.
    """
    trace = run.trace
    _reject_unsupported(trace)
    broken = trace.exit is not None or bool(ended_processes(trace.output)) or not trace.graph.nodes
    raised = _find_exception(trace) if broken or symptom is not Symptom.WRONG_NAMES else None
    return symptom.seen(trace, says=says, do=do, raised=raised, command_lines=run.command_lines, **about)


def _reject_unsupported(trace: Trace) -> None:
    """Raise NeedsInstalledRos if the launch has failed for the want of an installed ROS 2."""
    for line in written_by(trace.output, None):
        if found := _UNSUPPORTED.search(line.text):
            raise NeedsInstalledRos(found[0])
    for ended in ended_processes(trace.output)[:1]:
        words = [line.text for line in ended.output if line.text.strip()][-1:]
        if words and (found := _NEEDS_ROS.search(words[0])):
            raise NeedsInstalledRos(found[0])


def _find_exception(trace: Trace) -> Traceback | None:
    """The exception that kept the launch file from being loaded, or else one that a program of the launch left."""
    own = written_by(trace.output, None)
    if raised := tracebacks.find_tracebacks(by_stream(own)):
        return raised[-1]
    if (refusal := find_refusal(own, trace)) is not None:
        return refusal
    ended = ended_processes(trace.output)
    if ended:
        return ended[0].traceback
    left = [tracebacks.find_tracebacks(by_stream(written_by(trace.output, writer))) for writer in writers(trace.output)]
    return next((found[-1] for found in left if found), None)

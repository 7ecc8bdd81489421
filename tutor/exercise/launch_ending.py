"""How a launch ended on Ctrl+C: all of it, with every process that it has started."""

from __future__ import annotations

from dataclasses import replace

from tutor.judge import ending
from tutor.judge.launch_output import by_stream, writers, written_by
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Ending, OutputLine, Trace
from tutor.judge.verdict import Verdict, failed, passed


def judge_launch_ending(trace: Trace, ended: Ending | None, *, shown_by: str) -> Verdict:
    """Judge how a launch ended on Ctrl+C; see `tutor.judge.ending.judge_ending`."""
    expected = "one Ctrl+C ends the whole launch within 5 s, and no process is left"
    # The launch file itself has nothing to do with how its programs end.
    programs = replace(trace, sources={name: text for name, text in trace.sources.items() if name != trace.file})
    if ended is None:
        return ending.judge_ending(programs, None, shown_by=shown_by)
    # `ros2 launch` relays its nodes' output with a prefix on each line.
    ended = replace(ended, output=_without_prefixes(ended.output))
    verdict = ending.judge_ending(programs, ended, shown_by=shown_by)
    if ended.exit is None:
        left = [command[:200] for command in ended.survivors]
        return replace(verdict, expected=expected, evidence=(*left[:6], *(line.text for line in ended.output[-6:])))
    if not verdict.passed:
        return replace(verdict, expected=expected)
    if ended.survivors:
        return failed(
            expected,
            f"ended {ended.took_s:.2f} s after Ctrl+C with {ended.exit}; {len(ended.survivors)} left",
            Symptom.DOES_NOT_END.seen(programs, left_behind=ended.survivors[0][:120]),
            [command[:200] for command in ended.survivors[:6]],
        )
    return passed(expected, f"{verdict.observed}; no process is left")


def _without_prefixes(output: tuple[OutputLine, ...]) -> tuple[OutputLine, ...]:
    return tuple(line for process in (None, *writers(output)) for line in by_stream(written_by(output, process)))

"""Log messages that show that their node has received something: they quote it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tutor.exercise.launch_graph import Pair
from tutor.judge.trace import LogRecord, Sample

_TELLING_LENGTH = 4
"""Text of at least this many characters is unlikely to appear in a log message by chance."""

_NUMBER = re.compile(r"[-+\d.,e]+")


def logs_of_messages(pair: Pair, logs: Sequence[LogRecord], samples: Sequence[Sample]) -> list[LogRecord]:
    """The subscriber's log messages that quote the content of a sample received by then.

    A number or a few letters may be in any log message by chance: they count only if two different ones are quoted.
    """
    name = pair[1].node.strip("/").replace("/", ".")
    node_logs = [log for log in logs if log.name == name or log.name.startswith(f"{name}.")]
    quoted = {
        log: {
            text
            for sample in samples
            if sample.source_time <= log.stamp + 0.01
            for text in _quoted_values(log.text, sample)
        }
        for log in node_logs
    }
    distinct = set().union(*quoted.values())
    telling = any(len(text) >= _TELLING_LENGTH and not _NUMBER.fullmatch(text) for text in distinct)
    return [log for log in node_logs if quoted[log]] if telling or len(distinct) > 1 else []


def _quoted_values(text: str, sample: Sample) -> Iterator[str]:
    """The values of a message that occur in the text as whole words."""
    for value in {str(leaf).strip() for leaf in _leaves(sample.message)} - {""}:
        if re.search(rf"(?<![\w.]){re.escape(value)}(?!\w|\.\d)", text, re.IGNORECASE):
            yield value


def _leaves(value: Any) -> Iterator[Any]:
    if isinstance(value, Mapping):
        for item in value.values():
            yield from _leaves(item)
    elif isinstance(value, (list, tuple)):
        for item in value[:100]:
            yield from _leaves(item)
    else:
        yield value

"""A recording: the calls of judges that led to the verdicts on one submission, with the facts that they got.

Judges are pure functions of facts, so the same calls show what a changed judge, or a changed catalogue of mistakes,
makes of the same facts. Stored as compressed MessagePack, which keeps NaN and bytes.
"""

from __future__ import annotations

import importlib
import zlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec

from tutor.judge.verdict import Verdict

SUFFIX = ".recording"


@dataclass(frozen=True)
class JudgeCall:
    """One call of a criterion's judge. `scenario`: of an early judge, the name of its scenario; else "".

    `facts`: what it got, one for each of its arguments.
    """

    criterion: str
    scenario: str
    facts: tuple[Any, ...]


@dataclass(frozen=True)
class Outcome:
    """What a criterion's verdict says, as far as a change must keep it. `mistake` is "" unless it failed."""

    status: str
    mistake: str = ""
    cause: str = ""
    step: str = ""
    observed: str = ""
    same_as: str = ""


@dataclass(frozen=True)
class Recording:
    """One check of one submission, such as "i1.1/wrong/rate-as-period".

    `calls`: for each criterion that was judged, the call that gave its verdict. `outcomes`: the verdicts at the time of
    recording, by criterion.
    """

    case: str
    calls: tuple[JudgeCall, ...]
    outcomes: Mapping[str, Outcome] = field(default_factory=dict)

    @property
    def exercise(self) -> str:
        """The exercise's id."""
        return self.case.partition("/")[0]


def write(recording: Recording, folder: Path) -> Path:
    """Write a recording into a folder; facts that several calls share are stored once. Return the file."""
    objects: list[Any] = []
    places: dict[int, int] = {}

    def place(facts: Any) -> int:
        if id(facts) not in places:
            places[id(facts)] = len(objects)
            objects.append(facts)
        return places[id(facts)]

    calls = [(call.criterion, call.scenario, [place(facts) for facts in call.facts]) for call in recording.calls]
    document = {
        "case": recording.case,
        "calls": calls,
        "outcomes": recording.outcomes,
        "facts": [(_type_name(each), each) for each in objects],
    }
    file = folder / f"{recording.case.replace('/', '.')}{SUFFIX}"
    folder.mkdir(parents=True, exist_ok=True)
    file.write_bytes(zlib.compress(msgspec.msgpack.encode(document), 9))
    return file


def read(file: Path, moved: Mapping[str, str] | None = None) -> Recording:
    """Read a recording. `moved`: where classes of facts are now, "module:Class" to "module:Class"."""
    document = msgspec.msgpack.decode(zlib.decompress(file.read_bytes()))
    facts = [_facts(name, value, moved or {}) for name, value in document["facts"]]
    calls = (
        JudgeCall(criterion, scenario, tuple(facts[at] for at in used))
        for criterion, scenario, used in document["calls"]
    )
    return Recording(document["case"], tuple(calls), msgspec.convert(document["outcomes"], dict[str, Outcome]))


def read_all(folder: Path, wanted: Iterable[str] = ()) -> list[Recording]:
    """Read the recordings whose cases start with one of `wanted` (all if empty), in order."""
    prefixes = tuple(wanted)
    files = sorted(folder.glob(f"*{SUFFIX}"))
    chosen = [
        each for each in files if not prefixes or each.name.startswith(tuple(p.replace("/", ".") for p in prefixes))
    ]
    return [read(each) for each in chosen]


def _type_name(facts: Any) -> str:
    """The type of facts as "module:Class"; of a tuple, as "(module:Class)", the type that all of its items have."""
    if isinstance(facts, tuple) and facts and type(facts) is tuple:
        names = {_type_name(item) for item in facts}
        assert len(names) == 1, f"facts of several types in one tuple: {names}"
        return f"({names.pop()})"
    return f"{type(facts).__module__}:{type(facts).__qualname__}"


def _facts(name: str, value: Any, moved: Mapping[str, str]) -> Any:
    name = moved.get(name, name)
    if name.startswith("("):
        return tuple(_facts(name[1:-1], item, moved) for item in value)
    return None if value is None else msgspec.convert(value, _load(name), strict=False)


def _load(name: str) -> Any:
    module, _, attribute = name.partition(":")
    found: Any = importlib.import_module(module)
    for part in attribute.split("."):
        found = getattr(found, part)
    return found


def scenario_name(scenario: Any) -> str:
    """The name of a scenario, or of its class, by which a recording finds its early judge again."""
    return str(getattr(scenario, "__qualname__", None) or type(scenario).__qualname__)


def outcome(verdict: Verdict) -> Outcome:
    """What to compare of a verdict."""
    return Outcome(
        verdict.status.value, verdict.mistake, verdict.cause, verdict.step, verdict.observed, verdict.same_as
    )

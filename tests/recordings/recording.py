"""A recording: the calls of judges that led to the verdicts on one submission, with the facts that they got.

Judges are pure functions of facts, so the same calls show what a changed judge, or a changed catalogue of mistakes,
makes of the same facts. Stored as MessagePack, which keeps NaN and bytes, compressed. The submissions of this course
are recorded in `KEPT`, a file for each exercise; where the code has another name for a class of facts, or for a field,
`python -m tests.recordings.rename` says so in these files.
"""

from __future__ import annotations

import importlib
import lzma
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import msgspec

from tutor.judge.verdict import Verdict

SUFFIX = ".recordings"
KEPT = Path(__file__).parent / "kept"


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
    """Write a recording into a folder, as a file of its own. Return the file."""
    folder.mkdir(parents=True, exist_ok=True)
    return write_documents([to_document(recording)], folder / f"{recording.case.replace('/', '.')}{SUFFIX}")


def write_documents(documents: Sequence[Mapping[str, Any]], file: Path) -> Path:
    """Write recordings, as documents, into one file: together they take half the space. Return the file."""
    file.write_bytes(lzma.compress(msgspec.msgpack.encode(documents), preset=6))
    return file


def to_document(recording: Recording) -> dict[str, Any]:
    """The recording as it is stored: facts that several calls share are stored once."""
    objects: list[Any] = []
    places: dict[int, int] = {}

    def place(facts: Any) -> int:
        if id(facts) not in places:
            places[id(facts)] = len(objects)
            objects.append(facts)
        return places[id(facts)]

    calls = [(call.criterion, call.scenario, [place(facts) for facts in call.facts]) for call in recording.calls]
    return {
        "case": recording.case,
        "calls": calls,
        "outcomes": recording.outcomes,
        "facts": [(_type_name(facts), facts) for facts in objects],
    }


def read_documents(file: Path) -> list[dict[str, Any]]:
    """The recordings in a file, as they are stored."""
    documents: list[dict[str, Any]] = msgspec.msgpack.decode(lzma.decompress(file.read_bytes()))
    return documents


def kept_cases() -> frozenset[str]:
    """The submissions that are recorded in the repository, such as "i1.1/wrong/rate-as-period"."""
    return frozenset(document["case"] for file in KEPT.glob(f"*{SUFFIX}") for document in read_documents(file))


def from_document(document: Mapping[str, Any]) -> Recording:
    """A recording of what is stored."""
    facts = [_facts(name, value) for name, value in document["facts"]]
    calls = (
        JudgeCall(criterion, scenario, tuple(facts[at] for at in used))
        for criterion, scenario, used in document["calls"]
    )
    return Recording(document["case"], tuple(calls), msgspec.convert(document["outcomes"], dict[str, Outcome]))


def read(folder: Path, wanted: Iterable[str] = ()) -> Iterator[Recording]:
    """Yield the recordings in a folder whose cases start with one of `wanted` (all if empty), in order of the files."""
    prefixes = tuple(wanted) or ("",)
    for file in sorted(folder.glob(f"*{SUFFIX}")):
        if file.name.startswith(tuple(prefix.replace("/", ".") for prefix in prefixes)) or any(
            prefix.startswith(file.name.removesuffix(SUFFIX)) for prefix in prefixes
        ):
            for document in read_documents(file):
                if document["case"].startswith(prefixes):
                    yield from_document(document)


def accept(folder: Path, outcomes: Mapping[str, Mapping[str, Outcome]]) -> None:
    """Write other outcomes, by case, into the recordings in a folder."""
    for file in folder.glob(f"*{SUFFIX}"):
        documents = read_documents(file)
        write_documents([{**old, "outcomes": outcomes.get(old["case"], old["outcomes"])} for old in documents], file)


def _type_name(facts: Any) -> str:
    """The type of facts as "module:Class"; of a tuple, as "(module:Class)", the type that all of its items have."""
    if isinstance(facts, tuple) and facts and type(facts) is tuple:
        names = {_type_name(item) for item in facts}
        assert len(names) == 1, f"facts of several types in one tuple: {names}"
        return f"({names.pop()})"
    return f"{type(facts).__module__}:{type(facts).__qualname__}"


def _facts(name: str, value: Any) -> Any:
    if name.startswith("("):
        return tuple(_facts(name[1:-1], item) for item in value)
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

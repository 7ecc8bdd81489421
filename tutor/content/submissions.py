"""Test submissions: right and wrong answers to the exercises, each with its expected verdict.

Each is a folder `<exercise>/<right|wrong>/<name>/` with the learner's files and an `expect.yaml`, or a file
`<exercise>/<right|wrong>/<name>.yaml`, a patch of the solution (see `patches`). `Expected` describes their keys.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from tutor.content.fields import Document, Fields
from tutor.content.patches import Change, read_changes
from tutor.errors import ContentError

EXPECT = "expect.yaml"
PATCH = ".yaml"
RIGHT, WRONG = "right", "wrong"


@dataclass(frozen=True, slots=True)
class Expected:
    """The expected verdict on a submission. A criterion that no key names passes (or, in a wrong one, is skipped).

    - `says`: what the submission does right or wrong, for people
    - `passes`: every required criterion passes
    - `fails`: criteria that fail; of `fails_any`, at least one fails
    - `not_passed`: criteria that fail or are skipped
    - `either`: criteria that may have any verdict but an error
    - `bonus_failed`: bonus criteria that fail
    - `causes`: maps a criterion ("" stands for all that fail) to texts, one of which its cause contains
    - `mistakes`: in the same way, ids of mistakes in the catalogue, one of which it is (`mistake` in the file)
    - `gone`: a text that is in no process's command line afterwards
    - `ros`: the only kind of ROS for which this holds, unless empty
    - `exit`: the exit code of `ros-tutor check`, if given; with 3, criteria may end in an error
    - `keeps_busy`: its processes use all the CPU they get, so that several at once would starve each other
    """

    says: str
    passes: bool = False
    fails: tuple[str, ...] = ()
    fails_any: tuple[str, ...] = ()
    not_passed: tuple[str, ...] = ()
    either: tuple[str, ...] = ()
    bonus_failed: tuple[str, ...] = ()
    causes: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    gone: str = ""
    ros: str = ""
    exit: int | None = None
    keeps_busy: bool = False
    mistakes: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def named(self) -> Mapping[str, tuple[str, ...]]:
        """The keys that name criteria, and the criteria each of them names."""
        return {
            "fails": self.fails,
            "fails_any": self.fails_any,
            "not_passed": self.not_passed,
            "either": self.either,
            "bonus_failed": self.bonus_failed,
        }

    @property
    def diagnoses(self) -> Mapping[str, Mapping[str, tuple[str, ...]]]:
        """The keys that say how a failure is explained, with their texts by criterion."""
        return {"cause": self.causes, "mistake": self.mistakes}


@dataclass(frozen=True, slots=True)
class Case:
    """One submission. `exercise` is the exercise's id, `kind` is "right" or "wrong".

    `folder` has its files; of a patch, it is the patch itself, and `changes` are those to the solution.
    """

    exercise: str
    kind: str
    folder: Path
    expected: Expected
    changes: tuple[Change, ...] = ()

    @property
    def source(self) -> Path:
        """The file with what is expected."""
        return self.folder if self.changes else self.folder / EXPECT

    def __str__(self) -> str:
        return f"{self.exercise}/{self.kind}/{self.folder.stem if self.changes else self.folder.name}"


def read_expected(file: Path) -> Expected:
    """Read an `expect.yaml`.

    Raises ContentError if it cannot be read, or if a key is missing, unknown or of the wrong type.
    """
    fields = _read_fields(file)
    expected = _take_expected(fields)
    fields.done()
    return expected


def _read_fields(file: Path) -> Fields:
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ContentError(file, f"it cannot be read: {error}") from error
    return Document(file, text).read()


def _take_expected(fields: Fields) -> Expected:
    passes = fields.text("passes", optional=True)
    if passes not in ("", "all"):
        raise fields.error("passes", f"expected all, found {passes!r}")
    return Expected(
        says=fields.text("says"),
        passes=passes == "all",
        fails=fields.texts("fails", optional=True),
        fails_any=fields.texts("fails_any", optional=True),
        not_passed=fields.texts("not_passed", optional=True),
        either=fields.texts("either", optional=True),
        bonus_failed=fields.texts("bonus_failed", optional=True),
        causes=_texts_by_criterion(fields, "cause"),
        gone=fields.text("gone", optional=True),
        ros=fields.text("ros", optional=True),
        exit=None if (code := fields.number("exit")) is None else int(code),
        keeps_busy=fields.flag("keeps_busy", default=False),
        mistakes=_texts_by_criterion(fields, "mistake"),
    )


def read_case(path: Path) -> Case:
    """Read the submission in this folder, or this patch.

    Raises ContentError if the file that says what is expected is missing or broken.
    """
    exercise, kind = path.parts[-3].replace("_", "."), path.parts[-2]
    if path.suffix != PATCH or path.is_dir():
        return Case(exercise, kind, path, read_expected(path / EXPECT))
    fields = _read_fields(path)
    changes = read_changes(fields, path)
    if not changes:
        raise fields.error("change", "this field is missing: say what of the solution becomes what")
    expected = _take_expected(fields)
    fields.done()
    return Case(exercise, kind, path, expected, changes)


def _texts_by_criterion(fields: Fields, key: str) -> Mapping[str, tuple[str, ...]]:
    value = fields.anything(key)
    found = value if isinstance(value, dict) else {"": value or []}
    texts_of: dict[str, tuple[str, ...]] = {}
    for name, entry in found.items():
        texts = [entry] if isinstance(entry, str) else entry
        if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
            raise fields.error(key, "expected a text or a list of texts, or one of these for each criterion")
        texts_of[str(name)] = tuple(texts)
    return {name: texts for name, texts in texts_of.items() if texts}

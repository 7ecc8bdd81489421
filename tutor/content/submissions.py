"""Test submissions: right and wrong answers to the exercises, each with its expected verdict.

Each is a folder `<exercise>/<right|wrong>/<name>/` with the learner's files and an `expect.yaml`; `Expected` describes
the keys of the latter.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from tutor.content.fields import Document, Fields
from tutor.errors import ContentError

EXPECT = "expect.yaml"
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


@dataclass(frozen=True, slots=True)
class Case:
    """One submission folder. `exercise` is the exercise's id, `kind` is "right" or "wrong"."""

    exercise: str
    kind: str
    folder: Path
    expected: Expected

    def __str__(self) -> str:
        return f"{self.exercise}/{self.kind}/{self.folder.name}"


def read_expected(file: Path) -> Expected:
    """Read an `expect.yaml`.

    Raises ContentError if it cannot be read, or if a key is missing, unknown or of the wrong type.
    """
    try:
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ContentError(file, f"it cannot be read: {error}") from error
    fields = Document(file, text).read()
    passes = fields.text("passes", optional=True)
    if passes not in ("", "all"):
        raise fields.error("passes", f"expected all, found {passes!r}")
    expected = Expected(
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
    )
    fields.done()
    return expected


def read_case(folder: Path) -> Case:
    """Read the submission in this folder.

    Raises ContentError if its `expect.yaml` is missing or broken.
    """
    exercise, kind = folder.parts[-3].replace("_", "."), folder.parts[-2]
    return Case(exercise, kind, folder, read_expected(folder / EXPECT))


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

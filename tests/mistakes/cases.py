"""Cases made from a page's examples, and what the catalogue says about a program."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from tests.checks.builders import trace
from tutor.judge.symptom import Symptom
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame
from tutor.mistakes import CATALOGUE, Case, Catalogue, Diagnosis, Mistake, why

CHECKS = Path(__file__).parents[2] / "checks"


def all_catalogues() -> Iterator[tuple[str, Catalogue]]:
    """Ours and those of the exercises, each with the name of where it is."""
    yield "ours", CATALOGUE
    for module in sorted((*CHECKS.glob("*/mistakes.py"), *CHECKS.glob("*/mistakes/__init__.py"))):
        exercise = module.relative_to(CHECKS).parts[0]
        yield exercise, importlib.import_module(f"checks.{exercise}.mistakes").CATALOGUE


def case_of(mistake: Mistake, source: str) -> Case:
    """The case in which a mistake is asked about an example, as the only file of a program."""
    if mistake.example is not None:
        return Case(mistake.example(source))
    symptom = min(mistake.explains, key=lambda each: each.name)
    return Case(symptom.seen(Trace("node.py", sources={"node.py": source})))


def told(
    symptom: Symptom,
    source: str,
    *,
    files: Mapping[str, str] | None = None,
    run: Trace | None = None,
    stuck: Sequence[Frame] = (),
    answers: bool = True,
    **about: Any,
) -> Diagnosis:
    """What our catalogue says about a program whose node is up, and of which `run` shows anything else."""
    sources = {"node.py": source, **(files or {})}
    seen = replace(run or trace(), sources=sources)
    return why(symptom.seen(seen, stuck=tuple(stuck), answers=answers, **about), [CATALOGUE])


def assert_told(found: Diagnosis, mistake: str, words: str = "") -> None:
    """Fail unless this mistake is told, with these words in the cause, the step or the line."""
    assert found.mistake == mistake, found
    assert words in f"{found.cause} | {found.step} | {found.file}:{found.line}", found

"""Cases made from a page's examples."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from pathlib import Path

from tutor.judge.trace import Trace
from tutor.mistakes import CATALOGUE, Case, Catalogue, Mistake

CHECKS = Path(__file__).parents[2] / "checks"


def all_catalogues() -> Iterator[tuple[str, Catalogue]]:
    """Ours and those of the exercises, each with the name of where it is."""
    yield "ours", CATALOGUE
    for module in sorted(CHECKS.glob("*/mistakes*")):
        yield module.parent.name, importlib.import_module(f"checks.{module.parent.name}.mistakes").CATALOGUE


def case_of(mistake: Mistake, source: str) -> Case:
    """The case in which a mistake is asked about an example, as the only file of a program."""
    if mistake.example is not None:
        return Case(mistake.example(source))
    symptom = min(mistake.explains, key=lambda each: each.name)
    return Case(symptom.seen(Trace("node.py", sources={"node.py": source})))

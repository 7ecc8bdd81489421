"""docs/forms.md is what the docstrings say."""

from __future__ import annotations

from tests.exercise.docs import COMMAND, FILE, document


def test_the_forms_in_docs_are_those_of_the_docstrings() -> None:
    assert FILE.read_text(encoding="utf-8") == document(), f"{FILE.name} is out of date: run `{COMMAND}`"

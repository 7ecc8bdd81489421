"""A page in parts, as front ends show it."""

from __future__ import annotations

from tests.mistakes.cases import all_catalogues
from tutor.judge.symptom import Symptom
from tutor.mistakes import Case, Catalogue, Found
from tutor.mistakes.pages import Section, sections_of

CATALOGUE = Catalogue()


@CATALOGUE.mistake("bell-rings-twice", explains=[Symptom.WRONG_RATE], says="", do="")
def _bell_rings_twice(case: Case) -> list[Found]:
    """A bell rings twice.

    It has
    two hammers.

    - One is
      of iron.
    - One is not.

    Bad:

        def ring():
            strike()

            strike()

    Good:

        def ring():
            strike()

    See it: `ros2 topic echo /bell`,
    twice.

    Lesson: i1.1, on bells.
    """
    return []


def test_paragraphs_are_joined_and_examples_are_whole() -> None:
    assert list(sections_of(CATALOGUE.entries["bell-rings-twice"])) == [
        Section("", "It has two hammers."),
        Section("", "- One is of iron."),
        Section("", "- One is not."),
        Section("Bad", "def ring():\n    strike()\n\n    strike()", code=True),
        Section("Good", "def ring():\n    strike()", code=True),
        Section("See it", "`ros2 topic echo /bell`, twice."),
        Section("Lesson", "i1.1, on bells."),
    ]


def test_every_page_has_its_examples_as_the_catalogue_finds_them() -> None:
    for _, catalogue in all_catalogues():
        for entry in catalogue.entries.values():
            code = [section.text for section in sections_of(entry) if section.code]
            assert code == [text for pair in entry.examples for text in pair], entry.id
            text = " ".join(section.text for section in sections_of(entry))
            for word in entry.page.partition("\n")[2].split():
                assert word in text or word in ("Bad:", "Good:", "it:", "See", "Lesson:"), (entry.id, word)

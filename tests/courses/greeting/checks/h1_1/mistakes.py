"""The mistakes that only a greeter can make; those of timers, topics and the like are in the catalogue already."""

from __future__ import annotations

from collections.abc import Iterator

from tutor.judge.symptom import Symptom
from tutor.judge.trace import Trace
from tutor.mistakes import Case, Catalogue, Evidence, Found

CATALOGUE = Catalogue()


@CATALOGUE.mistake(
    "greets-nobody",
    explains=[Symptom.WRONG_VALUES],
    evidence=Evidence.SYMPTOM,
    says="“{text}” greets nobody",
    do="Begin the text with a word of welcome.",
    example=lambda source: Symptom.WRONG_VALUES.seen(Trace("node.py", sources={"node.py": source}), text="rain today"),
)
def greets_nobody(case: Case) -> Iterator[Found]:
    """A text is no greeting.

    Whoever listens waits for a certain word, and takes no other.

    Bad:

        self.publisher.publish(String(data='rain today'))

    Good:

        self.publisher.publish(String(data='welcome, rain today'))

    See it: `ros2 topic echo TOPIC`.
    """
    if case.about("text"):
        yield Found({"text": case.about("text")})

"""The catalogue of mistakes: what a symptom comes from, said in words, with a page on each.

A criterion reports a symptom (`tutor.judge.symptom`) and names no mistake; a mistake explains symptoms and knows no
exercise. What only an exercise can know is declared in the exercise, in a `Catalogue` of its own.
"""

from tutor.mistakes import themes as themes  # registers the entries
from tutor.mistakes.diagnosis import Diagnosis, catalogues_of, explain, remarks, why
from tutor.mistakes.entry import (
    CATALOGUE,
    EVERY_SYMPTOM,
    Case,
    Catalogue,
    Evidence,
    Found,
    Mistake,
    found,
    found_at,
    mistake,
)

__all__ = [
    "CATALOGUE",
    "EVERY_SYMPTOM",
    "Case",
    "Catalogue",
    "Diagnosis",
    "Evidence",
    "Found",
    "Mistake",
    "catalogues_of",
    "explain",
    "found",
    "found_at",
    "mistake",
    "remarks",
    "why",
]

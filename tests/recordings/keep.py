"""Keep recordings of a run in the repository, one file for each exercise.

    uv run python -m tests.recordings.keep FOLDER

What was recorded of a submission takes the place of what is kept of it; what was kept of one that is gone is dropped.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from tests.judging import find_cases
from tests.recordings.recording import KEPT, SUFFIX, read_documents, write_documents


def keep(folder: Path, kept: Path, cases: frozenset[str]) -> dict[str, int]:
    """Put the recordings in a folder among those kept, of `cases` only. Return how many each exercise has."""
    documents: dict[str, Any] = {}
    for file in (*sorted(kept.glob(f"*{SUFFIX}")), *sorted(folder.glob(f"*{SUFFIX}"))):
        documents |= {document["case"]: document for document in read_documents(file)}
    by_exercise: dict[str, list[Any]] = {}
    for case in sorted(documents.keys() & cases):
        by_exercise.setdefault(case.partition("/")[0], []).append(documents[case])
    kept.mkdir(exist_ok=True)
    for file in kept.glob(f"*{SUFFIX}"):
        file.unlink()
    for exercise, chosen in by_exercise.items():
        write_documents(chosen, kept / f"{exercise}{SUFFIX}")
    return {exercise: len(chosen) for exercise, chosen in by_exercise.items()}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    cases, _ = find_cases()
    for exercise, count in keep(parser.parse_args().folder, KEPT, frozenset(map(str, cases))).items():
        print(f"{exercise}: {count} submissions")


if __name__ == "__main__":
    main()

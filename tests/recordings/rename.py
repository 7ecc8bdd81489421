"""Say in recordings that a class of facts, or a field of it, has another name now: no submission has to run again.

    uv run python -m tests.recordings.rename tutor.judge.trace:Trace tutor.judge.run:Run
    uv run python -m tests.recordings.rename FIELD NEW_FIELD [--folder FOLDER]

A class is named as `module:Class`. A field without a class is renamed wherever it occurs in facts: take care with a
name that several classes use for different things.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from tests.recordings.recording import KEPT, SUFFIX, read_documents, write_documents


def renamed(document: Mapping[str, Any], old: str, new: str) -> dict[str, Any]:
    """A recording, as it is stored, in which a class or a field has another name."""
    if ":" in old:
        facts = [(_class_renamed(name, old, new), value) for name, value in document["facts"]]
    else:
        facts = [(name, _field_renamed(value, old, new)) for name, value in document["facts"]]
    return {**document, "facts": facts}


def _class_renamed(name: str, old: str, new: str) -> str:
    if name.startswith("("):
        return f"({_class_renamed(name[1:-1], old, new)})"
    return new if name == old else name


def _field_renamed(value: Any, old: str, new: str) -> Any:
    if isinstance(value, dict):
        return {new if key == old else key: _field_renamed(item, old, new) for key, item in value.items()}
    return [_field_renamed(item, old, new) for item in value] if isinstance(value, list) else value


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--folder", type=Path, default=KEPT)
    arguments = parser.parse_args()
    if (":" in arguments.old) != (":" in arguments.new):
        parser.error("give two classes, as module:Class, or two fields")
    for file in sorted(arguments.folder.glob(f"*{SUFFIX}")):
        write_documents([renamed(each, arguments.old, arguments.new) for each in read_documents(file)], file)


if __name__ == "__main__":
    main()

"""docs/mistakes is what the catalogue says."""

from __future__ import annotations

from tests.mistakes.docs import COMMAND, FOLDER, documents


def test_the_pages_in_docs_are_those_of_the_catalogue() -> None:
    written = {path.name: path.read_text(encoding="utf-8") for path in FOLDER.glob("*.md")}
    made = documents()
    changed = sorted(name for name in made.keys() | written.keys() if made.get(name) != written.get(name))
    assert not changed, f"docs/mistakes is out of date ({', '.join(changed)}): run `{COMMAND}`"

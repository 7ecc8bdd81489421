"""Digests of the learner's files."""

from __future__ import annotations

from pathlib import Path

from tutor.workspace import digest_of_text, digests_of, has_changed


def test_a_digest_is_that_of_the_content_and_a_file_that_cannot_be_read_has_none(tmp_path: Path) -> None:
    there, missing, folder = tmp_path / "a.py", tmp_path / "b.py", tmp_path / "c.py"
    there.write_text("é = 1\n")
    folder.mkdir()
    found = digests_of({"a.py": there, "b.py": missing, "c.py": folder})
    assert found == {"a.py": digest_of_text("é = 1\n"), "b.py": "", "c.py": ""}


def test_a_file_has_changed_if_it_was_edited_added_or_removed_since_and_that_is_known() -> None:
    judged = {"server.py": "1"}
    assert has_changed(judged, {"server.py": "1", "client.py": ""}) is False
    assert has_changed(judged, {}) is None, "not read yet"
    assert has_changed({}, {"server.py": "1"}) is None, "an unknown version was judged"
    assert has_changed(judged, {"server.py": "2"})
    assert has_changed(judged, {"server.py": ""})
    assert has_changed(judged, {"server.py": "1", "client.py": "3"})

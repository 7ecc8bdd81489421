"""A file is written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tutor.errors import StorageError
from tutor.workspace import write_atomically


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    folder = tmp_path / "folder"
    folder.mkdir()
    return folder


def test_writing_and_replacing_leaves_no_other_files(folder: Path) -> None:
    file = folder / "report.json"
    write_atomically(file, "one")
    file.chmod(0o640)
    write_atomically(file, "two ±")
    assert file.read_text(encoding="utf-8") == "two ±"
    assert file.stat().st_mode & 0o777 == 0o640
    assert list(folder.iterdir()) == [file]


def test_a_symlink_is_written_through(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "real")
    write_atomically(tmp_path / "link", "text")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "real").read_text() == "text"


def test_a_pipe_is_written_to(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    reader = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)  # a reader, without which the writer would block
    try:
        write_atomically(tmp_path / "pipe", "text")
        assert os.read(reader, 100) == b"text"
    finally:
        os.close(reader)


def test_a_missing_folder_is_reported(tmp_path: Path) -> None:
    with pytest.raises(StorageError, match=r"cannot write .*/no/report\.json: No such file or directory"):
        write_atomically(tmp_path / "no" / "report.json", "text")


def test_a_failure_leaves_the_old_content(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = folder / "report.json"
    file.write_text("old")

    def fail(_: int) -> None:
        raise OSError(5, "Input/output error")

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(StorageError, match="Input/output error"):
        write_atomically(file, "new")
    assert file.read_text() == "old"
    assert list(folder.iterdir()) == [file]

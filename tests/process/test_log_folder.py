"""A learner's log folder stays small, and is removed afterwards, whatever the learner turns it into."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable
from pathlib import Path

import pytest

from tutor.process.log_folder import MAX_OPENED, keep_small, keep_small_until_cancelled, temporary_log_folder


def symlink(folder: Path, elsewhere: Path) -> None:
    folder.rename(elsewhere / "moved")
    folder.symlink_to(elsewhere)


def regular_file(folder: Path, elsewhere: Path) -> None:
    folder.rename(elsewhere / "moved")
    folder.touch()


def other_folder(folder: Path, elsewhere: Path) -> None:
    folder.rename(elsewhere / "moved")
    (folder / "sub").mkdir(parents=True)


def deep_tree(folder: Path, elsewhere: Path) -> None:
    inner = os.open(folder, os.O_RDONLY)
    for _ in range(1500):
        os.mkdir("d", dir_fd=inner)
        deeper = os.open("d", os.O_RDONLY, dir_fd=inner)
        os.close(inner)
        inner = deeper
    os.close(inner)
    (folder / "d").chmod(0)
    folder.chmod(0)


def removed(folder: Path, elsewhere: Path) -> None:
    folder.rmdir()


def links_inside(folder: Path, elsewhere: Path) -> None:
    (folder / "a.log").symlink_to(elsewhere / "kept.log")
    (folder / "b").symlink_to(elsewhere)
    os.mkfifo(folder / "c.log")


@pytest.mark.parametrize("change", [symlink, regular_file, other_folder, deep_tree, removed, links_inside])
async def test_the_folder_is_removed_whatever_it_has_become(
    change: Callable[[Path, Path], None], tmp_path: Path
) -> None:
    (tmp_path / "kept.log").write_text("kept")
    with temporary_log_folder() as folder:
        change(folder, tmp_path)
    assert not os.path.lexists(folder)
    assert os.listdir(tmp_path) == ["kept.log"]
    assert (tmp_path / "kept.log").read_text() == "kept"


def test_only_log_files_are_emptied_when_they_grow_too_big(tmp_path: Path) -> None:
    logs, elsewhere = tmp_path / "logs", tmp_path / "elsewhere"
    (logs / "launch").mkdir(parents=True)
    elsewhere.mkdir()
    big = b"x" * 100_000
    for name in ("logs/node.log", "logs/launch/launch.log", "logs/notes.txt", "elsewhere/a.log", "elsewhere/b.log"):
        (tmp_path / name).write_bytes(big)
    (logs / "a.log").symlink_to(elsewhere / "a.log")
    (logs / "b.log").hardlink_to(elsewhere / "b.log")
    os.mkfifo(logs / "c.log")
    folder = os.open(logs, os.O_RDONLY)
    try:
        keep_small(folder, max_bytes=300_000)
        assert (logs / "node.log").stat().st_size == len(big)
        with (logs / "node.log").open("ab") as log:
            keep_small(folder, max_bytes=150_000)
            log.write(b"next")
    finally:
        os.close(folder)
    assert (logs / "node.log").read_bytes() == b"next"
    assert (logs / "launch/launch.log").stat().st_size == 0
    assert {(tmp_path / name).stat().st_size for name in ("logs/notes.txt", "elsewhere/a.log", "elsewhere/b.log")} == {
        len(big)
    }


async def test_a_large_log_among_many_is_emptied_repeatedly(tmp_path: Path) -> None:
    logs = tmp_path / "log"
    limiting = asyncio.create_task(keep_small_until_cancelled(logs, max_bytes=150_000))
    try:
        await asyncio.sleep(0)  # the folder does not exist yet
        logs.mkdir()
        for number in range(MAX_OPENED + 20):
            (logs / f"{number}.log").write_bytes(b"x")
        for text in ("once", "again"):
            (logs / "node.log").write_bytes(text.encode() * 50_000)
            async with asyncio.timeout(20):
                while (logs / "node.log").stat().st_size:
                    await asyncio.sleep(0.02)
        assert (logs / "0.log").stat().st_size <= 1
    finally:
        limiting.cancel()

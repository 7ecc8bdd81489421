"""Modules that a learner's program may have changed on disk are not imported."""

from __future__ import annotations

import importlib
import os
import py_compile
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tutor.engine import unchanged


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of modules, in the state in which learners' programs begin to run."""
    for name in ("kept_as_it_was", "replaced_later", "compiled_later"):
        (tmp_path / f"{name}.py").write_text("is_ours = True\n")
    monkeypatch.syspath_prepend(tmp_path)
    modules = set(sys.modules)
    monkeypatch.setattr(sys, "meta_path", list(sys.meta_path))
    time.sleep(0.05)  # file timestamps have a resolution of some milliseconds
    unchanged.refuse_changed_modules()
    time.sleep(0.05)
    yield tmp_path
    for name in set(sys.modules) - modules:
        del sys.modules[name]


def import_is_ours(name: str) -> bool:
    return bool(importlib.import_module(name).is_ours)


def test_an_unchanged_module_is_imported(folder: Path) -> None:
    assert import_is_ours("kept_as_it_was")


def test_a_replaced_module_is_refused(folder: Path) -> None:
    file = folder / "replaced_later.py"
    before = file.stat()
    file.write_text("is_ours = None\n")
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))
    with pytest.raises(ImportError, match=r"replaced_later\.py was changed while a program was checked"):
        import_is_ours("replaced_later")


def test_an_added_module_is_refused(folder: Path) -> None:
    (folder / "added_later").mkdir()
    (folder / "added_later" / "__init__.py").write_text("is_ours = None\n")
    with pytest.raises(ImportError, match="was changed"):
        import_is_ours("added_later")


def test_a_planted_bytecode_file_is_ignored(folder: Path) -> None:
    source = folder / "compiled_later.py"
    (folder / "other.py").write_text("is_ours = None\n")
    cached = importlib.util.cache_from_source(str(source))
    py_compile.compile(
        str(folder / "other.py"), cached, invalidation_mode=py_compile.PycInvalidationMode.UNCHECKED_HASH
    )
    assert import_is_ours("compiled_later")

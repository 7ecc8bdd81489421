"""What a learner's program may have written where our modules are is not run."""

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
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of modules, as they are when learners' programs begin to run."""
    for name in ("kept_as_it_was", "replaced_later", "compiled_later"):
        (tmp_path / f"{name}.py").write_text("is_ours = True\n")
    monkeypatch.syspath_prepend(tmp_path)
    modules = set(sys.modules)
    monkeypatch.setattr(sys, "meta_path", list(sys.meta_path))
    time.sleep(0.05)  # the system's clock of changes is as coarse as some milliseconds
    unchanged.refuse_changed_modules()
    time.sleep(0.05)
    yield tmp_path
    for name in set(sys.modules) - modules:
        del sys.modules[name]


def imported(name: str) -> bool:
    return bool(importlib.import_module(name).is_ours)


def test_what_stayed_as_it_was_is_imported(place: Path) -> None:
    assert imported("kept_as_it_was")


def test_what_was_replaced_is_not(place: Path) -> None:
    file = place / "replaced_later.py"
    before = file.stat()
    file.write_text("is_ours = None\n")
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))
    with pytest.raises(ImportError, match=r"replaced_later\.py was changed while a program was checked"):
        imported("replaced_later")


def test_what_was_added_is_not(place: Path) -> None:
    (place / "added_later").mkdir()
    (place / "added_later" / "__init__.py").write_text("is_ours = None\n")
    with pytest.raises(ImportError, match="was changed"):
        imported("added_later")


def test_what_was_compiled_is_read_from_its_source(place: Path) -> None:
    source = place / "compiled_later.py"
    (place / "other.py").write_text("is_ours = None\n")
    cached = importlib.util.cache_from_source(str(source))
    py_compile.compile(str(place / "other.py"), cached, invalidation_mode=py_compile.PycInvalidationMode.UNCHECKED_HASH)
    assert imported("compiled_later")

"""Modules that a learner's program may have changed on disk are not imported."""

from __future__ import annotations

import base64
import csv
import hashlib
import importlib
import os
import py_compile
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from tutor.engine import loading


def record(folder: Path, *names: str) -> None:
    """Write the RECORD of a package in which modules were installed, as installers do."""
    info = folder / "package-1.0.dist-info"
    info.mkdir(exist_ok=True)
    with (info / "RECORD").open("w", newline="") as file:
        for name in names:
            source = (folder / f"{name}.py").read_bytes()
            digest = base64.urlsafe_b64encode(hashlib.sha256(source).digest()).rstrip(b"=").decode()
            csv.writer(file).writerow([f"{name}.py", f"sha256={digest}", len(source)])


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder of modules, in the state in which learners' programs begin to run."""
    for name in ("kept_as_it_was", "replaced_later", "compiled_later"):
        (tmp_path / f"{name}.py").write_text("is_ours = True\n")
    record(tmp_path, "kept_as_it_was", "replaced_later")
    monkeypatch.syspath_prepend(tmp_path)
    modules = set(sys.modules)
    monkeypatch.setattr(sys, "meta_path", list(sys.meta_path))
    time.sleep(0.05)  # file timestamps have a resolution of some milliseconds
    loading.refuse_changed_modules()
    time.sleep(0.05)
    yield tmp_path
    for name in set(sys.modules) - modules:
        del sys.modules[name]


def import_is_ours(name: str) -> bool:
    return bool(importlib.import_module(name).is_ours)


def test_an_unchanged_module_is_imported(folder: Path) -> None:
    assert import_is_ours("kept_as_it_was")


def test_an_installed_module_that_is_linked_into_another_environment_is_imported(folder: Path) -> None:
    os.link(folder / "kept_as_it_was.py", folder / "in_another_environment.py")
    assert import_is_ours("kept_as_it_was")


def test_a_module_that_no_record_tells_of_is_refused_when_it_is_linked(folder: Path) -> None:
    os.link(folder / "compiled_later.py", folder / "in_another_environment.py")
    with pytest.raises(ImportError, match="was changed"):
        import_is_ours("compiled_later")


@pytest.mark.parametrize("forges_record", [False, True])
def test_a_replaced_module_is_refused(folder: Path, forges_record: bool) -> None:
    file = folder / "replaced_later.py"
    before = file.stat()
    file.write_text("is_ours = None\n")
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))
    if forges_record:
        record(folder, "replaced_later")
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

"""The command line in an empty home, with a fake engine."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

import tutor.engine
from tests.cli.fake_engine import FakeEngine
from tutor.cli import main


@dataclass(frozen=True)
class CliResult:
    code: int
    out: str
    err: str


Run = Callable[..., CliResult]


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    home = tmp_path / "home"
    home.mkdir()
    monkeypatch.setenv("HOME", str(home))
    for name in ("ROS_TUTOR_WORKSPACE", "ROS_TUTOR_LESSONS", "ROS_TUTOR_DEBUG", "NO_COLOR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(home)
    return home


@pytest.fixture
def engine(monkeypatch: pytest.MonkeyPatch) -> FakeEngine:
    fake = FakeEngine()
    monkeypatch.setattr(tutor.engine, "run_check", fake)
    return fake


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    def run(*argv: str | Path) -> CliResult:
        capsys.readouterr()
        code = main([str(each) for each in argv])
        captured = capsys.readouterr()
        return CliResult(code, captured.out, captured.err)

    return run

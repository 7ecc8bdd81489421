"""`ros-tutor explain`: the page of a mistake, found by its name or by words."""

from __future__ import annotations

import pytest

from tutor.cli import main


def test_a_page_of_another_name_is_announced(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "answered-too-late"]) == 0
    shown = capsys.readouterr()
    assert shown.out.startswith("answered-too-early:")
    assert "there is no mistake 'answered-too-late'; answered-too-early is the one" in " ".join(shown.err.split())


def test_a_page_of_this_name_is_not(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "answered-too-early"]) == 0
    assert "there is no mistake" not in capsys.readouterr().err

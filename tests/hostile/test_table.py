"""What `python -m tests.hostile` accepts as expected."""

from __future__ import annotations

import json
from pathlib import Path

from tests.hostile.__main__ import Checked, check, compare_with_expected, table
from tutor.content.submissions import Case, Expected

RATE_FAILED = Case("i1.1", "hostile", Path("x"), Expected("made", fails=("rate",)))


def report(status: str) -> bytes:
    criterion = {"id": "rate", "bonus": False, "status": status, "cause": "c", "hint": None}
    return json.dumps({"exercises": [{"id": "i1.1", "criteria": [criterion]}]}).encode()


def make_checked(**figures: object) -> Checked:
    return Checked("x", **{"exit": 1, "peak_mb": 200.0, **figures})  # type: ignore[arg-type]


def test_each_deviation_is_reported() -> None:
    def wrong(checked: Checked, written: bytes) -> list[str]:
        compare_with_expected(RATE_FAILED, checked, written, 190.0)
        return checked.wrong

    assert wrong(make_checked(), report("failed")) == []
    assert wrong(make_checked(exit=0), report("passed"))[0] == "exit code 0, not 1"
    assert wrong(make_checked(), report("passed"))[0].startswith("should fail: rate")
    assert wrong(make_checked(), b"{") == ["no report"]
    assert wrong(make_checked(peak_mb=400.0), report("failed")) == ["210 MB above an ordinary check"]
    assert wrong(make_checked(report_kb=2048.0), report("failed")) == ["a report of 2048 KB"]
    assert wrong(make_checked(left=["sleep 9"]), report("failed")) == ["left behind: sleep 9"]


def test_our_own_error_is_accepted_only_if_it_is_expected() -> None:
    error_expected = Case("i1.1", "hostile", Path("x"), Expected("made", exit=3))
    checked = make_checked(exit=3)
    compare_with_expected(error_expected, checked, report("error"), 190.0)
    assert checked.wrong == []
    checked = make_checked(exit=3)
    compare_with_expected(RATE_FAILED, checked, report("error"), 190.0)
    assert checked.wrong[0] == "exit code 3, not 1"


def test_a_real_check_is_measured(tmp_path: Path) -> None:
    (tmp_path / "temperature_publisher.py").write_text("raise SystemExit(1)\n")
    checked, written = check("made", "i1.1", [], tmp_path)
    assert checked.exit == 1
    assert json.loads(written)["verdict"] == "failed"
    assert checked.peak_mb > 20
    assert checked.report_kb > 0.5
    # Nodes of other tests use shared memory at the same time.
    assert [each for each in checked.left if not each.startswith("/dev/shm/")] == []
    assert table([checked]).splitlines()[1].startswith("made ")

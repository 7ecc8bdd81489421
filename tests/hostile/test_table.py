"""What `python -m tests.hostile` calls as expected, and what not."""

from __future__ import annotations

import json
from pathlib import Path

from tests.hostile.__main__ import Checked, check, compare_with_expected, table
from tutor.content.submissions import Case, Expected

RATE_FAILED = Case("i1.1", "hostile", Path("x"), Expected("made", fails=("rate",)))


def report(status: str) -> bytes:
    criterion = {"id": "rate", "bonus": False, "status": status, "cause": "c", "hint": None}
    return json.dumps({"exercises": [{"id": "i1.1", "criteria": [criterion]}]}).encode()


def found(**figures: object) -> Checked:
    return Checked("x", **{"exit": 1, "peak_mb": 200.0, **figures})  # type: ignore[arg-type]


def test_what_is_as_expected_and_what_is_not() -> None:
    def wrong(checked: Checked, written: bytes) -> list[str]:
        compare_with_expected(RATE_FAILED, checked, written, 190.0)
        return checked.wrong

    assert wrong(found(), report("failed")) == []
    assert wrong(found(exit=0), report("passed"))[0] == "exit code 0, not 1"
    assert wrong(found(), report("passed"))[0].startswith("should fail: rate")
    assert wrong(found(), b"{") == ["no report"]
    assert wrong(found(peak_mb=400.0), report("failed")) == ["210 MB above an ordinary check"]
    assert wrong(found(report_kb=2048.0), report("failed")) == ["a report of 2048 KB"]
    assert wrong(found(left=["sleep 9"]), report("failed")) == ["left behind: sleep 9"]


def test_our_own_fault_is_expected_only_where_it_is_said() -> None:
    ours = Case("i1.1", "hostile", Path("x"), Expected("made", exit=3))
    checked = found(exit=3)
    compare_with_expected(ours, checked, report("error"), 190.0)
    assert checked.wrong == []
    checked = found(exit=3)
    compare_with_expected(RATE_FAILED, checked, report("error"), 190.0)
    assert checked.wrong[0] == "exit code 3, not 1"


def test_a_real_check_is_measured(tmp_path: Path) -> None:
    (tmp_path / "temperature_publisher.py").write_text("raise SystemExit(1)\n")
    checked, written = check("made", "i1.1", [], tmp_path)
    assert checked.exit == 1
    assert json.loads(written)["verdict"] == "failed"
    assert checked.peak_mb > 20
    assert checked.report_kb > 0.5
    # Nodes of other tests use shared memory meanwhile.
    assert [each for each in checked.left if not each.startswith("/dev/shm/")] == []
    assert table([checked]).splitlines()[1].startswith("made ")

"""The folder of results: written whole, read back as it was, and never trusted."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.grade.made import (
    ADA,
    BRIAN,
    FAULT,
    LEARNERS,
    failing,
    hostile,
    missing,
    not_started,
    passing,
    unjudged,
    whole_class,
)
from tutor.errors import StorageError
from tutor.grade.learners import Learner
from tutor.grade.results import Result, ResultFolder, decode, encode
from tutor.judge.result import Restriction


def kinds() -> list[Result]:
    isolated = replace(passing(ADA).report, isolation=(Restriction("user", True, "x"), Restriction("net", False, "y")))
    return [*whole_class(), replace(passing(ADA), report=isolated, attempt=2)]


@pytest.mark.parametrize("result", kinds(), ids=lambda result: f"{result.learner.id}-{result.exercise}-{result.status}")
def test_every_kind_of_result_survives(result: Result) -> None:
    again = decode(encode(result))
    assert encode(again) == encode(result)
    assert (again.learner, again.exercise, again.digest, again.version) == (
        result.learner,
        result.exercise,
        result.digest,
        result.version,
    )
    assert (again.status, again.unjudged, again.cpu_s, again.attempt) == (
        result.status,
        result.unjudged,
        result.cpu_s,
        result.attempt,
    )
    assert json.loads(encode(result))["status"] == result.status


def test_what_each_status_means() -> None:
    assert [
        result.status for result in (passing(ADA), failing(ADA), missing(ADA), unjudged(ADA), not_started(ADA))
    ] == [*("passed", "failed", "missing", "error", "error")]
    assert [
        result.unjudged for result in (passing(ADA), failing(ADA), missing(ADA), unjudged(ADA), not_started(ADA))
    ] == [*(False, False, False, True, True)]
    assert not_started(ADA).judged is None


@settings(max_examples=60)
@given(st.text(), st.dictionaries(st.text(max_size=3), st.text(max_size=3), max_size=3))
def test_any_text_survives_or_is_replaced(text: str, columns: dict[str, str]) -> None:
    result = failing(Learner("x", text, text, text, columns), verdict=hostile(text))
    again = decode(encode(result).encode("utf-8", "replace").decode())
    assert encode(decode(encode(again))) == encode(again)


def test_the_folder_holds_a_file_for_each_result(tmp_path: Path) -> None:
    folder = ResultFolder(tmp_path / "deep" / "results")
    for result in whole_class():
        folder.save(result)
    found = list(folder)
    assert len(found) == len(whole_class())
    assert [encode(result) for result in found] == sorted(
        map(encode, whole_class()), key=lambda text: (json.loads(text)["learner"]["id"], json.loads(text)["exercise"])
    )
    assert folder.read(ADA, "i1.1") is not None
    assert folder.read(ADA, "i1.2") is None
    assert sorted(path.name for path in (folder.root / "ada").iterdir()) == ["i1.1.json", "i2.1.json"]


def damage(change: Callable[[dict[str, Any]], object]) -> str:
    document = json.loads(encode(failing(ADA)))
    change(document)
    return json.dumps(document)


DAMAGED = {
    "empty": "",
    "half": encode(passing(ADA))[:500],
    "list": "[]",
    "deep": "[" * 100_000,
    "a newer schema": damage(lambda document: document.update(schema="ros-tutor/result/2")),
    "another schema": damage(lambda document: document.update(schema="ros-tutor/report/1")),
    "no learner": damage(lambda document: document.pop("learner")),
    "learner of another kind": damage(lambda document: document.update(learner="ada")),
    "id of another kind": damage(lambda document: document["learner"].update(id=5)),
    "id leads out": damage(lambda document: document["learner"].update(id="../../ada")),
    "unknown field": damage(lambda document: document["learner"].update(x="y")),
    "another exercise": damage(lambda document: document.update(exercise="../i1.1")),
    "time of another kind": damage(lambda document: document.update(cpu_s="5")),
    "time not finite": damage(lambda document: document.update(cpu_s=float("nan"))),
    "no report": damage(lambda document: document.update(report=None)),
    "report is a list": damage(lambda document: document.update(report=[])),
    "exercises are numbers": damage(lambda document: document["report"].update(exercises=[1])),
    "newer report": damage(lambda document: document["report"].update(schema="ros-tutor/report/2")),
    "text is a number": damage(lambda document: document["report"]["exercises"][0]["criteria"][0].update(text=5)),
    "unknown status": damage(lambda document: document["report"]["exercises"][0]["criteria"][0].update(status="good")),
    "evidence is a number": damage(
        lambda document: document["report"]["exercises"][0]["criteria"][0].update(evidence=5)
    ),
}


@pytest.mark.parametrize("text", DAMAGED.values(), ids=DAMAGED.keys())
def test_a_damaged_file_is_no_result(tmp_path: Path, text: str) -> None:
    with pytest.raises(ValueError):  # noqa: PT011 - for any reason
        decode(text)
    folder = ResultFolder(tmp_path)
    (tmp_path / "ada").mkdir()
    (tmp_path / "ada" / "i1.1.json").write_text(text)
    assert folder.read(ADA, "i1.1") is None
    assert list(folder) == []


def test_a_file_in_anothers_place_is_no_result(tmp_path: Path) -> None:
    folder = ResultFolder(tmp_path)
    folder.save(passing(ADA))
    for name in ("brian/i1.1.json", "ada/i2.1.json", "ada/.i1.1.json"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(encode(passing(ADA)))
    (tmp_path / "ada" / "i1.2.json").mkdir()
    (tmp_path / "latin").mkdir()
    (tmp_path / "latin" / "i1.1.json").write_bytes(b"\xff")
    assert [result.learner for result in folder] == [ADA]
    assert folder.read(ADA, "i2.1") is None
    # A learner may have another name or row now: what was judged is in the same place.
    assert folder.read(replace(ADA, name="Ada King"), "i1.1") == decode(encode(passing(ADA)))


def test_what_a_killed_process_left_is_swept(tmp_path: Path) -> None:
    folder = ResultFolder(tmp_path)
    folder.save(passing(ADA))
    for name in ("ada/.i1.1.json.123.tmp", ".index.html.123.tmp"):
        (tmp_path / name).write_text("half")
    folder.sweep()
    assert sorted(path.name for path in tmp_path.rglob("*")) == ["ada", "i1.1.json"]
    ResultFolder(tmp_path / "none").sweep()


def test_errors_of_the_disk_have_one_type(tmp_path: Path) -> None:
    (tmp_path / "ada").write_text("a file")
    with pytest.raises(StorageError, match="cannot create"):
        ResultFolder(tmp_path).save(passing(ADA))
    (tmp_path / "brian" / "i1.1.json").mkdir(parents=True)
    with pytest.raises(StorageError, match="cannot write"):
        ResultFolder(tmp_path).save(passing(BRIAN))


def test_another_machine_sweeps_while_a_result_is_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = ResultFolder(tmp_path)
    rename = Path.replace
    swept: list[Path] = []

    def sweep_first(path: Path, target: Path) -> Path:
        if not swept:
            swept.append(path)
            folder.sweep()
        return rename(path, target)

    monkeypatch.setattr(Path, "replace", sweep_first)
    folder.save(passing(ADA))
    assert swept
    assert folder.read(ADA, "i1.1") is not None


def test_the_names_of_learners_are_in_no_path(tmp_path: Path) -> None:
    folder = ResultFolder(tmp_path)
    assert all(folder.path_of(learner, "i1.1").parent.parent == tmp_path for learner in LEARNERS)
    assert FAULT.cause in encode(unjudged(ADA))

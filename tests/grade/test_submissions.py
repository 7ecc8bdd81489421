"""Who handed in what: the layouts of the systems around a class, and what is no submission."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest

from tutor.content import load_course
from tutor.errors import UsageError
from tutor.grade.learners import Roster
from tutor.grade.submissions import Work, find_work

FILE = "temperature_publisher.py"
COURSE = load_course()


@pytest.fixture
def scratch(tmp_path: Path) -> Path:
    folder = tmp_path / "scratch"
    folder.mkdir()
    return folder


def write(path: Path, text: str = "print()\n") -> Path:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def by_name(works: list[Work]) -> dict[str, Work]:
    return {work.learner.name: work for work in works}


@pytest.mark.parametrize(
    ("place", "name"),
    [
        (f"ada/{FILE}", "ada"),
        (f"ada/i1_1/{FILE}", "ada"),
        (f"ada/ws/src/my_package/my_package/{FILE}", "ada"),
        (f"Ada Lovelace_123_assignsubmission_file_/{FILE}", "Ada Lovelace"),
        (f"lovelaceada_LATE_12_345_{FILE}", "lovelaceada"),
        ("lovelaceada_12_345_temperature_publisher-1.py", "lovelaceada"),
        (f"i1.1/ada/{FILE}", "ada"),
    ],
)
def test_layouts(place: str, name: str, tmp_path: Path, scratch: Path) -> None:
    write(tmp_path / "class" / place)
    (work,) = find_work(tmp_path / "class", COURSE, scratch)
    assert (work.learner.name, work.exercise) == (name, "i1.1")
    assert Path(FILE).name in {Path(file).name for file in work.files}


def test_an_own_layout_names_learner_and_exercise(tmp_path: Path, scratch: Path) -> None:
    write(tmp_path / "class/group-1/7_ada" / FILE)
    (work,) = find_work(tmp_path / "class", COURSE, scratch, layout="group-*/{number}_{learner}")
    assert (work.learner.id, work.learner.number) == ("ada", "7")
    with pytest.raises(UsageError, match="learner"):
        find_work(tmp_path / "class", COURSE, scratch, layout="{exercise}")


def test_what_cannot_be_judged_is_a_result_that_says_why(tmp_path: Path, scratch: Path) -> None:
    folder = tmp_path / "class"
    write(folder / "misnamed/tempature_publisher.py")
    (folder / "empty").mkdir()
    write(folder / "damaged.zip", "no zip")
    found = by_name(find_work(folder, COURSE, scratch, exercises=["i1.1"]))
    assert not any(work.files for work in found.values())
    assert "tempature_publisher.py is there" in found["misnamed"].missing
    assert found["empty"].missing == "nothing was handed in"
    assert "damaged.zip cannot be unpacked" in found["damaged"].missing
    assert not any("ros-tutor start" in work.missing for work in found.values())


def test_an_archive_writes_nowhere_else_and_brings_no_links(tmp_path: Path, scratch: Path) -> None:
    (tmp_path / "class").mkdir()
    with zipfile.ZipFile(tmp_path / "class/ada.zip", "w") as archive:
        archive.writestr(FILE, "print()\n")
        archive.writestr("../escaped.py", "print()\n")
        link = zipfile.ZipInfo("link.py")
        link.external_attr = 0o120777 << 16
        archive.writestr(link, "/etc/passwd")
    (work,) = find_work(tmp_path / "class", COURSE, scratch)
    assert set(work.files) == {FILE}
    assert not list(tmp_path.rglob("escaped.py"))


def test_a_link_that_leads_out_of_a_submission_is_no_file_of_it(tmp_path: Path, scratch: Path) -> None:
    secret = write(tmp_path / "secret.py")
    (tmp_path / "class/ada").mkdir(parents=True)
    (tmp_path / "class/ada" / FILE).symlink_to(secret)
    (work,) = find_work(tmp_path / "class", COURSE, scratch, exercises=["i1.1"])
    assert not work.files


def test_a_roster_names_learners_and_those_who_handed_in_nothing(tmp_path: Path, scratch: Path) -> None:
    write(tmp_path / "class/al1" / FILE)
    roster = write(tmp_path / "roster.csv", "folder;name;id\nal1;Ada Lovelace;7\ngh2;Grace Hopper;8\n")
    found = by_name(find_work(tmp_path / "class", COURSE, scratch, roster=Roster.read(roster)))
    assert found["Ada Lovelace"].learner.number == "7"
    assert found["Grace Hopper"].missing == "nothing was handed in"


def test_names_that_differ_in_case_only_get_folders_of_their_own(tmp_path: Path, scratch: Path) -> None:
    for name in ("ada", "ADA"):
        write(tmp_path / "class" / name / FILE)
    ids = [work.learner.id.casefold() for work in find_work(tmp_path / "class", COURSE, scratch)]
    assert len(set(ids)) == 2

"""Who handed in what, in every layout that the systems around a class have; nothing is skipped in silence."""

from __future__ import annotations

import os
import tempfile
import zipfile
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.grade.test_archives import encrypt
from tutor.content import Course, load_course
from tutor.errors import UnknownExercise, UsageError
from tutor.grade.layout_pattern import LayoutPattern
from tutor.grade.roster import Roster
from tutor.grade.work import Work, find_work

PUBLISHER, STATS, LAUNCH = "temperature_publisher.py", "message_stats.py", "my_launch.py"
SERVER, CLIENT = "calculator_server.py", "calculator_client.py"


@pytest.fixture(scope="module")
def course() -> Course:
    return load_course()


class Class:
    """A folder of submissions, and what is found in it."""

    def __init__(self, folder: Path, course: Course) -> None:
        self.root = folder / "class"
        self.root.mkdir()
        self.course = course
        self.notes: list[str] = []
        self._scratch = folder / "scratch"
        self._scratch.mkdir()

    def add(self, *names: str, text: str = "") -> None:
        for name in names:
            path = self.root / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text or "# it does nothing")

    def zip(self, name: str, *names: str) -> Path:
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        with zipfile.ZipFile(path, "w") as archive:
            for inner in names:
                archive.writestr(inner, f"# {inner}")
        return path

    def find(
        self,
        *exercises: str,
        layout: str = "",
        roster: Sequence[dict[str, str]] = (),
        root: Path | None = None,
    ) -> dict[str, Work]:
        """Return the work by "LEARNER EXERCISE"."""
        scratch = Path(tempfile.mkdtemp(dir=self._scratch))
        works = find_work(
            root or self.root,
            self.course,
            scratch,
            exercises=exercises,
            layout=layout,
            roster=Roster(roster),
            note=self.notes.append,
        )
        assert len({(work.learner.id, work.exercise) for work in works}) == len(works)
        for work in works:
            assert bool(work.files) + bool(work.missing) + bool(work.fault) == 1
            assert bool(work.digest) is bool(work.files)
            assert (work.lookup is not None) is bool(work.missing)
            assert "ros-tutor" not in work.missing
            assert not work.files or any(self._is_main(work, name) for name in work.files)
        return {f"{work.learner.id} {work.exercise}": work for work in works}

    @staticmethod
    def _is_main(work: Work, name: str) -> bool:
        return work.main in (".", name, os.path.dirname(name))

    def missing(self, *exercises: str, **options: str) -> dict[str, str]:
        return {key: work.missing for key, work in self.find(*exercises, **options).items() if work.missing}  # type: ignore[arg-type]


@pytest.fixture
def made(tmp_path: Path, course: Course) -> Class:
    return Class(tmp_path, course)


def test_a_folder_for_each_learner(made: Class) -> None:
    made.add(f"ana/{PUBLISHER}", f"ben/{PUBLISHER}", f"ben/{LAUNCH}", "cy/deep/er/temperature_publisher.py")
    made.add(".DS_Store", "points.toml", "README.md", "notes.txt")
    (made.root / "dee").mkdir()
    works = made.find()
    assert list(works) == [
        f"{learner} {exercise}" for learner in ("ana", "ben", "cy", "dee") for exercise in ("i1.1", "i2.2")
    ]
    assert (works["ana i1.1"].files, works["ana i1.1"].main) == ({PUBLISHER: made.root / "ana" / PUBLISHER}, ".")
    assert sorted(works["ben i1.1"].files) == sorted([PUBLISHER, LAUNCH])
    assert works["cy i1.1"].main == "."
    assert {key: work.missing for key, work in works.items() if work.missing} == {
        "ana i2.2": "there is no my_launch.py",
        "cy i2.2": "there is no my_launch.py",
        "dee i1.1": "nothing was handed in",
        "dee i2.2": "nothing was handed in",
    }
    lookup = works["cy i2.2"].lookup
    assert lookup is not None
    assert (lookup.looked_for, lookup.found) == ((LAUNCH,), (f"deep/er/{PUBLISHER}",))
    assert made.notes == ["left out, as nobody's submission: notes.txt"]


def test_the_chosen_exercises_in_the_order_of_the_course(made: Class) -> None:
    made.add(f"ana/{PUBLISHER}")
    assert list(made.find("i2_2", "I1.1")) == ["ana i1.1", "ana i2.2"]
    with pytest.raises(UnknownExercise):
        made.find("i9.9")


def test_nobody_handed_in_anything_known(made: Class) -> None:
    made.add("ana/essay.pdf")
    works = made.find()
    assert [work.exercise for work in works.values()] == [lesson.id for lesson in made.course.lessons]
    assert all(work.missing for work in works.values())


def test_what_is_no_class(made: Class, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="there are no submissions in"):
        made.find()
    with pytest.raises(UsageError, match="there is no"):
        made.find(root=tmp_path / "none")
    made.add("essay.pdf")
    with pytest.raises(UsageError, match="is neither a folder nor an archive"):
        made.find(root=made.root / "essay.pdf")
    (made.root / "x.zip").write_text("no")
    with pytest.raises(UsageError, match="cannot be unpacked: it is damaged"):
        made.find(root=made.root / "x.zip")


# --- systems ---


def test_moodle(made: Class) -> None:
    made.add(
        f"Ana Ruiz_17_assignsubmission_file_/{PUBLISHER}",
        "Ana Ruiz_17_assignsubmission_onlinetext_/onlinetext.html",
        f"Ana Ruiz_18_assignsubmission_file_/{PUBLISHER}",
        "Ben_van Li_19_assignsubmission_file_/notes.txt",
        "Cy Young_20_assignsubmission_file_temperature_publisher.py",  # not “in folders”
        "Dee_21_assignsubmission_file_calculator_client.py",
        "Dee_21_assignsubmission_file_calculator_server.py",
    )
    made.zip("Eve_22_assignsubmission_file_/my work.zip", f"ws/{PUBLISHER}")
    works = made.find("i1.1", "i1.3")
    assert list(works)[::2] == [
        f"{who} i1.1" for who in ("Ana Ruiz", "Ana Ruiz-18", "Ben_van Li", "Cy Young", "Dee", "Eve")
    ]
    assert [key for key, work in works.items() if work.files] == [
        *("Ana Ruiz i1.1", "Ana Ruiz-18 i1.1", "Cy Young i1.1", "Dee i1.3", "Eve i1.1")
    ]
    assert sorted(works["Dee i1.3"].files) == [CLIENT, SERVER]
    assert works["Ben_van Li i1.1"].learner.number == "19"


def test_moodle_by_assignment(made: Class) -> None:
    """Moodle gives a learner another number in each assignment."""
    made.add(f"i1.1/Ana Ruiz_17_assignsubmission_file_/{PUBLISHER}", f"I1_2/Ana Ruiz_99_assignsubmission_file_/{STATS}")
    made.add(f"i1.1/Ben Li_18_assignsubmission_file_/{STATS}", f"i1.1/ana ruiz_20_assignsubmission_file_/{PUBLISHER}")
    made.add("plan.odt")
    works = made.find()
    assert list(works) == [
        f"{who} {exercise}" for who in ("Ana Ruiz", "ana ruiz-20", "Ben Li") for exercise in ("i1.1", "i1.2")
    ]
    assert [key for key, work in works.items() if work.files] == ["Ana Ruiz i1.1", "Ana Ruiz i1.2", "ana ruiz-20 i1.1"]
    assert works["Ben Li i1.1"].missing == f"there is no {PUBLISHER}"
    assert works["Ben Li i1.2"].missing == "nothing was handed in"  # for this one
    assert made.notes == ["left out, as nobody's submission: plan.odt"]


def test_canvas(made: Class) -> None:
    made.add(
        f"ruizana_101_9001_{PUBLISHER}",
        "libenjamin_LATE_102_9002_temperature_publisher-1.py",
        "youngcy_103_9003_calculator_server.py",
        "youngcy_103_9004_calculator_client-2.py",
        "youngcy_103_9005_calculator_client-10.py",
        "doedee_104_9005_essay.pdf",
        "doedee_105_9006_temperature_publisher.py",  # another one of this name
    )
    made.zip("eve_106_9007_work-3.zip", f"i1_1/{PUBLISHER}", f"__MACOSX/i1_1/._{PUBLISHER}")
    works = made.find("i1.1", "i1.3")
    assert [key for key, work in works.items() if work.files] == [
        *("doedee-105 i1.1", "eve i1.1", "libenjamin i1.1", "ruizana i1.1", "youngcy i1.3")
    ]
    assert list(works["libenjamin i1.1"].files) == [PUBLISHER]
    assert works["youngcy i1.3"].files[CLIENT].name.endswith("-10.py")
    lookup = works["doedee i1.1"].lookup
    assert lookup is not None
    assert lookup.found == ("essay.pdf",)


GRADESCOPE = """---
submission_7:
  :submitters:
  - :name: Ana Ruiz
    :sid: '0101'
    :email: ana@example.org
  - :name: Ben Li
    :sid:
    :email: ben@example.org
  :created_at: 2026-01-31 25:61:00.000000000 Z
  :score: 3.0
  :status: processed
submission_8:
  :submitters:
  - :name: Cy Young
    :sid: ''
    :email:
nonsense: 5
"""


def test_gradescope_gives_every_submitter_the_result(made: Class) -> None:
    made.add("submission_metadata.yml", text=GRADESCOPE)
    made.add(f"submission_7/{PUBLISHER}", f"submission_8/{LAUNCH}", f"submission_9/{PUBLISHER}")
    works = made.find("i1.1", roster=[{"email": "Ben@example.org", "name": "Benjamin Li"}])
    assert [(work.learner.name, work.learner.number, work.learner.email) for work in works.values()] == [
        ("Ana Ruiz", "0101", "ana@example.org"),
        ("Benjamin Li", "", "Ben@example.org"),
        ("Cy Young", "", ""),
        ("submission_9", "", ""),
    ]
    assert [bool(work.files) for work in works.values()] == [True, True, False, True]
    assert len({work.digest for work in list(works.values())[:2]}) == 1
    assert made.notes == []


@pytest.mark.parametrize(
    "text", ["[1, 2]", "{a: {:submitters: [5]}}", "a: &a [*a]", "{", "\x00", "ana: {:submitters: 5}"]
)
def test_damaged_metadata_of_gradescope(made: Class, text: str) -> None:
    made.add("submission_metadata.yml", text=text)
    made.add(f"ana/{PUBLISHER}")
    assert list(made.find("i1.1")) == ["ana i1.1"]


def test_clones(made: Class) -> None:
    for learner in ("ana", "ben-li"):
        clone = f"robotics-hw1-{learner}"
        made.add(f"{clone}/src/my_package/my_package/{PUBLISHER}", f"{clone}/src/my_package/my_package/__init__.py")
        made.add(f"{clone}/src/my_package/launch/{LAUNCH}", f"{clone}/src/my_package/package.xml")
        for tool in (
            ".git/objects/aa",
            "build/my_package",
            "install/my_package",
            "log/latest",
            ".venv/lib",
            ".ros-tutor",
        ):
            made.add(f"{clone}/{tool}/{PUBLISHER}", text="old")
    works = made.find(roster=[{"github username": "ben-li", "name": "Ben Li"}])
    assert list(works) == [f"{who} {ex}" for who in ("ben-li", "robotics-hw1-ana") for ex in ("i1.1", "i2.2")]
    node, launch = works["ben-li i1.1"], works["ben-li i2.2"]
    assert (node.learner.name, node.main, launch.main) == ("Ben Li", "my_package", "launch")
    assert (
        sorted(node.files)
        == sorted(launch.files)
        == [f"launch/{LAUNCH}", "my_package/__init__.py", f"my_package/{PUBLISHER}", "package.xml"]
    )


def test_exercises_first_and_learners_first(made: Class) -> None:
    made.add(f"i1.1/ana/{PUBLISHER}", f"i1.1/ben/{PUBLISHER}", f"i2_2/ana/x/{LAUNCH}", "docs/README.md")
    works = made.find()
    assert [key for key, work in works.items() if work.files] == ["ana i1.1", "ana i2.2", "ben i1.1"]
    assert made.notes == ["left out, as nobody's submission: docs"]
    assert list(made.find("i1.1", layout="{exercise}/{learner}")) == ["ana i1.1", "ben i1.1"]


def test_the_exercises_own_folder_comes_first(made: Class) -> None:
    made.add(
        f"ana/{PUBLISHER}",
        f"ana/old/{PUBLISHER}",
        f"ana/I1-1/v2/{PUBLISHER}",
        f"ben/b/{PUBLISHER}",
        f"ben/a/x/{PUBLISHER}",
    )
    works = made.find()
    assert works["ana i1.1"].files == {PUBLISHER: made.root / "ana" / "I1-1" / "v2" / PUBLISHER}
    assert works["ben i1.1"].files == {PUBLISHER: made.root / "ben" / "b" / PUBLISHER}


@pytest.mark.parametrize(
    "names",
    [
        (PUBLISHER, "helper.py"),
        (f"i1_1/{PUBLISHER}", f"i2_2/{LAUNCH}"),
        (f"src/my_package/my_package/{PUBLISHER}", "src/my_package/package.xml"),
        ("package.xml", f"my_package/{PUBLISHER}"),
    ],
)
def test_one_learners_own_folder(made: Class, names: Sequence[str]) -> None:
    made.add(*names)
    assert made.find()["class i1.1"].files
    assert len({work.learner.id for work in made.find().values()}) == 1


def test_one_file_for_each_learner(made: Class) -> None:
    made.add("ana.py", "ben.py")
    made.add("dee.txt")
    made.zip("eve.zip", PUBLISHER)
    works = made.find("i1.1")
    assert [key for key, work in works.items() if work.files] == ["ana i1.1", "ben i1.1", "eve i1.1"]
    assert (works["ana i1.1"].main, works["ana i1.1"].files) == (PUBLISHER, {PUBLISHER: made.root / "ana.py"})
    assert made.notes == ["left out, as nobody's submission: dee.txt"]
    assert not made.find("i1.1", "i2.2")["ana i1.1"].files  # it could be for either


def test_archives_of_the_class_and_of_learners(made: Class, tmp_path: Path) -> None:
    inner = made.zip("ben.zip", f"deep/{PUBLISHER}")
    with zipfile.ZipFile(tmp_path / "inner.zip", "w") as archive:
        archive.write(inner, "again.zip")
    for name in ("hw.zip", "flat.zip"):
        with zipfile.ZipFile(tmp_path / name, "w") as archive:
            top = "hw/" if name == "hw.zip" else ""
            archive.writestr(f"{top}ana/{PUBLISHER}", "")
            archive.write(inner, f"{top}ben.zip")
            archive.write(tmp_path / "inner.zip", f"{top}cy/work/inner.zip")
            archive.writestr(f"{top}__MACOSX/x", "")
        works = made.find(root=tmp_path / name)
        assert {key: work.missing for key, work in works.items()} == {
            "ana i1.1": "",
            "ben i1.1": "",
            "cy i1.1": "",
        }


def test_an_archive_of_one_learner(made: Class, tmp_path: Path) -> None:
    made.zip("../ana.zip", PUBLISHER)
    made.zip("../hw.zip", f"ben/src/my_package/my_package/{PUBLISHER}", "ben/src/my_package/package.xml")
    assert list(made.find(root=tmp_path / "ana.zip")) == ["ana i1.1"]
    assert list(made.find(root=tmp_path / "hw.zip")) == ["ben i1.1"]


# --- bad submissions ---


def test_why_there_is_nothing_to_judge(made: Class) -> None:
    made.add("misnamed/temperature_publsher.py", "case/Temperature_Publisher.py", f"folder/{PUBLISHER}/x")
    made.add("damaged.zip", "rar/work.rar", "rar.rar", text="no")
    (made.root / "empty").mkdir()
    encrypt(made.zip("encrypted.zip", PUBLISHER))
    made.zip("nested/damaged.zip")
    (made.root / "nested" / "damaged.zip").write_text("no")
    assert made.missing("i1.1") == {
        "misnamed i1.1": f"there is no {PUBLISHER} (temperature_publsher.py is there)",
        "case i1.1": f"there is no {PUBLISHER} (Temperature_Publisher.py is there)",
        "folder i1.1": f"there is no {PUBLISHER}",
        "damaged i1.1": "damaged.zip cannot be unpacked: it is damaged, or not an archive of this kind",
        "nested i1.1": "damaged.zip cannot be unpacked: it is damaged, or not an archive of this kind",
        "encrypted i1.1": "encrypted.zip cannot be unpacked: it is encrypted",
        "rar i1.1": "work.rar cannot be unpacked: it is neither a zip nor a tar file",
        "empty i1.1": "nothing was handed in",
    }


def test_only_the_optional_file(made: Class) -> None:
    made.add(f"ana/{CLIENT}")
    work = made.find()["ana i1.3"]
    assert work.missing == f"there is no {SERVER} ({CLIENT} is there)"


def test_links(made: Class, tmp_path: Path) -> None:
    made.add(f"ben/{PUBLISHER}", f"ben/i1.1/{PUBLISHER}")
    (tmp_path / "solution").mkdir()
    (tmp_path / "solution" / PUBLISHER).write_text("secret")
    links = {
        f"file/{PUBLISHER}": f"../ben/{PUBLISHER}",
        f"out/{PUBLISHER}": "/etc/passwd",
        "inside/folder": "../ben",
        "copy": "ben",
        "nowhere": "none",
        "loop": "loop",
        "teachers": str(tmp_path / "solution"),
    }
    for name, target in links.items():
        (made.root / name).parent.mkdir(exist_ok=True)
        (made.root / name).symlink_to(target)
    works = made.find("i1.1")
    assert [key for key, work in works.items() if work.files] == ["ben i1.1", "teachers i1.1"]
    assert works["out i1.1"].missing == f"{PUBLISHER} is a link to what is not in this submission"
    assert works["copy i1.1"].missing == "copy is a link to what is not in this submission"
    (made.root / "inside" / "i1.1").symlink_to("../ben/i1.1")
    (made.root / "own").mkdir()
    (made.root / "own" / "v1").mkdir()
    (made.root / "own" / "v1" / PUBLISHER).write_text("# own")
    (made.root / "own" / "i1.1").symlink_to("v1")
    works = made.find(layout="{learner}/{exercise}")
    assert [key for key, work in works.items() if work.files] == ["ben i1.1", "own i1.1", "teachers i1.1"]
    assert works["inside i1.1"].missing == "i1.1 is a link to what is not in this submission"


def test_names_that_try_to_break_something(made: Class) -> None:
    names = [
        "\x1b[31mred\n",
        "\u202egnp.exe",
        "🤖",
        "ana",
        "Ana",
        "ANA",
        ".hidden",
        "x" * 255,
        os.fsdecode(b"m\xfcller"),
    ]
    for name in names:
        made.add(f"{name}/{PUBLISHER}")
    works = made.find()
    assert len(works) == len(names)
    assert all(work.files for work in works.values())
    assert len({work.learner.id.casefold() for work in works.values()}) == len(names)
    assert all(work.learner.id.isprintable() for work in works.values())
    assert {work.learner.name for work in works.values()} == set(names)


def test_huge_submissions(made: Class) -> None:
    made.add(f"ana/{PUBLISHER}")
    (made.root / "ana" / "bag.db3").write_bytes(b"")
    os.truncate(made.root / "ana" / "bag.db3", 1 << 32)  # sparse
    os.mkfifo(made.root / "ana" / "pipe.py")
    assert list(made.find()["ana i1.1"].files) == [PUBLISHER]


def test_what_cannot_be_read_is_a_fault_and_not_missing(made: Class, monkeypatch: pytest.MonkeyPatch) -> None:
    made.add(f"ana/{PUBLISHER}", f"ben/{PUBLISHER}", f"cy/deep/{PUBLISHER}")
    broken = made.root / "ben" / PUBLISHER
    read_bytes, walk = Path.read_bytes, os.walk

    def fail_to_read(path: Path) -> bytes:
        if path == broken:
            raise PermissionError(13, "Permission denied", str(path))
        return read_bytes(path)

    def fail_to_walk(top: Path, onerror: Callable[[OSError], None], **options: object) -> object:
        if top == made.root / "cy":
            onerror(PermissionError(13, "Permission denied", str(top / "deep")))
        return walk(top, onerror=onerror)

    monkeypatch.setattr(Path, "read_bytes", fail_to_read)
    monkeypatch.setattr(os, "walk", fail_to_walk)
    works = made.find("i1.1")
    assert {key: work.fault for key, work in works.items()} == {
        "ana i1.1": "",
        "ben i1.1": f"{broken} cannot be read: Permission denied",
        "cy i1.1": f"{made.root / 'cy' / 'deep'} cannot be read: Permission denied",
    }


# --- layouts of one's own ---


@pytest.mark.parametrize(
    ("layout", "name"),
    [
        ("{learner}/{exercise}", f"ana-li/i1.1/{PUBLISHER}"),
        ("{learner}/{exercise}", f"ana-li/I1_1/{PUBLISHER}"),
        ("{exercise}/{learner}", f"i1-1/ana-li/{PUBLISHER}"),
        ("{learner}/hw/{exercise}", f"ana-li/hw/i1.1/{PUBLISHER}"),
        ("week*/{learner}_final/{exercise}", f"week 3/ana-li_final/i1.1/{PUBLISHER}"),
        ("{learner}-{exercise}", f"ana-li-i1.1/{PUBLISHER}"),
        ("{exercise}-{learner}", f"i1-1-ana-li/{PUBLISHER}"),
        ("hw(1)+[{learner}]", f"hw(1)+[ana-li]/{PUBLISHER}"),
        ("{learner}/{learner}_{exercise}/src", f"ana-li/ana-li_i1.1/src/{PUBLISHER}"),
        ("/{exercise}/{learner}.py", "i1.1/ana-li.py"),
        ("{exercise}/{learner}", "i1.1/ana-li.zip"),
        ("{learner}", f"ana-li/{PUBLISHER}"),
        ("{name} ({number}) {email}/{learner}", f"Ana Li (12) ana@x.org/ana-li/{PUBLISHER}"),
    ],
)
def test_a_layout_of_ones_own(made: Class, layout: str, name: str) -> None:
    if name.endswith(".zip"):
        made.zip(name, PUBLISHER)
    else:
        made.add(name)
    works = made.find(layout=layout)
    assert list(works) == ["ana-li i1.1"]
    work = works["ana-li i1.1"]
    assert work.files
    if "{name}" in layout:
        assert (work.learner.name, work.learner.number, work.learner.email) == ("Ana Li", "12", "ana@x.org")


def test_a_layout_skips_nobody_in_silence(made: Class) -> None:
    made.add(f"ana/i1.1/{PUBLISHER}", "ben/notes.txt", f"cy/i1.l/{PUBLISHER}", "dee.txt", f"eve/exercise one/{LAUNCH}")
    (made.root / "fay").mkdir()
    works = made.find(layout="{learner}/{exercise}")
    assert [key for key, work in works.items() if work.files] == ["ana i1.1", "cy i1.1", "eve i2.2"]
    assert {work.learner.id for work in works.values()} == {"ana", "ben", "cy", "dee", "eve", "fay"}
    assert works["ben i1.1"].missing == f"there is no {PUBLISHER}"
    assert works["fay i1.1"].missing == "nothing was handed in"
    made.find(layout="hw_{learner}/{exercise}", roster=[{"folder": "gil"}])
    assert made.notes[-1] == "left out, as nobody's submission: ana, ben, cy, dee.txt, eve, fay"


@pytest.mark.parametrize(
    ("layout", "message"),
    [
        ("{exercise}", "{learner} is missing; it may have {learner}, {exercise}, {name}, {number}, {email}"),
        ("{learner}/{what}", "{what} is unknown"),
        ("{learner}/{}", "{} is unknown"),
    ],
)
def test_a_layout_that_cannot_be_read(made: Class, layout: str, message: str) -> None:
    made.add(f"ana/{PUBLISHER}")
    with pytest.raises(UsageError) as raised:
        made.find(layout=layout)
    assert message in str(raised.value)


def test_any_name_is_told_from_an_exercise(course: Course) -> None:
    @settings(max_examples=30)
    @given(st.text("aB-_. ü(", min_size=1, max_size=6))
    def check(learner: str) -> None:
        for layout, name in (("{learner}-{exercise}", f"{learner}-i1_1"), ("x{exercise}{learner}", f"xi2.2{learner}")):
            fields = LayoutPattern(layout, course)._fields(Path(f"{name}.zip"), 0)
            assert fields is not None
            assert fields["learner"] == learner

    check()


# --- rosters ---


def test_who_is_absent_appears_as_missing(made: Class) -> None:
    made.add(f"ana/{PUBLISHER}", f"zoe/{PUBLISHER}")
    roster = [{"folder": "ana", "name": "Ana Ruiz"}, {"folder": "ben", "name": "Ben Li"}]
    works = made.find(roster=roster)
    assert {work.learner.name: work.missing for work in works.values()} == {
        "Ana Ruiz": "",
        "Ben Li": "nothing was handed in",
        "zoe": "",
    }


def test_the_same_learner_under_two_names(made: Class) -> None:
    made.add(f"i1-1-ana/{PUBLISHER}", f"i2-2-ana/{LAUNCH}")
    works = made.find(roster=[{"github": "ana", "name": "Ana Ruiz"}])
    assert [key for key, work in works.items() if work.files] == ["ana i1.1", "ana i2.2"]


TYPES = [f"my_interfaces/{name}" for name in ("msg/Reading.msg", "srv/InRange.srv", "CMakeLists.txt", "package.xml")]


def test_a_package_of_types_is_found_beside_the_program_or_its_package(made: Class) -> None:
    made.add("ana/tank_sensor.py", *(f"ana/{name}" for name in TYPES))
    package = "bob/src/my_package"
    made.add(f"{package}/package.xml", f"{package}/my_package/__init__.py", f"{package}/my_package/tank_sensor.py")
    made.add(*(f"bob/src/{name}" for name in TYPES))
    made.add("eve/tank_sensor.py")
    ana, bob, eve = made.find("b1.3").values()
    assert ana.main == "."
    assert set(TYPES) <= set(ana.files)
    assert bob.main == "my_package/my_package"
    assert {"my_interfaces/msg/Reading.msg", "my_package/my_package/tank_sensor.py"} <= set(bob.files)
    assert "there is no my_interfaces/msg/Reading.msg" in eve.missing

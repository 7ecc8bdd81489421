"""Names of learners become folders, whatever they are; a roster says who a folder belongs to."""

from __future__ import annotations

import unicodedata
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tutor.errors import UsageError
from tutor.grade.learners import Learner, safe_name, with_unique_ids
from tutor.grade.roster import Roster


@given(st.text())
def test_a_safe_name_is_one_of_a_folder_and_stays_as_it_is(text: str) -> None:
    name = safe_name(text)
    assert name
    assert name == safe_name(name)
    assert name.isprintable()
    assert name[0] not in ". "
    assert not set(name) & set('/\\:*?"<>|')
    assert len(name.encode()) <= 100
    assert (Path("/results") / name).parent == Path("/results")


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("Zoë Müller", "Zoë Müller"),
        ("../../etc/passwd", "_.._etc_passwd"),
        (".hidden", "hidden"),
        ("..", "unnamed"),
        ("", "unnamed"),
        ("a\x1b[31m\nb", "a_[31m_b"),
        ("evil\u202egnp.py", "evil_gnp.py"),
        ("🤖", "🤖"),
        ("x" * 300, "x" * 100),
        ("ü" * 300, "ü" * 50),
        ("\udcff", "_"),
    ],
)
def test_names_that_no_folder_may_have(text: str, name: str) -> None:
    assert safe_name(text) == name


def folded(name: str) -> str:
    return unicodedata.normalize("NFC", name).casefold()


@settings(max_examples=50)
@given(st.lists(st.tuples(st.text("aAäÄ.-2/ß\u0308", max_size=3), st.sampled_from(["", "2", "7"])), max_size=8))
def test_ids_are_unique_on_every_file_system(names: list[tuple[str, str]]) -> None:
    learners = with_unique_ids(Learner(name, name, number) for name, number in names)
    assert [learner.name for learner in learners] == [name for name, _ in names]
    assert len({folded(learner.id) for learner in learners}) == len(names)
    assert all(learner.id == safe_name(learner.id) for learner in learners)


def test_learners_of_the_same_name_are_told_apart_by_their_numbers() -> None:
    names = [("Ana", "1"), ("ana", "2"), ("Ana", "3"), ("ANA", ""), ("x" * 300, "4"), ("x" * 300, "5" * 300)]
    ids = [learner.id for learner in with_unique_ids(Learner(name, name, number) for name, number in names)]
    assert ids == ["Ana", "ana-2", "Ana-3", "ANA-4", "x" * 100, "x" * 75 + "-" + "5" * 24]
    assert all(len(name.encode()) <= 100 for name in ids)


# --- rosters ---


def read(folder: Path, content: str | bytes) -> Roster:
    file = folder / "roster.csv"
    file.write_bytes(content.encode() if isinstance(content, str) else content)
    return Roster.read(file)


ANA = "ana,Ana Ruiz,101,ana@example.org"


@pytest.mark.parametrize(
    "content",
    [
        f"folder,name,id,email\n{ANA}\n",
        f"Folder, Name ,ID,E-Mail\r\n{ANA}\r\n",
        f"\ufefffolder,name,id,email\n{ANA}",
        "folder;name;id;email\nana;Ana Ruiz;101;ana@example.org\n",
        "sep=;\nfolder;name;id;email\nana;Ana Ruiz;101;ana@example.org\n",
        "folder\tname\tid\temail\nana\tAna Ruiz\t101\tana@example.org\n".encode("utf-16"),
        'GitHub Username,"Full name","Student ID",Mail,Group\nana,"Ruiz, Ana",101,ana@example.org,"B, ""2"""\n',
        "login,First name,Last name,sid,Email address\nana,Ana,Ruiz,101,ana@example.org\n",
        f"folder,name,id,email\n\n,,,\n{ANA},more,cells\nben\n",
    ],
)
def test_rosters_as_programs_write_them(tmp_path: Path, content: str | bytes) -> None:
    learner = read(tmp_path, content).learner("ana")
    assert (learner.id, learner.name) == ("ana", "Ana Ruiz")
    assert (learner.number, learner.email) == ("101", "ana@example.org")


def test_a_learner_is_found_by_whatever_a_system_tells(tmp_path: Path) -> None:
    content = "name,id,email,github,group\nAna Ruiz,101,ana@example.org,ana-r,B\nBen Li,102,ben@example.org,ben,A\n"
    roster = read(tmp_path, content)
    ana = roster.learner("Ana Ruiz")
    assert (ana.id, ana.columns["group"]) == ("ana-r", "B")
    for same in (
        roster.learner("ana-r"),
        roster.learner("ANA@example.org"),
        roster.learner("101"),
        roster.learner("submission_7", email="ana@example.org"),
        roster.learner("ruizana", name="ruizana", number="9"),  # as Canvas names files
        roster.learner("x", number="101"),
        roster.learner("i1-1-ana-r"),  # as GitHub Classroom names clones
        roster.learner("ana-r_homework"),
    ):
        assert same == ana
    assert roster.learner("Eve", number="5") == Learner("Eve", "Eve", "5")
    assert [learner.name for learner in roster.absent()] == ["Ben Li"]


def test_the_number_of_a_moodle_submission_is_not_a_student_number(tmp_path: Path) -> None:
    roster = read(tmp_path, "name,id\nAna Ruiz,101\nBen Li,102\n")
    assert roster.learner("Ben Li", name="Ben Li", participant="101").number == "102"
    assert roster.learner("Cy Young", name="Cy Young", participant="101").name == "Cy Young"
    blind = read(tmp_path, "Identifier,Full name\nParticipant 7,Ana Ruiz\n")
    assert blind.learner("Participant_7", name="Participant_7", participant="7").name == "Ana Ruiz"


def test_absent_learners_have_the_ids_that_they_would_have(tmp_path: Path) -> None:
    content = "name,id\nAna Ruiz,101\nBen Li,102\n,\n"
    absent = {learner.name: learner.id for learner in read(tmp_path, content).absent()}
    assert absent == {"Ana Ruiz": "101", "Ben Li": "102"}
    assert read(tmp_path, content).learner("Ana Ruiz", name="Ana Ruiz", participant="9").id == absent["Ana Ruiz"]


def test_canvas_own_gradebook_is_a_roster(tmp_path: Path) -> None:
    content = (
        "Student,ID,SIS User ID,SIS Login ID,Section,i1.1 (77)\n"
        '"    Points Possible",,,,,10\n"Ruiz, Ana",4711,s101,aruiz,A,\n'
    )
    roster = read(tmp_path, content)
    assert [learner.id for learner in roster.absent()] == ["aruiz"]
    ana = roster.learner("ruizana", name="ruizana", number="4711")
    assert (ana.name, ana.number, ana.columns["SIS User ID"]) == ("Ana Ruiz", "4711", "s101")


def test_two_rows_that_fit_are_an_error_unless_a_number_decides(tmp_path: Path) -> None:
    roster = read(tmp_path, "name,id\nAna Ruiz,101\nAna Ruiz,102\n")
    assert roster.learner("x", name="Ana Ruiz", number="102").number == "102"
    with pytest.raises(UsageError, match="Ana Ruiz may be 101 and 102; add a column folder"):
        roster.learner("Ana Ruiz")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "its first line names none"),
        (b"folder,name\n\n,\n", "it lists no learner"),
        (b"grade,comment\n1,2\n", "its first line names none of the columns folder, name, id and email"),
        (b"folder\nM\xfcller\n", "it is not UTF-8"),
        (b'folder\n"' + b"x" * 200_000, "field larger than field limit"),
    ],
)
def test_what_is_no_roster(tmp_path: Path, content: bytes, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        read(tmp_path, content)
    with pytest.raises(UsageError, match="cannot be read: No such file"):
        Roster.read(tmp_path / "none.csv")

"""Where courses are found: folders, packed files and installed packages; and what a course says of itself."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest

from tests.content.conftest import make_course
from tutor.content import load_course
from tutor.content.courses import Courses, find_course, read_manifest
from tutor.content.packing import SUFFIX, pack
from tutor.errors import ContentError, UsageError


@pytest.fixture
def root(tmp_path: Path) -> Path:
    root = tmp_path / "lamps"
    make_course(root)
    (root / "checks").mkdir()
    (root / "checks" / "x1_1.py").write_text("CHECK = None\n")
    (root / "course.yaml").write_text("format: 1\nname: lamps\ntitle: Lamps and switches\n")
    return root


def test_a_course_states_its_name_and_title(root: Path) -> None:
    manifest = read_manifest(root)
    assert (manifest.name, manifest.title) == ("lamps", "Lamps and switches")


def test_without_course_yaml_it_is_called_as_its_folder(tmp_path: Path) -> None:
    folder = tmp_path / "My Lamps"
    folder.mkdir()
    manifest = read_manifest(folder)
    assert (manifest.name, manifest.title, manifest.stated) == ("my-lamps", "My Lamps", False)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("format: 2\nname: lamps\n", ":1: format: it has format 2, and this ros-tutor knows format 1"),
        ("name: lamps\n", "format: it has no format, and this ros-tutor knows format 1"),
        ("format: 1\nname: My Lamps\n", ":2: name: 'My Lamps' has more than lowercase letters"),
        ("format: 1\nname: lamps\nauthor: me\n", ":3: author: there is no such field"),
    ],
)
def test_what_is_not_understood_is_refused_in_one_line(root: Path, text: str, message: str) -> None:
    (root / "course.yaml").write_text(text)
    with pytest.raises(ContentError) as caught:
        load_course(root)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_packed_course_has_its_files_and_is_unpacked_once(root: Path, tmp_path: Path) -> None:
    (root / "checks" / "__pycache__").mkdir()
    (root / "checks" / "__pycache__" / "x.pyc").touch()
    (root / ".git").mkdir()
    (root / ".git" / "config").touch()
    file = tmp_path / f"lamps{SUFFIX}"
    count = pack(root, file)
    assert sorted(zipfile.ZipFile(file).namelist()) == [
        "checks/x1_1.py",
        "course.yaml",
        "lessons/checklist.yaml",
        "lessons/x1_1/lesson.md",
        "lessons/x1_1/skeleton/mover.py",
        "lessons/x1_1/solution/mover.py",
    ]
    assert count == 6
    folder = find_course(str(file))
    assert [lesson.course for lesson in load_course(folder, only=True).lessons] == ["lamps"]
    (folder / "mark").touch()
    assert (find_course(str(file)) / "mark").exists()


def test_the_same_course_makes_the_same_file(root: Path, tmp_path: Path) -> None:
    first, second = tmp_path / f"1{SUFFIX}", tmp_path / f"2{SUFFIX}"
    pack(root, first)
    (root / "lessons" / "x1_1" / "lesson.md").touch()
    pack(root, second)
    assert first.read_bytes() == second.read_bytes()


def test_names_that_lead_out_of_a_packed_course_stay_in_it(tmp_path: Path) -> None:
    file = tmp_path / "bad.course.zip"
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("lessons/checklist.yaml", "groups: []\n")
        archive.writestr("../../escaped", "x")
    folder = find_course(str(file))
    assert (folder / "escaped").is_file()
    assert not (folder.parent / "escaped").exists()


@pytest.mark.parametrize("content", [b"", b"no zip", b"PK\x03\x04"])
def test_a_file_that_is_no_packed_course_is_refused(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "x.course.zip"
    file.write_bytes(content)
    with pytest.raises(UsageError, match="it is not a packed course"):
        find_course(str(file))


def test_an_installed_package_offers_a_course_by_an_entry_point(
    root: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    site = tmp_path / "site"
    package = site / "lamps_course"
    package.mkdir(parents=True)
    root.rename(package / "moved")
    for path in (package / "moved").iterdir():
        path.rename(package / path.name)
    (package / "__init__.py").write_text("raise RuntimeError('it must not be imported')\n")
    info = site / "lamps_course-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: lamps-course\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[ros_tutor.courses]\nlamps = lamps_course\n")
    monkeypatch.syspath_prepend(site)
    monkeypatch.chdir(tmp_path)
    courses = Courses.find(["lamps"])
    assert (courses.folders, courses.given) == ((package,), ("lamps",))
    with pytest.raises(UsageError, match=r"--lessons horns: .* no installed course; installed are lamps"):
        Courses.find(["horns"])


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ("nowhere/at_all", "there is no such folder or file"),
        ("nowhere", "there is no such folder or file, and no installed course"),
        (".", "it has no lessons/ folder"),
    ],
)
def test_a_course_that_is_not_there_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, given: str, message: str
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(UsageError, match=message):
        find_course(given)

"""Several courses in the app: each under its heading, with ids that cannot be mixed up."""

from __future__ import annotations

import shutil
from pathlib import Path

from tests.tui.conftest import open_app
from tutor.content import load_course
from tutor.content.courses import Courses
from tutor.session import Session
from tutor.tui.widgets.lesson_list import CourseRow, LessonList
from tutor.workspace import Workspace

GREETING = Path(__file__).parents[1] / "courses" / "greeting"


async def test_each_course_has_its_heading_and_the_ids_of_the_second_its_name(tmp_path: Path) -> None:
    other = Path(shutil.copytree(GREETING, tmp_path / "other", ignore=shutil.ignore_patterns("__pycache__")))
    (other / "course.yaml").write_text("format: 1\nname: other\ntitle: Another course\n")
    courses = Courses.find([GREETING, other], only=True)
    session = Session(load_course(courses.folders, only=True), Workspace(tmp_path / "ws"), courses)
    session.start(session.lessons[1])
    async with open_app(session) as me:
        lessons = me.main.query_one(LessonList)
        assert [row.unit for row in lessons.query(CourseRow)] == ["Greeting", "Another course"]
        titles = [str(row.render()).splitlines()[0] for row in lessons.lesson_rows]
        assert titles == ["○ H1.1 Greeter", "◐ other:H1.1 Greeter"]
        assert me.main.model.lesson == session.lessons[1]  # the one that was started
        assert list(session.check_arguments(session.lessons[1]))[2:] == courses.arguments
    assert Workspace(tmp_path / "ws").courses().read() == courses

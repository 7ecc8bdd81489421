"""Shows how the learner stands: the findings and attempts of the lesson, and the progress in all of them."""

from __future__ import annotations

from textual.widgets import Tabs

from tutor.content import Counts, Lesson
from tutor.session.findings import Findings
from tutor.tui import commands, messages
from tutor.tui.control.host import HostScreen
from tutor.tui.control.reports import Reports
from tutor.tui.widgets.criteria import CriteriaPanel
from tutor.tui.widgets.lesson_list import LessonList
from tutor.tui.widgets.status_bar import StatusBar


class Standing:
    """Keeps the criteria panel, the lesson list and the status bar up to date with the progress and the findings."""

    def __init__(self, host: HostScreen, reports: Reports) -> None:
        self._host, self._reports = host, reports

    async def show_lesson(self, lesson: Lesson) -> None:
        """Show the criteria of another lesson, which is the model's now."""
        model, lessons = self._host.model, self._host.model.session.lessons
        place = lessons.index(lesson) + 1
        criteria = self._criteria
        self._count_passed()
        await criteria.show_lesson(model.findings[lesson.id], lessons[place] if place < len(lessons) else None)
        criteria.show_attempts(lesson, model.progress.of(lesson.id))
        self._reports.findings_changed()

    def progress_read(self, message: messages.ProgressRead) -> None:
        """Show the progress, which was read."""
        model = self._host.model
        model.progress, model.versions = message.progress, message.versions
        for lesson in model.session.lessons:
            model.findings[lesson.id] = model.findings[lesson.id].with_last_check(message.progress.of(lesson.id))
        self._criteria.show_findings(model.findings[model.lesson.id])
        self._count_passed()
        self._host.query_one(LessonList).show_states(model.session.states(message.progress))
        self._criteria.show_attempts(model.lesson, message.progress.of(model.lesson.id))

    def show_findings(self, found: Findings) -> None:
        """Show the findings of a check, be it of the lesson shown or of another one."""
        if found.exercise == self._host.model.lesson.id:
            self._criteria.show_findings(found)
            self._reports.findings_changed()
        self._host.query_one(StatusBar).show_check(found)
        self._host.query_one(Tabs).query_one("#tab-criteria").set_class(found.checking, "-busy")

    def show_findings_of_lesson(self) -> None:
        """Show the findings of the lesson shown."""
        model = self._host.model
        self._criteria.show_findings(model.findings[model.lesson.id])
        self._reports.findings_changed()

    @property
    def _criteria(self) -> CriteriaPanel:
        return self._host.query_one(CriteriaPanel)

    def _count_passed(self) -> None:
        model = self._host.model
        lessons = model.session.lessons
        passed = {lesson.id for lesson in lessons if model.progress.of(lesson.id).is_passed}
        with_this = Counts.of(lessons, passed | {model.lesson.id})
        # After the last pass the panel points to the checklist, if the course has one.
        panel, can = self._criteria, self._host.can(commands.CHECKLIST)
        panel.after_pass = None
        if can and (with_this.all_done or (with_this.course_done and not model.lesson.beyond)):
            panel.after_pass = with_this
        self._host.query_one(StatusBar).show_progress(Counts.of(lessons, passed))

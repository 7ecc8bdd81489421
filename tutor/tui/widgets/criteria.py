"""The criteria of a lesson, and the diagnosis of the chosen one."""

from __future__ import annotations

from textual import events, on
from textual.app import ComposeResult
from textual.containers import Container
from textual.content import Content
from textual.widget import Widget
from textual.widgets import ListView, Static

from tutor.content import Counts, Lesson
from tutor.judge.verdict import Status
from tutor.session.findings import Finding, Findings
from tutor.tui import wording
from tutor.tui.widgets.attempts import format_attempts
from tutor.tui.widgets.criteria_list import CriteriaList, CriterionRow
from tutor.tui.widgets.diagnosis import Diagnosis
from tutor.workspace import ExerciseProgress


class BriefLine(Widget, can_focus=True):
    """The criteria on one line, while the lesson is being read and there is no verdict. Focusing it opens the panel."""

    def __init__(self, id: str) -> None:
        super().__init__(id=id)
        self._findings: Findings | None = None

    def show(self, findings: Findings) -> None:
        """Show the criteria of these findings."""
        self._findings = findings
        self.refresh()

    def render(self) -> Content:
        """The criteria's ids, or only their number in a narrow terminal, and the key that opens the panel."""
        found = self._findings.criteria if self._findings else ()
        required, bonus = [finding for finding in found if not finding.bonus], sum(finding.bonus for finding in found)
        more = [f"{bonus} bonus"] if bonus else []
        named = ", ".join([*(f"{'✓ ' if finding.before else ''}{finding.id}" for finding in required), *more])
        counted = ", ".join([f"{len(required)} to meet", *more])
        head, key = Content.styled("○ Criteria  ", "bold"), Content.assemble("  ", ("5", "bold $accent"), " opens")
        room = self.content_size.width - head.cell_length - key.cell_length
        names = Content.styled(named if len(named) <= room else counted, "$quiet")
        return Content.assemble(head, names.pad_right(max(0, room - names.cell_length)), key)


class CriteriaPanel(Container):
    """The list of criteria, and beside or below it the diagnosis of the chosen one."""

    DEFAULT_CSS = """
    CriteriaPanel {
        layout: horizontal;
        & > ListView {
            width: 1fr;
            background: $surface;
            scrollbar-size: 1 1;
            &:focus { background-tint: transparent 0%; }
        }
        & > ListView > CriterionRow { height: 1; padding: 0 1; text-wrap: nowrap; }
        & > BriefLine {
            display: none;
            height: 1;
            padding: 0 1;
            text-wrap: nowrap;
        }
        & > Diagnosis { display: none; }
        & > #attempts { display: none; }
        &.-detail > Diagnosis { display: block; }
    }
    """

    def compose(self) -> ComposeResult:
        yield BriefLine(id="criteria-brief")
        yield CriteriaList(id="criteria-list")
        yield Diagnosis(id="diagnosis")
        yield Static(id="attempts")

    def on_mount(self) -> None:
        self._findings: Findings | None = None
        self._following: Lesson | None = None
        self._typing = False
        self._reading = self._focus_inside = False
        self._shown_finding: Finding | None = None
        self.after_pass: Counts | None = None
        """What is passed once this exercise is, if nothing is left then of the course, or of what goes beyond it."""

    async def show_lesson(self, findings: Findings, following: Lesson | None) -> None:
        """Show a lesson's criteria, and its first failure if there is one; `following` is the next lesson."""
        self._findings = None
        self._following = following
        listed = self._list
        listed.moved = False
        await listed.clear()
        widest = max(len(finding.id) + len(" bonus") * finding.bonus for finding in findings.criteria)
        await listed.extend(CriterionRow(finding, widest + 1) for finding in findings.criteria)
        self._show(findings)
        self._show_result()

    def show_findings(self, findings: Findings) -> None:
        """Show what the check has found so far."""
        before = self._findings
        self._show(findings)
        if findings.checking and not (before and before.checking):
            self.remove_class("-detail")
        if findings.checking:
            self._show_first_failure()
        ended = before is not None and before.checking and not findings.checking
        restored = findings.at and not (before and before.at)
        if ended or restored:
            self._show_result()

    def _show_first_failure(self) -> None:
        """During a check, show the first failure as soon as it is final, or that of what the learner has selected."""
        found, chosen = self._findings, self.chosen
        if found is None:
            return
        if self.has_class("-detail"):
            if chosen is not None and chosen != self._shown_finding:
                self._show_diagnosis(chosen)
            return
        if self._list.moved:
            if chosen is not None and _is_failed(chosen):
                self._show_diagnosis(chosen)
            return
        failed = [n for n, f in enumerate(found.criteria) if _is_failed(f) and not f.bonus]
        if failed:
            self._list.index = failed[0]
            self._show_diagnosis(found.criteria[failed[0]])

    def _show_diagnosis(self, finding: Finding) -> None:
        """Show the diagnosis of a criterion."""
        assert self._findings is not None
        self._shown_finding = finding
        self.query_one(Diagnosis).show_finding(finding, self._findings, self._following)
        self.add_class("-detail")

    def show_attempts(self, lesson: Lesson, progress: ExerciseProgress) -> None:
        """Update the latest attempts, which only a large enough terminal displays."""
        self.query_one("#attempts", Static).update(format_attempts(lesson, progress, max_count=6))

    def set_reading(self, reading: bool) -> None:
        """Fold to one line while the lesson is being read and there is no verdict to show."""
        self._reading = reading
        self._show_brief()

    def set_focus_inside(self, focus_inside: bool) -> None:
        """Stay unfolded while the focus is inside."""
        self._focus_inside = focus_inside
        self._show_brief()

    def _show_brief(self) -> None:
        found = self._findings
        known = found is None or found.judged or found.checking or bool(found.note)
        self.set_class(self._reading and not known and not self._focus_inside, "-brief")

    @on(events.DescendantFocus)
    def _open(self, event: events.DescendantFocus) -> None:
        if isinstance(event.widget, BriefLine):
            self.open()

    def open(self) -> None:
        """Unfold, and focus the list."""
        self.set_focus_inside(True)
        self.screen.set_focus(self._list, scroll_visible=False)

    def show_typing(self, typing: bool) -> None:
        """Name the keys that work now: letters are typed while the editor has the focus."""
        if typing != self._typing:
            self._typing = typing
            self.query_one(Diagnosis).show_typing(typing)
            if self._findings is not None:
                self.border_subtitle = _headline(self._findings, typing=typing)

    def choose(self, id: str) -> None:
        """Select a criterion, as the learner does, and show its diagnosis."""
        for place, row in enumerate(self.rows):
            if row.finding.id == id:
                self._list.moved, self._list.index = True, place

    @property
    def chosen(self) -> Finding | None:
        """The criterion whose diagnosis is shown."""
        row = self._list.highlighted_child
        return row.finding if isinstance(row, CriterionRow) else None

    @property
    def _list(self) -> CriteriaList:
        return self.query_one(CriteriaList)

    @property
    def rows(self) -> list[CriterionRow]:
        """All rows, in order."""
        return list(self.query(CriterionRow))

    def _show(self, findings: Findings) -> None:
        self._findings = findings
        known = {finding.id: finding for finding in findings.criteria}
        for row in self.rows:
            row.show(known[row.finding.id], outdated=bool(findings.outdated))
        outdated = bool(findings.outdated) and findings.judged and not findings.checking
        self.border_title = _title(findings)
        self.border_subtitle = _headline(findings, typing=self._typing)
        self.set_class(outdated, "-outdated")
        self.query_one(BriefLine).show(findings)
        self._show_brief()
        self.set_class(bool(findings.result and findings.result.verdict is Status.PASSED), "-passed")

    def _show_result(self) -> None:
        """After a check, show the first failure, or the good news if all passed.

        What the learner has selected stays selected, and so does a failure that is being read, unless another explains
        it.
        """
        found, listed, chosen = self._findings, self._list, self.chosen
        if listed.moved and chosen is not None:
            if found is not None and found.judged:
                self._show_diagnosis(chosen)
            return
        if self.has_class("-detail") and chosen is not None and _is_failed(chosen):
            if found is not None and chosen.verdict is not None and (root := chosen.verdict.same_as):
                listed.index = [finding.id for finding in found.criteria].index(root)
            return
        listed.index = None
        self.remove_class("-detail")
        if found is None or not found.judged:
            return
        if found.result is not None and found.result.verdict is Status.PASSED:
            self.query_one(Diagnosis).show_passed(found.result, self._following, self.after_pass)
            self.add_class("-detail")
            return
        order = (Status.FAILED, Status.ERROR, Status.SKIPPED, Status.PASSED)
        judged = [(f.bonus, order.index(f.verdict.status), i) for i, f in enumerate(found.criteria) if f.verdict]
        listed.index = min(judged)[2]

    @on(ListView.Highlighted, "#criteria-list")
    @on(ListView.Selected, "#criteria-list")
    def _choose(self, event: ListView.Highlighted | ListView.Selected) -> None:
        event.stop()
        row = event.item
        if not isinstance(row, CriterionRow) or self._findings is None:
            return
        selected, checking = isinstance(event, ListView.Selected), self._findings.checking
        if checking and not selected and not self.has_class("-detail"):
            return
        if row.finding.verdict is not None or selected or checking:
            self._show_diagnosis(row.finding)
        elif not self._findings.judged:
            self.remove_class("-detail")


def _is_failed(finding: Finding) -> bool:
    return finding.verdict is not None and finding.verdict.status is Status.FAILED


def _title(findings: Findings) -> str:
    if findings.checking or not findings.judged:
        return "Criteria"
    if not findings.at:
        return "Criteria: your code has changed since this check" if findings.outdated else "Criteria"
    since = {True: ", your code has changed since", False: ", your code is the same"}
    known = "" if findings.outdated is None else since[findings.outdated]
    return f"Checked {wording.format_time(findings.at)}{known}"


def _headline(findings: Findings, *, typing: bool) -> str:
    if findings.checking:
        return f"checking {findings.fraction:.0%} · {'F9' if typing else 'Esc'} cancels"
    if findings.note:
        return findings.note
    if findings.result:
        return wording.summary(findings.result)
    if findings.before:
        required = [finding for finding in findings.criteria if not finding.bonus]
        met = sum(bool(finding.before) for finding in required)
        return f"last check {wording.format_time(findings.before)}: {met} of {len(required)} met"
    return "not checked yet"

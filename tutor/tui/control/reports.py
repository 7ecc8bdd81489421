"""What can be read beside a criterion's report: its evidence, and the page of the mistake that a check has named."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from typing import TYPE_CHECKING

from tutor.errors import EngineError
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status
from tutor.session.explaining import CHECKS_IN_A_ROW, find_mistakes
from tutor.tui import commands, wording
from tutor.tui.control.host import HostScreen
from tutor.tui.control.pages import Pages
from tutor.tui.control.preferences import Preferences
from tutor.tui.widgets.diagnosis import Diagnosis

if TYPE_CHECKING:
    from tutor.session.findings import Findings


class Reports:
    """Unfolds the evidence, explains mistakes, and does so unasked when a learner meets one again and again."""

    def __init__(self, host: HostScreen, pages: Pages, preferences: Preferences) -> None:
        self._host, self._pages, self._preferences = host, pages, preferences
        self._had_mistakes = False
        host.register(commands.EVIDENCE, self.toggle_evidence)
        host.register(commands.EXPLAIN, self.explain, lambda: self._had_mistakes)

    def toggle_evidence(self) -> None:
        """Show or hide the evidence of the criterion shown."""
        diagnosis = self._host.query_one(Diagnosis)
        if not diagnosis.has_evidence:
            self._host.say("There is no evidence here: choose a criterion that was checked.")
            return
        if self._pages.folded and self._host.page != "criteria":
            self._host.show_page("criteria")
        diagnosis.toggle_evidence()

    def explain(self) -> None:
        """Show the page of the mistake of the criterion shown, or else of the first failure, or of the remarks."""
        if mistakes := self._to_explain():
            self._host.start_worker(self._open, mistakes, group="explain", exclusive=True)

    def findings_changed(self) -> None:
        """Offer an explanation while the lesson's check has named a mistake, or remarked on one."""
        found = self._found
        remarked = found.result is not None and bool(found.result.remarks)
        named = remarked or any(finding.verdict is not None and finding.verdict.mistake for finding in found.criteria)
        if named != self._had_mistakes:
            self._had_mistakes = named
            self._host.refresh_bindings()

    def attempt_recorded(self, result: ExerciseResult) -> None:
        """Explain the first mistake of a check, if it is the last of several in a row that failed by it."""
        model = self._host.model
        mistake = next(iter(result.mistakes), "")
        key = f"{result.id} {mistake}"
        if not mistake or result.id != model.lesson.id or key in model.state.explained:
            return
        count = model.progress.of(result.id).in_a_row(mistake)
        if count < CHECKS_IN_A_ROW:
            return
        if self._may_interrupt():
            self._preferences.update(explained=(*model.state.explained, key))
            note = f"Your last {count} checks failed for this same reason. Here is what is behind it."
            self._host.start_worker(self._open, [mistake], note, group="explain", exclusive=True)
        else:
            letters = self._host.focused is not None and self._host.focused.check_consume_key("x", "x")
            key_name = wording.key_hint(commands.EXPLAIN.keys[0], typing=letters)
            self._host.say(f"Your last {count} checks failed for the same reason: {key_name} explains it.")

    @property
    def _found(self) -> Findings:
        return self._host.model.findings[self._host.model.lesson.id]

    def _may_interrupt(self) -> bool:
        """Return whether no dialog is open, and the learner is not typing: the page would swallow the letters."""
        focused = self._host.focused
        typing = focused is not None and focused.check_consume_key("a", "a")
        waiting = self._host.page == "code" and not self._found.outdated  # nothing was typed since the check began
        return self._host.app.screen is self._host and (waiting or not typing)

    def _to_explain(self) -> Sequence[str]:
        found = self._found
        failed = [finding for finding in found.criteria if finding.verdict is not None and finding.verdict.mistake]
        chosen = [finding for finding in failed if finding.id == self._host.chosen_criterion]
        if not chosen and found.result is not None and found.result.verdict is Status.PASSED and found.result.remarks:
            return [remark.mistake for remark in found.result.remarks]
        first = chosen or sorted(failed, key=lambda finding: finding.bonus)
        return [finding.verdict.mistake for finding in first[:1] if finding.verdict is not None]

    async def _open(self, mistakes: Sequence[str], note: str = "") -> None:
        session = self._host.model.session
        try:
            found = await asyncio.to_thread(find_mistakes, mistakes, session.course, self._host.model.lesson)
        except EngineError as error:
            self._host.show_error(str(error))
            return
        if not found:
            if not note:
                self._host.say("There is no page on this mistake: it was named by another ros-tutor. Check again.")
            return
        from tutor.tui.dialogs.explanation import ExplanationScreen  # late: it loads the catalogue

        if self._host.app.screen is self._host:
            self._host.app.push_screen(ExplanationScreen(found, note))

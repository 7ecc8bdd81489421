"""The diagnosis of one criterion: what was expected and observed, why, the next step, and where to read more."""

from __future__ import annotations

from functools import partial
from typing import Protocol

from textual.app import ComposeResult
from textual.containers import Horizontal, VerticalScroll
from textual.content import Content
from textual.style import Style
from textual.widgets import Static

from tutor.content import Counts, Lesson
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status, Verdict
from tutor.session.findings import Finding, Findings
from tutor.tui import wording
from tutor.tui.widgets import diagnosis_heads
from tutor.tui.widgets.wrapped import WrappedText


class _Text(Protocol):
    """Makes a text; `typing`: whether letters are typed where the focus is, so that it names other keys."""

    def __call__(self, *, typing: bool) -> Content: ...


def _nothing(*, typing: bool) -> Content:
    return Content("")


class Part(Horizontal):
    """A name and its text, side by side; hidden while there is no text."""

    DEFAULT_CSS = """
    Part {
        height: auto;
        display: none;
        &.-filled { display: block; }
        & > .part-name { width: 11; color: $quiet; }
        & > .part-text { width: 1fr; height: auto; link-style: underline; link-color: $foreground; }
        &#part-evidence > .part-text { color: $quiet; }
        &#part-observed > .part-text { text-style: bold; }
    }
    """

    def __init__(self, name: str, id: str, *, hang: int = 0) -> None:
        super().__init__(id=id)
        self._name_text, self._hang = name, hang

    def compose(self) -> ComposeResult:
        yield Static(self._name_text, classes="part-name")
        yield WrappedText(classes="part-text", hang=self._hang)

    def show(self, text: Content) -> None:
        """Show the text."""
        self.set_class(bool(text.plain), "-filled")
        self.query_one(".part-text", WrappedText).update(text)


class Diagnosis(VerticalScroll):
    """Everything known about one criterion, or the good news once all are met."""

    DEFAULT_CSS = """
    Diagnosis {
        width: 1fr;
        height: 1fr;
        padding: 0 1;
        scrollbar-size: 1 1;
        background: $surface;
        & > #diagnosis-news { height: auto; display: none; &.-filled { display: block; } }
        & > #diagnosis-head { height: auto; }
        & > #diagnosis-remarks {
            display: none;
            height: auto;
            margin: 1 0;
            padding: 0 1;
            background: $panel;
            border-left: outer $warn;
            &.-filled { display: block; }
        }
        & > #diagnosis-step {
            display: none;
            height: auto;
            margin: 1 0;
            padding: 0 1;
            background: $panel;
            border-left: outer $accent;
            &.-filled { display: block; }
        }
        &.-tight > #diagnosis-step { dock: bottom; max-height: 50%; margin: 0; }
    }
    """

    def compose(self) -> ComposeResult:
        yield Static(id="diagnosis-news")
        yield WrappedText(id="diagnosis-head")
        yield WrappedText(id="diagnosis-remarks", hang=2)
        yield Part("Expected", id="part-expected")
        yield Part("Observed", id="part-observed")
        yield Part("Why", id="part-why")
        yield WrappedText(id="diagnosis-step")
        yield Part("More", id="part-more")
        yield Part("Evidence", id="part-evidence", hang=2)

    def __init__(self, id: str) -> None:
        super().__init__(id=id)
        self._evidence: tuple[str, ...] = ()
        self._unfolded = False
        self._typing = False
        self._head, self._news, self._remarks = _nothing, _nothing, _nothing
        """Rebuild these parts, which name other keys while letters are typed."""
        self._mistake = ""

    @property
    def has_evidence(self) -> bool:
        """Whether the shown criterion has evidence."""
        return bool(self._evidence)

    def toggle_evidence(self) -> None:
        """Show or hide the evidence."""
        self._unfolded = not self._unfolded
        self._show_evidence()
        if self._unfolded:
            self.query_one("#part-evidence").scroll_visible(animate=False)

    def show_typing(self, typing: bool) -> None:
        """Name the keys that work now: letters are typed while the editor has the focus."""
        self._typing = typing
        self._show_head()
        self._show_evidence()

    def show_finding(self, finding: Finding, findings: Findings, following: Lesson | None) -> None:
        """Show one criterion, its evidence folded; above it the check's outcome, if the criterion does not tell it."""
        self._unfolded = False
        self._fill(
            partial(diagnosis_heads.finding_head, finding, findings),
            finding.verdict,
            news=partial(diagnosis_heads.outcome, finding, findings, following),
        )

    def show_passed(self, result: ExerciseResult, following: Lesson | None, done: Counts | None) -> None:
        """Show the good news and what comes next; `done`: what is passed now, if it is all of the course or more."""
        self._unfolded = False
        self._fill(
            partial(diagnosis_heads.passed_head, result, following, done),
            remarks=partial(diagnosis_heads.remarks, result),
        )

    def _fill(
        self,
        head: _Text,
        verdict: Verdict | None = None,
        *,
        news: _Text = _nothing,
        remarks: _Text = _nothing,
    ) -> None:
        verdict = verdict or Verdict(Status.SKIPPED)
        self._head, self._news, self._remarks = head, news, remarks
        self._mistake = verdict.mistake
        self.query_one("#part-expected", Part).show(Content(verdict.expected))
        self.query_one("#part-observed", Part).show(Content(verdict.observed))
        self.query_one("#part-why", Part).show(_why(verdict))
        step = Content.assemble(("Next step  ", "bold $accent"), verdict.step) if verdict.step else Content("")
        self._show("#diagnosis-step", step)
        self._evidence = verdict.evidence
        self._show_head()
        self._show_evidence()
        self.scroll_home(animate=False)
        self._keep_step_visible()

    def on_resize(self) -> None:
        """Arrange for the new size."""
        self._keep_step_visible()

    def _keep_step_visible(self) -> None:
        """Keep the next step at the bottom, whatever is above it, if it would be out of sight otherwise."""
        self.remove_class("-tight")
        self.call_after_refresh(self._dock_step)

    def _dock_step(self) -> None:
        step = self.query_one("#diagnosis-step")
        if step.display and step.virtual_region.bottom > self.scrollable_content_region.height:
            self.add_class("-tight")

    def _show(self, selector: str, text: Content) -> None:
        """Show a text in one of the parts without a name, or hide the part if there is none."""
        part = self.query_one(selector, Static)
        part.update(text)
        part.set_class(bool(text.plain), "-filled")

    def _show_head(self) -> None:
        """Show all that names keys."""
        self.query_one("#diagnosis-head", WrappedText).update(self._head(typing=self._typing))
        self._show("#diagnosis-news", self._news(typing=self._typing))
        self._show("#diagnosis-remarks", self._remarks(typing=self._typing))
        more = Content("")
        if self._mistake:
            more = diagnosis_heads.explain_link("this mistake", typing=self._typing)
        self.query_one("#part-more", Part).show(more)

    def _show_evidence(self) -> None:
        count = len(self._evidence)
        lines = f"{count} line{'' if count == 1 else 's'}"
        key = wording.key_hint("i", typing=self._typing)
        link = Content.from_markup(
            "[@click=screen.do('evidence')]$text[/]",
            text=f"▾ {lines}, {key} hides" if self._unfolded else f"▸ {lines}, {key} shows",
        )
        text = Content("\n").join([link, *(Content(line) for line in self._evidence)]) if self._unfolded else link
        self.query_one("#part-evidence", Part).show(text if count else Content(""))


def _why(verdict: Verdict) -> Content:
    """The cause, with the mistake's name in bold; or a link to the criterion where it is told."""
    if verdict.same_as:
        link = Style.from_meta({"@click": f"screen.show_criterion({verdict.same_as!r})"})
        root = Content(verdict.same_as).stylize(link)
        return Content.assemble("for the same reason as ", root)
    title, colon, text = verdict.cause.partition(": ")
    if not verdict.mistake or not colon:
        return Content(verdict.cause)
    return Content.assemble((title, "bold"), colon, text)

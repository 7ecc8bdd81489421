"""The diagnosis of one criterion: what was expected and observed, why, the next step, and where to read more."""

from __future__ import annotations

from functools import partial

from rich.cells import cell_len
from textual.app import ComposeResult
from textual.containers import Horizontal, VerticalScroll
from textual.content import Content
from textual.style import Style
from textual.widgets import Static

from tutor.content import Counts, Lesson
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status, Verdict
from tutor.report.plain import REMARKS_HEADING, one_line, remark_lines
from tutor.session.findings import Finding, Findings
from tutor.tui import wording
from tutor.tui.widgets.wrapped import WrappedText


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
        self._head = partial(Content)
        """Rebuilds the head, which names other keys while letters are typed."""
        self._news, self._remarked = partial(Content), partial(Content)
        """Rebuild the news and the remarks, likewise."""
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
            partial(self._finding_head, finding, findings),
            finding.verdict,
            news=partial(self._outcome, finding, findings, following),
        )

    def _outcome(self, finding: Finding, findings: Findings, following: Lesson | None) -> Content:
        if (result := findings.result) is None or findings.checking:
            return Content("")
        if result.verdict is Status.PASSED:
            passed = Content.styled(f"✓ {result.id.upper()} passed", "bold $good")
            if following is None:
                return passed
            key = wording.key_hint("n", typing=self._typing)
            where = f" for {wording.label(following)} {following.title}"
            return Content.assemble(passed, "  press ", (key, "bold $accent"), where)
        failed = [c.id for c in result.criteria if c.verdict.status is Status.FAILED and not c.bonus]
        if not failed or finding.id in failed:
            return Content("")
        return Content.assemble((f"✗ Not met yet: {', '.join(failed)}", "bold $bad"))

    def _finding_head(self, finding: Finding, findings: Findings) -> Content:
        verdict = finding.verdict
        if verdict is not None:
            mark, colour = wording.MARKS[verdict.status], wording.STATUS_COLOURS[verdict.status]
            # An error is the tutor's own, and learners know no mark for that: add the word.
            status = " error" if verdict.status is Status.ERROR else ""
        else:
            mark, colour, status = "○", "$quiet", " being checked" if finding.checking else ""
            if finding.before is not None and not finding.checking:
                mark = wording.MARKS[Status.PASSED] if finding.before else "○"
        name = Content.assemble(
            (f"{mark}{status} ", f"bold {colour}"), (finding.id, "bold"), "  ", (finding.text, "$quiet")
        )
        details = "  bonus: never changes the verdict" if finding.bonus else ""
        if verdict is None and finding.so_far:
            details += f"\n\n{finding.doing}\n\nSo far, and not final: {one_line(finding.so_far)}"
        if verdict is None and not finding.checking:
            met = "Met" if finding.before else "Not met"
            last_result = (
                f"{met} at the last check, {wording.format_time(findings.before)}"
                if findings.before
                else "Not checked yet"
            )
            details += f"\n\n{last_result}. Press {'F9' if self._typing else 'c'} to check."
        return Content.assemble(name, (details, "$quiet"))

    def show_passed(self, result: ExerciseResult, following: Lesson | None, done: Counts | None) -> None:
        """Show the good news and what comes next; `done`: what is passed now, if it is all of the course or more."""
        self._unfolded = False
        self._fill(partial(self._passed_head, result, following, done), remarks=partial(self._remarks, result))

    def _passed_head(self, result: ExerciseResult, following: Lesson | None, done: Counts | None) -> Content:
        missed = [c.id for c in result.criteria if c.bonus and c.verdict.status is not Status.PASSED]
        line = f"✓ {result.id.upper()} {result.title} passed"
        bonus = f"Still open as a bonus: {', '.join(missed)}.\n" if missed else ""
        go_on = ("", "", "")
        if done is not None:
            command, key, where = "checklist", "6", "the checklist"
            if following is not None and not done.all_done:
                go_on = ("next", "n", f"{wording.label(following)} {following.title}")
        elif following is not None:
            command, key, where = "next", "n", f"{wording.label(following)} {following.title}"
        else:
            command, key, where = "lessons", "l", "the list of lessons"
        gap = "" if result.remarks else "\n"  # the remarks below need the room
        return Content.assemble(
            (line, "bold $good"),
            "\n",
            ("━" * cell_len(line), "$good"),
            f"\n{gap}Well done: your node does all that was asked for.\n",
            _describe_done(done),
            bonus,
            f"{gap}Next: press ",
            self._bold(key),
            " for ",
            self._link(command, where),
            ", ",
            *((self._bold(go_on[1]), " for ", self._link(go_on[0], go_on[2]), ", ") if go_on[0] else ()),
            ("V", "bold $accent"),
            " to ",
            Content.from_markup("[@click=screen.do('against')]compare your code with our solution[/]"),
            ".",
            ("" if result.remarks else "\nChoose a criterion to see what was measured.", "$quiet"),
        )

    def _bold(self, key: str) -> tuple[str, str]:
        return wording.key_hint(key, typing=self._typing), "bold $accent"

    def _link(self, command: str, where: str) -> Content:
        return Content.from_markup(f"[@click=screen.do('{command}')]$where[/]", where=where)

    def _remarks(self, result: ExerciseResult) -> Content:
        if not result.remarks:
            return Content("")
        parts: list[Content | str | tuple[str, str]] = [(REMARKS_HEADING, "bold $warn"), "\n"]
        for line in remark_lines(result):
            parts += [("- ", "$warn"), line, "\n"]
        return Content.assemble(*parts, self._explain_link("why"))

    def _explain_link(self, what: str) -> Content:
        key = wording.key_hint("x", typing=self._typing)
        return Content.from_markup("[@click=screen.do('explain')]$key explains $what[/]", key=key, what=what)

    def _fill(
        self,
        head: partial[Content],
        verdict: Verdict | None = None,
        *,
        news: partial[Content] | None = None,
        remarks: partial[Content] | None = None,
    ) -> None:
        verdict = verdict or Verdict(Status.SKIPPED)
        self._head, self._news, self._remarked = head, news or partial(Content), remarks or partial(Content)
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
        self.query_one("#diagnosis-head", WrappedText).update(self._head())
        self._show("#diagnosis-news", self._news())
        self._show("#diagnosis-remarks", self._remarked())
        more = self._explain_link("this mistake") if self._mistake else Content("")
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


def _describe_done(done: Counts | None) -> str:
    if done is None:
        return ""
    return "Every exercise is passed now.\n" if done.all_done else "Every exercise of the course is passed now.\n"


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

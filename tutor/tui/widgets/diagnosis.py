"""The diagnosis of one criterion: expected, observed, cause, next step, evidence."""

from __future__ import annotations

from rich.cells import cell_len
from textual.app import ComposeResult
from textual.containers import Horizontal, VerticalScroll
from textual.content import Content
from textual.widgets import Static

from tutor.content import Lesson
from tutor.judge.result import ExerciseResult
from tutor.judge.verdict import Status
from tutor.tui import words
from tutor.tui.findings import Finding


class Part(Horizontal):
    """A name and its text, side by side; hidden where there is no text."""

    DEFAULT_CSS = """
    Part {
        height: auto;
        display: none;
        &.-filled { display: block; }
        & > .part-name { width: 11; color: $quiet; }
        & > .part-text { width: 1fr; height: auto; link-style: underline; link-color: $foreground; }
        &#part-hint > .part-text { color: $accent; }
        &#part-evidence > .part-text { color: $quiet; }
        &#part-observed > .part-text { text-style: bold; }
    }
    """

    def __init__(self, name: str, id: str) -> None:
        super().__init__(id=id)
        self._name_text = name

    def compose(self) -> ComposeResult:
        yield Static(self._name_text, classes="part-name")
        yield Static(classes="part-text", markup=False)

    def show(self, text: Content) -> None:
        """Show the text."""
        self.set_class(bool(text.plain), "-filled")
        self.query_one(".part-text", Static).update(text)


class Diagnosis(VerticalScroll):
    """Everything that is known of one criterion."""

    DEFAULT_CSS = """
    Diagnosis {
        width: 1fr;
        height: 1fr;
        padding: 0 2 0 1;
        scrollbar-size: 1 1;
        background: $surface;
        & > #diagnosis-head { margin-bottom: 1; height: auto; }
    }
    """

    PARTS = (
        ("expected", "Expected"),
        ("observed", "Observed"),
        ("cause", "Cause"),
        ("hint", "Next step"),
        ("evidence", "Evidence"),
    )

    def compose(self) -> ComposeResult:
        yield Static(id="diagnosis-head")
        for key, name in self.PARTS:
            yield Part(name, id=f"part-{key}")

    def __init__(self, id: str) -> None:
        super().__init__(id=id)
        self._evidence: tuple[str, ...] = ()
        self._unfolded = False

    @property
    def has_evidence(self) -> bool:
        """Whether there is any for the criterion that is shown."""
        return bool(self._evidence)

    def fold(self) -> None:
        """Show the evidence, or hide it."""
        self._unfolded = not self._unfolded
        self._show_evidence()
        if self._unfolded:
            self.query_one("#part-evidence").scroll_visible(animate=False)

    def show_finding(self, finding: Finding) -> None:
        """Show one criterion; its evidence is folded."""
        verdict = finding.verdict
        self._unfolded = False
        if verdict is None:
            mark, ink, word = "○", "$quiet", "being checked" if finding.checking else "not checked yet"
        else:
            mark, ink, word = words.MARKS[verdict.status], words.INKS[verdict.status], verdict.status.value
        about = Content.assemble((f"{mark} {word}", f"bold {ink}"), "  ", (finding.id, "bold"))
        if finding.bonus:
            about = Content.assemble(about, ("  bonus: never changes the verdict", "$quiet"))
        self._fill(
            Content.assemble(about, "\n", (finding.text, "$quiet")),
            expected=verdict.expected if verdict else "",
            observed=verdict.observed if verdict else "",
            cause=verdict.cause if verdict else "",
            hint=verdict.hint if verdict else "",
            evidence=verdict.evidence if verdict else (),
        )

    def show_passed(self, result: ExerciseResult, following: Lesson | None) -> None:
        """The good news, and where to go from here."""
        missed = [c.id for c in result.criteria if c.bonus and c.verdict.status is not Status.PASSED]
        line = f"✓ {result.id.upper()} {result.title} passed"
        bonus = f"Still open as a bonus: {', '.join(missed)}.\n" if missed else ""
        parts: list[Content | str | tuple[str, str]] = [
            (line, "bold $good"),
            "\n",
            ("━" * cell_len(line), "$good"),
            "\n\nWell done: your node does all that was asked for.\n",
            bonus,
        ]
        if following is not None:
            name = f"{words.label(following)} {following.title}"
            link = Content.from_markup("[@click=screen.do('next')]$name[/]", name=name)
            parts += ["\nNext: press ", ("n", "bold $accent"), " for ", link, "."]
        else:
            parts.append("\nThis was the last exercise.")
        parts.append(" Choose a criterion to see what was measured.")
        self._fill(Content.assemble(*parts))

    def _fill(self, head: Content, *, evidence: tuple[str, ...] = (), **texts: str) -> None:
        self.query_one("#diagnosis-head", Static).update(head)
        for key, _ in self.PARTS[:-1]:
            self.query_one(f"#part-{key}", Part).show(Content(texts.get(key, "")))
        self._evidence = evidence
        self._show_evidence()
        self.scroll_home(animate=False)

    def _show_evidence(self) -> None:
        count = len(self._evidence)
        lines = f"{count} line{'' if count == 1 else 's'}"
        link = Content.from_markup(
            "[@click=screen.do('evidence')]$text[/]",
            text=f"▾ {lines}, i hides" if self._unfolded else f"▸ {lines}, i shows",
        )
        text = Content("\n").join([link, *(Content(line) for line in self._evidence)]) if self._unfolded else link
        self.query_one("#part-evidence", Part).show(text if count else Content(""))

"""The diagnosis of one criterion: expected, observed, cause, next step, evidence."""

from __future__ import annotations

from rich.cells import cell_len
from textual.app import ComposeResult
from textual.containers import Horizontal, VerticalScroll
from textual.content import Content
from textual.widgets import Static

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
        & > .part-text { width: 1fr; height: auto; }
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

    def show(self, text: str) -> None:
        """Show the text, word by word as it is."""
        self.set_class(bool(text), "-filled")
        self.query_one(".part-text", Static).update(Content(text))


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

    def show_finding(self, finding: Finding) -> None:
        """Show one criterion."""
        verdict = finding.verdict
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
            evidence="\n".join(verdict.evidence) if verdict else "",
        )

    def show_passed(self, result: ExerciseResult) -> None:
        """The good news, and where to go from here."""
        missed = [c.id for c in result.criteria if c.bonus and c.verdict.status is not Status.PASSED]
        line = f"✓ {result.id.upper()} {result.title} passed"
        bonus = f"Still open as a bonus: {', '.join(missed)}.\n" if missed else ""
        text = Content.assemble(
            (line, "bold $good"),
            "\n",
            ("━" * cell_len(line), "$good"),
            "\n\nWell done: your node does all that was asked for.\n",
            bonus,
            "\nPress ",
            ("n", "bold $accent"),
            " for the next lesson, or choose a criterion to see what was measured.",
        )
        self._fill(text)

    def _fill(self, head: Content, **texts: str) -> None:
        self.query_one("#diagnosis-head", Static).update(head)
        for key, _ in self.PARTS:
            self.query_one(f"#part-{key}", Part).show(texts.get(key, ""))
        self.scroll_home(animate=False)

"""A program, a question about it, and the options; once answered, what the program wrote, and which option holds."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical, VerticalScroll
from textual.content import Content
from textual.widgets import OptionList
from textual.widgets.option_list import Option

from tutor.content import Lesson, Prediction
from tutor.session.predictions import Outcome, standing
from tutor.terminal_text import printable
from tutor.tui import wording
from tutor.tui.dialogs.dialog import Dialog
from tutor.tui.widgets.code_view import CodeView
from tutor.tui.widgets.wrapped import WrappedText
from tutor.workspace import Predicted

_DIGITS = "1234"


class PredictScreen(Dialog[None]):
    """The predictions of a lesson, one at a time, beginning with the first that is not right yet.

    `answer` is called with a prediction and the index of the option chosen; `show_output` and `show_outcome` then
    show what its program does.
    """

    BINDINGS: ClassVar[list[BindingType]] = [
        *(Binding(digit, f"answer({digit})", show=False) for digit in _DIGITS),
        Binding("n,enter", "step(1)", "Next", show=False),
        Binding("p", "step(-1)", "Previous", show=False),
        Binding("pageup", "scroll_code(-1)", show=False, priority=True),
        Binding("pagedown", "scroll_code(1)", show=False, priority=True),
        Binding("q", "close", show=False),
    ]

    def __init__(
        self, lesson: Lesson, answers: Mapping[str, Predicted], answer: Callable[[Prediction, int], object]
    ) -> None:
        super().__init__()
        self._lesson, self._answers, self._answer = lesson, answers, answer
        right = [(found := answers.get(p.id)) is not None and found.right for p in lesson.predictions]
        self._index = right.index(False) if False in right else 0
        self._chosen: int | None = None
        """The index of the learner's answer, once given."""
        self._told = False
        """Whether the outcome is shown."""

    @property
    def prediction(self) -> Prediction:
        """The one that is shown."""
        return self._lesson.predictions[self._index]

    @property
    def told(self) -> bool:
        """Whether the learner has been told what was seen."""
        return self._told

    def compose(self) -> ComposeResult:
        with Vertical(classes="window -wide"):
            yield CodeView(id="predict-code")
            yield WrappedText(id="predict-question")
            yield OptionList(id="predict-options")
            with VerticalScroll(id="predict-seen"):
                yield WrappedText(id="predict-output", hang=2)
                yield WrappedText(id="predict-verdict")

    def on_mount(self) -> None:
        self._show()

    # --- the question ---

    def _show(self) -> None:
        """Show the prediction, not answered."""
        self._chosen, self._told = None, False
        try:
            source = self.prediction.program.read_text(encoding="utf-8")
        except OSError as error:
            source = f"# {self.prediction.program} cannot be read: {error.strerror}"
        code = self.query_one(CodeView)
        code.show_source(source.rstrip("\n"))
        code.scroll_home(animate=False)
        self.query_one("#predict-question", WrappedText).update(Content.styled(self.prediction.asks, "bold"))
        self.query_one("#predict-seen").display = False
        self._show_options()
        self.query_one(OptionList).focus()
        self._show_titles()

    def _show_options(self, seen: int | None = None) -> None:
        options = self.query_one(OptionList)
        options.clear_options()
        for index, option in enumerate(self.prediction.options):
            mark, colour = "", ""
            if self._chosen is not None:
                mark = "▸ " if index == self._chosen else "  "
            if seen is not None:
                mark = "✓ " if index == seen else "✗ " if index == self._chosen else "  "
                colour = "$good" if index == seen else "$bad" if index == self._chosen else "$quiet"
            prompt = Content.assemble((f"{mark}{index + 1}  ", "bold $accent"), (option.says, colour))
            options.add_option(Option(prompt, disabled=self._chosen is not None))
        options.highlighted = 0 if self._chosen is None else None

    def _show_titles(self) -> None:
        window, count = self.query_one(".window"), len(self._lesson.predictions)
        place = f"{self._index + 1} of {count}, {standing(self._answers.get(self.prediction.id))}"
        window.border_title = Content(f"{wording.label(self._lesson)}: predict and see, {place}")
        scroll = "PgUp PgDn program"
        digits = f"1-{len(self.prediction.options)}"
        step = "n next · " if self._index + 1 < count else ""
        if self._told:
            window.border_subtitle = f"{scroll} · {step}Esc closes"
        elif self._chosen is not None:
            window.border_subtitle = "it runs, to be judged by what it does · Esc ends it"
        else:
            window.border_subtitle = f"{digits} answers · {scroll} · {step}Esc closes"

    def show_answers(self, answers: Mapping[str, Predicted]) -> None:
        """Show what has been recorded since."""
        self._answers = answers
        if self.is_mounted:
            self._show_titles()

    # --- the answer ---

    def action_answer(self, number: int) -> None:
        """Answer with the option of this number, if it is still open."""
        if self._chosen is None and number <= len(self.prediction.options):
            self._chosen = number - 1
            self._show_options()
            self.query_one("#predict-seen").display = True
            self.show_output([])
            self.query_one("#predict-verdict", WrappedText).update(Content())
            self._show_titles()
            self._answer(self.prediction, self._chosen)

    @on(OptionList.OptionSelected)
    def _option_chosen(self, event: OptionList.OptionSelected) -> None:
        event.stop()
        self.action_answer(event.option_index + 1)

    def show_output(self, lines: list[str]) -> None:
        """Show what the program has written so far."""
        written = [Content.assemble(("│ ", "$quiet"), printable(line)) for line in lines]
        text = Content("\n").join(written) if written else Content.styled("│ nothing written yet", "$quiet")
        self.query_one("#predict-output", WrappedText).update(text)
        self.query_one("#predict-seen", VerticalScroll).scroll_end(animate=False)

    def show_outcome(self, outcome: Outcome) -> None:
        """Tell what was seen, and why; or that nothing can be said, which leaves the question open."""
        verdict, seen = self.query_one("#predict-verdict", WrappedText), self.query_one("#predict-seen", VerticalScroll)
        if outcome.holds is None:
            text = f"! Nothing is recorded, as {outcome.problem}. Is the machine very busy? Answer again."
            verdict.update(Content.styled(text, "$warn"))
            self._chosen = None
            self._show_options()
            self.query_one(OptionList).focus()
        else:
            right = outcome.holds == self._chosen
            head = ("✓ Right. ", "bold $good") if right else ("✗ Not so. ", "bold $bad")
            verdict.update(Content.assemble(head, self.prediction.because))
            self._told = True
            self._show_options(outcome.holds)
            seen.focus()
        seen.scroll_home(animate=False)
        self._show_titles()

    # --- getting around ---

    def action_step(self, by: int) -> None:
        """Show the next or the previous prediction; after the last one, close."""
        if self._chosen is not None and not self._told:
            return
        if self._told and self._index + by == len(self._lesson.predictions):
            self.dismiss(None)
        elif 0 <= self._index + by < len(self._lesson.predictions):
            self._index += by
            self._show()

    def action_scroll_code(self, by: int) -> None:
        """Scroll the program by a page."""
        code = self.query_one(CodeView)
        code.scroll_relative(y=by * max(1, code.size.height - 1), animate=False)

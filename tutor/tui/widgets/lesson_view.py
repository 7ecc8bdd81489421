"""The text of a lesson."""

from __future__ import annotations

from textual import events
from textual.app import ComposeResult
from textual.containers import VerticalScroll
from textual.content import Content
from textual.widgets import Markdown, Static
from textual.widgets.markdown import MarkdownBlock

from tutor.content import Lesson
from tutor.judge.wording import counted
from tutor.tui import commands, messages, wording
from tutor.tui.lesson_commands import LANGUAGES, command_at
from tutor.tui.widgets.lesson_fence import LessonFence, LessonMarkdown


class LessonView(VerticalScroll):
    """Title, objective and body."""

    DEFAULT_CSS = """
    LessonView {
        background: $surface;
        padding: 1 1 0 2;
        scrollbar-size: 1 1;
        & > #lesson-head { height: auto; }
        & > Markdown {
            background: transparent;
            padding: 0 1 0 0;
            max-width: 100;
            MarkdownH2 { color: $primary; text-style: bold; margin: 1 0 1 0; }
            MarkdownH3 { color: $secondary; text-style: bold; margin: 1 0 1 0; }
            LessonFence { background: $background; margin: 0 0 1 0; padding: 0; }
            MarkdownBlockQuote { background: $panel; border-left: outer $accent; margin: 0 0 1 0; padding: 0 1; }
            MarkdownBlock.-found { background: $block-cursor-background; }
            MarkdownBullet { color: $accent; }
        }
    }
    """

    def compose(self) -> ComposeResult:
        yield Static(id="lesson-head")
        yield LessonMarkdown(id="lesson-body", open_links=False)

    def watch_has_focus(self, _has_focus: bool) -> None:
        """Restyle only this widget, not its hundreds of children: the focus does not change how the text looks."""
        self.app.stylesheet.update_nodes([self])

    async def show_lesson(self, lesson: Lesson) -> None:
        """Show a lesson, scrolled to its top."""
        files = ", ".join(file.name for file in lesson.files)
        head = Content.assemble(
            (f"{wording.label(lesson)}  {lesson.title}", "bold $primary"),
            ("   " + wording.LEVELS[lesson.difficulty], "$accent"),
            "\n",
            (f"{lesson.unit} · {files}", "$quiet"),
            _to_predict(lesson),
        )
        self.query_one("#lesson-head", Static).update(head)
        self.scroll_home(animate=False)
        await self.query_one(Markdown).update(lesson.body)

    def on_click(self, event: events.Click) -> None:
        """Run a clicked command of an example in the terminal."""
        above = self.screen.get_widget_at(*event.screen_offset)[0].ancestors_with_self
        fence = next((widget for widget in above if isinstance(widget, LessonFence)), None)
        if fence is None or fence.lexer.partition(" ")[0] not in LANGUAGES:
            return
        line = fence.line_at(*event.screen_offset)
        if line is not None and (command := command_at(fence.code, line)):
            event.stop()
            self.post_message(messages.RunCommand(command))

    def go_to_line(self, line: int) -> None:
        """Scroll to and highlight the block with this line of the body (from 0)."""
        for block in self.query(MarkdownBlock):
            first, end = block.source_range
            if first <= line < end and not block.query(MarkdownBlock):
                block.scroll_visible(animate=False, top=True)
                block.add_class("-found")
            else:
                block.remove_class("-found")


def _to_predict(lesson: Lesson) -> Content:
    """Return a line that opens the lesson's predictions; empty if it has none."""
    if not lesson.predictions:
        return Content()
    programs = counted(len(lesson.predictions), "given program")
    link = Content.from_markup("[@click=screen.do('predict')]Predict what $n do, then see[/]", n=programs)
    return Content.assemble("\n", (commands.PREDICT.shown_keys[0], "bold $accent"), " ", link)

"""The search line below the editor."""

from __future__ import annotations

from typing import ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Horizontal
from textual.content import Content
from textual.widgets import Input, Static
from textual.widgets.text_area import Selection

from tutor.tui.text_search import Place, find_all, nearest_index
from tutor.tui.widgets.editor import CodeEditor


class FindBar(Horizontal):
    """Selects each match in the editor. Esc closes the bar and leaves the cursor at the match."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter,down,ctrl+g,ctrl+f", "go(1)", "Next", key_display="Enter"),
        Binding("up,shift+enter", "go(-1)", "Previous", key_display="↑"),
        Binding("escape", "end", "Done", key_display="Esc"),
    ]
    DEFAULT_CSS = """
    FindBar {
        height: 1;
        display: none;
        background: $panel;
        & > Static { width: auto; padding: 0 1; }
        & > Input {
            width: 1fr;
            height: 1;
            border: none;
            padding: 0 1;
            background: $background;
            &:focus { border: none; }
        }
    }
    """

    def __init__(self, id: str | None = None) -> None:
        super().__init__(id=id)
        self._editor: CodeEditor | None = None
        self._origin: Place = (0, 0)
        self._typing = False

    def compose(self) -> ComposeResult:
        yield Static("Find")
        yield Input(placeholder="text to find in your code", id="find-text")
        yield Static(id="find-count")

    def begin(self, editor: CodeEditor, *, typing: bool) -> None:
        """Start a search from the editor's cursor; `typing` if the editor has the focus, and is to get it back."""
        self._editor, self._typing = editor, typing
        self._origin = min(editor.selection.start, editor.selection.end)
        self.display = True
        field = self.query_one(Input)
        if chosen := editor.selected_text.partition("\n")[0]:
            field.value = chosen
        field.focus()
        field.action_select_all()
        self._show()

    def again(self, editor: CodeEditor) -> bool:
        """Go to the next match of the last search. Return False if there was none yet."""
        self._editor = editor
        if self.query_one(Input).value:
            self.action_go(1)
            return True
        return False

    @on(Input.Changed)
    def _changed(self, event: Input.Changed) -> None:
        event.stop()
        if self.display:
            self._show()

    @on(Input.Submitted)
    def _submitted(self, event: Input.Submitted) -> None:
        event.stop()
        self.action_go(1)

    def action_go(self, by: int) -> None:
        """Go to the next match, or with a negative `by` to the previous one."""
        if self._editor is not None:
            self._origin = self._editor.selection.start
            self._show(by)

    def action_end(self) -> None:
        """Close the bar and give the focus back."""
        self.display = False
        if self._editor is not None:
            target = self._editor if self._typing else self._editor.parent
            self.screen.set_focus(target, scroll_visible=False)  # type: ignore[arg-type]

    def _show(self, by: int = 0) -> None:
        editor, wanted = self._editor, self.query_one(Input).value
        if editor is None:
            return
        found = find_all(editor.text, wanted)
        count = self.query_one("#find-count", Static)
        if not found:
            count.update(Content.styled("not found", "$bad") if wanted else "")
            return
        number = nearest_index(found, self._origin, by)
        row, column = found[number]
        editor.selection = Selection((row, column), (row, column + len(wanted)))
        editor.scroll_cursor_visible(center=True)
        count.update(f"{number + 1} of {len(found)}")

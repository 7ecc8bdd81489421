"""The pane of the learner's files: the editor, read-only views such as the solution, or how to get a missing file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from textual import on
from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Vertical
from textual.content import Content
from textual.widget import Widget
from textual.widgets import Static

from tutor.tui.messages import EditWanted
from tutor.tui.widgets import code_head
from tutor.tui.widgets.code_body import CodeBody
from tutor.tui.widgets.code_view import CodeView
from tutor.tui.widgets.edit_offer import EditOffer
from tutor.tui.widgets.find_bar import FindBar
from tutor.tui.widgets.line_view import Piece, Row

if TYPE_CHECKING:
    from tutor.tui.widgets.editor import CodeEditor

OWN_FILE_VIEW = "mine"
"""The name of the view in which the learner edits their own file."""


class CodePane(Vertical):
    """A line with the file names, a line with links to the views, and below them the editor or another view."""

    BINDINGS: ClassVar[list[BindingType]] = [Binding("escape", "back", "Your file", show=True, key_display="Esc")]
    DEFAULT_CSS = """
    CodePane {
        background: $surface;
        & > .code-line { height: 1; background: $panel; padding: 0 1; text-wrap: nowrap; text-overflow: ellipsis; }
        & > #code-body { height: 1fr; }
        & > #code-missing {
            height: 1fr;
            display: none;
            content-align: center middle;
            text-align: center;
            padding: 0 2;
        }
        & Static { link-color: $accent; link-style: underline; link-color-hover: $background; }
        & > CodeView { display: none; height: 1fr; }
        &.-missing > #code-missing { display: block; }
        &.-missing > #code-body { display: none; }
        &.-other > CodeView { display: block; }
        &.-other > #code-missing, &.-other > #code-body { display: none; }
    }
    """

    def __init__(self, id: str) -> None:
        super().__init__(id=id)
        self.view = OWN_FILE_VIEW
        self._body, self._offer = CodeBody(id="code-body"), EditOffer(id="code-offer")
        self._editors: dict[Path, CodeEditor] = {}
        self._paths: Sequence[Path] = ()
        self._chosen = 0
        self._title = ""

    def compose(self) -> ComposeResult:
        yield Static(id="code-head", classes="code-line")
        yield Static(id="code-looks", classes="code-line")
        yield self._body
        yield CodeView(id="code-view")
        yield Static(id="code-missing")
        yield FindBar(id="code-find")
        yield self._offer

    def on_descendant_focus(self) -> None:
        """Name other keys while the editor has the focus."""
        self.refresh_head()

    def on_descendant_blur(self) -> None:
        """Name the command keys, which work again."""
        self.refresh_head()

    # --- find ---

    def find(self, *, again: bool = False) -> None:
        """Ask for a text to find in the learner's file; with `again`, go to the next match of the last one."""
        if self.editor is None:
            return
        if self.view != OWN_FILE_VIEW:
            self._switch_view(OWN_FILE_VIEW, "")
        bar = self.query_one(FindBar)
        if not again or not bar.again(self.editor):
            bar.begin(self.editor, typing=self.editor.has_focus)

    # --- typing before editing ---

    @property
    def guarded(self) -> bool:
        """Whether letters are no commands where the focus is, because the learner may be about to type."""
        focused = self.screen.focused
        return (
            self._body.guarded and focused is not None and (focused is self._body or self._offer in focused.ancestors)
        )

    @on(CodeBody.Typed)
    def _offer_to_edit(self, event: CodeBody.Typed) -> None:
        """Offer to edit; a single letter that has a command may be meant as that."""
        event.stop()
        body, text = self._body, event.text
        body.guarded, guarded = False, body.guarded
        command = self.screen.active_bindings.get(text) if text.isalpha() and text.isascii() else None
        body.guarded = guarded
        self._offer.begin(text, command.binding.description if command and command.enabled else "")

    @on(EditOffer.Accepted)
    def _edit_with(self, event: EditOffer.Accepted) -> None:
        event.stop()
        self._offer.end()
        self.post_message(EditWanted(event.text))

    @on(EditOffer.CommandWanted)
    async def _run_command_of(self, event: EditOffer.CommandWanted) -> None:
        """Make letters commands, and run that of the letter typed twice."""
        event.stop()
        self.leave_editor()
        active = self.screen.active_bindings.get(event.key)
        if active is not None and active.enabled:
            await self.app.run_action(active.binding.action, active.node)

    # --- the editors ---

    @property
    def editor(self) -> CodeEditor | None:
        """The editor of the chosen file, or None while that file does not exist."""
        return self._editors.get(self._paths[self._chosen]) if self._paths else None

    def has_editor(self, path: Path) -> bool:
        """Return whether this file has an editor."""
        return path in self._editors

    def text(self, path: Path) -> str:
        """Return the text in the editor of a file that has one."""
        return self._editors[path].text

    def unsaved_files(self) -> list[Path]:
        """Return the files with unsaved edits."""
        return [path for path, editor in self._editors.items() if editor.changed]

    def is_unsaved(self, path: Path) -> bool:
        """Return whether this file has unsaved edits."""
        return path in self._editors and self._editors[path].changed

    def mark_saved(self, path: Path, text: str) -> None:
        """Note that this text is now on disk."""
        self._editors[path].saved_text = text
        self.refresh_head()

    def go_to(self, path: Path, line: int) -> None:
        """Move the cursor to a line (from 1) and focus the editor."""
        if path in self._editors:
            self._editors[path].go_to(line)
            self.focus_content(typing=True)

    # --- the views ---

    def show_names(self, paths: Sequence[Path], chosen: int) -> None:
        """Show the names of the lesson's files; a click chooses one."""
        self._paths, self._chosen = paths, chosen
        self.remove_class("-missing")
        for path, editor in self._editors.items():
            editor.display = path == paths[chosen]
        self.show_own()

    async def show_source(self, path: Path, text: str, *, visible: bool) -> None:
        """Show a file's text, in a new editor if it has none yet; `visible` if it is the chosen file."""
        if path in self._editors:
            self._editors[path].take(text)
        else:
            from tutor.tui.widgets.editor import CodeEditor  # late import: keeps the first paint fast

            editor = self._editors[path] = CodeEditor(path, text)
            editor.display = visible
            await self._body.mount(editor)
        if visible:
            self.show_existing(path)

    def show_existing(self, path: Path) -> None:
        """Show the editor of a file that exists, in place of the notice that it is missing."""
        if self._paths and path == self._paths[self._chosen]:
            self.remove_class("-missing")
            self._editors[path].display = True
        self.refresh_head()

    def show_missing(self, path: Path, problem: str = "") -> None:
        """Say that the file does not exist yet, and how to get it; or with which `problem` it cannot be read."""
        self.add_class("-missing")
        if path in self._editors and not problem:
            self._editors.pop(path).remove()
        if problem:
            text = Content.assemble((f"{path.name} cannot be shown\n\n", "bold $bad"), problem)
        else:
            text = Content.assemble(
                (f"{path.name} is not in your workspace yet\n\n", "bold"),
                "Press ",
                ("s", "bold $accent"),
                " or ",
                Content.from_markup("[@click=screen.do('start')]click here[/]"),
                " to put the skeleton there and begin.",
            )
        self.query_one("#code-missing", Static).update(text)
        self.refresh_head()

    def show_read_only(self, view: str, title: str, source: str) -> None:
        """Show Python source read-only in place of the editor."""
        self._switch_view(view, title)
        self.query_one(CodeView).show_source(source)
        self.query_one(CodeView).scroll_home(animate=False, immediate=True)
        self.focus_content()

    def show_made(self, view: str, title: str, make: Callable[[int], tuple[Sequence[Row], Sequence[Piece]]]) -> None:
        """Show the rows that `make` returns for the width of the pane, such as a diff, in place of the editor."""
        self._switch_view(view, title)
        self.query_one(CodeView).show_made(make)
        self.query_one(CodeView).scroll_home(animate=False, immediate=True)
        self.focus_content()

    def show_own(self) -> None:
        """Show the learner's own file again."""
        had_focus = self.query_one(CodeView).has_focus
        self._switch_view(OWN_FILE_VIEW, "")
        if had_focus:
            self.focus_content()
            self.release()

    def edit(self) -> None:
        """Show the learner's own file for editing."""
        self._switch_view(OWN_FILE_VIEW, "")

    def _switch_view(self, view: str, title: str) -> None:
        self.view, self._title = view, title
        self.set_class(view != OWN_FILE_VIEW, "-other")
        self.refresh_head()

    def focus_content(self, *, typing: bool = False) -> None:
        """Focus the widget that the arrow keys scroll; the editor itself only if the learner is typing."""
        target: Widget = self._body
        if self.view != OWN_FILE_VIEW:
            target = self.query_one(CodeView)
        elif self.editor is not None and (typing or self.editor.has_focus):
            target = self.editor
        if isinstance(target, CodeBody):
            target.guard(True)
        self.screen.set_focus(target, scroll_visible=False)

    def release(self) -> None:
        """Have letters be commands: the learner has just used one, or has left the editor."""
        self._body.guard(False)

    def leave_editor(self) -> None:
        """Move the focus out of the editor, so that single keys are commands again."""
        self.release()
        self._offer.end()
        self.screen.set_focus(self._body, scroll_visible=False)

    def action_back(self) -> None:
        """Show the learner's own file again."""
        self.show_own()

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """Enable `back` only in a read-only view."""
        return self.view != OWN_FILE_VIEW if action == "back" else True

    def refresh_head(self) -> None:
        """Update the two head lines: file names, whether all is saved, and the view that is shown."""
        if not self._paths:
            return
        typing = self.editor is not None and self.editor.has_focus
        keys = not typing and not self.guarded
        unsaved = [path for path in self._paths if self.is_unsaved(path)]
        files = code_head.file_line(self._paths, self._chosen, unsaved, in_editor=self.editor is not None, keys=keys)
        if self.view != OWN_FILE_VIEW:
            views = code_head.back_line(self._title)
        else:
            views = code_head.view_line(editable=self.editor is not None and not typing, keys=keys)
        self.query_one("#code-head", Static).update(files, layout=False)
        self.query_one("#code-looks", Static).update(views, layout=False)

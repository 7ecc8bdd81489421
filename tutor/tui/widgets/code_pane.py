"""The learner's file: which one, where it is, and its editor; or how to get it; or another look at it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from textual.app import ComposeResult
from textual.binding import Binding, BindingType
from textual.containers import Container, Vertical
from textual.content import Content
from textual.widget import Widget
from textual.widgets import Static

from tutor.session.paths import short_path
from tutor.tui.widgets.code_view import CodeView
from tutor.tui.widgets.find_bar import FindBar
from tutor.tui.widgets.line_view import Piece, Row

if TYPE_CHECKING:
    from tutor.tui.widgets.editor import CodeEditor

OWN = "mine"
"""The view of the learner's own file."""

LOOKS = (
    ("skeleton", "k", "Skeleton"),
    ("changes", "d", "Changes"),
    ("solution", "v", "Solution"),
    ("against", "V", "Compare"),
)


class CodeBody(Container, can_focus=True):
    """Holds the editors. Has the focus while single keys are commands: the arrows scroll, Enter begins to type."""

    BINDINGS: ClassVar[list[BindingType]] = [
        Binding("enter", "screen.do('edit')", "Edit", show=False),
        Binding("up", "by(-1)", show=False),
        Binding("down", "by(1)", show=False),
        Binding("pageup", "pages(-1)", show=False),
        Binding("pagedown", "pages(1)", show=False),
        Binding("home", "end(False)", show=False),
        Binding("end", "end(True)", show=False),
    ]

    @property
    def _editor(self) -> Widget | None:
        return next((child for child in self.children if child.display), None)

    def action_by(self, lines: int) -> None:
        """Scroll by lines."""
        if self._editor is not None:
            self._editor.scroll_relative(y=lines, animate=False)

    def action_pages(self, pages: int) -> None:
        """Scroll by pages."""
        self.action_by(pages * max(1, self.size.height - 1))

    def action_end(self, down: bool) -> None:
        """Scroll to the top or the bottom."""
        if self._editor is not None:
            (self._editor.scroll_end if down else self._editor.scroll_home)(animate=False)


class CodePane(Vertical):
    """A line that names the files, a line with the looks at them, and what is shown."""

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
        self.view = OWN
        self._editors: dict[Path, CodeEditor] = {}
        self._paths: Sequence[Path] = ()
        self._chosen = 0
        self._title = ""

    def compose(self) -> ComposeResult:
        yield Static(id="code-head", classes="code-line")
        yield Static(id="code-looks", classes="code-line")
        yield CodeBody(id="code-body")
        yield CodeView(id="code-view")
        yield Static(id="code-missing")
        yield FindBar(id="code-find")

    def on_descendant_focus(self) -> None:
        """Other keys are named while letters type."""
        self.show_saved()

    def on_descendant_blur(self) -> None:
        """The keys of commands work again."""
        self.show_saved()

    # --- finding ---

    def find(self, *, again: bool = False) -> None:
        """Ask what to find in the learner's file; or go on to the next place (`again`)."""
        if self.editor is None:
            return
        if self.view != OWN:
            self._turn(OWN, "")
        bar = self.query_one(FindBar)
        if not again or not bar.again(self.editor):
            bar.begin(self.editor, typing=self.editor.has_focus)

    # --- what the editors hold ---

    @property
    def editor(self) -> CodeEditor | None:
        """The editor of the chosen file, if the file is there."""
        return self._editors.get(self._paths[self._chosen]) if self._paths else None

    def knows(self, path: Path) -> bool:
        """Whether the file has been read."""
        return path in self._editors

    def text(self, path: Path) -> str:
        """What the editor of a known file holds."""
        return self._editors[path].text

    def changed(self) -> list[Path]:
        """The files that have something to save."""
        return [path for path, editor in self._editors.items() if editor.changed]

    def is_changed(self, path: Path) -> bool:
        """Whether this file has something to save."""
        return path in self._editors and self._editors[path].changed

    def mark_saved(self, path: Path, text: str) -> None:
        """The file holds this text now."""
        self._editors[path].saved_text = text
        self.show_saved()

    def go_to(self, path: Path, line: int) -> None:
        """Put the cursor on a line, and the focus into the editor."""
        if path in self._editors:
            self._editors[path].go_to(line)
            self.focus_content(typing=True)

    # --- what is shown ---

    def show_names(self, paths: Sequence[Path], chosen: int) -> None:
        """Name the files of the lesson; a click chooses one."""
        self._paths, self._chosen = paths, chosen
        self.remove_class("-missing")
        for path, editor in self._editors.items():
            editor.display = path == paths[chosen]
        self.show_own()

    async def show_source(self, path: Path, text: str, *, visible: bool) -> None:
        """The file is there, and this is its text."""
        if path in self._editors:
            self._editors[path].take(text)
        else:
            from tutor.tui.widgets.editor import CodeEditor  # late: the first paint does not wait for it

            editor = self._editors[path] = CodeEditor(path, text)
            editor.display = visible
            await self.query_one("#code-body").mount(editor)
        if visible:
            self.show_found(path)

    def show_found(self, path: Path) -> None:
        """A known file is there."""
        if self._paths and path == self._paths[self._chosen]:
            self.remove_class("-missing")
            self._editors[path].display = True
        self.show_saved()

    def show_missing(self, path: Path, problem: str = "") -> None:
        """Say that there is no such file, and how to get it."""
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
        self.show_saved()

    def show_other(self, view: str, title: str, source: str) -> None:
        """Show a text to read in the place of the editor."""
        self._turn(view, title)
        self.query_one(CodeView).show_source(source)
        self.query_one(CodeView).scroll_home(animate=False, immediate=True)
        self.focus_content()

    def show_rows(self, view: str, title: str, rows: Sequence[Row], margins: Sequence[Piece]) -> None:
        """Show rows in the place of the editor."""
        self._turn(view, title)
        self.query_one(CodeView).show_rows(rows, margins)
        self.query_one(CodeView).scroll_home(animate=False, immediate=True)
        self.focus_content()

    def show_own(self) -> None:
        """Show the learner's own file again."""
        had_focus = self.query_one(CodeView).has_focus
        self._turn(OWN, "")
        if had_focus:
            self.focus_content()

    def edit(self) -> None:
        """Show the learner's own file, to type in."""
        self._turn(OWN, "")

    def _turn(self, view: str, title: str) -> None:
        self.view, self._title = view, title
        self.set_class(view != OWN, "-other")
        self.show_saved()

    def focus_content(self, *, typing: bool = False) -> None:
        """Focus what the arrow keys move in; the editor itself only where the learner wants to type."""
        target: Widget = self.query_one(CodeBody)
        if self.view != OWN:
            target = self.query_one(CodeView)
        elif self.editor is not None and (typing or self.editor.has_focus):
            target = self.editor
        self.screen.set_focus(target, scroll_visible=False)

    def leave_editor(self) -> None:
        """Make single keys commands again."""
        self.screen.set_focus(self.query_one(CodeBody), scroll_visible=False)

    def action_back(self) -> None:
        """Show the learner's own file again."""
        self.show_own()

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """There is only a way back from another look."""
        return self.view != OWN if action == "back" else True

    def show_saved(self) -> None:
        """Say whether all is saved, and which look is shown."""
        if not self._paths:
            return
        path = self._paths[self._chosen]
        parts: list[Content | str | tuple[str, str]] = []
        for index, each in enumerate(self._paths):
            mark = "● " if self.is_changed(each) else ""
            if index == self._chosen:
                parts += [Content.styled(mark + each.name, "bold $primary"), "  "]
            else:
                parts += [
                    mark,
                    Content.from_markup(f"[@click=screen.show_file({index})]$name[/]", name=each.name),
                    "  ",
                ]
        if len(self._paths) > 1 and not self._typing:
            parts.append(("f: other file  ", "$quiet"))
        if self.editor is not None:
            parts.append(("not saved yet  ", "$warn") if self.editor.changed else ("✓ saved  ", "$good"))
        parts.append((short_path(path.parent), "$quiet"))
        self.query_one("#code-head", Static).update(Content.assemble(*parts), layout=False)
        self.query_one("#code-looks", Static).update(self._looks(), layout=False)

    @property
    def _typing(self) -> bool:
        return self.editor is not None and self.editor.has_focus

    def _looks(self) -> Content:
        parts: list[Content | str | tuple[str, str]] = []
        if self.view != OWN:
            parts += [(self._title, "bold"), "  ", Content.from_markup("[@click=back]Esc: your file[/]")]
            return Content.assemble(*parts)
        if self._typing:
            parts.append(("Esc, then  ", "$quiet"))
        elif self.editor is not None:
            parts += [("e", "bold $accent"), (" edit  ", "$quiet")]
        for view, key, name in LOOKS:
            parts += [(key, "bold $accent"), " ", Content.from_markup(f"[@click=screen.do('{view}')]{name}[/]"), "  "]
        return Content.assemble(*parts)

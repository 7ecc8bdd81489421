"""The learner's file: which one, where it is, and its text; or how to get it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from textual.app import ComposeResult
from textual.containers import Vertical
from textual.content import Content
from textual.widgets import Static

from tutor.tui import words
from tutor.tui.widgets.code_view import CodeView


class CodePane(Vertical):
    """A line that names the files, and the one that is shown."""

    DEFAULT_CSS = """
    CodePane {
        background: $surface;
        & > #code-head { height: 1; background: $panel; padding: 0 1; text-wrap: nowrap; text-overflow: ellipsis; }
        & > #code-missing {
            height: 1fr;
            display: none;
            content-align: center middle;
            text-align: center;
            padding: 0 2;
        }
        & > Static { link-color: $accent; link-style: underline; link-color-hover: $background; }
        &.-missing > #code-missing { display: block; }
        &.-missing > CodeView { display: none; }
    }
    """

    def compose(self) -> ComposeResult:
        yield Static(id="code-head")
        yield CodeView(id="code-view")
        yield Static(id="code-missing")

    def show_names(self, paths: Sequence[Path], chosen: int) -> None:
        """Name the files of the lesson; a click chooses one."""
        parts: list[Content | str] = []
        for index, path in enumerate(paths):
            if index == chosen:
                parts += [Content.styled(path.name, "bold $primary"), "   "]
            else:
                parts += [Content.from_markup(f"[@click=screen.show_file({index})]{path.name}[/]"), "   "]
        folder = words.short(paths[chosen].parent)
        if len(paths) > 1:
            parts.append(Content.styled("f: other file   ", "$quiet"))
        self.query_one("#code-head", Static).update(Content.assemble(*parts, (folder, "$quiet")))

    def show_source(self, text: str, *, anew: bool) -> None:
        """Show the text; from its top where it is another file's (`anew`)."""
        self.remove_class("-missing")
        view = self.query_one(CodeView)
        view.show_source(text)
        if anew:
            view.scroll_home(animate=False, immediate=True)

    def show_missing(self, path: Path, problem: str = "") -> None:
        """Say that there is no such file, and how to get it."""
        self.add_class("-missing")
        if problem:
            text = Content.assemble((f"{path.name} cannot be read\n\n", "bold $bad"), problem)
        else:
            text = Content.assemble(
                (f"{path.name} is not in your workspace yet\n\n", "bold"),
                "Press ",
                ("s", "bold $accent"),
                " or ",
                Content.from_markup("[@click=screen.start_exercise]click here[/]"),
                " to put the skeleton there and begin.",
            )
        self.query_one("#code-missing", Static).update(text)

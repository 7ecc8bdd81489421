"""A learner in front of the app: what they press, and what they see."""

from __future__ import annotations

import threading
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from textual.css.model import RuleSet
from textual.css.stylesheet import Stylesheet
from textual.document._syntax_aware_document import SyntaxAwareDocument
from textual.keys import _character_to_key
from textual.pilot import Pilot
from textual.widget import Widget
from textual.widgets import Static

from tests.tui import made
from tests.tui.person import Person
from tutor.judge.events import Event
from tutor.session import Session
from tutor.session.node import Node
from tutor.tui.app import TutorApp
from tutor.tui.screens.main import MainScreen
from tutor.tui.widgets.code_pane import CodePane
from tutor.tui.widgets.criteria import CriteriaPanel
from tutor.tui.widgets.editor import CodeEditor
from tutor.tui.widgets.line_view import LineView


def _remember_what_textual_compiles() -> None:
    """Style sheets and queries are the same in every app of a run; each would parse them again, a tenth of its time."""
    parse_rules, prepare_query = Stylesheet._parse_rules, SyntaxAwareDocument.prepare_query
    rules: dict[object, list[RuleSet]] = {}
    queries: dict[object, object] = {}

    def remembered_rules(self: Stylesheet, *args: Any, **options: Any) -> list[RuleSet]:
        key = (args, frozenset(options.items()), frozenset(self._variables.items()))
        if key not in rules:
            rules[key] = parse_rules(self, *args, **options)
        return rules[key]

    def remembered_query(self: SyntaxAwareDocument, query: str) -> Any:
        key = (self.language, query)
        if key not in queries:
            queries[key] = prepare_query(self, query)
        return queries[key]

    Stylesheet._parse_rules = remembered_rules  # type: ignore[method-assign]
    SyntaxAwareDocument.prepare_query = remembered_query  # type: ignore[method-assign]


_remember_what_textual_compiles()


class Learner(Person[TutorApp]):
    """Somebody with a workspace."""

    def __init__(self, app: TutorApp, pilot: Pilot[int], session: Session) -> None:
        super().__init__(app, pilot)
        self.session = session

    @property
    def main(self) -> MainScreen:
        assert self.app.main is not None
        return self.app.main

    @property
    def node(self) -> Node | None:
        """The node whose log is shown."""
        shown = self.main.nodes.shown
        return None if shown is None else self.main.nodes.known.get(shown)

    @property
    def editor(self) -> CodeEditor:
        """The editor of the file that is shown."""
        found = self.main.query_one(CodePane).editor
        assert found is not None
        return found

    @property
    def file(self) -> Path:
        """The file that is shown."""
        return self.main.model.path

    def background(self) -> list[str]:
        """What each node wrote, shown or not."""
        nodes = {} if self.app.main is None else self.main.nodes.known
        return [f"{name}: {line.text}" for name, node in nodes.items() for line in node.state.lines]

    async def types(self, text: str) -> None:
        await self.pilot.press(*("enter" if c == "\n" else _character_to_key(c) for c in text))

    async def edits(self) -> CodeEditor:
        """Go into the editor; the cursor is at the very beginning where nothing was done in it before."""
        await self.press("e")
        await self.until(lambda: isinstance(self.app.focused, CodeEditor), "the editor has the focus")
        return self.editor

    def diagnosis(self) -> str:
        """The diagnosis that is shown, whole: on the screen it is folded."""
        return "\n".join(str(part.render()) for part in self.main.query_one("#diagnosis").query(Static))

    def text(self, selector: str) -> str:
        """The text of one widget, whole."""
        widget = self.main.query_one(selector, Widget)
        return widget.plain if isinstance(widget, LineView) else str(widget.query_one(Static).render())

    def criterion(self, id: str) -> str:
        """The line of one criterion."""
        rows = self.main.query_one(CriteriaPanel).rows
        return next(str(row.render()) for row in rows if row.finding.id == id)

    async def told(self, *lines: Event | str) -> None:
        """Have the engine say this. In a daemon thread: opening the pipe waits for the child."""
        assert isinstance(self.session, made.FakeServices)
        thread = threading.Thread(target=self.session.engine.say, args=lines, daemon=True)
        thread.start()
        await self.until(lambda: not thread.is_alive(), "the engine listens")


@asynccontextmanager
async def at(session: Session, size: tuple[int, int] = (120, 36)) -> AsyncIterator[Learner]:
    """Open the app for a learner; when they leave, nothing runs any more."""
    app = TutorApp(session)
    app.animation_level = "none"
    async with app.run_test(size=size, notifications=True) as pilot:
        try:
            if session.workspace.exists:
                await made.opened(app, pilot)
            yield Learner(app, pilot, session)
        finally:
            if isinstance(session, made.FakeServices):
                session.engine.close()
            if app.main is not None:
                await app.main.close_down()


@pytest.fixture
def learner(tmp_path: Path) -> Callable[..., object]:
    """A learner with a made course, an engine that says what it is told, and nodes without ROS."""

    def opened(size: tuple[int, int] = (120, 36), *, started: bool = True) -> AbstractAsyncContextManager[Learner]:
        return at(made.FakeServices(tmp_path / "learner", started=started), size)

    return opened

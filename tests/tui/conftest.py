"""The `Learner` driver and fixtures: the whole app under Textual's pilot, with fake or real services."""

from __future__ import annotations

import os
import threading
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from textual.css.model import RuleSet
from textual.css.stylesheet import Stylesheet
from textual.document._syntax_aware_document import SyntaxAwareDocument
from textual.events import Paste
from textual.keys import _character_to_key
from textual.pilot import Pilot
from textual.widget import Widget
from textual.widgets import Static

from tests.ros.ordinary_domain import ordinary_domain
from tests.tui import fakes
from tests.tui.person import Person
from tutor.content import load_course
from tutor.judge.events import Event
from tutor.session import Session
from tutor.session.node import Node
from tutor.tui.app import TutorApp
from tutor.tui.screens.main import MainScreen
from tutor.tui.widgets.code_pane import CodePane
from tutor.tui.widgets.criteria import CriteriaPanel
from tutor.tui.widgets.editor import CodeEditor
from tutor.tui.widgets.line_view import LineView
from tutor.workspace import Workspace


def _cache_textual_parsing() -> None:
    """Cache parsed style sheets and syntax queries. All apps of a run share them; parsing took 10 % of their time."""
    parse_rules, prepare_query = Stylesheet._parse_rules, SyntaxAwareDocument.prepare_query
    rules: dict[object, list[RuleSet]] = {}
    queries: dict[object, object] = {}

    def cached_rules(self: Stylesheet, *args: Any, **options: Any) -> list[RuleSet]:
        key = (args, frozenset(options.items()), frozenset(self._variables.items()))
        if key not in rules:
            rules[key] = parse_rules(self, *args, **options)
        return rules[key]

    def cached_query(self: SyntaxAwareDocument, query: str) -> Any:
        key = (self.language, query)
        if key not in queries:
            queries[key] = prepare_query(self, query)
        return queries[key]

    Stylesheet._parse_rules = cached_rules  # type: ignore[method-assign]
    SyntaxAwareDocument.prepare_query = cached_query  # type: ignore[method-assign]


_cache_textual_parsing()


@pytest.fixture(autouse=True)
def home(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """A short prompt, and bash, whatever the developer's own shell is like, and however long it takes to start."""
    folder = tmp_path_factory.mktemp("home")
    (folder / ".bashrc").write_text("PS1='$ '\n")
    monkeypatch.setenv("HOME", str(folder))
    monkeypatch.setenv("SHELL", "/bin/bash")


def is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


class Learner(Person[TutorApp]):
    """Drives the whole app as a learner does."""

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
        return None if shown is None else self.main.nodes.by_path.get(shown)

    @property
    def editor(self) -> CodeEditor:
        """The editor of the file that is shown."""
        editor = self.main.query_one(CodePane).editor
        assert editor is not None
        return editor

    @property
    def file(self) -> Path:
        """The file that is shown."""
        return self.main.model.path

    def background(self) -> list[str]:
        """The output of every node, whether its log is on the screen or not."""
        nodes = {} if self.app.main is None else self.main.nodes.by_path
        return [f"{name}: {line.text}" for name, node in nodes.items() for line in node.state.lines]

    async def type_text(self, text: str) -> None:
        await self.pilot.press(*("enter" if c == "\n" else _character_to_key(c) for c in text))

    def paste(self, text: str) -> None:
        """Paste a text, as quickly as one key is pressed. It arrives before keys that are pressed afterwards."""
        self.app.post_message(Paste(text))

    async def runs(self, code: str | None = None) -> Node:
        """Press r, after giving the file this text, and wait until a new node has been started."""
        if code is not None:
            self.file.write_text(code)
        before = self.node
        await self.press("r")
        await self.until(lambda: self.node not in (None, before), "a new node")
        assert self.node is not None
        return self.node

    async def focus_editor(self) -> CodeEditor:
        """Move the focus to the editor. At first, the cursor is at the very beginning of the file."""
        await self.press("e")
        await self.until(lambda: isinstance(self.app.focused, CodeEditor), "the editor has the focus")
        return self.editor

    def diagnosis(self) -> str:
        """The full text of the diagnosis, which is folded on the screen."""
        return "\n".join(str(part.content) for part in self.main.query_one("#diagnosis").query(Static))

    def text(self, selector: str) -> str:
        """The full text of one widget."""
        widget = self.main.query_one(selector, Widget)
        return widget.plain if isinstance(widget, LineView) else str(widget.query_one(Static).render())

    def criterion(self, id: str) -> str:
        """The row of one criterion, as text."""
        rows = self.main.query_one(CriteriaPanel).rows
        return next(str(row.render()) for row in rows if row.finding.id == id)

    async def start_check(self) -> None:
        """Press F9, which checks from every page, and have the engine say that it has started."""
        await self.press("f9")
        await self.engine_emits(*fakes.started_events())

    async def end_check(self) -> None:
        """Let the engine exit, and wait until the app has noticed: another check can be started then."""
        assert isinstance(self.session, fakes.FakeSession)
        self.session.engine.close()
        await self.until(lambda: self.main.checks.running is None, "the check has ended")

    async def engine_emits(self, *lines: Event | str) -> None:
        """Have the engine emit these events. In a daemon thread, as opening the pipe blocks until the child reads."""
        assert isinstance(self.session, fakes.FakeSession)
        thread = threading.Thread(target=self.session.engine.emit, args=lines, daemon=True)
        thread.start()
        await self.until(lambda: not thread.is_alive(), "the engine reads")


@asynccontextmanager
async def open_app(session: Session, size: tuple[int, int] = (120, 36)) -> AsyncIterator[Learner]:
    """Run the app for a learner. On exit, everything that it started is ended."""
    app = TutorApp(session)
    app.animation_level = "none"
    async with app.run_test(size=size, notifications=True) as pilot:
        try:
            if session.workspace.exists:
                await fakes.wait_until_ready(app, pilot)
            yield Learner(app, pilot, session)
        finally:
            if isinstance(session, fakes.FakeSession):
                session.engine.close()
            await app.close_down()


@pytest.fixture
def session(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Session]:
    """The real course and an empty workspace, on a domain that nobody else uses."""
    with ordinary_domain() as domain:
        monkeypatch.setenv("ROS_DOMAIN_ID", str(domain))
        monkeypatch.setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
        yield Session(load_course(), Workspace(tmp_path / "ws"))


@pytest.fixture
def learner(tmp_path: Path) -> Callable[..., object]:
    """A factory of learners with a fake course, an engine that emits what the test sends, and nodes without ROS."""

    def open_learner(
        size: tuple[int, int] = (120, 36), *, started: bool = True
    ) -> AbstractAsyncContextManager[Learner]:
        return open_app(fakes.FakeSession(tmp_path / "learner", started=started), size)

    return open_learner

"""Names, values and lines crafted to break a screen: every panel and dialog shows them as plain text."""

from __future__ import annotations

import unicodedata
from pathlib import Path
from typing import Any

from rich.cells import cell_len

from tests.tui import fakes
from tutor.content import LessonFile
from tutor.judge.verdict import Status, Verdict
from tutor.live.protocol import Ready, Update, WatcherError
from tutor.live.updates import CallOutcome, NodeParameters, PublishStatus, RequestForm, SetOutcome, TopicUpdate
from tutor.ros_model import Field, Graph, Parameter, QoS, ServiceEndpoint, TopicEndpoint
from tutor.tui import messages
from tutor.tui.dialogs.run_options import RunOptionsScreen
from tutor.tui.dialogs.simple import ConfirmScreen, ConflictScreen
from tutor.tui.live.pane import LivePane
from tutor.tui.live.publish_dialog import PublishScreen
from tutor.tui.live.status import TABS
from tutor.tui.terminal.view import TerminalView
from tutor.workspace import RunOptions

HOSTILE = (
    "a[/]gain[@click=app.quit]b[/]",
    "a\x1b]0;t\x07\x1b[2J\x9b2J\u202eb\u2066c\ud800d\0e\rf\tg\nh",  # short, for narrow columns to show all of it
    "a" * 10_000,
)
ALL = "".join(HOSTILE[:-1])


def harmful_chars(text: str) -> set[str]:
    """The characters that a terminal would obey, or that cannot be encoded."""
    return {char for char in text if unicodedata.category(char) in ("Cc", "Cs") or char in "\u202e\u2066"}


def assert_harmless(me: Any) -> None:
    width, _ = me.app.size
    for strip in me.app.screen._compositor.render_strips():
        text = strip.text
        assert not harmful_chars(text), repr(text)
        assert cell_len(text) == width, repr(text)


def hostile_updates(name: str) -> tuple[Update, ...]:
    node, topic = f"/{name}", f"/t/{name}"
    endpoints = (TopicEndpoint(topic, name, node), TopicEndpoint(topic, "std_msgs/msg/String", node))
    return (
        Ready(1),
        Graph((node,), endpoints, endpoints, (ServiceEndpoint(f"/s/{name}", name, node),)),
        TopicUpdate(topic, name, QoS(), 1, 0, None, 0.1, f"data: {name}", (name,), name, ((1.0, 2.0), (2.0, 3.0))),
        TopicUpdate(topic, name, QoS(), 0, 0, None, None, problem=name),
        NodeParameters(node, True, (Parameter(node, name, "string", name), Parameter(node, f"z{name}", name, [name]))),
        NodeParameters(f"{node}2", False),
        SetOutcome(1, node, name, name, True, False, name, 1.0, 0.1),
        CallOutcome(1, f"/s/{name}", {name: name}, name, "", 1.0, 0.1),
        CallOutcome(2, f"/s/{name}", {name: name}, None, name, 1.0, 0.1),
        RequestForm(name, (Field(name, name, name),)),
        RequestForm(name, problem=name),
        PublishStatus(topic, name, 1.0, 3, 0, 1.0),
        PublishStatus(f"{topic}2", name, 1.0, 3, 0, 1.0, problem=name),
        WatcherError(name),
    )


async def test_hostile_text_on_the_live_page(learner: Any) -> None:
    async with learner() as me:
        await me.press("4")
        pane = me.main.query_one(LivePane)
        for name in HOSTILE:
            for update in hostile_updates(name):
                pane.post_message(LivePane.Arrived(update))
            await me.pilot.pause()
            for tab in TABS:
                pane.open_tab(tab)
                pane.focus_content()
                await me.press("down", "enter")
                assert_harmless(me)
                await me.press("enter", "escape")
            assert_harmless(me)
            me.app.clear_notifications()


async def test_hostile_text_in_dialogs_and_notifications(learner: Any) -> None:
    async with learner() as me:
        for name in HOSTILE:
            file = LessonFile(name, True, Path(__file__), Path(__file__))
            for screen in (
                ConfirmScreen(name, name, name, name),
                ConflictScreen(name, name, name, f"{name}\n{name}"),
                PublishScreen(f"/{name}", lambda topic: topic, lambda command: None),
                RunOptionsScreen(file, RunOptions((name,), (name,)), str),
            ):
                await me.app.push_screen(screen)
                await me.pilot.pause()
                assert_harmless(me)
                me.app.pop_screen()
            me.main.post_message(messages.ErrorOccurred(name))
            me.main.say(name)
            me.app.notify(name)
            me.session.notify(name)
            await me.sees("a")
            assert_harmless(me)
            me.app.clear_notifications()


async def test_hostile_text_in_the_code_the_log_the_terminal_a_verdict_and_the_attempts(learner: Any) -> None:
    async with learner() as me:
        printed = ALL.replace("\ud800", "")
        comment = printed.translate(dict.fromkeys(map(ord, "\0\n\r")))
        me.session.path(me.session.lessons[0].files[0]).write_text(f"# {comment}\nprint({printed!r})\n")
        (me.session.workspace.root / "all.txt").write_text(printed)
        await me.press("2")
        await me.pilot.pause()
        assert_harmless(me)
        await me.press("f5", "3")
        await me.sees("gain")
        assert_harmless(me)
        await me.press("7")
        await me.until(lambda: isinstance(me.app.focused, TerminalView), "the terminal has the focus")
        await me.sees("(ROS 2: ws)")
        me.paste(f"cat {me.session.workspace.root}/all.txt")
        await me.press("enter")
        await me.sees("2Jbcde")  # the rest has moved the cursor and cleared the screen, which is this terminal's own
        assert_harmless(me)

        verdict = Verdict(Status.FAILED, ALL, ALL, f"{ALL}: {ALL}", ALL, (*HOSTILE, ALL), "no-spin")
        await me.press("f9")
        await me.engine_emits(*fakes.started_events(), fakes.progress_event("rate", 0.5, ALL.replace("\ud800", "")))
        await me.press("5")
        assert_harmless(me)
        await me.engine_emits(*fakes.final_events(verdict))
        await me.sees("2 of 3")
        for key in ("down", "down", "i", "a"):
            await me.press(key)
            assert_harmless(me)

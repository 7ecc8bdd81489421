"""Whole lessons: the real course, the real engine, and real nodes on a domain of their own."""

from __future__ import annotations

import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from tests.running import is_running
from tests.tui.conftest import Learner, open_app
from tutor.content import load_course
from tutor.session import Session
from tutor.session.node import NodeState
from tutor.tui.live.request_form import FieldRow
from tutor.workspace import AppState, Workspace

pytestmark = pytest.mark.timeout(300)
CHECK_S = 60.0
"""Time limit for a check, generous for a busy machine."""


@asynccontextmanager
async def solving(session: Session, exercise: str) -> AsyncIterator[Learner]:
    """A learner whose workspace holds our solution of this exercise."""
    lesson = session.course.find(exercise)
    session.start(lesson)
    for file in lesson.files:
        session.path(file).write_bytes(file.solution.read_bytes())
    session.save_app_state(AppState(lesson=lesson.id))
    async with open_app(session) as me:
        await me.sees(f"{lesson.id.upper()}  {lesson.title}", "Objective")
        yield me


async def test_a_node_is_run_with_options_watched_and_changed_live(session: Session) -> None:
    async with solving(session, "i1.1") as me:
        await me.press("o")
        await me.sees("F5 runs")
        me.app.screen.query_one("#run-parameters").text = "publish_rate:=5.0"  # type: ignore[attr-defined]
        me.app.screen.query_one("#run-remaps").text = "/sensor/temperature:=/greenhouse"  # type: ignore[attr-defined]
        await me.press("f5")
        await me.sees("INFO", "thermometer_1 publishes 5.0 readings")

        await me.press("4")
        await me.sees("/greenhouse", "std_msgs/Float64", "Parameters 2", "1 node")
        await me.sees("data: 2", "reliable, volatile")
        await me.until(lambda: re.search(r"\b(4\.9\d|5\.0\d) Hz · jitter", me.screen()) is not None, "5 Hz")

        await me.press("right_square_bracket")
        await me.sees("publish_rate", "5.0", "sensor_name", "thermometer_1", "Enter Set")
        await me.press("down", "enter")
        await me.sees("Set /temperature_publisher sensor_name")
        await me.press("ctrl+u", *"roof", "enter")
        await me.sees("sensor_name = roof  accepted")

        assert is_running(me.file)
        await me.press("r")
        await me.sees("No node runs in domain")
        await me.press("3")
        await me.sees("stopped")
        assert not is_running(me.file)


async def test_a_failure_is_fixed_and_the_pass_is_evidence_in_the_checklist(session: Session) -> None:
    async with solving(session, "i1.3") as me:
        correct = me.file.read_text()
        me.file.write_text(correct.replace("request.a - request.b", "request.b - request.a"))
        await me.press("c")
        await me.until(lambda: "✗ operations  " in me.screen(), "a failure", limit_s=CHECK_S)
        await me.sees("Expected   /subtract: ", "Observed   -", "wrong result: the operands are the", "3 of 4 passed")

        await me.press("w")
        await me.sees("a save checks")
        editor = await me.focus_editor()
        line = next(n for n, text in enumerate(editor.text.splitlines()) if "request.b - request.a" in text)
        editor.move_cursor((line, editor.document.get_line(line).index("request.b - request.a")))
        await me.press(*["delete"] * len("request.b - request.a"))
        await me.type_text("request.a - request.b")
        await me.press("ctrl+s")
        await me.until(lambda: "I1.3 Calculator Service passed" in me.screen(), "a pass", limit_s=CHECK_S)
        assert me.file.read_text() == correct
        await me.sees("Next: press Esc, then n for", "4 of 4 passed")

        await me.press("escape", "6")
        await me.sees("0 of 15 ticked", "✓ i1.3 services, operations and client passed")
        await me.press("space", "x")
        await me.sees("(•) Markdown", "checklist.md")
        await me.press("enter")
        exported = session.workspace.root / "checklist.md"
        await me.until(exported.exists, "the export")
        assert exported.read_text().count("- [x] ") == 1
        await me.press("escape", "n")
        await me.sees("I2.1  Parameterized Publisher")


async def test_the_talker_starts_and_stops_beside_the_node_and_quitting_ends_both(
    session: Session,
) -> None:
    async with solving(session, "i1.2") as me:
        await me.press("r")
        await me.sees("● running  message_stats.py", "Waiting for messages on /chatter")
        await me.press("b")
        await me.sees("● running  talker", "ros2 run demo_nodes_py talker", "Publishing: ", "b stops it")
        await me.press("left_square_bracket")
        await me.sees("● running  message_stats.py", "r stops it")
        await me.sees("10 messages, ")
        await me.press("b")
        await me.sees("■ talker")
        await me.press("b")
        await me.sees("● talker")
        pids = [pid for node in me.main.nodes.running if (pid := node.pid) is not None]
        assert len(pids) == 2
        await me.press("q")
        await me.until(lambda: me.app.return_code == 0)
        assert not any(Path(f"/proc/{pid}").exists() for pid in pids)


async def test_the_log_is_beside_the_live_page_where_there_is_room(session: Session) -> None:
    async with solving(session, "i1.1") as me:
        await me.press("r")
        await me.sees("Lessons", "● running  temperature_publisher.py")
        await me.press("4")
        await me.sees("data: 2", "asked: 20 to 30", "● running  temperature_publisher.py", "INFO")
        await me.press("3")
        await me.until(lambda: me.app.focused is not None and me.app.focused.id == "log-view", "the log has the focus")
        await me.sees("asked: 20 to 30")
        await me.press("L")
        await me.sees_no("asked: 20 to 30")
        await me.press("L")
        await me.sees("asked: 20 to 30", "INFO")
        await me.pilot.resize_terminal(80, 24)
        await me.sees_no("asked: 20 to 30")
        await me.press("4")
        await me.sees("asked: 20 to 30")
        assert "INFO" not in me.screen()


async def run_to_completion(me: Learner) -> NodeState:
    """Press r, and wait until the node has ended."""
    shown = me.node
    await me.press("r")
    await me.until(lambda: me.node not in (None, shown) and me.node.over.is_set(), "it has ended")
    assert me.node is not None
    return me.node.state


async def test_a_client_runs_beside_our_server_and_beside_the_learners_own(session: Session) -> None:
    async with solving(session, "i1.3") as me:
        await me.press("f")
        await me.sees("calculator_client.py")
        await me.press("b")
        await me.sees("● running  our server", "Calculator is up")
        client = await run_to_completion(me)
        assert not client.failed, client
        await me.sees("calculator_client.py", "add(10, 5) = 15", "■ ended")
        await me.press("b")
        await me.sees("■ our server")
        await me.press("j")
        await me.sees("● running  calculator_server.py", "j stops it")
        await me.press("b")
        await me.sees("Your calculator_server.py is already running")
        await me.press("j")
        await me.sees("■ ended  calculator_server.py")


def field_has_focus(me: Learner) -> bool:
    return me.app.focused is not None and any(isinstance(each, FieldRow) for each in me.app.focused.ancestors)


async def test_messages_published_by_hand_once_and_at_a_rate_reach_the_node(session: Session) -> None:
    async with solving(session, "i1.2") as me:
        await me.press("r")
        await me.sees("Waiting for messages on /chatter")
        await me.press("4")
        await me.sees("/chatter", "1 node")
        await me.press("M")
        await me.sees("Publish a message", "std_msgs/msg/String", "data", "Times per second")
        await me.until(lambda: field_has_focus(me), "the first field has the focus")
        await me.press(*"Hello: 7", "enter")
        await me.sees("✓ published once on /chatter: 1 listens", "data: 'Hello: 7'")
        await me.press("M")
        await me.sees("Publish a message", "Times per second")
        await me.until(lambda: field_has_focus(me), "the first field has the focus")
        await me.press(*"Hello: 8", "tab", *"fast", "enter")
        await me.sees("✗ Write a rate")
        await me.press("ctrl+u", *"20", "enter")
        await me.sees("▶ you publish on /chatter at 20 Hz", "data: 'Hello: 8'")
        await me.press("3")
        await me.until(lambda: 'last "Hello: 8"' in me.text("#log-view").replace("\n        ", ""), "the last message")
        await me.press("4", "M")
        await me.sees("■ published on /chatter")


async def test_a_course_from_another_folder_is_played(tmp_path: Path, session: Session) -> None:
    course = Path(__file__).parents[1] / "courses" / "greeting"
    mine = Session(load_course(course), Workspace(tmp_path / "ws"), course)
    async with solving(mine, "h1.1") as me:
        await me.press("c")
        await me.until(lambda: "H1.1 Greeter passed" in me.screen(), "a pass", limit_s=CHECK_S)

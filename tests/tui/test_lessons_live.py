"""Plays what each lesson says can be seen in the app, with our solution and real nodes on a domain of their own."""

from __future__ import annotations

import re
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import pytest

from tests.running import is_running
from tests.tui.conftest import Learner, open_app
from tutor.session import Session
from tutor.workspace import AppState

pytestmark = pytest.mark.timeout(300)


class Reader(Learner):
    """A learner who does what the lesson says."""

    limit_s = 45.0

    def reads(self, *phrases: str) -> None:
        """Assert that the lesson contains these phrases, wherever its lines are broken."""
        text = " ".join(self.main.model.lesson.body.split())
        missing = [phrase for phrase in phrases if phrase not in text]
        assert not missing, f"the lesson no longer says {missing}"

    async def sees_rate(self, hz: float) -> None:
        """Wait until a rate within 10 % of this one is on the screen."""

        def near() -> bool:
            rates = re.findall(r"([0-9.]+) Hz · jitter", self.screen())
            return any(abs(float(rate) - hz) < 0.1 * hz for rate in rates)

        await self.until(near, f"{hz} Hz")

    async def until_field_focused(self) -> None:
        """Wait until a field of a form has the focus; fields have no id."""
        await self.until(lambda: self.app.focused is not None and not self.app.focused.id, "a field has the focus")


@asynccontextmanager
async def reading(session: Session, exercise: str, size: tuple[int, int] = (150, 36)) -> AsyncIterator[Reader]:
    """A reader of this exercise, whose workspace holds our solution."""
    lesson = session.course.find(exercise)
    session.start(lesson)
    for file in lesson.files:
        session.path(file).write_bytes(file.solution.read_bytes())
    session.save_app_state(AppState(lesson=lesson.id))
    async with open_app(session, size) as learner:
        me = Reader(learner.app, learner.pilot, session)
        await me.sees(f"{lesson.id.upper()}  {lesson.title}", "Objective")
        yield me


async def test_i1_1(session: Session) -> None:
    async with reading(session, "i1.1", (120, 36)) as me:
        me.reads("Run your node with `r`, and switch to Live with `4`")
        await me.press("r")
        await me.sees("Lessons", "● running  temperature_publisher.py", "thermometer_1 publishes 2.0")
        await me.press("4")
        me.reads("A timer of 0.5 s gives 2.00 Hz", "two dashed lines at 20 and 30", "a dot for each message")
        await me.sees("/sensor/temperature  std_msgs/Float64", "data: 2", "asked: 20 to 30", "╌╌", "•")
        await me.sees("1 node", "Parameters 2", "reliable, volatile")
        await me.sees_rate(2.0)

        # The log is beside the Live page where there is room, unless the learner hides the latter.
        await me.sees("● running  temperature_publisher.py", "INFO")
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

        me.reads("**Parameters** (`P`): both of yours", "The node says *accepted*, yet goes on as before")
        await me.press("P")
        await me.sees("publish_rate", "sensor_name", "double", "string", "Enter Set")
        await me.press("down", "enter")
        await me.sees("Set /temperature_publisher sensor_name")
        await me.press("ctrl+u")
        me.paste("roof")
        await me.press("enter")
        await me.sees("sensor_name = roof  accepted")
        me.reads("**Graph** (`G`): your node and the topic, and that nobody subscribes yet")
        await me.press("escape", "G")
        await me.sees("/temperature_publisher", "/sensor/temperature", "nobody listens")

        me.reads("write `publish_rate:=5.0` and `sensor_name:=kitchen` on two lines, and press F5")
        await me.press("o")
        await me.sees("F5 runs")
        me.paste("publish_rate:=5.0\nsensor_name:=kitchen")
        me.app.screen.query_one("#run-remaps").text = "/sensor/temperature:=/greenhouse"  # type: ignore[attr-defined]
        await me.press("f5")
        me.reads("The rate is now 5.00 Hz, and the log mentions the kitchen")
        await me.sees("kitchen publishes 5.0 readings")
        await me.press("4", "T")
        await me.sees("/greenhouse", "std_msgs/Float64")
        await me.until(lambda: re.search(r"\b(4\.9\d|5\.0\d) Hz · jitter", me.screen()) is not None, "5 Hz")
        await me.press("right_square_bracket")
        await me.sees("publish_rate", "5.0", "sensor_name", "kitchen")

        assert is_running(me.file)
        await me.press("r")
        await me.sees("No node runs in domain")
        await me.press("3")
        await me.sees("stopped")
        assert not is_running(me.file)


async def test_i1_2(session: Session) -> None:
    async with reading(session, "i1.2") as me:
        me.reads("Run it with `r`, then press `b`: that starts a talker beside it", "`[` and `]` switch from one log")
        await me.press("r")
        await me.sees("● running  message_stats.py", "Waiting for messages on /chatter")
        await me.press("b")
        await me.sees("● running  talker", "ros2 run demo_nodes_py talker", "Hello World: 0", "b stops it")
        await me.press("left_square_bracket")
        await me.sees("● running  message_stats.py", "r stops it")
        me.reads("`/chatter` with 1.00 Hz, one publisher (Pub) and one subscriber (Sub), and the messages")
        await me.press("T")
        await me.sees("data: 'Hello World: ")
        await me.sees_rate(1.0)
        row = next(line for line in me.screen().splitlines() if "●  /chatter" in line)
        assert re.search(r"/chatter .* 1 +1 +std_msgs/String", row)
        me.reads("`M` publishes a message by hand. Send `Hello World: 99`", "your node has a gap to report")
        await me.press("M")
        await me.sees("Publish a message", "data string")
        await me.until_field_focused()
        me.paste("Hello World: 99")
        await me.press("enter")
        await me.sees("✓ published once on /chatter")
        await me.press("3")
        await me.sees("messages are missing between")
        me.reads("Press `b` again to stop the talker, and once more to start it again, from 0")
        await me.press("b")
        await me.sees("■ talker")
        await me.press("b")
        await me.sees("● talker")
        await me.press("left_square_bracket")
        await me.sees("The publisher was restarted", "10 messages, ")
        me.reads("**Graph** (`G`): the talker, `/chatter`, and your node, with arrows from one to the next")
        await me.press("G")
        await me.sees("/talker", "/chatter", "/message_stats", "──▶")

        pids = [pid for node in me.main.nodes.running if (pid := node.pid) is not None]
        assert len(pids) == 2
        await me.press("q")
        await me.until(lambda: me.app.return_code == 0)
        assert not any(Path(f"/proc/{pid}").exists() for pid in pids)


async def test_i1_3(session: Session) -> None:
    async with reading(session, "i1.3", (120, 36)) as me:
        me.reads(
            "`r` runs the file that is shown",
            "`j` runs the other file beside it, so that your client meets your server",
        )
        await me.press("r")
        await me.sees("Calculator is up")
        await me.press("j")
        await me.sees("add(10, 5) = 15", "■ ended  calculator_client.py")
        me.reads("`b` starts ours instead: our client beside your server")
        await me.press("b")
        await me.sees("■ ended  our client", "multiply(10, -5) = -50")
        me.reads("`/add`, `/subtract`, `/multiply` and `/divide`, their type, and the node that offers them")
        await me.press("S")
        await me.sees(
            "/add", "/subtract", "/multiply", "/divide", "example_interfaces/AddTwoInts", "/calculator_server"
        )
        me.reads("press Enter, fill in `a` and `b`, and press Enter again")
        await me.press("enter")
        await me.until_field_focused()
        await me.press("ctrl+u", *"10", "tab", "ctrl+u", *"5", "enter")
        await me.sees("/add a=10, b=5", "answered in", "sum: 15")
        me.reads("Choose `/divide` in the list, and try 0 for `b`", "an error in the server's log")
        await me.press("escape", "down", "enter")
        await me.sees("/divide  example_interfaces/AddTwoInts")
        await me.until_field_focused()
        await me.press("ctrl+u", *"1", "enter")
        await me.sees("/divide a=1, b=0", "sum: 0")
        await me.press("escape", "3", "left_square_bracket", "left_square_bracket")
        await me.sees("Cannot divide 1 by zero")
        await me.press("r")
        await me.sees("■ ended  calculator_server.py")

        # The client beside our server, with the whole width for the log.
        await me.press("L", "f")
        await me.sees("calculator_client.py")
        await me.press("b")
        await me.sees("● running  our server", "Calculator is up")
        client = await me.runs()
        await me.until(client.over.is_set, "it has ended")
        assert not client.state.failed, client.state
        await me.sees("calculator_client.py", "add(10, 5) = 15", "■ ended")
        await me.press("b")
        await me.sees("■ our server")
        await me.press("j")
        await me.sees("● running  calculator_server.py", "j stops it")
        await me.sees("Calculator is up")  # Ctrl+C before then may interrupt the import of rclpy, and is an error
        await me.press("b")
        await me.sees("Your calculator_server.py is already running")
        await me.press("j")
        await me.sees("■ ended  calculator_server.py")


async def test_i2_1(session: Session) -> None:
    async with reading(session, "i2.1") as me:
        await me.press("r")
        await me.sees("Published: Hello")
        me.reads("`enabled`, `message_prefix` and `publish_rate`, with type and value", "A new prefix is *accepted*")
        await me.press("P")
        await me.sees("enabled", "message_prefix", "publish_rate", "boolean", "string", "double")
        await me.press("down", "enter", "ctrl+u")
        me.paste("Ahoy")
        await me.press("enter")
        await me.sees("message_prefix = Ahoy  accepted")
        me.reads("A rate of `0.0` should be *rejected*, with your reason beside it")
        await me.press("down", "enter", "ctrl+u", *"0.0", "enter")
        await me.sees("publish_rate = 0.0  rejected", "publish_rate must be")
        await me.press("enter", "ctrl+u", *"10.0", "enter")
        await me.sees("publish_rate = 10.0  accepted")
        me.reads("the messages begin with it", "If you set a rate of 10.0, the **Rate** goes up to 10.0 Hz")
        await me.press("escape", "T")
        await me.sees("data: 'Ahoy")
        await me.sees_rate(10.0)
        me.reads("while `enabled` is false, the topic is *silent*")
        await me.press("P", "up", "up", "enter", "ctrl+u", *"false", "enter")
        await me.sees("enabled = false  accepted")
        await me.press("escape", "T")
        await me.sees("silent")
        me.reads("`b` starts a listener beside your node", "Try `publish_rate:=0.0`, too: what does the log say?")
        await me.press("b")
        await me.sees("● running  listener", "2 nodes")
        await me.press("o")
        await me.sees("F5 runs")
        me.paste("publish_rate:=0.0")
        await me.press("f5")
        await me.sees("publish_rate must be", "ended")


async def test_i2_2(session: Session) -> None:
    async with reading(session, "i2.2", (120, 36)) as me:
        me.reads("`r` launches your file, and the log shows both nodes")
        await me.press("r")
        await me.sees("I heard: ", "Publishing: ")
        me.reads(
            "`b` starts one of our listeners on `/chatter`. It hears your publisher while the topic is called `chatter`"
        )
        await me.press("b")
        await me.sees("● running  listener", "I heard: [Hello World: ")
        me.reads("write `topic:=my_topic` and `namespace:=robot1`, and press F5")
        await me.press("o")
        await me.sees("Launch arguments")
        me.paste("topic:=my_topic")
        await me.press("enter")
        me.paste("namespace:=robot1")
        await me.press("f5")
        await me.sees("robot1.minimal_publisher")
        me.reads("`/robot1/minimal_publisher`, `/robot1/my_topic` and `/robot1/minimal_subscriber`, with arrows")
        await me.press("G")
        await me.sees("/robot1/minimal_publisher", "/robot1/my_topic", "/robot1/minimal_subscriber", "──▶")
        me.reads("`/robot1/my_topic` is followed automatically, with 2.00 Hz")
        await me.press("T")
        await me.sees("/robot1/my_topic  std_msgs/String", "data: 'Hello World: ")
        await me.sees_rate(2.0)


async def test_i2_3(session: Session) -> None:
    async with reading(session, "i2.3") as me:
        me.reads("switch to Live with `4`, and to its services with `S`. The form for `/slow_add` is open")
        await me.press("r")
        await me.sees("Ready: /slow_add")
        await me.press("4", "S")
        await me.sees("/slow_add", "a int64")
        await me.press("enter")
        await me.until_field_focused()
        await me.press("ctrl+u", *"5", "tab", "ctrl+u", *"3", "enter")
        me.reads("It says *waiting* for three seconds, then shows the answer and the time it took")
        await me.sees("/slow_add  waiting")
        await me.sees("sum: 8", "answered in 3")
        me.reads("`b` calls `/slow_add` three times at once, and logs how long each answer took: 3 seconds each")
        await me.press("escape", "b")
        await me.sees(
            "Called /slow_add 3 times at once", "5 + 1 = 6, answered after 3.", "5 + 3 = 8, answered after 3."
        )
        me.reads("Meanwhile the ticks in the log must continue. The log is beside Live if your terminal is wide enough")
        await me.press("3", "left_square_bracket")
        await me.sees("Tick ")


async def test_b1_1(session: Session) -> None:
    async with reading(session, "b1.1") as me:
        code = me.file.read_text(encoding="utf-8")
        me.file.write_text(code.replace("self.on_range, RANGE_QOS", "self.on_range, 10"), encoding="utf-8")
        me.reads("Press `b` first: that starts the given warehouse", "Run your node with `r`")
        await me.press("b")
        await me.sees("● running  warehouse", "Published the map hall-")
        await me.press("r")
        me.reads("it warns once, at the start", "New publisher discovered on topic 'range'")
        for text in ("map: hall-", "publisher discovered on topic 'range'", r"parcel: lorry-\d+-200"):
            await me.until(lambda text=text: re.search(text, "\n".join(me.background())) is not None, text)  # type: ignore[misc]
        me.reads("where a publisher and a subscription are not compatible, the line between them is broken")
        await me.press("4", "G")
        await me.sees("✗ 1 connection does not work", "/warehouse ──✗ /warehouse_monitor", "asks for reliable")
        me.reads("choose `/range`, and the line above its messages says what the publisher offers")
        await me.press("T", "down", "down")
        await me.sees("/range  std_msgs/Int32 · best effort, volatile", "data: ")


async def test_b1_2(session: Session) -> None:
    async with reading(session, "b1.2") as me:
        me.reads("switch to Live with `4`: `/bridge/light` is there, with its rate")
        await me.press("r")
        await me.sees("Ready: /bridge/move")
        await me.press("4")
        await me.sees("/bridge/light  std_msgs/Bool")
        await me.sees_rate(10.0)
        me.reads("the form for `/bridge/move` is open: press Enter, fill in `data`", "There is no harbour yet")
        await me.press("S")
        await me.sees("/bridge/move", "data bool")
        await me.press("enter")
        await me.until_field_focused()
        await me.press("ctrl+u", *"true", "enter")
        await me.sees("There is no harbour")
        me.reads("`b` starts a harbour office, which thinks for 1.5 seconds", "the form says *waiting*, then shows")
        await me.press("escape", "b")
        await me.sees("Ready: /harbour/clearance")
        await me.press("4", "enter")
        await me.until_field_focused()
        await me.press("enter")
        await me.sees("clearance 101 to raise", "answered in 1.")


async def test_b1_6(session: Session) -> None:
    async with reading(session, "b1.6") as me:
        me.reads("Run your node with `r`, and press `b`: a battery begins to send")
        await me.press("r")
        await me.sees("● running  battery_monitor.py")
        await me.press("b")
        await me.sees("● running  battery", "The battery discharges", "The battery is low, and hot")
        me.reads("its own log (`[` and `]` switch) says when")
        await me.press("left_square_bracket")
        await me.sees(
            "● running  battery_monitor.py", "The battery reports", "The battery is low: ", "The battery is hot: "
        )
        await me.sees("Broken readings: ")

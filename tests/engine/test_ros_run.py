"""What a run can do to a live node, and what it observes."""

from __future__ import annotations

import asyncio
import time
import warnings
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest

from tests.engine.helpers import FILE, PUBLISHES, WAITS, Scene, node
from tutor.errors import EngineError
from tutor.judge import tracebacks
from tutor.judge.bench import Run
from tutor.ros_model import QoS

CHATTER = {"/chatter": "std_msgs/msg/String"}
ADD = "example_interfaces/srv/AddTwoInts"
STARTUP_S = 20.0
"""Limit for the discovery of a node on a busy machine."""

SERVES = """
def add(request, response):
    response.sum = request.a + request.b
    return response

def stuck(request, response):
    while True:
        time.sleep(0.01)

node.create_service(AddTwoInts, "add", add)
node.create_service(AddTwoInts, "stuck", stuck)
"""
DECLARES = """
from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult

positive = FloatingPointRange(from_value=0.5, to_value=9.0)
node.declare_parameter("rate", 1.0, ParameterDescriptor(floating_point_range=[positive]))
node.declare_parameter("name", "thermometer")
node.declare_parameter("count", 3)
node.declare_parameter("loud", True)
node.declare_parameter("fixed", 1, ParameterDescriptor(read_only=True))
node.declare_parameter("unset", rclpy.Parameter.Type.STRING)

def judge(parameters):
    bad = any(p.name == "count" and p.value < 0 for p in parameters)
    return SetParametersResult(successful=not bad, reason="count must not be negative" if bad else "")

node.add_on_set_parameters_callback(judge)
"""


# On a busy machine, the middleware may drop a response like this.
LOSES_FIRST_RESPONSES = """
for service in node.services:
    def send_response(response, header, send=service.send_response, service=service, first=[]):
        if first:
            send(response, header)
        else:
            first.append(response)
            print(f"dropped by {service.srv_name}", flush=True)
    service.send_response = send_response
"""

# Reports each SIGINT, and ends shortly after the first one, so that a second one would be reported as well.
COUNTS_INTERRUPTS = """
import signal, sys, threading
def count(*_):
    print("interrupted", flush=True)
    threading.Timer(0.5, over.set).start()
over = threading.Event()
signal.signal(signal.SIGINT, count)
print("up", flush=True)
while not over.wait(0.05):
    pass
"""
BUSY_FOR_A_MOMENT = """
import threading, time
try:
    print("busy", flush=True)
    until = time.monotonic() + 0.2
    while time.monotonic() < until:
        pass
    print("done", flush=True)
    threading.Event().wait()
except KeyboardInterrupt:
    print("interrupted", flush=True)
"""
LAUNCHES_LATER = """
from launch import LaunchDescription
from launch.actions import TimerAction
from launch_ros.actions import Node

def generate_launch_description():
    talker, listener = (Node(package="demo_nodes_py", executable=name) for name in ("talker", "listener"))
    return LaunchDescription([talker, TimerAction(period=4.0, actions=[listener])])
"""
LAUNCHES = """
import sys
from launch import LaunchDescription
from launch.actions import ExecuteProcess
def generate_launch_description():
    return LaunchDescription([ExecuteProcess(cmd=[sys.executable, "counts.py"], output="screen")])
"""


# Runs the code that its parameter is set to.
OBEYS = """
import subprocess
from rcl_interfaces.msg import SetParametersResult
def obey(parameters):
    exec(parameters[0].value, globals())
    return SetParametersResult(successful=True)
node.declare_parameter("do", "")
node.add_on_set_parameters_callback(obey)
later = node.create_publisher(String, "later", 10)
"""
PUBLISHES_LATER = 'threading.Timer(2.5, lambda: later.publish(String(data="at last"))).start()'
STARTS_CHILD = 'subprocess.Popen([sys.executable, "-c", "import time; time.sleep(1000)"])'
LONG_S = 60.0


async def wait_for_samples(run: Run, topic: str = "/chatter") -> None:
    assert await run.until(lambda: bool(run.samples_on(topic)), STARTUP_S), run.trace()


async def wait_for_service(run: Run, service: str) -> None:
    assert await run.until(lambda: any(s.name == service for s in run.graph.servers), STARTUP_S), run.trace()


async def tell(run: Run, code: str) -> None:
    """Have a node that obeys run some code."""
    answer = await run.set_parameters("/learner", {"do": code}, limit_s=STARTUP_S)
    assert answer.successful, answer


async def test_a_node_is_observed_from_its_first_message_to_its_exit(scene: Scene) -> None:
    source = node(
        PUBLISHES,
        "node.get_logger().warning('hot')",
        "print('printed')",
        "node.create_subscription(Float64, 'in', print, 10)",
    )
    async with scene.bench(source).start(FILE, watch=CHATTER, parameters={"a": 1, "b": True, "c": "x"}) as run:
        await wait_for_samples(run)
        assert await run.until(lambda: bool(run.logs) and bool(run.output), STARTUP_S)
        echo = await run.echo("/chatter", samples=2, limit_s=10)
        silent = await run.echo("/nothing", samples=1, limit_s=0.2)
        before = run.trace()
        ending = await run.interrupt()
        after = run.trace()
    assert ending is not None
    sample = before.samples_on("/chatter")[0]
    assert sample.message == {"data": "learner"}
    assert before.started_at <= sample.source_time <= sample.received_at + 0.05 <= time.time() + 0.05
    (log,) = before.logs
    assert (log.text, log.level, log.name) == ("hot", 30, "learner")
    assert before.started_at <= log.stamp <= log.received_at + 0.05
    assert "printed" in [line.text for line in before.output if line.stream == "stdout"]
    assert before.graph.nodes == ("/learner",)
    assert [(p.topic, p.type, p.node, p.qos.reliability) for p in before.graph.publishers] == [
        ("/chatter", CHATTER["/chatter"], "/learner", "reliable")
    ]
    assert [(s.topic, s.node) for s in before.graph.subscriptions] == [("/in", "/learner")]
    assert before.parameters == {"a": 1, "b": True, "c": "x"}
    assert before.exit is None
    assert (echo.types, echo.qos) == ((CHATTER["/chatter"],), QoS("reliable", "volatile"))
    assert [each.message for each in echo.samples[:2]] == [{"data": "learner"}] * 2
    assert (silent.types, silent.samples) == ((), ())
    assert ending.exit is not None
    assert (ending.exit.code, ending.exit.signal) == (0, None)
    assert 0 < ending.took_s < 5
    assert after.exit == ending.exit
    assert after.graph.nodes == ("/learner",), "the last graph seen before the exit"


async def test_parameters_are_read_and_set(scene: Scene) -> None:
    async with scene.bench(node(DECLARES)).start(FILE, parameters={"name": "mine"}) as run:
        await wait_for_service(run, "/learner/set_parameters_atomically")
        declared = await run.parameters(10)
        assert declared is not None
        mine = {p.name: p for p in declared if p.name in ("rate", "name", "count", "loud", "fixed", "unset")}
        assert {name: (p.type, p.value) for name, p in mine.items()} == {
            "rate": ("double", 1.0),
            "name": ("string", "mine"),
            "count": ("integer", 3),
            "loud": ("boolean", True),
            "fixed": ("integer", 1),
            "unset": ("string", None),
        }
        assert (mine["rate"].minimum, mine["rate"].maximum, mine["name"].minimum) == (0.5, 9.0, None)
        assert [p.name for p in mine.values() if p.read_only] == ["fixed"]
        assert {p.node for p in mine.values()} == {"/learner"}

        good = await run.set_parameters("/learner", {"rate": 2.0, "loud": False, "name": "other"})
        assert (good.answered, good.successful, good.reason) == (True, True, "")
        assert run.started_at < good.asked_at <= good.answered_at
        bad = await run.set_parameters("/learner", {"count": -1})
        assert (bad.answered, bad.successful, bad.reason) == (True, False, "count must not be negative")
        wrong_type = await run.set_parameters("/learner", {"rate": 2})
        assert (wrong_type.answered, wrong_type.successful) == (True, False)
        half = await run.set_parameters("/learner", {"name": "half", "count": -1})
        assert not half.successful
        whole = await run.set_parameters("/learner", {"name": "whole", "count": -1}, atomic=True)
        assert (whole.successful, whole.reason) == (False, "count must not be negative")
        held = {p.name: p.value for p in await run.parameters(10) or ()}
        assert (held["rate"], held["loud"], held["name"], held["count"]) == (2.0, False, "half", 3)
        nobody = await run.set_parameters("/nobody", {"rate": 2.0}, limit_s=0.2)
        assert (nobody.answered, nobody.successful) == (False, False)


async def test_a_best_effort_publisher_is_received_and_parameters_come_from_the_node_that_answers(scene: Scene) -> None:
    qos = "QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL, reliability=ReliabilityPolicy.BEST_EFFORT)"
    source = node(
        "from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy",
        PUBLISHES.replace(", 10)", f", {qos})"),
        "node.declare_parameter('rate', 1.0)",
        "other = Node('deaf')  # nobody spins it",
    )
    async with scene.bench(source).start(FILE) as run:
        assert await run.until(lambda: any(p.topic == "/chatter" for p in run.graph.publishers), STARTUP_S)
        assert run.watch("/chatter", CHATTER["/chatter"])
        await wait_for_samples(run)
        await wait_for_service(run, "/learner/list_parameters")
        await wait_for_service(run, "/deaf/list_parameters")
        declared = await run.parameters(1.0)
    assert declared is not None
    assert {p.node for p in declared} == {"/learner"}
    assert "rate" in {p.name for p in declared}


async def test_requests_without_side_effects_are_sent_again(scene: Scene) -> None:
    async with scene.bench(node(DECLARES, SERVES, LOSES_FIRST_RESPONSES)).start(FILE) as run:
        await wait_for_service(run, "/learner/list_parameters")
        declared = await run.parameters(10)
        added = await run.call("/add", ADD, {"a": 2, "b": 3}, limit_s=10, resend_s=0.5)
    assert "rate" in {p.name for p in declared or ()}
    assert added.response == {"sum": 5}
    dropped = [line.text for line in run.output if line.text.startswith("dropped")]
    assert [text.rpartition("/")[2].split()[-1] for text in dropped] == [
        "list_parameters", "describe_parameters", "get_parameters", "add",
    ]  # fmt: skip


async def test_parameters_of_a_node_that_never_answers_are_unknown(scene: Scene) -> None:
    async with scene.bench(node("while True: time.sleep(1)")).start(FILE) as run:
        await wait_for_service(run, "/learner/list_parameters")
        assert await run.parameters(0.3) is None
        assert not (await run.set_parameters("/learner", {"rate": 2.0}, limit_s=0.3)).answered
        # A request that is pending when the run ends is not sent again.
        pending = asyncio.ensure_future(run.parameters(5.0))
        assert not await run.until(pending.done, 0.5)
    assert await pending is None


async def test_services_are_called_and_a_stuck_callback_is_located(scene: Scene) -> None:
    async with scene.bench(node(SERVES)).start(FILE) as run:
        await wait_for_service(run, "/stuck")
        answer = await run.call("/add", ADD, {"a": 2, "b": -5}, limit_s=10)
        assert (answer.response, answer.request) == ({"sum": -3}, {"a": 2, "b": -5})
        assert 0 < answer.took_s < 10
        assert (await run.call("/nothing", ADD, {"a": 1, "b": 1}, limit_s=0.2)).response is None
        assert (await run.call("/stuck", ADD, {"a": 1, "b": 1}, limit_s=0.5)).response is None
        folder = run.trace().folder
        frame = tracebacks.own_frame(await run.dump_stacks(), folder)
        assert frame is not None
        assert (frame.function, frame.path.rpartition("/")[2]) == ("stuck", FILE)
        assert "while True" in frame.code or "sleep" in frame.code
        assert run.exit is not None
        assert await run.dump_stacks() == ()


async def test_waiting_for_a_response_ends_when_the_node_exits(scene: Scene) -> None:
    source = node("import os", "node.create_service(AddTwoInts, 'die', lambda request, response: os._exit(3))")
    async with scene.bench(source).start(FILE) as run:
        await wait_for_service(run, "/die")
        began = time.monotonic()
        answer = await run.call("/die", ADD, {"a": 1, "b": 1}, limit_s=60)
        assert answer.response is None
        assert time.monotonic() - began < 20
        assert run.exit is not None
        assert run.exit.code == 3
        assert not await run.until(lambda: False, 60)
        assert time.monotonic() - began < 25


WAITS_IN_CALLBACK = """
import threading
def never(request, response):
    threading.Event().wait()

def late(request, response):
    threading.Event().wait(4.5)
    response.sum = 7
    return response

node.create_service(AddTwoInts, "never", never)
node.create_service(AddTwoInts, "late", late)
"""


async def test_messages_in_transit_are_waited_for_once_after_the_node_has_ended(scene: Scene) -> None:
    async with scene.bench("pass").start(FILE) as run:
        await run.until(lambda: run.exit is not None, STARTUP_S)
        assert not await run.until(lambda: False, 5.0)
        since = run.now()
        for _ in range(10):
            assert not await run.until(lambda: False, 5.0)
        assert run.now() - since < 0.4


async def test_waiting_for_a_response_ends_when_the_node_blocks_forever(scene: Scene) -> None:
    async with scene.bench(node(WAITS_IN_CALLBACK)).start(FILE) as run:
        await wait_for_service(run, "/never")
        await wait_for_service(run, "/late")
        late = await run.call("/late", ADD, {"a": 1, "b": 1}, limit_s=60)
        assert late.response == {"sum": 7}
        began = time.monotonic()
        answered, parameters, ended = await asyncio.gather(
            run.call("/never", ADD, {"a": 1, "b": 1}, limit_s=60),
            run.parameters(60),
            run.wait_for_exit(60, all_sent=lambda: True),
        )
        assert time.monotonic() - began < 40
        assert (answered.response, parameters, ended, run.exit) == (None, None, False, None)


async def test_a_call_that_still_waits_when_our_participant_leaves_gets_no_response(scene: Scene) -> None:
    from tutor.ros.observer import Observer

    async with scene.bench(WAITS).start(FILE) as run:
        observer = Observer(run._domain_id)  # type: ignore[attr-defined]
        call = asyncio.ensure_future(observer.call("/nowhere", ADD, {"a": 1, "b": 1}, limit_s=60))
        await asyncio.sleep(0.1)
        assert not call.done()
        observer.close()
        assert await call is None


PUBLISHES_ONCE = """
from rclpy.qos import DurabilityPolicy, QoSProfile
latched = node.create_publisher(String, "latched", QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL))
latched.publish(String(data="once"))
publisher = node.create_publisher(String, "chatter", 10)
publisher.publish(String(data="once"))
"""


async def test_echo_stops_when_no_message_can_come(scene: Scene) -> None:
    async with scene.bench(node(OBEYS, PUBLISHES_ONCE)).start(FILE) as run:
        await wait_for_service(run, "/learner/set_parameters")
        assert await run.until(lambda: {"/latched", "/chatter"} <= {p.topic for p in run.graph.publishers}, STARTUP_S)
        began = time.monotonic()
        latched = await run.echo("/latched", samples=1, limit_s=60)
        assert [sample.message["data"] for sample in latched.samples] == ["once"]
        while_idle = await run.echo("/chatter", samples=1, limit_s=60)
        was_running = run.exit is None
        await tell(run, "import os; node.create_timer(1.0, lambda: os._exit(0))")
        until_exit = await run.echo("/chatter", samples=1, limit_s=60)
        assert was_running
        assert run.exit is not None
    for shown in (while_idle, until_exit):
        assert (shown.types, shown.samples) == (("std_msgs/msg/String",), ())
        assert shown.limit_s < 20
    assert time.monotonic() - began < 40


CALLS = """
def call(name):
    client = node.create_client(AddTwoInts, name)
    assert client.wait_for_service(20)
    future = client.call_async(AddTwoInts.Request(a=4, b=5))
    rclpy.spin_until_future_complete(node, future, timeout_sec=20)
    print(f"{name} {future.result().sum}")

for name in ("add", "late", "broken"):
    call(name)
sys.exit(0)
"""


async def test_our_servers_answer_record_calls_and_raise_their_own_errors_but_no_warnings(scene: Scene) -> None:
    def add(request: Mapping[str, Any]) -> Mapping[str, Any]:
        return {"sum": request["a"] + request["b"]}

    def answer_too_late(request: Mapping[str, Any]) -> Mapping[str, Any]:
        # As rclpy warns when the client has left. Tests turn warnings into errors, which would end the executor.
        warnings.warn("failed to send response (timeout): client will not receive response", RuntimeWarning, 1)
        return {"sum": 10}

    def broken(request: Mapping[str, Any]) -> Mapping[str, Any]:
        raise ZeroDivisionError("ours")

    async with scene.bench(node(CALLS)).start(FILE) as run:
        run.serve("/add", ADD, add)
        run.serve("/late", ADD, answer_too_late)
        assert await run.until(lambda: any(line.text == "late 10" for line in run.output), STARTUP_S), run.trace()
        trace, served = run.trace(), tuple(run.served)
        run.serve("/broken", ADD, broken)
        with pytest.raises(EngineError, match="ours"):
            await run.until(lambda: run.exit is not None, STARTUP_S)
    assert [line.text for line in trace.output if line.stream == "stdout"] == ["add 9", "late 10"]
    assert [(s.service, s.request, s.response) for s in served] == [
        ("/add", {"a": 4, "b": 5}, {"sum": 9}),
        ("/late", {"a": 4, "b": 5}, {"sum": 10}),
    ]
    assert trace.graph.servers == () or all(s.node == "/learner" for s in trace.graph.servers)


async def test_a_process_that_ignores_ctrl_c_is_killed_when_the_run_ends(scene: Scene) -> None:
    source = "import signal, time\nsignal.signal(2, signal.SIG_IGN)\nprint('up', flush=True)\ntime.sleep(1000)"
    async with scene.bench(source).start(FILE) as run:
        assert await run.until(lambda: bool(run.output), STARTUP_S)
        ending = await run.interrupt(0.3)
        assert ending is not None
        assert (ending.exit, ending.limit_s) == (None, 0.3)
        assert scene.leftovers()
    assert not scene.leftovers()


async def test_two_runs_at_once_do_not_discover_each_other(scene: Scene) -> None:
    bench = scene.bench(node(PUBLISHES.replace("node.get_name()", "sys.argv[-1]")))
    async with (
        bench.start(FILE, watch=CHATTER, parameters={"me": 1}) as one,
        bench.start(FILE, watch=CHATTER, parameters={"me": 2}) as two,
    ):
        await asyncio.gather(wait_for_samples(one), wait_for_samples(two))
        received = [len(one.samples_on("/chatter")), len(two.samples_on("/chatter"))]
        assert await one.until(lambda: len(one.samples_on("/chatter")) >= received[0] + 10, STARTUP_S)
        assert await two.until(lambda: len(two.samples_on("/chatter")) >= received[1] + 10, STARTUP_S)
        for run, me in ((one, "me:=1"), (two, "me:=2")):
            assert {sample.message["data"] for sample in run.samples_on("/chatter")} == {me}
            assert run.graph.nodes == ("/learner",)


FLOODS = """
publisher = node.create_publisher(String, "chatter", 10)
def flood():
    while rclpy.ok():
        publisher.publish(String(data="x" * 100))
        print("y" * 100)
        node.get_logger().info("z")
threading.Thread(target=flood, daemon=True).start()
"""


async def test_a_flood_of_messages_and_output_is_bounded(scene: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    from tutor.ros import intake

    limit = 200
    monkeypatch.setattr(intake, "MAX_SAMPLES", limit)
    async with scene.bench(node(FLOODS)).start(FILE, watch=CHATTER) as run:
        assert await run.until(lambda: len(run.samples_on("/chatter")) >= limit and len(run.logs) >= limit, STARTUP_S)
        assert await run.until(lambda: run.trace().dropped_lines > 500, STARTUP_S)
        # Messages already in flight still come in, and are not kept either.
        declared = await run.parameters(10)
        ending = await run.interrupt()
        trace = run.trace()
    assert declared is not None
    assert ending is not None
    assert ending.exit is not None
    assert len(trace.samples_on("/chatter")) == limit
    assert len(trace.logs) == limit
    assert len(trace.output) <= 2002


BIG = """
publisher = node.create_publisher(String, "chatter", 10)
node.declare_parameter("name", "x" * 100_000)
sent = 0
def big():
    global sent
    publisher.publish(String(data="x" * 250_000))
    node.get_logger().info("y" * 250_000)
    sent += 1
    if sent == 40:
        print("sent 40")
node.create_timer(0.02, big)
"""


async def test_big_messages_are_truncated_and_their_number_is_bounded(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    from tutor.ros import intake, messages, observer

    monkeypatch.setattr(intake, "MAX_BYTES", 250_000)
    async with scene.bench(node(BIG)).start(FILE, watch=CHATTER) as run:
        assert await run.until(lambda: len(run.samples_on("/chatter")) >= 5 and len(run.logs) >= 6, STARTUP_S)
        assert await run.until(lambda: any(line.text == "sent 40" for line in run.output), STARTUP_S)
        declared = await run.parameters(10)
        trace = run.trace()
    assert {len(sample.message["data"]) for sample in trace.samples_on("/chatter")} == {messages.MAX_CHARACTERS}
    assert max(len(log.text) for log in trace.logs) == observer.LINE_CHARACTERS
    assert len(trace.samples_on("/chatter")) <= 10
    assert len(trace.logs) <= 10
    assert [len(p.value) for p in declared or () if p.name == "name"] == [messages.MAX_CHARACTERS]


async def test_ctrl_c_is_pressed_once_the_node_has_finished_what_it_is_doing(scene: Scene) -> None:
    async with scene.bench(BUSY_FOR_A_MOMENT).start(FILE) as run:
        assert await run.until(lambda: any(line.text == "busy" for line in run.output), STARTUP_S), run.output
        await run.interrupt()
    assert [line.text for line in run.output] == ["busy", "done", "interrupted"]


DIES = """
def die():
    try:
        raise SystemExit(3)
    finally:
        until = time.monotonic() + {busy_s}
        while time.monotonic() < until:
            pass
"""


@pytest.mark.parametrize("busy_s", [0.0, 0.3])
async def test_a_node_that_our_request_has_ended_was_not_ended_by_ctrl_c(scene: Scene, busy_s: float) -> None:
    """It is still busy with its end when Ctrl+C is about to be pressed."""
    async with scene.bench(node(OBEYS, DIES.format(busy_s=busy_s))).start(FILE) as run:
        await wait_for_service(run, "/learner/set_parameters")
        await tell(run, "node.create_timer(0.0, die)")
        assert await run.interrupt() is None
    assert run.exit is not None
    assert run.exit.code == 3


async def test_ctrl_c_reaches_a_launched_process_exactly_once(scene: Scene) -> None:
    (scene.folder / "counts.py").write_text(COUNTS_INTERRUPTS)
    async with scene.bench(LAUNCHES).launch(FILE) as run:
        assert await run.until(lambda: any(line.text.endswith("] up") for line in run.output), STARTUP_S), run.output
        ending = await run.interrupt()
        assert ending is not None
        assert ending.exit is not None, run.output
        assert sum(line.text.endswith("] interrupted") for line in run.output) == 1, run.output


async def test_a_launch_has_launched_all_once_no_timer_is_pending(scene: Scene) -> None:
    seen: list[bool] = []

    def record(nodes: int) -> bool:
        if len(run.graph.nodes) == nodes:
            seen.append(run.has_launched_all())
        return len(seen) > 20

    async with scene.bench(LAUNCHES_LATER).launch(FILE) as run:
        assert await run.until(lambda: record(1), STARTUP_S), run.output
        assert not any(seen)
        assert await run.until(lambda: len(run.graph.nodes) == 2, STARTUP_S), run.output
        assert await run.until(run.has_launched_all, STARTUP_S), run.output


async def test_of_waiting_runs_the_longest_one_starts_first(scene: Scene) -> None:
    from tutor.engine.scheduling import StartLimiter

    began: list[float] = []
    machine = replace(scene.machine, starts=StartLimiter(slots=1))
    bench = replace(scene.bench(WAITS), machine=machine, expected_s=2.0)

    async def start(expected_s: float | None) -> None:
        async with bench.start(FILE, expected_s=expected_s):
            began.append(bench.expected_s if expected_s is None else expected_s)

    async with machine.starts.slot(0.0) as up:
        waiting = [asyncio.create_task(start(expected_s)) for expected_s in (0.5, None, 7.0)]
        await asyncio.sleep(0)  # all three queue for the slot
        up()
        await asyncio.gather(*waiting)
    assert began == [7.0, 2.0, 0.5]


@pytest.mark.parametrize(("dropped", "idle_s"), [(None, 6.0), (5, 1.0)])  # where nothing was lost, a second is enough
async def test_the_thread_that_flushes_the_log_every_5_s_does_not_keep_a_node_busy(
    scene: Scene, monkeypatch: pytest.MonkeyPatch, dropped: int | None, idle_s: float
) -> None:
    monkeypatch.setattr("tutor.engine.waits.count_dropped_datagrams", lambda: dropped)
    async with scene.bench(node()).start(FILE) as run:
        assert await run.until(lambda: bool(run.graph.nodes), STARTUP_S)
        began = time.monotonic()
        assert not await run.until(lambda: False, LONG_S, idle_s=6.0)
        assert idle_s <= time.monotonic() - began < LONG_S


async def test_a_run_waits_for_a_node_only_as_long_as_it_may_wake_up_before_the_deadline(scene: Scene) -> None:
    async def wait(limit_s: float) -> tuple[bool, float]:
        """Return whether a message on /later came, and for how many seconds it was waited for."""
        began, before = time.monotonic(), len(run.samples_on("/later"))
        came = await run.until(lambda: len(run.samples_on("/later")) > before, limit_s, idle_s=0.7)
        return came, time.monotonic() - began

    async with scene.bench(node(OBEYS)).start(FILE, watch={"/later": CHATTER["/chatter"]}) as run:
        await wait_for_service(run, "/learner/set_parameters")

        came, idle_s = await wait(LONG_S)
        assert not came, run.trace()
        assert 0.7 <= idle_s < LONG_S / 2

        # Neither a timer beyond the deadline nor the sleep of a child process counts.
        for code in ("node.create_timer(90.0, print)", STARTS_CHILD):
            await tell(run, code)
            came, idle_s = await wait(10.0)
            assert not came, run.trace()
            assert 0.7 <= idle_s < 9.0, code

        await tell(run, PUBLISHES_LATER)
        came, _ = await wait(LONG_S)
        assert came, run.trace()

        await tell(run, "node.create_timer(4.0, print)")
        came, until_deadline_s = await wait(10.0)
        assert not came, run.trace()
        assert 7.0 <= until_deadline_s < 60.0


DEAF = """
def wait(request, response):
    threading.Event().wait()

node.create_service(AddTwoInts, "deaf", wait)
"""


async def test_a_call_ends_once_the_node_is_idle_but_not_while_it_waits_for_us(
    scene: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tutor.engine.waits.count_dropped_datagrams", lambda: 5)  # nothing was lost
    async with scene.bench(node(DEAF)).start(FILE) as run:
        await wait_for_service(run, "/deaf")
        for waits_for_us_s in (0.0, 4.0):
            until = time.monotonic() + waits_for_us_s
            answer = await run.call(
                "/deaf",
                ADD,
                {"a": 1},
                limit_s=LONG_S,
                all_sent=lambda: time.monotonic() >= until,  # noqa: B023
            )
            assert answer.response is None
            assert waits_for_us_s <= answer.took_s < LONG_S

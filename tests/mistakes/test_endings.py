"""Programs that go on after Ctrl+C, or end with the wrong exit code: what in their code shows why."""

from __future__ import annotations

import pytest

from tutor.judge.symptom import Symptom
from tutor.judge.trace import Ending, Exit, OutputLine, Trace
from tutor.judge.tracebacks import Frame, Traceback
from tutor.mistakes import CATALOGUE, why
from tutor.mistakes.diagnosis import Diagnosis

SPIN = """
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
rclpy.try_shutdown()
"""
HANDLE = "signal.signal(signal.SIGINT, lambda *_: stop.set())\n"
LOOP = "def watch():\n    while True:\n        {}\n"
SLEEP = "time.sleep(1)"
START = "Thread(target=watch{}).start()\n"


def going_on(source: str, **others: str) -> Diagnosis:
    sources = {"node.py": source, **{f"{name}.py": text for name, text in others.items()}}
    ending = Ending(None, 5.0, 5.0)
    seen = Symptom.DOES_NOT_END.seen(Trace("node.py", "/ws", sources=sources), ending=ending, raised=None)
    return why(seen, [CATALOGUE])


def ended(source: str, *, code: int | None = 1, signal: int | None = None, err: str = "") -> Diagnosis:
    output = tuple(OutputLine("stderr", line, 0.0) for line in err.splitlines())
    ending = Ending(Exit(code if signal is None else None, signal, 2.0), 0.1, 5.0, output)
    trace = Trace("node.py", "/ws", sources={"node.py": source})
    return why(Symptom.ENDS_BADLY.seen(trace, ending=ending, raised=None), [CATALOGUE])


@pytest.mark.parametrize(
    ("source", "mistake"),
    [
        (SPIN, "does-not-end"),
        ("def broken(", "does-not-end"),
        (f"signal.signal(signal.SIGINT, signal.SIG_IGN){SPIN}", "sigint-ignored"),
        (f"signal.signal(signal.SIGTERM, signal.SIG_IGN){SPIN}", "does-not-end"),
        (f"for each in SIGNALS:\n    signal.signal(each, signal.SIG_IGN){SPIN}", "sigint-ignored"),
        (f"signal.signal(signal.SIGINT, lambda *args: print('no')){SPIN}", "sigint-ignored"),
        (f"signal.signal(signal.SIGINT, lambda *args: rclpy.shutdown()){SPIN}", "does-not-end"),
        (f"def pause(*_):\n    node.paused = True\nsignal.signal(signal.SIGINT, pause){SPIN}", "sigint-ignored"),
        (
            "def stop(*_):\n    global up\n    up = False\nsignal.signal(signal.SIGINT, stop)\nwhile up:\n    work()\n",
            "does-not-end",
        ),
        ("while True:\n    try:\n        rclpy.spin_once(node)\n    except:\n        pass\n", "interrupt-swallowed"),
        ("while True:\n    try:\n        spin_once()\n    except KeyboardInterrupt:\n        pass\n", "does-not-end"),
        ("while True:\n    try:\n        work()\n    except KeyboardInterrupt:\n        pass\n", "interrupt-swallowed"),
        ("while True:\n    try:\n        work()\n    except BaseException:\n        break\n", "does-not-end"),
        ("while rclpy.ok():\n    try:\n        work()\n    except:\n        pass\n", "does-not-end"),
        (SPIN.replace("pass", "time.sleep(8)"), "too-slow-to-end"),
        (SPIN.replace("pass", "time.sleep(0.1)"), "does-not-end"),
        (f"time.sleep(8){SPIN}", "does-not-end"),
        (LOOP.format(SLEEP) + START.format("") + SPIN, "thread-goes-on"),
        (LOOP.format(SLEEP) + START.format(", daemon=True") + SPIN, "does-not-end"),
        (LOOP.format(SLEEP) + "t = Thread(target=watch)\nt.daemon = True\nt.start()\n" + SPIN, "does-not-end"),
        (LOOP.format(f"if done:\n            return\n        {SLEEP}") + START.format("") + SPIN, "does-not-end"),
        (LOOP.format("pub.publish(msg)") + START.format("") + SPIN, "does-not-end"),
        (LOOP.format("jobs.get()") + "pool.submit(watch)\n" + SPIN, "thread-goes-on"),
        (f"Thread(target=time.sleep, args=(30,)).start()\n{SPIN}", "thread-goes-on"),
        (f"Thread(target=time.sleep, args=(1,)).start()\n{SPIN}", "does-not-end"),
        (f"class Watch(Thread):\n    def run(self):\n        while True:\n            {SLEEP}\n", "thread-goes-on"),
        (
            "class Watch(Thread):\n    def __init__(self):\n        super().__init__(daemon=True)\n"
            f"    def run(self):\n        while True:\n            {SLEEP}\n",
            "does-not-end",
        ),
        (
            "async def main():\n    loop = asyncio.get_running_loop()\n"
            "    spinning = loop.run_in_executor(None, executor.spin)\n    await stop.wait()\n"
            "    await spinning\n    rclpy.try_shutdown()\n",
            "waits-for-the-spin-before-the-shutdown",
        ),
        (
            f"{HANDLE}s = pool.submit(rclpy.spin, node)\ns.result()\nrclpy.shutdown()\n",
            "waits-for-the-spin-before-the-shutdown",
        ),
        ("s = pool.submit(rclpy.spin, node)\ns.result()\nrclpy.shutdown()\n", "does-not-end"),
        (f"{HANDLE}s = pool.submit(rclpy.spin, node)\nrclpy.shutdown()\ns.result()\n", "does-not-end"),
    ],
)
def test_what_goes_on_after_ctrl_c(source: str, mistake: str) -> None:
    assert going_on(source).mistake == mistake


def test_a_thread_of_another_file() -> None:
    found = going_on(
        SPIN, watch="class Watch(Thread):\n    def run(self):\n        while True:\n            sleep(1)\n"
    )
    assert (found.mistake, found.file, found.line) == ("thread-goes-on", "watch.py", 3)


@pytest.mark.parametrize(
    ("source", "code", "line"),
    [
        ("sys.exit(1)", 1, 1),
        ("sys.exit('bye')", 1, 1),
        ("sys.exit(True)", 1, 1),
        ("sys.exit(1)", 3, 0),
        ("sys.exit(0)", 1, 0),
        ("raise SystemExit(3)", 3, 1),
        ("sys.exit()", 1, 0),
        ("def main():\n    return robot.run()\n\nsys.exit(main())", 1, 4),
        ("def main():\n    robot.run()\n\nsys.exit(main())", 1, 0),
        ("def main():\n    return main()\n\nsys.exit(main())", 1, 4),
        (
            "if bad:\n    sys.exit(2)\ndef end(number, _):\n    sys.exit(number)\nsignal.signal(signal.SIGINT, end)",
            2,
            4,
        ),
    ],
)
def test_where_an_exit_code_comes_from(source: str, code: int, line: int) -> None:
    found = ended(source, code=code)
    assert (found.mistake, found.line) == ("non-zero-exit", line)


def test_a_crash_is_told_where_the_program_aborts() -> None:
    dump = "Thread 0x1 (most recent call first):\n{}Current thread 0x2 (most recent call first):\n{}"
    err = dump.format('  File "/ws/node.py", line 1 in tick\n', '  File "/ws/node.py", line 2 in end\n')
    assert ended("sleep(1)\nos.abort()\n", signal=6, err=err).line == 2
    assert ended("sleep(1)\nsleep(2)\n", signal=6, err=err).line == 1


@pytest.mark.parametrize(
    ("code", "step"),
    [
        ("raise RuntimeError('interrupted')", "Let it end there without an exception"),
        ("self.bell.ring()", "Change line 7 of node.py"),
        ("", "last lines of the output"),
    ],
)
def test_the_step_for_an_exception_while_the_program_ends(code: str, step: str) -> None:
    frames = (Frame("/ws/node.py", 7, "end", code),) if code else ()
    trace = Trace("node.py", "/ws", sources={"node.py": "\n" * 6 + code})
    raised = Traceback("RuntimeError", "interrupted", frames)
    assert step in why(Symptom.ENDS_BADLY.seen(trace, raised=raised), [CATALOGUE]).step


@pytest.mark.parametrize(
    ("frames", "step"),
    [
        ((("node.py", "<module>", "main()"), ("node.py", "main", "rclpy.spin(node)")), "around the spin"),
        (
            (("node.py", "<module>", "main()"), ("node.py", "main", "wait()"), ("node.py", "wait", "sleep(1)")),
            "around line 2",
        ),
        ((("node.py", "<module>", "sleep(1)"),), "around line 1"),
        ((("threading.py", "run", ""), ("executors.py", "spin", "")), "Give the thread a function"),
    ],
)
def test_where_to_catch_what_ctrl_c_raises(frames: tuple[tuple[str, str, str], ...], step: str) -> None:
    folders = {"node.py": "/ws"}
    called = tuple(
        Frame(f"{folders.get(file, '/lib')}/{file}", number, function, code)
        for number, (file, function, code) in enumerate(frames, 1)
    )
    raised = Traceback("KeyboardInterrupt", "", called)
    seen = Symptom.ENDS_BADLY.seen(Trace("node.py", "/ws"), raised=raised)
    assert step in why(seen, [CATALOGUE]).step

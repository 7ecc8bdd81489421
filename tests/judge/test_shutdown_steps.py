"""Steps for a process that does not end cleanly on Ctrl+C, in terms of the learner's own file."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.checks.builders import FOLDER, trace
from tutor.judge import shutdown_steps
from tutor.judge.trace import Trace
from tutor.judge.tracebacks import Frame


def node(source: str) -> Trace:
    return replace(trace(), sources={"node.py": source})


BOTH = "except (KeyboardInterrupt, ExternalShutdownException):"
IMPORT = "at the top of the file: from rclpy.executors import ExternalShutdownException"
MAIN = """\
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node


class Talker(Node):
    pass


def main():
    rclpy.init()
    node = Talker("talker")
    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()


main()
"""


def changed(*pairs: tuple[str, str]) -> Trace:
    code = MAIN
    for old, new in pairs:
        assert old in code
        code = code.replace(old, new)
    return node(code)


@pytest.mark.parametrize(
    ("pairs", "steps"),
    [
        ((("rclpy.try_shutdown", "rclpy.shutdown"),), ("line 18 becomes: rclpy.try_shutdown()",)),
        (
            ((BOTH, "except KeyboardInterrupt:"), ("from rclpy.executors import ExternalShutdownException\n", "")),
            (f"line 14 becomes: {BOTH}", IMPORT),
        ),
        (((BOTH, "except ExternalShutdownException as end:"),), (f"line 15 becomes: {BOTH[:-1]} as end:",)),
        (
            (
                (
                    "    try:\n        rclpy.spin(node)\n    " + BOTH + "\n        pass\n    finally:\n        ",
                    "    rclpy.spin(node)\n    ",
                ),
            ),
            (f"line 13 becomes:\n    try:\n        rclpy.spin(node)\n    {BOTH}\n        pass",),
        ),
        (((BOTH, "except ValueError:"),), (BOTH,)),
    ],
)
def test_the_exceptions_that_end_a_spin_are_caught(pairs: tuple[tuple[str, str], ...], steps: tuple[str, ...]) -> None:
    step = shutdown_steps.catch_interrupt(changed(*pairs))
    assert all(each in step for each in steps)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("        rclpy.try_shutdown()\n", "        rclpy.try_shutdown()\n        time.sleep(9)\n"),
        ("        pass\n    finally", "        os.abort()\n    finally"),
        ("        rclpy.try_shutdown()\n", "        rclpy.try_shutdown()\n    sys.exit(3)\n"),
        ("    try:\n", "    signal.signal(signal.SIGINT, signal.SIG_IGN)\n    try:\n"),
        ("    try:\n", "    Thread(target=watch).start()\n    try:\n"),
        ("        rclpy.spin(node)\n", "        while True:\n            rclpy.spin_once(node)\n"),
    ],
)
def test_main_is_rewritten_as_a_whole(old: str, new: str) -> None:
    step = shutdown_steps.allow_interrupt(changed((old, new)))
    assert step.endswith(
        f"    try:\n        rclpy.spin(node)\n    {BOTH}\n        pass\n    finally:\n        rclpy.try_shutdown()"
    )
    assert not any(each in step for each in ("sleep", "abort", "exit", "signal", "Thread", "while"))


def test_a_thread_started_by_the_node_becomes_a_daemon() -> None:
    kept = changed(("    pass\n\n\ndef", "    def __init__(self):\n        Thread(target=self.watch).start()\n\n\ndef"))
    assert "line 8 becomes: Thread(target=self.watch, daemon=True).start()" in shutdown_steps.allow_interrupt(kept)


@pytest.mark.parametrize(
    ("loop", "given", "thread"),
    [
        ("while True:\n            self.jobs.get()", "", "Thread(target=self.work, daemon=True).start()"),
        ("while True:\n            self.jobs.get()", ", 3", "Thread(target=self.work, args=(3,), daemon=True).start()"),
        ("while True:\n            return self.jobs.get()", "", ""),
        ("while self.running:\n            self.jobs.get()", "", ""),
    ],
)
def test_endless_work_of_a_pool_becomes_a_daemon(loop: str, given: str, thread: str) -> None:
    start = f"    def start(self):\n        self.pool.submit(self.work{given})\n\n"
    pool = f"class Pool:\n{start}    def work(self):\n        {loop}\n\n\ndef main"
    kept = changed(("def main", pool))
    step = shutdown_steps.allow_interrupt(kept)
    if thread:
        assert f"becomes: {thread}" in step
        assert "from threading import Thread" in step
    else:
        assert "Thread(" not in step


@pytest.mark.parametrize(
    ("started", "wait"),
    [
        ("loop.run_in_executor(None, executor.spin)", "await spinning"),
        ("Thread(target=rclpy.spin, args=(node,))", "spinning.join()"),
        ("pool.submit(rclpy.spin, node)", "spinning.result()"),
    ],
)
def test_the_spin_is_ended_before_the_program_waits_for_it(started: str, wait: str) -> None:
    main = f"async def main():\n    spinning = {started}\n    await stop.wait()\n    {wait}\n    rclpy.try_shutdown()\n"
    step = shutdown_steps.allow_interrupt(node(main))
    assert step == (
        "remove line 5: rclpy.try_shutdown()\nwrite above line 4, with the same indentation: rclpy.try_shutdown()"
    )


def test_a_thread_that_a_mixin_starts_becomes_a_daemon() -> None:
    made = "Thread(\n            target=self.watch, name='w'\n        )\n"
    started = f"        self.thread = {made}        self.thread.start()\n"
    mixin = f"class Watch:\n    def start(self):\n{started}\n\ndef main"
    step = shutdown_steps.allow_interrupt(changed(("def main", mixin)))
    assert "target=self.watch, name='w',\n    daemon=True)" in step


def test_a_subclass_of_thread_becomes_a_daemon() -> None:
    watch = "class Watch(Thread):\n    def __init__(self):\n        super().__init__(name='w')\n\n\n"
    kept = changed(("def main", f"{watch}def main"))
    assert "super().__init__(name='w', daemon=True)" in shutdown_steps.allow_interrupt(kept)


def test_a_thread_of_another_file_becomes_a_daemon_if_the_program_catches_ctrl_c() -> None:
    watch = "class Watch(Thread):\n    def __init__(self):\n        super().__init__(name='w')\n"
    program = node(MAIN)
    kept = replace(program, sources={**program.sources, "watch.py": watch})
    step = shutdown_steps.allow_interrupt(kept)
    assert step == "in watch.py, line 3 becomes: super().__init__(name='w', daemon=True)"
    deaf = replace(kept, sources={program.file: "while True:\n    pass\n", "watch.py": watch})
    assert "watch.py" not in shutdown_steps.allow_interrupt(deaf)


def test_a_correct_program_is_not_rewritten() -> None:
    assert shutdown_steps.allow_interrupt(node(MAIN)).startswith("let KeyboardInterrupt end the program")
    assert shutdown_steps.exit_with_zero(node("def broken(")).startswith("return normally")


def test_the_line_that_raises_is_removed() -> None:
    broken = Frame(f"{FOLDER}/node.py", 7, "slow_add", "raise RuntimeError('interrupted')")
    raising = changed(
        ("    pass\n\n\ndef", "    def slow_add(self):\n        raise RuntimeError('interrupted')\n\n\ndef")
    )
    assert shutdown_steps.remove_line(raising, replace(broken, line=8)) == "line 8 becomes: return"
    assert "stop before that" in shutdown_steps.remove_line(node(MAIN), None)


def test_a_spin_that_is_the_target_of_a_thread_is_caught() -> None:
    source = MAIN.replace(
        "    try:", "    spinner = threading.Thread(target=rclpy.spin, args=(node,))\n    spinner.start()\n    try:"
    ).replace("        rclpy.spin(node)", "        spinner.join()")
    step = shutdown_steps.catch_interrupt(node(source))
    for words in (
        "def spin_until_shutdown(*arguments, spin=rclpy.spin):",
        "spin(*arguments)",
        "except ExternalShutdownException:",
        "spinner = threading.Thread(target=spin_until_shutdown, args=(node,))",
    ):
        assert words in step


def test_a_spin_in_an_imported_file_is_caught_there() -> None:
    base = "class Base(Node):\n    def run(self):\n        rclpy.spin(self)\n"
    run = replace(trace(), file="node.py", sources={"base.py": base, "node.py": MAIN})
    assert shutdown_steps.catch_interrupt(run).startswith("in base.py, ")


def test_what_main_does_when_it_is_interrupted_is_guarded() -> None:
    source = MAIN.replace("        rclpy.spin(node)", "        wait()").replace(BOTH, "except ValueError:")
    line = source[: source.index("wait()")].count("\n") + 1
    called = Frame(f"{FOLDER}/node.py", 30, "<module>", "main()"), Frame(f"{FOLDER}/node.py", line, "main", "wait()")
    step = shutdown_steps.catch_interrupt(node(source), (*called, Frame(f"{FOLDER}/node.py", 3, "wait", "sleep(1)")))
    assert step == (f"line {line} becomes:\n    try:\n        wait()\n    except KeyboardInterrupt:\n        pass")


@pytest.mark.parametrize(
    ("old", "new", "joined"),
    [
        ("spinner.start()\n", "spinner.start()\n", "    try:\n        spinner.join()\n    except KeyboardInterrupt:\n"),
        (
            "spinner.start()\n",
            "try:\n        spinner.start()\n    except KeyboardInterrupt:\n        rclpy.try_shutdown()\n",
            ": spinner.join()",
        ),
        (
            "spinner.start()\n",
            "for each in [spinner]:\n        each.start()\n",
            "    try:\n        for each in [spinner]:\n            each.join()\n    except KeyboardInterrupt:\n",
        ),
        ("spinner.start()\n", "spinner.daemon = True\n", "wait for each thread at the end of main()"),
    ],
)
def test_threads_are_waited_for(old: str, new: str, joined: str) -> None:
    source = "def main():\n    spinner = Thread(target=spin, args=(Node('a'),))\n    spinner.start()\nmain()\n"
    assert joined in shutdown_steps.wait_for_threads(node(source.replace(old, new)))


@pytest.mark.parametrize("end", ["sys.exit(main())", "raise SystemExit(main())"])
def test_a_program_no_longer_exits_with_what_main_returns(end: str) -> None:
    source = f"def main():\n    robot = Robot()\n    return robot.run()\n\n\n{end}\n"
    assert shutdown_steps.exit_with_zero(node(source)) == "line 6 becomes: main()"
    nothing = source.replace("return robot.run()", "robot.run()")
    assert "line 6" not in shutdown_steps.exit_with_zero(node(nothing))

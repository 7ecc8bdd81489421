"""How a learner's process is started, watched and interrupted."""

from __future__ import annotations

import asyncio
import os
import resource
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tutor.errors import StartError
from tutor.judge.trace import Exit
from tutor.process import CpuMeter, LearnerProcess, pipe
from tutor.process.output import LINE_CHARACTERS

LIMIT_S = 20.0


def texts(learner: LearnerProcess, stream: str = "stdout") -> list[str]:
    return [line.text for line in learner.output if line.stream == stream]


async def wait_for_exit(learner: LearnerProcess) -> Exit:
    found = await learner.wait(LIMIT_S)
    assert found is not None, "the process did not end"
    return found


@pytest.mark.parametrize("code", [0, 130, 255])
async def test_the_exit_code_is_reported(bench: Any, code: int) -> None:
    learner = await bench.start(f"sys.exit({code})")
    found = await wait_for_exit(learner)
    assert (found.code, found.signal) == (code, None)
    assert 0 < found.after_s < LIMIT_S
    assert learner.exit == found
    assert abs(time.time() - learner.started_at) < LIMIT_S


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGSEGV, signal.SIGKILL])
async def test_a_fatal_signal_is_reported(bench: Any, number: signal.Signals) -> None:
    found = await wait_for_exit(await bench.start(f"os.kill(os.getpid(), {int(number)}); forever()"))
    assert (found.code, found.signal) == (None, number)


async def test_output_is_complete_when_the_exit_is_known(bench: Any) -> None:
    for _ in range(10):
        learner = await bench.start(
            "print('a\\n' * 5000 + 'last'); print('oops', file=sys.stderr); os._exit(sys.stdout.flush() or 7)"
        )
        assert (await wait_for_exit(learner)).code == 7
        assert texts(learner)[-1] == "last"
        assert texts(learner, "stderr") == ["oops"]
        assert len(texts(learner)) + learner.dropped_lines == 5001


async def test_output_written_right_before_the_exit_is_complete_at_the_exit(bench: Any, tmp_path: Path) -> None:
    learner = await bench.start(
        """
print('first', flush=True)
while not os.path.exists('go'): pass
print('last', flush=True)
os._exit(0)
""",
        on_change=(tmp_path / "go").touch,
    )
    await wait_for_exit(learner)
    assert texts(learner) == ["first", "last"]


async def test_stdout_and_stderr_keep_their_order(bench: Any) -> None:
    source = "for n in range(300): print(n, flush=True); print(n, file=sys.stderr, flush=True)"
    learner = await bench.start(source)
    await wait_for_exit(learner)
    order = {(line.stream, line.text): index for index, line in enumerate(learner.output)}
    assert len(order) == 600
    assert [n for n in range(300) if order["stdout", str(n)] > order["stderr", str(n)]] == []


async def test_an_unfinished_last_line_is_included(bench: Any) -> None:
    learner = await bench.start("sys.stdout.write('whole\\nhalf'); sys.stdout.flush(); forever()")
    await wait_until(lambda: texts(learner) == ["whole", "half"])
    assert learner.exit is None


async def test_on_change_is_called_for_output_and_exit(bench: Any) -> None:
    seen: list[tuple[int, bool]] = []
    changed = asyncio.Event()
    holder: list[LearnerProcess] = []

    def on_change() -> None:
        if holder:
            seen.append((len(holder[0].output), holder[0].exit is not None))
        changed.set()

    learner = await bench.start("print('hello', flush=True); sys.stdin.read(); forever()", on_change=on_change)
    holder.append(learner)
    await wait_until(lambda: texts(learner) == ["hello"])
    assert changed.is_set()
    learner.interrupt()
    await wait_for_exit(learner)
    await wait_until(lambda: seen and seen[-1][1])


async def test_ctrl_c_after_the_end_did_not_reach_the_program(bench: Any) -> None:
    # The child keeps the process group alive, so the signal itself is sent.
    child = await bench.start("""
if os.fork() == 0:
    signal.signal(signal.SIGINT, lambda *_: print('got it', flush=True))
    print('up', flush=True)
    forever()
""")
    await wait_until(lambda: texts(child) == ["up"])
    await wait_for_exit(child)
    child.interrupt()
    await wait_until(lambda: "got it" in texts(child))
    assert not child.interrupted
    running = await bench.start("print('up', flush=True); forever()")
    await wait_until(lambda: texts(running) == ["up"])
    running.interrupt()
    await wait_for_exit(running)
    assert running.interrupted


async def test_the_program_starts_with_a_clean_session_and_clean_signals(bench: Any, tmp_path: Path) -> None:
    learner = await bench.start(
        """
print(os.getpid(), os.getpgid(0), os.getsid(0))
print(sys.stdin.read() == '', os.getcwd(), sorted(set(os.environ) - {'LC_CTYPE'}))
print([int(s) for s in signal.valid_signals() if signal.getsignal(s) is signal.SIG_IGN])
print([int(s) for s in signal.pthread_sigmask(signal.SIG_BLOCK, [])], sorted(os.listdir('/proc/self/fd')))
status = dict(line.split(':\\t', 1) for line in open('/proc/self/status').read().splitlines() if ':\\t' in line)
print(status['SigBlk'].strip())
"""
    )
    await wait_for_exit(learner)
    ids, surroundings, ignored, blocked, mask = texts(learner)
    assert ids.split() == [str(learner.pid)] * 3
    assert surroundings == f"True {tmp_path} ['PATH', 'ROS_TUTOR_RUN', 'TEST_TOKEN']"
    # Python itself ignores SIGPIPE and SIGXFSZ.
    assert ignored == str([int(signal.SIGPIPE), int(signal.SIGXFSZ)])
    assert blocked == "[] ['0', '1', '2', '3']"  # 3 is the listing itself
    assert int(mask, 16) == 0


async def test_sigint_can_be_handled(bench: Any) -> None:
    learner = await bench.start("""
try:
    note('main'); forever()
except KeyboardInterrupt:
    print('bye'); sys.exit(4)
""")
    await bench.noted_pid("main")
    learner.interrupt()
    assert (await wait_for_exit(learner)).code == 4
    assert texts(learner) == ["bye"]


async def test_sigint_by_default_kills(bench: Any) -> None:
    learner = await bench.start("signal.signal(signal.SIGINT, signal.SIG_DFL); note('main'); forever()")
    await bench.noted_pid("main")
    learner.interrupt()
    assert (await wait_for_exit(learner)).signal == signal.SIGINT


async def test_a_program_that_ignores_sigint_is_killed_at_the_end(bench: Any) -> None:
    learner = await bench.start("""
heard = []
signal.signal(signal.SIGINT, lambda *_: print('no', flush=True))
signal.signal(signal.SIGTERM, signal.SIG_IGN)
note('main'); forever()
""")
    await bench.noted_pid("main")
    learner.interrupt()
    await wait_until(lambda: texts(learner) == ["no"])
    assert await learner.wait(0.05) is None
    await learner.end()
    assert learner.exit is not None
    assert learner.exit.signal == signal.SIGKILL


async def test_sigint_goes_to_the_process_group_only(bench: Any) -> None:
    learner = await bench.start("""
if os.fork() == 0:
    signal.signal(signal.SIGINT, lambda *_: os._exit(0)); note('same_group'); forever()
if os.fork() == 0:
    os.setsid()
    signal.signal(signal.SIGINT, lambda *_: os._exit(0)); note('own_session'); forever()
signal.signal(signal.SIGINT, lambda *_: print('main', flush=True))
note('main'); forever()
""")
    await bench.noted_pid("main")
    same, own = await bench.noted_pid("same_group"), await bench.noted_pid("own_session")
    learner.interrupt()
    await wait_until(lambda: texts(learner) == ["main"] and same not in bench.leftovers())
    assert own in bench.leftovers()


async def test_interrupt_reaches_group_members_left_by_the_exited_main_process(bench: Any) -> None:
    learner = await bench.start("""
if os.fork() == 0:
    signal.signal(signal.SIGINT, lambda *_: os._exit(0)); note('left'); forever()
while not os.path.exists('left'): time.sleep(0.001)
""")
    left = await bench.noted_pid("left")
    await wait_for_exit(learner)
    assert [s.pid for s in learner.survivors()] == [left]
    learner.interrupt()
    await wait_until(lambda: left not in bench.leftovers())
    assert learner.survivors() == []


async def test_an_ignored_sigint_is_not_inherited(bench: Any) -> None:
    learner_argv = bench.script("""
try:
    print('ready', flush=True); forever()
except KeyboardInterrupt:
    sys.exit(42)
""")
    helper = bench.script(
        f"""
import asyncio
from pathlib import Path
from tutor.process import LearnerProcess
assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
async def main():
    ready = asyncio.Event()
    start = LearnerProcess.start({learner_argv!r}, env={bench.env!r}, cwd=Path('.'), on_change=ready.set)
    async with await start as learner:
        await asyncio.wait_for(ready.wait(), 20)
        learner.interrupt()
        print(await learner.wait(20))
asyncio.run(main())
""",
        flags=(),
    )
    done = await asyncio.to_thread(
        subprocess.run,
        ["sh", "-c", 'trap "" INT; exec "$0" "$@"', *helper],
        env=bench.helper_env,
        cwd=bench.folder,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.stdout.strip(), done.stderr) == ("exit code 42", "")


@pytest.mark.parametrize(
    ("argv", "folder", "message"),
    [
        (["/no/such/program"], None, "No such file or directory"),
        (["no-such-program-anywhere"], None, "no-such-program-anywhere: No such file or directory"),
        (["/etc/passwd"], None, "Permission denied"),
        ([sys.executable], "/no/such/folder", "/no/such/folder: No such file or directory"),
        (["a\0b"], None, "NUL"),
        ([], None, "empty"),
        ([sys.executable, "x" * 200_000], None, "Argument list too long"),
    ],
)
async def test_a_failed_start_says_why(bench: Any, argv: list[str], folder: str | None, message: str) -> None:
    with pytest.raises(StartError, match=message) as caught:
        await LearnerProcess.start(argv, env=bench.env, cwd=Path(folder or bench.folder))
    assert str(caught.value).endswith(".")


async def test_a_missing_python_for_the_supervisor_is_named(bench: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", "/no/such/python")
    with pytest.raises(StartError, match="/no/such/python"):
        await bench.start("pass")


async def test_a_supervisor_that_fails_at_once_says_why(
    bench: Any, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    broken = tmp_path / "broken.py"
    broken.write_text("raise SystemExit('this machine is odd')")
    monkeypatch.setattr("tutor.process.spawner._SUPERVISOR", broken)
    with pytest.raises(StartError, match="this machine is odd"):
        await bench.start("pass")


async def test_endless_printing_costs_little_cpu_and_memory(bench: Any) -> None:
    learner = await bench.start("while True: print('x' * 80)")
    before, memory = time.process_time(), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = time.monotonic()
    assert await learner.wait(1.5) is None
    share = (time.process_time() - before) / (time.monotonic() - start)
    assert share < 0.25
    assert len(learner.output) <= 1001
    assert learner.dropped_lines > 10_000
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - memory < 30_000  # KiB
    await learner.end()


async def test_a_program_that_prints_endlessly_is_throttled(bench: Any) -> None:
    learner = await bench.start("while True: print('x')")
    await wait_until(lambda: learner.dropped_lines > 200_000)  # its burst allowance is used up
    meter = CpuMeter(learner.pid)
    before, start = meter.read().ran_s, time.monotonic()
    assert await learner.wait(1.5) is None
    assert (meter.read().ran_s - before) / (time.monotonic() - start) < 0.3


async def test_a_large_table_is_printed_without_throttling(bench: Any) -> None:
    learner = await bench.start("""
start = time.monotonic()
for row in range(30_000): print(row, 'x' * 50, flush=True)
print(time.monotonic() - start, file=sys.stderr)
""")
    assert (await wait_for_exit(learner)).code == 0
    assert len(texts(learner)) + learner.dropped_lines == 30_000
    # Throttled, the program would take at least this long.
    assert float(texts(learner, "stderr")[0]) < 30_000 * (50 + pipe.LINE_BYTES) / pipe.MAX_PER_S


async def test_output_after_a_flood_is_not_delayed(bench: Any) -> None:
    learner = await bench.start("""
for _ in range(150_000): print('x')
print('last', file=sys.stderr)
forever()
""")
    await wait_until(lambda: texts(learner, "stderr") == ["last"])
    assert learner.dropped_lines > 100_000  # all but the contents of the pipe has been read by now
    await learner.end()


async def test_an_endless_line_is_truncated(bench: Any) -> None:
    learner = await bench.start("while True: sys.stdout.write('y' * 100_000)")
    assert await learner.wait(0.3) is None
    await learner.end()
    assert texts(learner) == ["y" * LINE_CHARACTERS]


async def test_binary_output_is_accepted(bench: Any) -> None:
    learner = await bench.start("sys.stdout.buffer.write(bytes(range(256)) * 1000)")
    assert (await wait_for_exit(learner)).code == 0
    assert len(texts(learner)) + learner.dropped_lines == 1001


async def test_output_held_open_by_a_grandchild_does_not_delay_the_exit(bench: Any) -> None:
    learner = await bench.start("""
if os.fork() == 0:
    note('flood')
    while True: os.write(1, b'z' * 79 + b'\\n')
while not os.path.exists('flood'): time.sleep(0.001)
print('mine', file=sys.stderr)
""")
    flood = await bench.noted_pid("flood")
    found = await wait_for_exit(learner)
    assert found.code == 0
    assert texts(learner, "stderr") == ["mine"]
    dropped = learner.dropped_lines
    await wait_until(lambda: learner.dropped_lines > dropped + 10_000)  # reading continues
    assert [s.pid for s in learner.survivors()] == [flood]


async def wait_until(condition: Callable[[], object]) -> None:
    deadline = time.monotonic() + LIMIT_S
    while not condition():
        assert time.monotonic() < deadline
        await asyncio.sleep(0.002)


async def test_a_program_does_not_write_to_our_stdout(bench: Any, capfd: pytest.CaptureFixture[str]) -> None:
    await wait_for_exit(await bench.start("os.system('echo hidden; echo hidden >&2')"))
    assert capfd.readouterr() == ("", "")


async def test_many_programs_run_at_once(bench: Any) -> None:
    learners = await asyncio.gather(*(bench.start(f"print({n}); sys.exit({n})") for n in range(8)))
    for n, learner in enumerate(learners):
        assert (await wait_for_exit(learner)).code == n
        assert texts(learner) == [str(n)]


async def test_wait_works_with_and_without_a_limit(bench: Any) -> None:
    learner = await bench.start("note('main'); forever()")
    assert await learner.wait(0.01) is None
    waiting = asyncio.ensure_future(learner.wait(None))
    os.kill(await bench.noted_pid("main"), signal.SIGTERM)
    assert str(await waiting) == "signal 15"


async def test_a_program_on_a_terminal_can_be_interrupted(bench: Any) -> None:
    # Polled: Ctrl+C right before a `readline` would set a flag of Python's and leave it to wait for a line, as on any
    # terminal.
    script = """
import select
os.isatty(0) and print('terminal', flush=True)
while not select.select([0], [], [], 0.1)[0]: pass
print('input', repr(sys.stdin.readline()))
"""
    learner = await bench.start(script, terminal=True)
    await bench.until(lambda: texts(learner) == ["terminal"], "the terminal to be seen")
    learner.interrupt()
    assert (await wait_for_exit(learner)).signal == signal.SIGINT

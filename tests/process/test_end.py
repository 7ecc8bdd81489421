"""Whatever a learner's process does, and whatever happens to us, none of its processes survive."""

from __future__ import annotations

import asyncio
import os
import signal
import time
from typing import Any

import pytest

from tutor.errors import EndError
from tutor.process import LearnerProcess
from tutor.process.process_table import descendants, processes

CHILD = "if os.fork() == 0:\n    note('child'); forever()\nnote('main'); forever()\n"
STUBBORN = """
for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT): signal.signal(number, signal.SIG_IGN)
if os.fork() == 0:
    note('child'); forever()
note('main'); forever()
"""
DAEMON = """
def daemon():
    if os.fork(): return
    os.setsid()
    between = os.getpid()
    if os.fork(): os._exit(0)
    while os.getppid() == between: time.sleep(0.001)
    {before}
    note('child'); forever()
daemon()
note('main'); forever()
"""
FILES_CLOSED = "os.closerange(0, 100)"
# An exec with an empty environment removes the marker variable.
BARE = """os.execve(sys.executable, [sys.executable, '-I', '-S', '-c',
        'import os, time; open("x", "w").write(str(os.getpid())); os.rename("x", "child"); time.sleep(1000)'], {})"""
BARE_CHILD = f"if os.fork() == 0:\n    {BARE}\nnote('main'); forever()\n"
BARE_CHILD_WITHOUT_FILES = BARE_CHILD.replace(BARE, f"{FILES_CLOSED}; {BARE}")
BARE_DAEMON = DAEMON.format(before=BARE)
# Without environment, files or session, only its ancestry identifies this process.
UNMARKED_DAEMON = DAEMON.format(before=f"{FILES_CLOSED}; {BARE}")
STOPPED = """
if os.fork() == 0:
    note('child'); os.kill(os.getpid(), signal.SIGSTOP)
note('main'); os.kill(os.getpid(), signal.SIGSTOP)
"""
DEEP = """
for depth in range(8):
    if os.fork(): break
else:
    note('child'); forever()
note('main') if depth == 0 else None
forever()
"""
SUBREAPER = """
import ctypes
ctypes.CDLL(None).prctl(36, 1, 0, 0, 0)
if os.fork() == 0:
    if os.fork() == 0:
        os.setsid(); note('child'); forever()
    os._exit(0)
note('main'); forever()
"""
CASES = {
    "child": CHILD,
    "stubborn": STUBBORN,
    "daemon": DAEMON.format(before="pass"),
    "daemon with closed files": DAEMON.format(before=FILES_CLOSED),
    "child with an empty environment": BARE_CHILD,
    "child with nothing but its session": BARE_CHILD_WITHOUT_FILES,
    "daemon with an empty environment": BARE_DAEMON,
    "unmarked daemon": UNMARKED_DAEMON,
    "stopped": STOPPED,
    "deep": DEEP,
    "subreaper": SUBREAPER,
}
CHAIN = """
note('chain')
while True:
    if os.fork(): os._exit(0)
    os.setsid()
"""
each_case = pytest.mark.parametrize("source", CASES.values(), ids=CASES.keys())


@each_case
async def test_end_leaves_no_process(bench: Any, source: str) -> None:
    learner = await bench.start(source)
    main, child = await bench.noted_pid("main"), await bench.noted_pid("child")
    assert main == learner.pid
    assert {main, child} <= {s.pid for s in learner.survivors()}
    start = time.monotonic()
    await learner.end()
    assert bench.leftovers() == []
    assert time.monotonic() - start < 2.0
    assert learner.exit is not None
    assert learner.exit.signal == signal.SIGKILL
    await learner.end()
    assert learner.survivors() == []


async def test_our_own_death_leaves_no_process(bench: Any) -> None:
    commands = {name: bench.script(source) for name, source in CASES.items()}
    for name in CASES:
        (bench.folder / name).mkdir()
    helper = bench.script(
        f"""
import asyncio
from pathlib import Path
from tutor.process import LearnerProcess
async def main():
    learners = [
        await LearnerProcess.start(command, env={bench.env!r}, cwd=Path(name))
        for name, command in {commands!r}.items()
    ]
    await asyncio.gather(*(learner.wait(None) for learner in learners))
asyncio.run(main())
""",
        flags=(),
    )
    process = await asyncio.create_subprocess_exec(*helper, env=bench.helper_env, cwd=bench.folder)
    for name in CASES:
        await bench.noted_pid(f"{name}/main")
        await bench.noted_pid(f"{name}/child")
    process.kill()
    await process.wait()
    await bench.all_gone()


async def test_our_own_death_ends_the_learner_even_if_a_fork_of_ours_lives_on(bench: Any) -> None:
    helper = await asyncio.create_subprocess_exec(
        *bench.helper(CHILD, then="if os.fork() == 0:\n    note('fork')\n    forever()"),
        env=bench.helper_env,
        cwd=bench.folder,
    )
    main, child = await bench.noted_pid("main"), await bench.noted_pid("child")
    fork = await bench.noted_pid("fork")
    helper.kill()
    await helper.wait()
    try:
        await bench.until(
            lambda: main not in bench.leftovers() and child not in bench.leftovers(),
            "the learner's processes to be gone",
        )
        assert fork in bench.leftovers()
    finally:
        os.kill(fork, signal.SIGKILL)
    await bench.all_gone()


async def test_our_own_death_at_any_moment_of_the_start_leaves_no_process(bench: Any) -> None:
    for step in range(6):
        helper = await asyncio.create_subprocess_exec(
            *bench.helper("note('main'); forever()", then="pass", before="note('helper')"),
            env=bench.helper_env,
            cwd=bench.folder,
        )
        await bench.noted_pid("helper")
        await asyncio.sleep(step * 0.01)  # not a wait for an event: each iteration kills at another moment
        helper.kill()
        await helper.wait()
        await bench.all_gone()
        for file in ("helper", "main"):
            (bench.folder / file).unlink(missing_ok=True)


async def test_a_surviving_grandchild_is_reported(bench: Any) -> None:
    learner = await bench.start("""
if os.fork() == 0:
    note('child'); forever()
zombie = os.fork()
if zombie == 0:
    os._exit(0)
os.waitid(os.P_PID, zombie, os.WEXITED | os.WNOWAIT)
while not os.path.exists('child'): time.sleep(0.001)
note('main')
""")
    child = await bench.noted_pid("child")
    found = await learner.wait(20)
    assert found is not None
    assert found.code == 0
    (survivor,) = learner.survivors()
    assert survivor.pid == child
    assert "learner_" in survivor.command
    assert child in bench.leftovers()
    await learner.end()
    assert bench.leftovers() == []
    assert learner.exit == found


async def test_zombies_are_not_survivors(bench: Any) -> None:
    learner = await bench.start("""
child = os.fork()
if child == 0: os._exit(0)
os.waitid(os.P_PID, child, os.WEXITED | os.WNOWAIT)
note('main'); forever()
""")
    main = await bench.noted_pid("main")
    assert [s.pid for s in learner.survivors()] == [main]


async def test_end_kills_every_process_of_a_fork_storm(bench: Any) -> None:
    learner = await bench.start("""
for n in range(50):
    if os.fork() == 0:
        if n % 2: os.setsid()
        if n % 3 == 0:
            between = os.getpid()
            if os.fork(): os._exit(0)
            while os.getppid() == between: time.sleep(0.001)
        note(f'child{n}'); forever()
note('main'); forever()
""")
    for n in range(50):
        await bench.noted_pid(f"child{n}")
    assert len(learner.survivors()) == 51
    await learner.end()
    assert bench.leftovers() == []


async def test_end_kills_a_process_that_keeps_forking_and_exiting(bench: Any) -> None:
    """Each process of a chain forks the next and exits, so none lives long enough to be listed.

    They all hold a pipe open; EOF on it shows that none is left.
    """
    os.mkfifo(bench.folder / "pipe")
    pipe = os.open(bench.folder / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    try:
        learner = await bench.start("""
held = os.open('pipe', os.O_WRONLY)
note('main')
while True:
    if os.fork(): os._exit(0)
    os.setsid()
""")
        await bench.noted_pid("main")
        await learner.wait(20)
        with pytest.raises(BlockingIOError):
            os.read(pipe, 1)
        await learner.end()
        assert os.read(pipe, 1) == b""
    finally:
        os.close(pipe)


async def test_a_chain_of_processes_is_ended_beside_many_others(bench: Any) -> None:
    """The more processes there are, the longer a scan of /proc takes, in which a chain goes on by many processes."""
    others = await bench.start("""
for n in range(500):
    if os.fork() == 0: time.sleep(1000)
note('others')
forever()
""")
    chain = await bench.start(CHAIN)
    for name in ("others", "chain"):
        await bench.noted_pid(name)
    start = time.monotonic()
    await chain.end()
    assert time.monotonic() - start < 3.0, "it took so long that the supervisor was killed"
    await others.end()
    assert bench.leftovers() == []


async def test_end_kills_a_process_that_restarts_its_killed_children(bench: Any) -> None:
    learner = await bench.start("""
note('main')
while True:
    child = os.fork()
    if child == 0:
        os.setsid(); note('child'); forever()
    os.waitpid(child, 0)
""")
    await bench.noted_pid("child")
    await learner.end()
    assert bench.leftovers() == []


async def test_leaving_the_context_manager_ends_the_process(bench: Any) -> None:
    async def check() -> None:
        async with await bench.start(CHILD):
            await bench.noted_pid("child")
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        await check()
    assert bench.leftovers() == []


async def test_cancellation_while_running_leaves_no_process(bench: Any) -> None:
    async def check() -> None:
        async with await bench.start(STUBBORN) as learner:
            await learner.wait(1000)

    task = asyncio.create_task(check())
    await bench.noted_pid("child")
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task
    assert bench.leftovers() == []


async def test_cancellation_while_ending_leaves_no_process(bench: Any) -> None:
    learner = await bench.start(STUBBORN)
    await bench.noted_pid("child")
    task = asyncio.create_task(learner.end())
    await asyncio.sleep(0)
    for _ in range(3):
        task.cancel()
        await asyncio.sleep(0)
    with pytest.raises(asyncio.CancelledError):
        await task
    assert bench.leftovers() == []


async def test_cancellation_while_starting_leaves_no_process(bench: Any) -> None:
    for turns in range(0, 40, 6):
        task = asyncio.create_task(bench.start(STUBBORN))
        for _ in range(turns):
            await asyncio.sleep(0.001)
            if task.done():
                break
        task.cancel()
        await asyncio.gather(task, return_exceptions=True)
        if not task.cancelled():
            await task.result().end()
        assert bench.leftovers() == []


def test_tearing_down_the_event_loop_leaves_no_process(bench_sync: Any) -> None:
    """On Ctrl+C, asyncio.run cancels every task and closes the loop."""

    async def check() -> None:
        async with await bench_sync.start(STUBBORN) as learner:
            await bench_sync.noted_pid("child")
            asyncio.get_running_loop().call_soon(os.kill, os.getpid(), signal.SIGINT)
            await learner.wait(1000)

    with pytest.raises(KeyboardInterrupt):
        asyncio.run(check())
    assert bench_sync.leftovers() == []


def alive(pid: int) -> bool:
    found = processes().get(pid)
    return found is not None and found.alive


async def find_supervisor(learner: LearnerProcess) -> int:
    return processes()[learner.pid].parent


@each_case
async def test_a_killed_supervisor_takes_the_program_with_it(bench: Any, source: str) -> None:
    learner = await bench.start(source)
    await bench.noted_pid("main")
    await bench.noted_pid("child")
    os.kill(await find_supervisor(learner), signal.SIGKILL)
    assert await learner.wait(20) is not None
    assert learner.exit is not None
    assert learner.exit.signal == signal.SIGKILL
    assert "was killed, and the program with it" in learner.fault
    await learner.end()
    assert bench.leftovers() == []
    assert learner.survivors() == []


async def test_killing_us_and_the_supervisor_ends_the_main_process(bench: Any) -> None:
    """Nobody is left to end it, but the kernel still kills the main process (parent-death signal)."""
    helper = await asyncio.create_subprocess_exec(
        *bench.helper("note('main'); forever()"), env=bench.helper_env, cwd=bench.folder
    )
    main = await bench.noted_pid("main")
    supervisor = processes()[main].parent
    os.kill(helper.pid, signal.SIGSTOP)
    os.kill(supervisor, signal.SIGKILL)
    helper.kill()
    await helper.wait()
    await bench.all_gone()


async def test_a_supervisor_killed_by_the_learners_code_leaves_no_process(bench: Any) -> None:
    learner = await bench.start("""
if os.fork() == 0:
    os.setsid(); note('child'); forever()
while not os.path.exists('child'): time.sleep(0.001)
os.kill(os.getppid(), signal.SIGKILL); forever()
""")
    await bench.noted_pid("child")
    assert str(await learner.wait(20)) == "signal 9"
    await learner.end()
    assert bench.leftovers() == []


async def test_a_supervisor_killed_after_the_exit_does_not_change_the_exit(bench: Any) -> None:
    learner = await bench.start("""
if os.fork() == 0:
    os.setsid(); note('child'); forever()
while not os.path.exists('child'): time.sleep(0.001)
""")
    child = await bench.noted_pid("child")
    found = await learner.wait(20)
    os.kill(processes()[child].parent, signal.SIGKILL)
    await bench.until(lambda: learner.fault, "the supervisor's death to be known")
    await learner.end()
    assert bench.leftovers() == []
    assert learner.exit == found


async def test_our_own_sigkill_is_not_reported_as_somebody_elses(bench: Any) -> None:
    learner = await bench.start(CHILD)
    await bench.noted_pid("child")
    await learner.end()
    assert learner.exit is not None
    assert learner.exit.signal == signal.SIGKILL
    assert not learner.killed
    assert learner.fault == ""


@pytest.mark.parametrize("out_of_memory", [False, True])
async def test_an_out_of_memory_kill_is_reported(
    bench: Any, monkeypatch: pytest.MonkeyPatch, out_of_memory: bool
) -> None:
    """A program's own SIGKILL and the kernel's look alike, except for the kernel's count of out-of-memory kills."""
    vmstat = bench.folder / "vmstat"
    vmstat.write_text("nr_free_pages 1\noom_kill 3\n")
    monkeypatch.setattr("tutor.process.memory._VMSTAT", vmstat)
    count_kill = f"open('vmstat', 'w').write('oom_kill {3 + out_of_memory}\\n')"
    learner = await bench.start(f"{count_kill}\nos.kill(os.getpid(), signal.SIGKILL)")
    assert str(await learner.wait(20)) == "signal 9"
    assert learner.killed
    assert learner.fault == (
        "the machine ran out of memory, and the system killed the program" if out_of_memory else ""
    )


async def test_a_terminated_supervisor_takes_the_program_with_it(bench: Any) -> None:
    learner = await bench.start(STUBBORN)
    await bench.noted_pid("child")
    os.kill(await find_supervisor(learner), signal.SIGTERM)
    await bench.all_gone()
    assert str(await learner.wait(20)) == "signal 9"
    assert "was killed, and the program with it" in learner.fault


async def test_end_works_with_a_stopped_supervisor(bench: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tutor.process.link._SUPERVISOR_LIMIT_S", 1000.0)
    learner = await bench.start(STUBBORN)
    await bench.noted_pid("child")
    os.kill(await find_supervisor(learner), signal.SIGSTOP)
    await asyncio.wait_for(learner.end(), 60)
    assert bench.leftovers() == []


async def test_end_works_with_a_supervisor_that_times_out(bench: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tutor.process.link._SUPERVISOR_LIMIT_S", 0.0)
    learner = await bench.start(UNMARKED_DAEMON)
    await bench.noted_pid("child")
    await learner.end()
    assert bench.leftovers() == []


async def test_processes_that_cannot_be_ended_are_named_in_the_error(
    bench: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The error comes after a time limit; here the SIGKILL is suppressed."""
    monkeypatch.setattr("tutor.process.link._ORPHANS_LIMIT_S", 0.05)
    monkeypatch.setattr("tutor.process.link.kill", lambda found: None)
    learner = await bench.start(DAEMON.format(before="pass"))
    child = await bench.noted_pid("child")
    os.kill(await find_supervisor(learner), signal.SIGKILL)
    await bench.until(lambda: not alive(learner.pid), "the program to die with its supervisor")
    with pytest.raises(EndError, match=rf"could not be ended: {child} \(.*learner_.*\)\.$"):
        await learner.end()
    os.kill(child, signal.SIGKILL)
    await bench.all_gone()
    bench.started.clear()


async def test_signals_that_we_block_are_not_blocked_in_the_learner(bench: Any) -> None:
    """A child inherits ignored SIGCHLD and blocked signals from its parent."""
    old = signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT, signal.SIGCHLD, signal.SIGTERM])
    try:
        learner = await bench.start(CHILD)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, old)
    await bench.noted_pid("child")
    learner.interrupt()
    found = await learner.wait(20)
    assert found is not None
    assert found.code == 1 or found.signal == signal.SIGINT
    await learner.end()
    assert bench.leftovers() == []


async def test_ending_one_program_leaves_others_alone(bench: Any) -> None:
    one, other = await bench.start("note('one'); forever()"), await bench.start("note('other'); forever()")
    await bench.noted_pid("one")
    await bench.noted_pid("other")
    os.kill(await find_supervisor(one), signal.SIGKILL)
    await one.end()
    assert [s.pid for s in other.survivors()] == [other.pid]
    assert bench.leftovers() == [other.pid]


@pytest.mark.parametrize("killed", [False, True])
async def test_no_supervisor_or_zombie_is_left(bench: Any, killed: bool) -> None:
    before = {p.pid for p in descendants(os.getpid())}
    for _ in range(3):
        learner = await bench.start(CHILD)
        if killed:
            os.kill(await find_supervisor(learner), signal.SIGKILL)
        await learner.end()
    assert {p.pid for p in descendants(os.getpid())} <= before

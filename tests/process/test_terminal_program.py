"""A real bash on a real pseudo-terminal: it behaves as in a terminal window, and nothing of it stays behind."""

from __future__ import annotations

import os
import shutil
import signal
from pathlib import Path

import pytest

from tests.waiting import wait_for
from tutor.errors import StartError
from tutor.process import terminal_program
from tutor.process.orphans import command_line
from tutor.process.process_table import processes
from tutor.process.terminal_program import TerminalProgram

LIMIT_S = 20.0
ENV = {"PATH": os.environ["PATH"], "TERM": "xterm-256color", "PS1": "prompt> ", "HISTFILE": ""}


class Typist:
    """Types into a shell, and reads what it writes."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.read = bytearray()
        self.program: TerminalProgram | None = None

    async def open(self, *argv: str) -> TerminalProgram:
        self.program = await TerminalProgram.start(
            argv or ("bash", "--norc", "-i"),
            env=ENV,
            cwd=self.folder,
            size=(100, 30),
            on_output=self.read.extend,
            on_exit=lambda: None,
        )
        if not argv:
            assert await wait_for(lambda: self.program is not None and self.program.reads_keys, LIMIT_S)
        return self.program

    async def type(self, text: str, expected: str) -> None:
        assert self.program is not None
        del self.read[:]
        self.program.write(text.encode())
        await self.until(expected)

    async def until(self, expected: str) -> None:
        assert await wait_for(lambda: expected.encode() in self.read, LIMIT_S), bytes(self.read[-2000:])

    def pid(self, name: str) -> int:
        return int((self.folder / name).read_text())


def is_alive(pid: int) -> bool:
    found = processes().get(pid)
    return found is not None and found.alive


async def test_a_shell_keeps_its_state_and_passes_on_keys_signals_and_the_size(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    me = Typist(tmp_path)
    program = await me.open()
    await me.type("cd sub; export WHERE=here\r", "prompt> ")
    await me.type("echo at:${PWD##*/}-$WHERE\r", "at:sub-here")
    await me.type("read line; echo got:$line\r", "read line")
    assert await wait_for(lambda: not program.reads_keys, LIMIT_S)
    await me.type("typed\r", "got:typed")
    await me.type("stty size\r", "30 100")
    program.resize((77, 22))
    await me.type("stty size\r", "22 77")

    # Ctrl+C, Ctrl+Z and job control.
    await me.type("sleep 600\r", "sleep 600")
    # Not only in the foreground: until its exec, it ignores Ctrl+Z, as the shell does.
    assert await wait_for(lambda: command_line(program.foreground).startswith("sleep"), LIMIT_S)
    await me.type("\x1a", "Stopped")
    await me.type("fg\r", "sleep 600")
    assert await wait_for(lambda: program.foreground not in (0, program.pid), LIMIT_S)
    await me.type("\x03", "prompt> ")
    await me.type("echo code:$?\r", "code:130")
    await me.type("\x04", "exit")
    assert await wait_for(lambda: program.exit is not None, LIMIT_S)
    await program.end()


async def test_a_closed_terminal_hangs_up_and_then_kills_everything(tmp_path: Path) -> None:
    me = Typist(tmp_path)
    program = await me.open()
    for command in ("sleep 600 & echo $! > job", "nohup sleep 600 & echo $! > nohup"):
        await me.type(command + "\r", "prompt> ")
    detached = "setsid bash -c 'trap \"\" HUP; echo $$ > detached; exec sleep 600' &"
    await me.type(detached + "\r", "prompt> ")
    assert await wait_for((tmp_path / "detached").exists, LIMIT_S)
    foreground = "sh -c 'trap \"echo > hup; exit\" HUP; echo $$ > foreground; while true; do sleep 0.1; done'"
    await me.type(foreground + "\r", "done")
    assert await wait_for((tmp_path / "foreground").exists, LIMIT_S)
    assert await wait_for(lambda: (tmp_path / "foreground").read_text() != "", LIMIT_S)
    pids = [me.pid("foreground"), program.pid, me.pid("job"), me.pid("nohup"), me.pid("detached")]
    assert all(map(is_alive, pids))
    await program.end()
    assert not any(map(is_alive, pids))
    assert (tmp_path / "hup").exists()


async def test_a_shell_that_ignores_the_hangup_is_killed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(terminal_program, "HANGUP_S", 0.1)
    me = Typist(tmp_path)
    program = await me.open()
    await me.type("trap '' HUP; while true; do sleep 0.1; done\r", "done")
    await program.end()
    assert not is_alive(program.pid)


async def test_a_flood_waits_in_the_program_and_typing_to_a_deaf_one_is_bounded(tmp_path: Path) -> None:
    me = Typist(tmp_path)
    program = await me.open()
    await me.type("yes\r", "y\r\n" * 100)
    assert len(me.read) < 50 * terminal_program.READ_BYTES
    await me.type("\x03", "prompt> ")
    await me.type("stty -icanon; sleep 600\r", "sleep 600")
    for _ in range(100):
        program.write(b"x" * 100_000)
    assert len(program._unwritten) <= terminal_program.MAX_UNWRITTEN_BYTES
    await program.end()


async def test_a_program_that_cannot_be_started_says_why(tmp_path: Path) -> None:
    with pytest.raises(StartError, match="No such file"):
        await Typist(tmp_path).open(str(tmp_path / "nothing"))


async def test_a_killed_supervisor_ends_the_program(tmp_path: Path) -> None:
    me = Typist(tmp_path)
    program = await me.open()
    os.kill(processes()[program.pid].parent, signal.SIGKILL)
    assert await wait_for(lambda: program.exit is not None, LIMIT_S)
    await program.end()
    assert not is_alive(program.pid)


@pytest.mark.skipif(shutil.which("vim") is None, reason="vim is not installed")
async def test_a_full_screen_program_comes_and_goes(tmp_path: Path) -> None:
    me = Typist(tmp_path)
    program = await me.open()
    await me.type("vim -u NONE -N made.txt\r", "\x1b[?1049h")
    await me.type("ihello\x1b:wq\r", "\x1b[?1049l")
    assert await wait_for(lambda: program.reads_keys, LIMIT_S)
    assert (tmp_path / "made.txt").read_text() == "hello\n"
    await program.end()

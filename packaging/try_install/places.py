"""Where and as whom ros-tutor is installed and used: each time a new home, and a folder that cannot be written."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType

SELF = "you"
STRANGER = "another user"
READ_ONLY = "another user, home read-only, installed by root"

CLONE = Path(__file__).resolve().parents[2]
LIMIT_S = 600.0


class Failed(Exception):
    """A command did not do what it should; the text says which, and what it said."""


@dataclass(frozen=True)
class Place:
    """`folder` is the home of whoever installs, `home` that of the `account` (None: this one) that uses it."""

    user: str
    folder: Path
    home: Path
    account: str | None
    installer: str | None
    elsewhere: Path
    env: dict[str, str] = field(default_factory=dict)

    def install(self, *command: str | Path, **env: str) -> str:
        """Run a command that installs; return its output. Raises Failed."""
        return self._run(command, self.installer, self.folder, env)

    def use(self, *command: str | Path, **env: str) -> str:
        """Run a command as the user, in a folder that is not the home; return its output. Raises Failed."""
        return self._run(command, self.account, self.home, env)

    def command(
        self, words: Sequence[str | Path], account: str | None, home: Path, env: Mapping[str, str]
    ) -> list[str]:
        """Return what runs a command with no variables but these, as an account."""
        given = {"PATH": "/usr/local/bin:/usr/bin:/bin", "LANG": "C.UTF-8", "TERM": "xterm-256color"}
        given |= {"HOME": str(home), **self.env, **env}
        user = [] if account is None else ["runuser", "-u", account, "--"]
        return [*user, "env", "-i", *(f"{name}={value}" for name, value in given.items()), *map(str, words)]

    def _run(self, words: Sequence[str | Path], account: str | None, home: Path, env: Mapping[str, str]) -> str:
        try:
            done = subprocess.run(
                self.command(words, account, home, env),
                cwd=self.elsewhere,
                stdin=subprocess.DEVNULL,
                capture_output=True,
                text=True,
                timeout=LIMIT_S,
                check=False,
            )
        except subprocess.TimeoutExpired as error:
            raise Failed(f"{_typed(words)}: not done after {LIMIT_S:.0f} s") from error
        if done.returncode:
            said = (done.stderr.strip() or done.stdout.strip() or "nothing").splitlines()
            raise Failed(f"{_typed(words)}: exit code {done.returncode}, {' '.join(said[-3:])}")
        return done.stdout


class Users:
    """Gives out places. As root, it makes an account for the block, which is gone after it."""

    def __init__(self, work: Path) -> None:
        self._work = work
        self._account = f"ros-tutor-{os.getpid()}"

    def __enter__(self) -> Users:
        self._work.chmod(0o755)  # unlike other temporary folders, open to other users
        self._elsewhere = self._work / "elsewhere"
        self._elsewhere.mkdir(mode=0o555)
        if os.getuid() == 0:
            command = ["useradd", "--no-create-home", "--home-dir", str(self._work / "account"), self._account]
            subprocess.run(command, check=True)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if os.getuid() == 0:
            subprocess.run(["userdel", self._account], check=True, capture_output=True)

    def place(self, user: str, way: str) -> Place:
        """Return a place for a user, with an empty home."""
        root = self._work / re.sub(r"\W+", "-", f"{way} {user}")
        shutil.rmtree(root, ignore_errors=True)
        home, cache = root / "home", root / "cache"
        for folder in (root, home, cache):
            folder.mkdir()
        if user == SELF:
            return Place(user, home, home, None, None, self._elsewhere)
        for folder in (home, cache):
            shutil.chown(folder, self._account)
        if user == STRANGER:
            return Place(user, home, home, self._account, self._account, self._elsewhere)
        home.chmod(0o555)
        shared = root / "shared"
        shared.mkdir()
        # uv keeps what uvx runs in its cache, which has to be somewhere.
        return Place(user, shared, home, self._account, None, self._elsewhere, {"UV_CACHE_DIR": str(cache)})


def _typed(words: Sequence[str | Path]) -> str:
    return " ".join([Path(words[0]).name, *map(str, words[1:])])

"""The terminal page's shell state: environment, working directory, and the builtins `cd` and `export`."""

from __future__ import annotations

import re
import shlex
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from tutor.session.node_command import NodeCommand


@dataclass(frozen=True, slots=True)
class Shell:
    """The environment and working directory of commands. `Session` makes it like the one of `ros-tutor shell`."""

    env: Mapping[str, str]
    cwd: Path

    @property
    def place(self) -> str:
        """The working directory as a prompt shows it."""
        home = self.env.get("HOME", "")
        path = str(self.cwd)
        return "~" + path[len(home) :] if home and (path == home or path.startswith(home + "/")) else path

    def command(self, line: str) -> NodeCommand:
        """Return how to run a command line."""
        env = dict(self.env)
        # On a terminal, each line appears as it is printed; the nodes of a launch do not run on one.
        if not re.match(r"\s*ros2\s+launch\b", line):
            env["PYTHONUNBUFFERED"] = "1"
        return NodeCommand(line, ("bash", "-c", line), env, self.cwd, line, terminal=True)

    def run_builtin(self, line: str) -> Shell | str | None:
        """Run `cd` or `export`: return the new shell, or an error message; None if the line is any other command."""
        try:
            words = shlex.split(line, comments=True)
        except ValueError:
            return None
        if not words or any(mark in line for mark in ";&|"):
            return None
        if words[0] == "cd":
            return self._change_directory(words[1:])
        if words[0] == "export" and len(words) > 1:
            return self._export(words[1:])
        return None

    def _change_directory(self, words: list[str]) -> Shell | str:
        if len(words) > 1:
            return "cd: too many arguments"
        folder = (self.cwd / Path(words[0] if words else self.env.get("HOME", "/")).expanduser()).resolve()
        if not folder.is_dir():
            return f"cd: {words[0]}: {'Not a directory' if folder.exists() else 'No such file or directory'}"
        return replace(self, cwd=folder)

    def _export(self, words: list[str]) -> Shell | str:
        env = dict(self.env)
        for word in words:
            name, sign, value = word.partition("=")
            if not re.fullmatch(r"[A-Za-z_]\w*", name):
                return f"export: `{word}': not a valid identifier"
            if sign:
                env[name] = value
        return replace(self, env=env)

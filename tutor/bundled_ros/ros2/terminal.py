"""Turn the user's own shell into a sourced terminal. Their rc file is read first and never changed."""

from __future__ import annotations

import os
import shlex
import shutil
from collections.abc import Mapping
from pathlib import Path

from tutor.bundled_ros.ros2.completion import registration_code

SHELLS = ("bash", "zsh")
# Set by another ROS that the rc file may source: mixed with ours, neither would work.
_OTHER_ROS_VARIABLES = ("ROS_DISTRO", "ROS_VERSION", "ROS_PYTHON_VERSION", "COLCON_PREFIX_PATH", "CMAKE_PREFIX_PATH")

_PROMPT = {
    "bash": """\
__ros_tutor_prompt() { case "$PS1" in *"$__ros_tutor_mark"*) ;; *) PS1="$__ros_tutor_mark$PS1" ;; esac; }
PROMPT_COMMAND="${PROMPT_COMMAND:+$PROMPT_COMMAND
}__ros_tutor_prompt"
""",
    "zsh": """\
__ros_tutor_prompt() { case "$PROMPT" in *"$__ros_tutor_mark"*) ;; *) PROMPT="$__ros_tutor_mark$PROMPT" ;; esac; }
typeset -ga precmd_functions
precmd_functions+=(__ros_tutor_prompt)
""",
}
_ZSH_COMPLETION = "(( $+functions[compdef] )) || {{ autoload -Uz compinit && compinit -u -d {dump}; }}\n"
_ZSHENV = """\
ZDOTDIR={users}
[[ -f "$ZDOTDIR/.zshenv" ]] && source "$ZDOTDIR/.zshenv"
__ros_tutor_users="$ZDOTDIR"
ZDOTDIR={ours}
"""
_ZSHRC = """\
ZDOTDIR="$__ros_tutor_users"
unset __ros_tutor_users
[[ -f "$ZDOTDIR/.zshrc" ]] && source "$ZDOTDIR/.zshrc"
{unset}\
"""


def users_shell(environ: Mapping[str, str] = os.environ) -> tuple[str, Path]:
    """Return the name and path of the user's shell if it is bash or zsh, else of bash or zsh. Raises LookupError."""
    own = Path(environ.get("SHELL", ""))
    if own.name in SHELLS and os.access(own, os.X_OK):
        return own.name, own
    for name in SHELLS:
        if found := shutil.which(name, path=environ.get("PATH", os.defpath)):
            return name, Path(found)
    raise LookupError("neither bash nor zsh is installed")


def interactive_command(
    shell: str,
    path: Path,
    *,
    env: dict[str, str],
    exported: Mapping[str, str],
    unset: list[str],
    tools: Path,
    mark: str,
    setup: Path | None,
) -> list[str]:
    """Return the command of an interactive shell; write its rc files into `tools` and extend `env`.

    The variables in `exported` are exported, and those in `unset` unset, again after the user's own rc file, which may
    have set them for another ROS. The programs in `tools` come first on PATH. `setup` is sourced last. `mark` is put
    before the prompt. Raises OSError.
    """
    lines = _restore_environment(exported, unset, tools)
    if setup is not None:
        lines += f"source {shlex.quote(str(setup))}\n"
    lines += f"__ros_tutor_mark={shlex.quote(mark)}\n{_PROMPT[shell]}"
    if shell == "bash":
        rc = tools / "bashrc"
        rc.write_text(f"[ -f ~/.bashrc ] && . ~/.bashrc\n{lines}{registration_code('bash')}", encoding="utf-8")
        return [str(path), "--rcfile", str(rc), "-i"]
    folder = tools / "zsh"
    folder.mkdir(exist_ok=True)
    users = env.get("ZDOTDIR") or env.get("HOME", "")
    unset_zdotdir = "" if env.get("ZDOTDIR") else '[[ "$ZDOTDIR" == "$HOME" ]] && unset ZDOTDIR\n'
    zshenv = _ZSHENV.format(users=shlex.quote(users), ours=shlex.quote(str(folder)))
    completion = _ZSH_COMPLETION.format(dump=shlex.quote(str(folder / "zcompdump"))) + registration_code("zsh")
    (folder / ".zshenv").write_text(zshenv, encoding="utf-8")
    (folder / ".zshrc").write_text(f"{_ZSHRC.format(unset=unset_zdotdir)}{lines}{completion}", encoding="utf-8")
    env["ZDOTDIR"] = str(folder)
    return [str(path), "-i"]


def _restore_environment(exported: Mapping[str, str], unset: list[str], tools: Path) -> str:
    exports = [
        f"export {name}={shlex.quote(value)}\n"
        for name, value in sorted(exported.items())
        if name not in ("PATH", "SHLVL")
    ]
    if (tools / "bin").is_dir():
        exports.append(f'export PATH={shlex.quote(str(tools / "bin"))}:"$PATH"\n')
        unset = sorted({*unset, *_OTHER_ROS_VARIABLES})
    return "".join(exports) + (f"unset {' '.join(unset)}\n" if unset else "")

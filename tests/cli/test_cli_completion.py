"""Tab completion, requested as bash, zsh and fish do."""

from __future__ import annotations

import os
import shutil
import subprocess
from functools import cache
from pathlib import Path

import pytest

import tutor
from tests.cli.conftest import Run

ROOT = Path(tutor.__file__).parents[1]

# For each shell: the variables that it sets, the request, and printing the candidates.
REQUEST = {
    "bash": """
COMP_LINE="$LINE"; COMP_POINT=${#LINE}; COMP_TYPE=9
_python_argcomplete ./ros-tutor
printf '%s\\n' "${COMPREPLY[@]}"
""",
    "zsh": """
BUFFER="$LINE"; CURSOR=${#LINE}; words=(./ros-tutor)
_describe() { print -l -- "${completions[@]%%:*}" }
_python_argcomplete
""",
    "fish": 'complete -C "$LINE" | cut -f1\n',
}
SETUP = {"zsh": "autoload -U compinit; compinit -u -D\n", "bash": "", "fish": ""}


@cache
def shell_code(shell: str) -> str:
    """The code that enables completion."""
    command = ["./ros-tutor", "completion", shell]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout


def completions(shell: str, line: str, home: Path) -> list[str]:
    """The words that Tab offers at the end of a line."""
    program = f"{SETUP[shell]}{shell_code(shell)}\n{REQUEST[shell]}"
    completion = subprocess.run(
        [shell, *(["--no-rcs"] if shell == "zsh" else []), "-c", program],
        cwd=ROOT,
        env={**os.environ, "HOME": str(home), "LINE": line},
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    return [word.strip() for word in completion.stdout.splitlines() if word.strip()]


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_exercises_and_criteria_are_completed(shell: str, home: Path) -> None:
    if shutil.which(shell) is None:
        pytest.skip(f"there is no {shell}")
    assert completions(shell, "./ros-tutor check i2.", home) == ["i2.1", "i2.2", "i2.3"]
    assert completions(shell, "./ros-tutor check i2.1 --criterion t", home) == ["timer"]


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("che", {"check", "checklist"}),
        ("wat", {"watch"}),
        ("les", {"lesson"}),
        ("lesson i1.", {"i1.1", "i1.2", "i1.3"}),
        ("run b1.1 --par", {"--partner"}),
        ("check a", {"all"}),
        ("start a", set()),
        ("check --criterion shut", {"shutdown", "shutdown-active", "shutdown-busy"}),
        ("check i1.2 --criterion g", {"gaps"}),
        ("check i1.1 --form", {"--format"}),
        ("check i1.1 --format j", {"json", "junit"}),
        ("checklist untick tim", {"timers"}),
        ("run i1.3 calc", {"calculator_server", "calculator_client"}),
        ("predict i2", {"i2.3"}),
        ("predict i2.3 two", {"two-groups"}),
        ("help so", {"solution"}),
        ("explain old-t", {"old-timer-kept"}),
        ("explain count-and-r", {"count-and-rate-swapped"}),
        ("explain old-timer-kept no-s", set()),
        ("completion ", {"bash", "zsh", "fish", "--workspace", "--lessons", "--only"}),
        ("ros2 topic ec", {"echo"}),
        ("--workspace tut", {"tutor/"}),
    ],
)
def test_every_kind_of_word_is_completed(line: str, words: set[str], home: Path) -> None:
    assert set(completions("bash", f"./ros-tutor {line}", home)) == words


def test_help_says_how_to_enable_completion(run: Run) -> None:
    help_text = run("completion", "--help").out
    assert 'eval "$(ros-tutor completion bash)"' in help_text
    assert "ros-tutor completion fish | source" in help_text
    result = run("completion", "tcsh")
    assert result.code == 2
    assert "choose from bash, zsh, fish" in result.err

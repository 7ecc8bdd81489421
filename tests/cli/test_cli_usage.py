"""Wrong usage is one clear line on stderr and exit code 2; help and version are on stdout."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Run

WORKSPACE = ("--workspace", "ws")


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["frobnicate"], "there is no command 'frobnicate' (see `ros-tutor --help`)"),
        (["chek", "i1.1"], "there is no command 'chek', did you mean check?"),
        (["Lst"], "there is no command 'Lst', did you mean list?"),
        (["help", "chek"], "there is no command 'chek', did you mean check?"),
        (["check", "i1.1", "--critrion", "rate"], "unrecognized arguments: --critrion rate, did you mean --criterion?"),
        (["check", "i1.1", "--format", "jsn"], "invalid choice: 'jsn', did you mean json?; choose from text, json"),
        (["checklist", "tik", "timers"], "invalid choice: 'tik', did you mean tick?"),
        (["check", "1.1"], "Did you mean i1.1?"),
        (["start", "i1.1", "i1.2"], "start takes one exercise at a time: `ros-tutor start i1.2`"),
        (["start", "i1.1", "I1_2"], "start takes one exercise at a time"),
        (["list", "--workspace", "file.txt"], "cannot be your workspace: it is a file"),
        (["start", "i1.1", "--workspace", "file.txt/ws"], "file.txt is a file"),
        (["start", "i1.1", "--workspace", "/proc"], "/proc cannot be your workspace: nothing can be written"),
        (["check", "i1.1", "--workspace", "/proc/ws"], "/proc/ws cannot be your workspace: nothing can be written"),
        (["check", "i1.1", "file.txt"], "is not a Python file; i1.1 is judged by temperature_publisher.py"),
        (["check", "i2.2", "file.txt"], "is not a Python file"),
        (["checklist", "export", "--output", "x.docx"], "no format for .docx; the formats are markdown (.md), json"),
        (["check"], "the following arguments are required: EXERCISE"),
        (["check", "i1.1", "--format", "pdf"], "argument --format: invalid choice: 'pdf'"),
        (["check", "i1.1", "--frob"], "unrecognized arguments: --frob"),
        (["check", "i9.9"], "There is no exercise 'i9.9'"),
        (["start", "x"], "There is no exercise 'x'"),
        (["hint", "x"], "There is no exercise 'x'"),
        (["solution", "x"], "There is no exercise 'x'"),
        (["check", "i1.1"], "there is no workspace at"),
        (["check", "all"], "there is no workspace at"),
        (["check", "i1.1", "nowhere.py"], "there is no file or folder"),
        (["check", "i1.1", "--solution", "x.py"], "give no PATH"),
        (
            ["check", "i1.1", "--solution", "--criterion", "rte"],
            "no criterion 'rte' in i1.1. The criteria are: publishes",
        ),
        (["check", "all", "--solution", "--criterion", "rte"], "no criterion 'rte' in any exercise"),
        (["check", "i1.1", "--solution", "--output", "no/such/file"], "there is no folder no/such"),
        (["check", "i1.1", "--solution", "--output", "."], "this is a folder"),
        (["check", "all", "nowhere"], "check all needs a folder"),
        (["list", "--workspace", "."], "is not a workspace; `ros-tutor start i1.1 --workspace"),
        (["check", "i1.1", "--workspace", "."], "is not a workspace"),
        (["hint", "i1.1", "--workspace", "."], "is not a workspace"),
        (["list", "--lessons", "nowhere"], "--lessons nowhere: there is no such folder or file"),
        (["checklist", "tick"], "checklist tick needs an ITEM"),
        (["checklist", "show", "timers"], "takes no ITEM"),
        (["checklist", "--output", "x"], "go with `checklist export`"),
        (["checklist", "tick", "timer"], "no checklist item 'timer'. Did you mean timers?"),
        (["checklist", "tick", "timers"], "ticks are kept in a workspace"),
    ],
)
def test_wrong_usage_is_one_line_and_exit_code_2(run: Run, home: Path, argv: list[str], message: str) -> None:
    (home / "file.txt").write_text("read me\n")
    result = run(*argv)
    assert result.code == 2
    assert result.out == ""
    assert message in result.err
    assert result.err.startswith("ros-tutor: ")
    assert result.err.count("\n") == 1
    assert [path.name for path in home.iterdir()] == ["file.txt"]


def test_a_workspace_named_by_the_environment_is_validated_too(
    run: Run, home: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (home / "file.txt").write_text("read me\n")
    monkeypatch.setenv("ROS_TUTOR_WORKSPACE", str(home / "file.txt"))
    result = run("start", "i1.1")
    assert (result.code, result.out) == (2, "")
    assert "cannot be your workspace: it is a file" in result.err


def test_start_takes_a_folder_whose_name_looks_like_an_exercise(run: Run, home: Path) -> None:
    assert run("start", "i1.1", "./i1.2").code == 0
    assert (home / "i1.2" / "temperature_publisher.py").is_file()


def test_an_export_without_a_suffix_is_markdown(run: Run, home: Path) -> None:
    assert run("checklist", "export", "--output", "mine").code == 0
    assert (home / "mine").read_text().startswith("# ")
    assert run("checklist", "export", "--format", "json", "--output", "mine.txt").code == 0


def test_help_covers_all_commands_or_one(run: Run) -> None:
    assert run("help").out == run("--help").out
    assert run("help", "check").out == run("check", "--help").out
    assert run("help").code == run("help", "check").code == 0


def test_without_a_terminal_the_app_says_so(run: Run) -> None:
    result = run()
    assert (result.code, result.out) == (2, "")
    assert "the app needs a terminal" in result.err
    assert result.err.count("\n") == 1


@pytest.mark.parametrize(
    "argv", [["--help"], ["check", "-h"], ["checklist", "-h"], ["--version"], ["list", "--version"]]
)
def test_help_and_version_go_to_stdout(run: Run, argv: list[str]) -> None:
    result = run(*argv)
    assert (result.code, result.err) == (0, "")
    assert "ros-tutor" in result.out


@pytest.mark.parametrize(
    "argv", [[*WORKSPACE, "start", "i1.1"], ["start", *WORKSPACE, "i1.1"], ["start", "i1.1", *WORKSPACE]]
)
def test_global_options_go_before_and_after_the_command(run: Run, home: Path, argv: list[str]) -> None:
    assert run(*argv).code == 0
    assert (home / "ws" / ".ros-tutor" / "progress.json").is_file()


def test_an_internal_error_is_one_line_and_exit_code_3(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*folders: object, **options: object) -> None:
        raise RuntimeError("it\nbroke")

    monkeypatch.setattr("tutor.content.load_course", broken)
    result = run("list")
    assert (result.code, result.out) == (3, "")
    assert "RuntimeError: it broke" in result.err
    assert result.err.count("\n") == 1

    monkeypatch.setenv("ROS_TUTOR_DEBUG", "1")
    assert "Traceback (most recent call last)" in run("list").err


def test_an_interrupt_anywhere_is_exit_code_130(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*folders: object, **options: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("tutor.content.load_course", interrupted)
    assert run("list").code == 130

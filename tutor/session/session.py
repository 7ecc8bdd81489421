"""A learner's session with a course: lessons, files, progress, and the commands to run and check.

Methods that access the disk are called in worker threads.
"""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from tutor import interpreter
from tutor.content import Course, Lesson, LessonFile, Partner, Prediction
from tutor.content.courses import Courses
from tutor.errors import StorageError
from tutor.session import run_options
from tutor.session.handed_over import HandedOver
from tutor.session.node_command import NodeCommand
from tutor.workspace import (
    AppState,
    ExerciseState,
    LastCheck,
    Placed,
    Progress,
    RunOptions,
    Workspace,
    domain_of,
    place_files,
    record,
    start,
    start_another,
    states_of,
    versions_of,
    write_atomically,
)
from tutor.workspace.progress import now

if TYPE_CHECKING:
    from tutor.judge.result import ExerciseResult
    from tutor.report.assessment import Assessment
    from tutor.ros.environment import RosEnvironment
    from tutor.session.shell import ShellCommand

Notify = Callable[[str], None]


class Session:
    """A course and the workspace to do it in. `courses`: those that the course is of, apart from the bundled one."""

    def __init__(self, course: Course, workspace: Workspace, courses: Courses | None = None) -> None:
        self.course = course
        self.workspace = workspace
        self.courses = courses or Courses()
        self.may_keep_engine = True
        """Whether the app may keep an engine ready for the next check."""
        self._domain: tuple[Path, int] | None = None
        self._tools: Path | None = None
        self.notify: Notify = lambda text: None
        """Called, from any thread, with a one-line message for the learner (damaged progress was set aside)."""
        self.handed_over = HandedOver(lambda: self.workspace, lambda text: self.notify(text))

    @property
    def lessons(self) -> tuple[Lesson, ...]:
        """All lessons, in the order to do them."""
        return self.course.lessons

    @property
    def domain(self) -> int:
        """The id of the ROS domain in which the learner's nodes run. The first access reads the disk."""
        root = self.workspace.root
        if self._domain is None or self._domain[0] != root:
            self._domain = (root, domain_of(self.workspace))
        return self._domain[1]

    def path(self, file: LessonFile) -> Path:
        """Return where the learner's file is, or will be."""
        return self.workspace.path_of(file.name)

    def missing(self, lesson: Lesson) -> tuple[str, ...]:
        """Return the names of the required files that do not exist yet; the lesson cannot be checked without them."""
        return tuple(file.name for file in lesson.files if file.required and not self.path(file).exists())

    def start(self, lesson: Lesson, *, another: bool = False) -> Placed:
        """Put missing skeleton files into the workspace; existing files are not changed.

        `another`: another fault, in place of the files that are there. Raises WorkspaceError or StorageError.
        """
        placed = (start_another if another else start)(lesson, self.workspace).files
        self.workspace.courses(self.notify).add(self.courses)
        return placed

    def create_workspace(self, root: Path) -> None:
        """Create the workspace at `root` and start the first exercise in it; an existing workspace is kept.

        A symbolic link to it is put at the previous root, if nothing is there, so that it is found the next time.
        Raises WorkspaceError or StorageError.
        """
        default, chosen = self.workspace.root, Workspace(root)
        if not chosen.exists:
            start(self.lessons[0], chosen)
            chosen.courses(self.notify).add(self.courses)
        self.workspace = chosen
        if root != default and not os.path.lexists(default):
            try:
                default.parent.mkdir(parents=True, exist_ok=True)
                default.symlink_to(root, target_is_directory=True)
            except OSError as error:
                self.notify(
                    f"Next time, start with --workspace {root}: no link to it could be made at {default} "
                    f"({error.strerror})."
                )

    def reset(self, lesson: Lesson, file: LessonFile) -> Placed:
        """Replace the learner's file with the skeleton; the file is kept as a backup.

        Raises WorkspaceError or StorageError.
        """
        return place_files({self.path(file): self.handed_over.skeleton(lesson, file).encode()}, force=True)

    def app_state(self) -> AppState:
        """Read the app's saved state of this workspace."""
        return self.workspace.app_state(self.notify).read() if self.workspace.exists else AppState()

    def save_app_state(self, state: AppState) -> None:
        """Save the app's state. Raises StorageError."""
        if self.workspace.exists:
            self.workspace.app_state(self.notify).write(state)

    def lesson_to_open(self, state: AppState) -> Lesson:
        """Return the lesson where the learner left off in the app; if none, what was started last, or the first one."""
        by_id = {lesson.id: lesson for lesson in self.lessons}
        if state.lesson in by_id:
            return by_id[state.lesson]
        try:
            progress = self.progress()
        except StorageError:  # told when the progress is shown
            return self.lessons[0]
        return max(self.lessons, key=lambda lesson: progress.of(lesson.id).started_at or "")

    def progress(self) -> Progress:
        """Read the learner's progress. Raises StorageError."""
        if not self.workspace.exists:
            return Progress()
        return self.workspace.progress(self.notify).read()

    def states(self, progress: Progress) -> dict[str, ExerciseState]:
        """Return the state of each exercise, by exercise id."""
        return states_of(self.lessons, progress, self.workspace)

    def record(self, result: ExerciseResult) -> Progress:
        """Save one attempt, and what it found; return the new progress. Raises StorageError."""
        criteria = {lesson.id: [criterion.id for criterion in lesson.criteria] for lesson in self.lessons}
        return record([result], self.workspace, criteria, self.notify)

    def last_checks(self, progress: Progress) -> dict[str, LastCheck]:
        """Read what the last check of each exercise found, by exercise id, if it was kept."""
        if not self.workspace.exists:
            return {}
        found = self.workspace.last_checks(self.notify).read(lesson.id for lesson in self.lessons)
        return {id: last for id, last in found.items() if last.is_current(progress)}

    def show_hint(self, lesson: Lesson) -> Progress:
        """Count one more hint as shown and return the new progress. Raises StorageError."""
        file = self.workspace.progress(self.notify)
        file.next_hint(lesson.id, total=len(lesson.hints))
        return file.read()

    def tick(self, item: str, ticked: bool) -> Progress:
        """Tick or untick a checklist item and return the new progress. Raises StorageError."""
        return self.workspace.progress(self.notify).change(lambda progress: progress.with_tick(item, ticked))

    def show_criterion_hint(self, lesson: Lesson) -> Progress:
        """Note that the hint for a criterion was shown, and return the new progress. Raises StorageError."""
        file = self.workspace.progress(self.notify)
        return file.change(lambda progress: progress.with_criterion_hint(lesson.id))

    def show_solution(self, lesson: Lesson) -> Progress:
        """Note that our solution was shown, and return the new progress. Raises StorageError."""
        if not self.workspace.exists:
            return Progress()
        return self.workspace.progress(self.notify).change(lambda progress: progress.with_solution(lesson.id))

    def predict(self, lesson: Lesson, prediction: Prediction, right: bool) -> Progress:
        """Record the answer to a prediction whose outcome was seen; return the new progress. Raises StorageError."""
        if not self.workspace.exists:
            return Progress()
        file = self.workspace.progress(self.notify)
        return file.change(lambda progress: progress.with_prediction(lesson.id, prediction.id, right))

    def versions(self) -> dict[str, str]:
        """Read the versions of all exercises' files, by exercise id."""
        return versions_of(self.lessons, self.workspace)

    def assess(self) -> Assessment:
        """Read the progress and the files, and assess them. Raises StorageError."""
        from tutor.report.assessment import assess

        return assess(self.course, self.progress(), self.versions())

    def export(self, format: str, path: Path, replace: bool) -> bool:
        """Write the checklist to `path`; return False, without writing, if the file exists and `replace` is not set.

        Raises StorageError.
        """
        from tutor.report.checklist_formats import render_checklist

        if os.path.exists(path) and not replace:  # Path.exists raises PermissionError
            return False
        write_atomically(path, render_checklist(self.assess(), format, at=now()))
        return True

    def check_arguments(self, lesson: Lesson, *, first: bool = False) -> Sequence[str]:
        """Return the arguments with which the engine checks the workspace's own files.

        `first`: end at the first failure.
        """
        more = ("--first",) if first else ()
        return (lesson.id, str(self.workspace.root), *more, *self.courses.arguments)

    def engine_command(self, *arguments: str) -> Sequence[str]:
        """Return the command that runs the engine in the workspace; it prints events."""
        return interpreter.module_command("tutor.engine", *arguments)

    def node_command(self, file: LessonFile, options: RunOptions) -> NodeCommand:
        """Return how to run one file in the learner's own ROS domain.

        Raises CommandError if ROS has no `ros2`, and OSError.
        """
        from tutor.bundled_ros.ros2 import starting  # imported late, not to delay the first paint

        path = self.path(file)
        launch = starting.is_launch_file(path)
        ros, env = self._ros_and_env(path.parent.parent if (path.parent / "__init__.py").is_file() else None)
        first = [*starting.ros2_command(ros, env), "launch"] if launch else [str(ros.python)]
        given = run_options.arguments(options, launch=launch)
        typed = self.command_line(file, options)
        return NodeCommand(file.name, (*first, str(path), *given), env, path.parent, typed, terminal=launch)

    def partner_command(self, partner: Partner) -> NodeCommand:
        """Return how to run our partner node in the learner's own ROS domain. Raises what `node_command` raises."""
        if partner.file is not None:
            ros, env = self._ros_and_env()
            typed = f"python3 {partner.file.name}"
            return NodeCommand(partner.name, (str(ros.python), str(partner.file)), env, partner.file.parent, typed)
        return replace(self.ros2_command(["run", *partner.run]), file=partner.name)

    def ros2_command(self, words: Sequence[str]) -> NodeCommand:
        """Return how to run `ros2` with these words in the learner's own domain. Raises what `node_command` raises."""
        from tutor.bundled_ros.ros2 import starting  # imported late, not to delay the first paint

        ros, env = self._ros_and_env()
        folder = self.workspace.root if self.workspace.exists else Path.home()
        typed = shlex.join(["ros2", *words])
        return NodeCommand("ros2", (*starting.ros2_command(ros, env), *words), env, folder, typed)

    def _ros_and_env(self, package: Path | None = None) -> tuple[RosEnvironment, dict[str, str]]:
        from tutor.session.terminal_environment import ros_and_env  # imported late, not to delay the first paint

        return ros_and_env(self.workspace, self.domain, self._terminal_tools(), package)

    def _terminal_tools(self) -> Path:
        """Return the folder for the programs of a sourced terminal. Raises OSError."""
        from tutor import private_folders

        if self._tools is None:
            self._tools = private_folders.create_until_exit("terminal")
        return self._tools

    def command_line(self, file: LessonFile, options: RunOptions) -> str:
        """Return what a ROS user would type to run this file, once the workspace is built."""
        return run_options.command_line(self.workspace.package.name, file.name, options)

    def shell(self) -> tuple[ShellCommand, Path]:
        """Return the shell of a terminal in the app, as `ros-tutor shell` starts it, and the folder to start it in.

        Raises what `shell_command` raises.
        """
        from tutor.session.shell import in_the_app, shell_command

        folder = self.workspace.root if self.workspace.exists else Path.home()
        return shell_command(self.workspace, self._terminal_tools(), in_the_app()), folder

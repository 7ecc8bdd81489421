"""All that the learner can do, in one table: it gives the keys, the footer, the help and the command palette."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from textual.binding import Binding, BindingType
from textual.command import DiscoveryHit, Hit, Hits, Provider

from tutor.tui import words

if TYPE_CHECKING:
    from tutor.tui.screens.main import MainScreen


@dataclass(frozen=True, slots=True)
class Command:
    """One thing to do. `label` is for the footer, `text` for help and palette. `footer`: shown at the bottom."""

    key: str
    action: str
    label: str
    text: str
    footer: bool = False
    palette: bool = True

    @property
    def shown_key(self) -> str:
        """The key as the learner reads it."""
        return {"escape": "Esc", "question_mark": "?", "ctrl+p": "Ctrl+P"}.get(self.key, self.key)

    def binding(self) -> Binding:
        """As Textual wants it."""
        return Binding(self.key, self.action, self.label, show=self.footer, key_display=self.shown_key)


GROUPS: tuple[tuple[str, tuple[Command, ...]], ...] = (
    (
        "Your node",
        (
            Command("r", "run_node", "Run", "Run your node in your own ROS domain", footer=True),
            Command("r", "stop_node", "Stop", "Stop your node, as Ctrl+C does", footer=True),
            Command("c", "check", "Check", "Check your node against the criteria", footer=True),
            Command("c", "cancel_check", "Cancel", "Cancel the running check", footer=True),
            Command("escape", "cancel_check", "Cancel", "Cancel the running check", palette=False),
        ),
    ),
    (
        "The exercise",
        (
            Command("s", "start_exercise", "Start", "Put the skeleton into your workspace", footer=True),
            Command("e", "edit", "Edit", "Open the file in your editor ($EDITOR)", footer=True),
            Command("f", "next_file", "File", "Show the exercise's other file"),
            Command("h", "hint", "Hint", "Show the next hint", footer=True),
            Command("v", "solution", "Solution", "Show our solution (asks first)"),
        ),
    ),
    (
        "Around",
        (
            Command("n", "next_lesson", "Next", "Go to the next lesson", footer=True),
            Command("p", "previous_lesson", "Prev", "Go to the previous lesson", footer=True),
            Command("l", "lessons", "Lessons", "Show or hide the list of lessons"),
            Command("1", "tab('lesson')", "Lesson", "Show the lesson"),
            Command("2", "tab('code')", "Code", "Show your code"),
            Command("3", "tab('log')", "Log", "Show the log of your node"),
            Command("4", "tab('criteria')", "Criteria", "Show the criteria"),
            Command("t", "app.switch_theme", "Theme", "Switch between the dark and the light theme"),
            Command("question_mark", "help", "Help", "Show all keys", footer=True),
            Command("q", "app.quit", "Quit", "Stop everything and leave", footer=True),
        ),
    ),
)


def commands() -> Iterator[Command]:
    """Every command, in the order of the help."""
    for _, group in GROUPS:
        yield from group


def bindings() -> list[BindingType]:
    """The keys of the main screen."""
    return [command.binding() for command in commands()]


class TutorCommands(Provider):
    """The command palette: every action, and every lesson to go to."""

    def _offers(self) -> Iterator[tuple[str, str, Callable[[], object]]]:
        screen = self.screen
        from tutor.tui.screens.main import MainScreen

        if not isinstance(screen, MainScreen):
            return
        for command in commands():
            if command.palette and screen.can(command.action):
                yield command.text, f"Key {command.shown_key}", partial(screen.run_action, command.action)
        yield from self._lessons(screen)

    def _lessons(self, screen: MainScreen) -> Iterator[tuple[str, str, Callable[[], object]]]:
        for lesson in screen.desk.lessons:
            name = f"Go to {words.label(lesson)} {lesson.title}"
            yield name, f"{lesson.unit}, {lesson.difficulty}", partial(screen.go_to, lesson)

    async def discover(self) -> Hits:
        """What is offered before anything is typed."""
        for name, about, run in self._offers():
            yield DiscoveryHit(name, run, help=about)

    async def search(self, query: str) -> Hits:
        """What fits the typed text."""
        matcher = self.matcher(query)
        for name, about, run in self._offers():
            if (score := matcher.match(name)) > 0:
                yield Hit(score, matcher.highlight(name), run, help=about)

"""Types commands of the lesson's text into a terminal."""

from __future__ import annotations

from tutor.tui import commands
from tutor.tui.control.host import HostScreen
from tutor.tui.control.pages import Pages
from tutor.tui.lesson_commands import commands_in


class Terminal:
    """Runs the current lesson's commands."""

    def __init__(self, host: HostScreen, pages: Pages) -> None:
        self._host, self._pages = host, pages
        host.register(commands.LESSON_COMMAND, self.choose, lambda: bool(self._commands))

    @property
    def _commands(self) -> tuple[str, ...]:
        return commands_in(self._host.model.lesson.body)

    def choose(self) -> None:
        """Let the learner choose one of the lesson's commands, and run it."""
        from tutor.tui.dialogs.choose_command import ChooseCommandScreen

        def chosen(command: str | None) -> None:
            if command is not None:
                self.run(command)

        self._host.app.push_screen(ChooseCommandScreen(self._commands), chosen)

    def run(self, command: str) -> None:
        """Show the terminal page, and type a command there, with Enter."""
        self._host.show_page("terminal")
        self._pages.open_terminal().run_line(command)

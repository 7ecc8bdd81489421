"""Everything the learner can do, in one table: the source of the keys, the footer, the help and the command palette."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from textual.binding import Binding, BindingType

_KEY_NAMES = {"escape": "Esc", "question_mark": "?", "slash": "/", "space": "Space"}


@dataclass(frozen=True, slots=True)
class Command:
    """One action. `name` identifies it; `label` is shown in the footer, `text` in the help and the palette.

    `help` replaces `text` in the help: commands with the same `help` share a line there.

    Any of the `keys` triggers it; the first is shown in the footer if `footer` is set. Several commands may share a
    key, as long as only one of them is available at a time.
    """

    name: str
    keys: tuple[str, ...]
    label: str
    text: str
    footer: bool = False
    help: str = ""

    @property
    def shown_keys(self) -> tuple[str, ...]:
        """The keys as shown to the learner."""
        return tuple(key_label(key) for key in self.keys)

    def bindings(self) -> Iterator[Binding]:
        """Yield a Textual binding for each key."""
        for number, key in enumerate(self.keys):
            yield Binding(
                key, f"do('{self.name}')", self.label, show=self.footer and number == 0, key_display=key_label(key)
            )


def key_label(key: str) -> str:
    """Return a Textual key name as shown to the learner, e.g. "ctrl+s" as "Ctrl+S"."""
    if key in _KEY_NAMES:
        return _KEY_NAMES[key]
    if key.startswith("ctrl+"):
        return f"Ctrl+{key.removeprefix('ctrl+').upper()}"
    return key.upper() if key.startswith("f") and key[1:].isdecimal() else key


_LIVE = "Live's topics, parameters, services, graph"
_STEP = "Go to the next or the previous lesson"

# Your node
RUN = Command("run", ("r", "f5"), "Run", "Run your node in your own ROS domain", footer=True)
STOP = Command("stop", ("r", "f6"), "Stop", "Stop your node, as Ctrl+C does", footer=True)
RESTART = Command("restart", ("f5",), "Restart", "Stop your node and run it again")
PARTNER = Command("partner", ("b",), "Partner", "Run or stop our node that goes with yours", footer=True)
OTHER_FILE = Command("other_file", ("j",), "Other file", "Run or stop the exercise's other file")
OPTIONS = Command("options", ("o",), "Options", "Set parameters and remaps")
RESTART_ON_SAVE = Command("restart_on_save", ("W",), "Restart on save", "Restart on each save: on or off")

# The check
CHECK = Command("check", ("c", "f9"), "Check", "Check your node against the criteria", footer=True)
CANCEL = Command("cancel", ("c", "f9", "escape"), "Cancel", "Cancel the running check", footer=True)
WATCH = Command("watch", ("w",), "Watch", "Check on each save: on or off")
FIRST_FAILURE = Command("first_failure", ("F",), "First failure", "End checks at the first failure: on or off")
EVIDENCE = Command("evidence", ("i",), "Evidence", "Show or hide the evidence")
EXPLAIN = Command("explain", ("x",), "Why", "Explain the mistake, with an example", footer=True)
ATTEMPTS = Command("attempts", ("a",), "Attempts", "Show your attempts over time")
ANSWER = Command("answer", ("A",), "Answer", "Say what is wrong with the system, and where", footer=True)
ANOTHER = Command("another", ("N",), "Another", "Hand over another fault")
HINT = Command("hint", ("h",), "Hint", "Show the next hint", footer=True)
PREDICT = Command("predict", ("8",), "Predict", "Predict what a program does, then see")

# Your code
START = Command("start", ("s",), "Start", "Put the skeleton into your workspace")
EDIT = Command("edit", ("e",), "Edit", "Edit your file here, until Esc", footer=True)
SAVE = Command("save", ("ctrl+s",), "Save", "Save (it is also saved as you go)")
FIND = Command("find", ("ctrl+f",), "Find", "Find text in your code")
FIND_NEXT = Command("find_next", ("ctrl+g",), "Find next", "Find the same text again")
OWN_EDITOR = Command("own_editor", ("E",), "$EDITOR", "Open it in your own editor ($EDITOR)")
NEXT_FILE = Command("next_file", ("f",), "File", "Show the exercise's other file")
SKELETON = Command("skeleton", ("k",), "Skeleton", "Show the skeleton")
CHANGES = Command("changes", ("d",), "Changes", "Show what you changed in the skeleton")
SOLUTION = Command("solution", ("v",), "Solution", "Show our solution (asks first)")
AGAINST = Command("against", ("V",), "Compare", "Compare your file with our solution")
RESET = Command("reset", ("Z",), "Reset", "Start again (keeps a backup)")

# The log
LEVEL = Command("level", ("m",), "Level", "Choose the lowest log level to show")
FILTER = Command("filter", ("slash",), "Filter", "Show only lines that contain a given text")
PAUSE = Command("pause", ("space",), "Pause", "Pause the log, or follow it again")
CLEAR = Command("clear", ("C",), "Clear", "Clear the log")
GO_TO_ERROR = Command("go_to_error", ("g",), "Go to error", "Go to the last error in your code")

# Getting around
NEXT = Command("next", ("n",), "Next", "Go to the next lesson", footer=True, help=_STEP)
PREVIOUS = Command("previous", ("p",), "Prev", "Go to the previous lesson", help=_STEP)
LESSONS = Command("lessons", ("l",), "Lessons", "Show or hide the list of lessons")
ZOOM = Command("zoom", ("z",), "Zoom", "Enlarge the part with the focus, or restore")
PAGE_LESSON = Command("page_lesson", ("1", "f2"), "Lesson", "Show the lesson")
PAGE_CODE = Command("page_code", ("2", "f3"), "Code", "Show your code")
PAGE_LOG = Command("page_log", ("3", "f4"), "Log", "Show the log of your node")
PAGE_LIVE = Command("page_live", ("4", "f7"), "Live", "Show topics, parameters, services, live")
LIVE_TOPICS = Command("live_topics", ("T",), "Topics", "Live: show the topics, with echo, rate and plot", help=_LIVE)
LIVE_PARAMETERS = Command(
    "live_parameters", ("P",), "Parameters", "Live: show the parameters, and set them", help=_LIVE
)
LIVE_SERVICES = Command("live_services", ("S",), "Services", "Live: show the services, and call them", help=_LIVE)
SIDE_BY_SIDE = Command("side_by_side", ("L",), "Side by side", "Show the log beside Live: on or off")
PUBLISH = Command("publish", ("M",), "Publish", "Live: publish a message, or stop that")
LIVE_GRAPH = Command("live_graph", ("G",), "Graph", "Live: show the graph of nodes and topics", help=_LIVE)
LESSON_COMMAND = Command("lesson_command", ("R",), "Run command", "Type a command of the lesson into a terminal")
PAGE_TERMINAL = Command("page_terminal", ("7", "f10"), "Terminal", "Show the terminals: your own shell")
PAGE_CRITERIA = Command("page_criteria", ("5", "f8"), "Criteria", "Show the criteria")
CHECKLIST = Command("checklist", ("6", "f12"), "Checklist", "Tick what you can do by now", footer=True)
EXPORT = Command("export", ("X",), "Export", "Export the checklist and your progress")
THEME = Command("theme", ("t",), "Theme", "Dark or light theme")
HELP = Command("help", ("question_mark", "f1"), "Help", "Show all keys", footer=True)
QUIT = Command(
    "quit", ("q",), "Quit", "Stop everything and leave", footer=True, help="Stop everything and leave (Ctrl+Q, too)"
)

GROUPS: tuple[tuple[str, tuple[Command, ...]], ...] = (
    ("Your node", (RUN, STOP, RESTART, PARTNER, OTHER_FILE, OPTIONS, RESTART_ON_SAVE)),
    (
        "The check",
        (CHECK, CANCEL, WATCH, FIRST_FAILURE, EVIDENCE, EXPLAIN, ATTEMPTS, HINT, ANSWER, ANOTHER, PREDICT),
    ),
    (
        "Your code",
        (START, EDIT, SAVE, FIND, FIND_NEXT, OWN_EDITOR, NEXT_FILE, SKELETON, CHANGES, SOLUTION, AGAINST, RESET),
    ),
    ("The log", (LEVEL, FILTER, PAUSE, CLEAR, GO_TO_ERROR)),
    (
        "Getting around",
        (
            NEXT,
            PREVIOUS,
            LESSONS,
            ZOOM,
            PAGE_LESSON,
            PAGE_CODE,
            PAGE_LOG,
            PAGE_LIVE,
            LIVE_TOPICS,
            LIVE_PARAMETERS,
            LIVE_SERVICES,
            SIDE_BY_SIDE,
            PUBLISH,
            LIVE_GRAPH,
            LESSON_COMMAND,
            PAGE_TERMINAL,
            PAGE_CRITERIA,
            CHECKLIST,
            EXPORT,
            THEME,
            HELP,
            QUIT,
        ),
    ),
)
"""Every command, grouped as in the help."""

PAGES = {
    "lesson": PAGE_LESSON,
    "code": PAGE_CODE,
    "log": PAGE_LOG,
    "live": PAGE_LIVE,
    "terminal": PAGE_TERMINAL,
    "criteria": PAGE_CRITERIA,
}
"""The pages in the order of their tabs, each with the command that opens it."""

LIVE_TABS = {
    "topics": LIVE_TOPICS,
    "parameters": LIVE_PARAMETERS,
    "services": LIVE_SERVICES,
    "graph": LIVE_GRAPH,
}
"""The tabs of the live page, likewise."""


def all_commands() -> Iterator[Command]:
    """Yield every command, in the order of the help."""
    for _, group in GROUPS:
        yield from group


BY_NAME = {command.name: command for command in all_commands()}


def bindings() -> list[BindingType]:
    """Return the key bindings of the main screen."""
    return [binding for command in all_commands() for binding in command.bindings()]


EDITOR_KEYS = (
    ("Esc", "Leave the editor: letters are commands again"),
    ("Ctrl+F", "Find; Enter or ↓ next, ↑ previous, Esc ends"),
    ("Ctrl+A", "Select all; Shift with a movement key selects, too"),
    ("Ctrl+C", "Copy; Ctrl+X: cut; Ctrl+V: paste"),
    ("Ctrl+Z", "Undo; Ctrl+Y: redo"),
    ("Home", "To the beginning of the line; End: to its end"),
    ("Ctrl+Home", "To the beginning of the file; Ctrl+End: to its end"),
    ("Ctrl+←", "A word to the left; Ctrl+→: to the right"),
    ("Ctrl+W", "Delete the word before; Ctrl+K: the rest of the line"),
    ("Tab", "Indent; Backspace: back by one step"),
)
"""The editor's own keys, for the help, which lists them beside the commands above."""

TERMINAL_KEYS = (
    ("Ctrl+]", "Leave it: single keys work again (also: Ctrl+5)"),
    ("1-9", "Then: show that terminal; Enter: type into it"),
    ("+", "Then: open another terminal; -: close it"),
    ("PgUp", "With Shift: scroll back; PgDn, or any key: forward"),
    ("Ctrl+C", "Copy, while the mouse has selected text"),
)
"""What a terminal does not pass on to its program, likewise."""


def panel_bindings(*commands: Command, shown_key: int = 0, show: bool = True) -> list[BindingType]:
    """Return bindings for the footer of a focused panel: screen commands, each under its key at index `shown_key`."""
    panel: list[BindingType] = []
    for command in commands:
        key = command.keys[min(shown_key, len(command.keys) - 1)]
        panel.append(Binding(key, f"screen.do('{command.name}')", command.label, show=show, key_display=key_label(key)))
    return panel

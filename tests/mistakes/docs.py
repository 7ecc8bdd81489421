"""Write the catalogue of mistakes as Markdown into docs/mistakes: a page for each theme, and their contents.

    uv run python -m tests.mistakes.docs

A known exception is told more briefly than the others: what Python says, and the example as a difference.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from tests.mistakes.cases import all_catalogues
from tutor.content import load_course
from tutor.mistakes import CATALOGUE, Mistake, exceptions
from tutor.mistakes.pages import explanation_of, in_markdown, markdown_of

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs/mistakes"
COMMAND = "./.ci/uv run python -m tests.mistakes.docs"

TITLES = {
    "nodes": "Nodes and programs",
    "timers": "Timers and rates",
    "topics": "Topics, messages and QoS",
    "parameters": "Parameters",
    "services": "Services and clients",
    "actions": "Actions",
    "callbacks": "Callbacks and callback groups",
    "executors": "Spinning, executors and threads",
    "logging": "Logging",
    "ending": "Ending on Ctrl+C",
    "launch": "Launch files",
    "python": "Python",
    "symptoms": "When nothing else explains it",
}
"""The pages by the names of their files, in the order of the contents; those of the exercises follow."""

PAGE_OF = {
    "early_ends": "nodes",
    "ended_processes": "nodes",
    "missing_attributes": "nodes",
    "missing_files": "nodes",
    "no_node": "nodes",
    "node_names": "nodes",
    "nodes": "nodes",
    "lifecycle": "nodes",
    "process": "nodes",
    "setting_up": "nodes",
    "late_timers": "timers",
    "replaced_timers": "timers",
    "running_timers": "timers",
    "sleeping_loops": "timers",
    "timer": "timers",
    "creation": "topics",
    "messages": "topics",
    "message_fields": "topics",
    "message_symptoms": "symptoms",
    "qos": "topics",
    "qos_deliveries": "topics",
    "published_values": "topics",
    "stopped_topics": "topics",
    "topics": "topics",
    "parameter": "parameters",
    "client": "services",
    "missing_responses": "services",
    "services": "services",
    "waiting_clients": "services",
    "wrong_arithmetic": "services",
    "wrong_responses": "services",
    "actions": "actions",
    "asking_services": "callbacks",
    "asynchronous": "callbacks",
    "blocked_callbacks": "callbacks",
    "callback": "callbacks",
    "executor": "executors",
    "spinning": "executors",
    "log_options": "logging",
    "log_levels": "logging",
    "logged_exceptions": "logging",
    "logging": "logging",
    "missing_logs": "logging",
    "same_log_messages": "logging",
    "exit_codes": "ending",
    "exit_exceptions": "ending",
    "lasting_threads": "ending",
    "not_ending": "ending",
    "lifetime": "ending",
    "launch": "launch",
    "attributes": "python",
    "clocks": "python",
    "comparisons": "python",
    "hidden_modules": "python",
    "interfaces": "topics",
    "imports": "python",
    "python": "python",
    "syntax": "python",
    "uncalled_functions": "python",
    "unhandled_exceptions": "python",
    "unread_attributes": "python",
    "action_symptoms": "symptoms",
    "system_symptoms": "symptoms",
    "ending_symptoms": "symptoms",
    "launch_symptoms": "symptoms",
    "lifecycle_symptoms": "symptoms",
    "node_symptoms": "symptoms",
    "parameter_symptoms": "symptoms",
    "service_symptoms": "symptoms",
}
"""On which page a module of `tutor.mistakes.themes`, or a table of known exceptions, is, by the start of its name."""

MAX_SAID = 3


@dataclass
class Page:
    """One file: its title, its mistakes in full, and its known exceptions with what Python says in them."""

    title: str
    mistakes: list[Mistake] = field(default_factory=list)
    known: dict[str, list[str]] = field(default_factory=dict)


def documents() -> dict[str, str]:
    """All files of the folder: names and texts."""
    pages = _pages()
    texts = {f"{name}.md": _text(page) for name, page in pages.items()}
    return {"README.md": _contents(pages), **texts}


def _pages() -> Mapping[str, Page]:
    pages = {name: Page(title) for name, title in TITLES.items()}
    known = _known_exceptions()
    for entry in CATALOGUE.entries.values():
        module, said = known.get(entry.id) or (entry.find.__module__.rpartition(".")[2], [])
        page = pages[_page_of(module)]
        page.mistakes.append(entry)
        if entry.id in known:
            page.known[entry.id] = said
    packages = {lesson.check.parent.name: lesson for lesson in load_course(None).lessons}
    for where, catalogue in all_catalogues():
        if catalogue is not CATALOGUE:
            lesson = packages[where]
            pages[lesson.id] = Page(f"{lesson.id} {lesson.title}", list(catalogue.entries.values()))
    return pages


def _known_exceptions() -> Mapping[str, tuple[str, list[str]]]:
    """The name of its table, and what Python says, for each known exception's id."""
    found: dict[str, tuple[str, list[str]]] = {}
    for path in sorted(Path(exceptions.__file__).parent.glob("*.toml")):
        for known in exceptions.load(path):
            said = [example.raised for way in known.ways for example in way.examples[:1]]
            found[known.id] = (path.stem, list(dict.fromkeys(said))[:MAX_SAID])
    return found


def _page_of(module: str) -> str:
    for start in sorted(PAGE_OF, key=len, reverse=True):
        if module.startswith(start):
            return PAGE_OF[start]
    raise LookupError(f"on which page of docs/mistakes is {module}? Add it to PAGE_OF in {Path(__file__).name}")


def _contents(pages: Mapping[str, Page]) -> str:
    lines = [
        "# Mistakes",
        "",
        "What a failing check can find, by theme. `ros-tutor explain MISTAKE` shows the same pages in a terminal, and",
        "`ros-tutor explain WORDS` searches them.",
        "",
        f"These files are made from the catalogue; change the entries, and run `{COMMAND}`.",
    ]
    for name, page in pages.items():
        if list(TITLES)[-1] == name:
            continue
        lines += _list_of(name, page, f"Only in {page.title}" if name not in TITLES else page.title)
    last = list(TITLES)[-1]
    return "\n".join([*lines, *_list_of(last, pages[last], TITLES[last]), ""])


def _list_of(name: str, page: Page, title: str) -> list[str]:
    rows = [f"- [{entry.id}]({name}.md#{entry.id}): {in_markdown(entry.summary)}" for entry in page.mistakes]
    return ["", f"## [{title}]({name}.md)", "", *sorted(rows)]


def _text(page: Page) -> str:
    full = [markdown_of(entry) for entry in page.mistakes if entry.id not in page.known]
    known = [_known_text(entry, page.known[entry.id]) for entry in page.mistakes if entry.id in page.known]
    heading = f"# {page.title}\n\n[All mistakes](README.md)\n"
    return "\n".join([heading, *full, *(["## Exceptions\n", *known] if known else [])])


def _known_text(entry: Mistake, said: list[str]) -> str:
    bad, good = entry.examples[0]
    changed = [line for line in difflib.ndiff(bad.splitlines(), good.splitlines()) if not line.startswith("?")]
    parts = [f"### {entry.id}", f"**{in_markdown(entry.summary)}** {in_markdown(explanation_of(entry))}"]
    if said:
        parts.append("\n".join(["```text", *said, "```"]))
    parts.append("\n".join(["```diff", *(line.rstrip() for line in changed), "```"]))
    return "\n\n".join(parts) + "\n"


def main(say: Callable[[str], object] = print) -> None:
    """Write all files, and delete those that are no longer made."""
    FOLDER.mkdir(exist_ok=True)
    made = documents()
    for name, text in made.items():
        (FOLDER / name).write_text(text, encoding="utf-8")
    for path in FOLDER.glob("*.md"):
        if path.name not in made:
            path.unlink()
    say(f"{len(made)} files in {FOLDER.relative_to(ROOT)}")


if __name__ == "__main__":
    main()

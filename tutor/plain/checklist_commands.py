"""Commands to read, tick and export the self-assessment checklist."""

from __future__ import annotations

from pathlib import Path

from tutor.errors import CommandRefused
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.report.assessment import AssessedItem, Assessment
from tutor.report.checklist_formats import FORMATS, SUFFIXES
from tutor.report.phrases import describe_evidence, near_day
from tutor.session.paths import short_path

_MAX_EVIDENCE = 2
_FORMATS = f"{', '.join(FORMATS[:-1])} or {FORMATS[-1]}"


class ChecklistCommands:
    """The learner's own assessment of what they can do by now."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self.commands = (
            DialogCommand("checklist", "read the self-assessment checklist", self.read),
            DialogCommand("tick", "tick an item of the checklist", self.tick, "NUMBER"),
            DialogCommand("untick", "untick an item of the checklist", self.untick, "NUMBER"),
            DialogCommand(
                "export",
                f"write checklist and progress to a file in your workspace, as {_FORMATS}",
                self.export,
                "[FORMAT]",
            ),
        )

    def _assess(self) -> Assessment:
        return self._conversation.session.assess()

    async def read(self, words: list[str]) -> None:
        """Say one line per item, numbered across all groups."""
        assessment = self._assess()
        number = 0
        for group in assessment.groups:
            self._conversation.say(f"{group.title}, {group.ticked} of {len(group.items)} ticked:")
            for item in group.items:
                number += 1
                self._conversation.say(f"{number}: {_describe(item)}")
        if assessment.ready:
            self._conversation.say(f"{assessment.ready_title} {' '.join(assessment.ready_text.split())}")
        self._conversation.say(f"{assessment.ticked} of {number} ticked. tick 1 ticks the first, untick 1 unticks it.")

    async def tick(self, words: list[str]) -> None:
        """Tick items."""
        self._set_ticked(words, True)

    async def untick(self, words: list[str]) -> None:
        """Untick items."""
        self._set_ticked(words, False)

    def _set_ticked(self, words: list[str], ticked: bool) -> None:
        items = self._assess().items
        if not words:
            raise CommandRefused("Which item? Give its number, as in: tick 1. checklist lists them.")
        chosen = [_find_item(word, items) for word in words]
        if not self._conversation.session.workspace.exists:
            raise CommandRefused("Ticks are kept in your workspace, and there is none yet: say start.")
        for item in chosen:
            self._conversation.session.tick(item.id, ticked)
            self._conversation.say(f"{'Ticked' if ticked else 'No longer ticked'}: {item.text}.")
        assessment = self._assess()
        self._conversation.say(f"{assessment.ticked} of {len(items)} ticked.")
        if assessment.ready:
            self._conversation.say(assessment.ready_title)

    async def export(self, words: list[str]) -> None:
        """Write the checklist to a file; an existing file is replaced only if the learner says yes."""
        format = words[0].lower() if words else FORMATS[0]
        if format not in FORMATS:
            raise CommandRefused(f"There is no format {format}: choose {_FORMATS}.")
        root: Path = self._conversation.session.workspace.root
        if not self._conversation.session.workspace.exists:
            raise CommandRefused("There is no workspace yet to write to: say start.")
        path = root / f"checklist{SUFFIXES[format]}"
        if not self._conversation.session.export(format, path, replace=False):
            answer = await self._conversation.ask(f"{short_path(path)} exists already. Type yes to replace it: ")
            if (answer or "").strip().lower() not in ("yes", "y"):
                self._conversation.say("Not written.")
                return
            self._conversation.session.export(format, path, replace=True)
        self._conversation.say(f"Written: {short_path(path)}")


def _describe(item: AssessedItem) -> str:
    shown = "; ".join(describe_evidence(item.evidence, near_day, max_items=_MAX_EVIDENCE))
    return f"{'ticked' if item.ticked else 'not ticked'}: {item.text}.{f' Evidence: {shown}.' if shown else ''}"


def _find_item(word: str, items: tuple[AssessedItem, ...]) -> AssessedItem:
    """Return an item by its number or id. Raises CommandRefused."""
    if word.isdecimal() and 1 <= int(word) <= len(items):
        return items[int(word) - 1]
    for item in items:
        if item.id == word.lower():
            return item
    raise CommandRefused(f"There is no item {word}: they go from 1 to {len(items)}. checklist lists them.")

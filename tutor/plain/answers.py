"""Commands of exercises that hand over a system: answer what is wrong with it, or get another one."""

from __future__ import annotations

from collections.abc import Sequence

from tutor.content.cases import has_cases
from tutor.errors import CommandRefused, UsageError
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.session.paths import short_path


class Answers:
    """The learner's answer."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self.commands = (
            DialogCommand("answer", "say what is wrong with a system that was handed over, and where", self.answer),
            DialogCommand("another", "hand over another fault", self.another),
        )

    async def answer(self, words: list[str]) -> None:
        """Ask what it is, and where, by numbers; then write it into the report."""
        session, lesson = self._conversation.session, self._conversation.lesson
        try:
            cases = session.handed_over.question(lesson).cases
            what = await self._choose("What is wrong?", [*cases.kinds], [*cases.kinds.values()])
            where = await self._choose("In which file?", cases.places, cases.places) if what else ""
            if not what or not where:
                self._conversation.say("Nothing is reported.")
                return
            session.handed_over.answer(lesson, what, where)
        except UsageError as error:
            raise CommandRefused(str(error)) from error
        self._conversation.say(f"Reported: {cases.kinds[what]}, in {where}. check judges it.")

    async def another(self, words: list[str]) -> None:
        """Hand over another fault; the files that are there are moved to a folder that keeps them."""
        session, lesson = self._conversation.session, self._conversation.lesson
        if not has_cases(lesson):
            raise CommandRefused(f"There is only one of {lesson.id}.")
        placed = session.start(lesson, another=True)
        for path in placed.backups:
            self._conversation.say(f"Kept: {short_path(path)}")
        found = session.handed_over.drawn(lesson).describe()
        self._conversation.say(f"Another fault is handed over.{f' So far: {found}.' if found else ''}")

    async def _choose(self, title: str, ids: Sequence[str], choices: Sequence[str]) -> str:
        """Read the choices, and return the id of the one whose number is given; "" if none is."""
        self._conversation.say(title)
        for number, choice in enumerate(choices, 1):
            self._conversation.say(f"{number}: {choice}.")
        while True:
            word = (await self._conversation.ask(f"1 to {len(ids)}, or nothing: ") or "").strip()
            if not word:
                return ""
            if word.isdecimal() and 1 <= int(word) <= len(ids):
                return ids[int(word) - 1]
            self._conversation.say(f"There is no number {word}.")

"""Going from lesson to lesson: list, read, start, hints, solution."""

from __future__ import annotations

from tutor.content import Lesson
from tutor.errors import CommandRefused
from tutor.invocation import with_program_name
from tutor.plain import speech
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.session.paths import short_path


class Lessons:
    """The lessons, and what each has to say."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self.commands = (
            DialogCommand("lessons", "list the lessons, with your progress", self.show, others=("list",)),
            DialogCommand("lesson", "go to a lesson; its number or id alone does the same", self.choose, "NUMBER"),
            DialogCommand("next", "go to the next lesson", self.next),
            DialogCommand("previous", "go to the lesson before", self.previous, others=("prev", "back")),
            DialogCommand("read", "read the lesson; with a number, only that section", self.read, "[NUMBER]"),
            DialogCommand("criteria", "read what the check will look at", self.criteria),
            DialogCommand("start", "put the skeleton of the lesson into your workspace", self.start),
            DialogCommand("hint", "read the next hint", self.hint),
            DialogCommand("solution", "read our solution", self.solution),
        )

    async def show(self, words: list[str]) -> None:
        """One line for each."""
        progress = self._conversation.session.progress()
        for number, lesson in enumerate(self._conversation.session.lessons, 1):
            conversation = " You are here." if lesson is self._conversation.lesson else ""
            self._conversation.say(f"{number}: {self._conversation.about(lesson, progress)}{conversation}")

    async def choose(self, words: list[str]) -> None:
        """Go to a lesson."""
        if not words:
            raise CommandRefused("Which lesson? Give its number or its id, as in: lesson 2. lessons lists them.")
        self._conversation.open_lesson(self._conversation.find(words[0]))

    async def next(self, words: list[str]) -> None:
        """Go one on."""
        self._conversation.open_lesson(self._beside(1))

    async def previous(self, words: list[str]) -> None:
        """Go one back."""
        self._conversation.open_lesson(self._beside(-1))

    def _beside(self, step: int) -> Lesson:
        lessons = self._conversation.session.lessons
        wanted = lessons.index(self._conversation.lesson) + step
        if not 0 <= wanted < len(lessons):
            raise CommandRefused(f"This is the {'last' if step > 0 else 'first'} lesson.")
        return lessons[wanted]

    async def read(self, words: list[str]) -> None:
        """All of the text, or one section."""
        lesson = self._conversation.lesson
        found = speech.sections(with_program_name(lesson.body))
        if words:
            number = int(words[0]) if words[0].isdecimal() else 0
            if not 1 <= number <= len(found):
                raise CommandRefused(f"There is no section {words[0]}: they go from 1 to {len(found)}.")
            self._section(number, found)
            return
        self._conversation.say(f"{lesson.id} {lesson.title}, {lesson.difficulty.value}. {lesson.objective.strip()}")
        self._conversation.say(
            f"{speech.counted(len(found), 'section')}: {speech.listed(section.title for section in found)}. "
            "read 2 reads the second only."
        )
        for number in range(1, len(found) + 1):
            self._section(number, found)

    def _section(self, number: int, found: list[speech.Section]) -> None:
        section = found[number - 1]
        self._conversation.say(f"Section {number} of {len(found)}: {section.title}.")
        for line in section.lines:
            self._conversation.say(line)

    async def criteria(self, words: list[str]) -> None:
        """One line for each."""
        for criterion in self._conversation.lesson.criteria:
            self._conversation.say(f"{criterion.id}{' (bonus)' if criterion.bonus else ''}: {criterion.text}.")

    async def start(self, words: list[str]) -> None:
        """Put in what is not there; say where it is."""
        session, lesson = self._conversation.session, self._conversation.lesson
        if not session.workspace.exists:
            self._conversation.say(f"Creating your workspace: {short_path(session.workspace.root)}.")
        placed = session.start(lesson)
        for path in placed.written:
            self._conversation.say(f"To edit: {short_path(path)}")
        for path in placed.already_there:
            self._conversation.say(f"Already there, and not changed: {short_path(path)}")
        self._conversation.say("Edit it in your editor, save it, then say check.")

    async def hint(self, words: list[str]) -> None:
        """Read one more."""
        session, lesson = self._conversation.session, self._conversation.lesson
        of = len(lesson.hints)
        number, again = 1, False
        if session.workspace.exists:
            number, again = session.workspace.progress(self._conversation.say).next_hint(lesson.id, of=of)
        self._conversation.say(
            f"Hint {number} of {of}{', again' if again else ''}: {_in_a_line(lesson.hints[number - 1])}"
        )
        if number == of:
            self._conversation.say("That was the last hint. solution reads our solution.")

    async def solution(self, words: list[str]) -> None:
        """Read it; before a pass, only where the learner says so."""
        lesson = self._conversation.lesson
        if not self._conversation.session.progress().of(lesson.id).is_passed:
            answer = await self._conversation.ask(
                "You have not passed this lesson yet. Type yes to read our solution: "
            )
            if (answer or "").strip().lower() not in ("yes", "y"):
                self._conversation.say("Not read.")
                return
        for file in lesson.files:
            lines = speech.code(file.solution.read_text(encoding="utf-8"))
            self._conversation.say(f"{file.name}, {speech.counted(len(lines), 'line')} of code:")
            for line in lines:
                self._conversation.say(line)
            self._conversation.say(f"End of {file.name}.")


def _in_a_line(markdown: str) -> str:
    return " ".join(line for section in speech.sections(with_program_name(markdown)) for line in section.lines)

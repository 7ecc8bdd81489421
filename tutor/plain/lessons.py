"""Going from lesson to lesson: list, read, start, hints, solution."""

from __future__ import annotations

from tutor.content import Lesson
from tutor.invocation import as_started
from tutor.judge.verdict import Status
from tutor.plain import speech
from tutor.plain.here import Command, Here, Refused, short


class Lessons:
    """The lessons, and what each has to say."""

    def __init__(self, here: Here) -> None:
        self._here = here
        self.commands = (
            Command("lessons", "list the lessons, with your progress", self.show, others=("list",)),
            Command("lesson", "go to a lesson; its number or id alone does the same", self.choose, "NUMBER"),
            Command("next", "go to the next lesson", self.next),
            Command("previous", "go to the lesson before", self.previous, others=("prev", "back")),
            Command("read", "read the lesson; with a number, only that section", self.read, "[NUMBER]"),
            Command("criteria", "read what the check will look at", self.criteria),
            Command("start", "put the skeleton of the lesson into your workspace", self.start),
            Command("hint", "read the next hint", self.hint),
            Command("solution", "read our solution", self.solution),
        )

    async def show(self, words: list[str]) -> None:
        """One line for each."""
        progress = self._here.desk.progress()
        for number, lesson in enumerate(self._here.desk.lessons, 1):
            here = " You are here." if lesson is self._here.lesson else ""
            self._here.say(f"{number}: {self._here.about(lesson, progress)}{here}")

    async def choose(self, words: list[str]) -> None:
        """Go to a lesson."""
        if not words:
            raise Refused("Which lesson? Give its number or its id, as in: lesson 2. lessons lists them.")
        self._here.go_to(self._here.find(words[0]))

    async def next(self, words: list[str]) -> None:
        """Go one on."""
        self._here.go_to(self._beside(1))

    async def previous(self, words: list[str]) -> None:
        """Go one back."""
        self._here.go_to(self._beside(-1))

    def _beside(self, step: int) -> Lesson:
        lessons = self._here.desk.lessons
        wanted = lessons.index(self._here.lesson) + step
        if not 0 <= wanted < len(lessons):
            raise Refused(f"This is the {'last' if step > 0 else 'first'} lesson.")
        return lessons[wanted]

    async def read(self, words: list[str]) -> None:
        """All of the text, or one section."""
        lesson = self._here.lesson
        found = speech.sections(as_started(lesson.body))
        if words:
            number = int(words[0]) if words[0].isdecimal() else 0
            if not 1 <= number <= len(found):
                raise Refused(f"There is no section {words[0]}: they go from 1 to {len(found)}.")
            self._section(number, found)
            return
        self._here.say(f"{lesson.id} {lesson.title}, {lesson.difficulty.value}. {lesson.objective.strip()}")
        self._here.say(
            f"{speech.counted(len(found), 'section')}: {speech.listed(section.title for section in found)}. "
            "read 2 reads the second only."
        )
        for number in range(1, len(found) + 1):
            self._section(number, found)

    def _section(self, number: int, found: list[speech.Section]) -> None:
        section = found[number - 1]
        self._here.say(f"Section {number} of {len(found)}: {section.title}.")
        for line in section.lines:
            self._here.say(line)

    async def criteria(self, words: list[str]) -> None:
        """One line for each."""
        for criterion in self._here.lesson.criteria:
            self._here.say(f"{criterion.id}{' (bonus)' if criterion.bonus else ''}: {criterion.text}.")

    async def start(self, words: list[str]) -> None:
        """Put in what is not there; say where it is."""
        desk, lesson = self._here.desk, self._here.lesson
        if not desk.workspace.exists:
            self._here.say(f"Creating your workspace: {short(desk.workspace.root)}.")
        placed = desk.start(lesson)
        for path in placed.written:
            self._here.say(f"To edit: {short(path)}")
        for path in placed.already_there:
            self._here.say(f"Already there, and not changed: {short(path)}")
        self._here.say("Edit it in your editor, save it, then say check.")

    async def hint(self, words: list[str]) -> None:
        """Read one more."""
        desk, lesson = self._here.desk, self._here.lesson
        of = len(lesson.hints)
        number, again = 1, False
        if desk.workspace.exists:
            number, again = desk.workspace.progress(self._here.say).next_hint(lesson.id, of=of)
        self._here.say(f"Hint {number} of {of}{', again' if again else ''}: {_in_a_line(lesson.hints[number - 1])}")
        if number == of:
            self._here.say("That was the last hint. solution reads our solution.")

    async def solution(self, words: list[str]) -> None:
        """Read it; before a pass, only where the learner says so."""
        lesson = self._here.lesson
        if self._here.desk.progress().of(lesson.id).best is not Status.PASSED:
            answer = await self._here.ask("You have not passed this lesson yet. Type yes to read our solution: ")
            if (answer or "").strip().lower() not in ("yes", "y"):
                self._here.say("Not read.")
                return
        for file in lesson.files:
            lines = speech.code(file.solution.read_text(encoding="utf-8"))
            self._here.say(f"{file.name}, {speech.counted(len(lines), 'line')} of code:")
            for line in lines:
                self._here.say(line)
            self._here.say(f"End of {file.name}.")


def _in_a_line(markdown: str) -> str:
    return " ".join(line for section in speech.sections(as_started(markdown)) for line in section.lines)

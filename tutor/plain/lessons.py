"""Commands on lessons: list, open, read, start, hint, solution."""

from __future__ import annotations

from tutor.content import Lesson
from tutor.errors import CommandRefused
from tutor.invocation import with_program_name
from tutor.judge.wording import counted
from tutor.plain import speech
from tutor.plain.conversation import Conversation, DialogCommand
from tutor.session.paths import short_path

_ABOUT_THE_APP = "In the app"
_HERE = (
    "Its keys are the app's. Here, run does what r does there, partner b, and stop ends them; log and log partner read "
    "the two logs; topic, echo, param and service are for Live."
)


class Lessons:
    """The lessons and their texts."""

    def __init__(self, conversation: Conversation) -> None:
        self._conversation = conversation
        self.commands = (
            DialogCommand("lessons", "list the lessons, with your progress", self.show, aliases=("list",)),
            DialogCommand("lesson", "go to a lesson; its number or id alone does the same", self.choose, "NUMBER"),
            DialogCommand("next", "go to the next lesson", self.next),
            DialogCommand("previous", "go to the previous lesson", self.previous, aliases=("prev", "back")),
            DialogCommand("read", "read the lesson; with a number, only that section", self.read, "[NUMBER]"),
            DialogCommand("criteria", "read what the check will look at", self.criteria),
            DialogCommand("start", "add the skeleton of the lesson to your workspace", self.start),
            DialogCommand("hint", "read the next hint", self.hint),
            DialogCommand("solution", "read our solution", self.solution),
        )

    async def show(self, words: list[str]) -> None:
        """Say one line per lesson."""
        progress = self._conversation.session.progress()
        course = self._conversation.session.course
        heading = ""
        for number, lesson in enumerate(course.lessons, 1):
            if len(course.headings) > 1 and lesson.heading != heading:
                heading = lesson.heading
                self._conversation.say(f"{heading}:")
            if lesson.beyond and not course.lessons[number - 2].beyond:
                self._conversation.say("Beyond the course:")
            marker = " You are here." if lesson is self._conversation.lesson else ""
            self._conversation.say(f"{number}: {self._conversation.describe(lesson, progress)}{marker}")

    async def choose(self, words: list[str]) -> None:
        """Go to a lesson."""
        if not words:
            raise CommandRefused("Which lesson? Give its number or its id, as in: lesson 2. lessons lists them.")
        self._conversation.open_lesson(self._conversation.find_lesson(words[0]))

    async def next(self, words: list[str]) -> None:
        """Go to the next lesson."""
        self._conversation.open_lesson(self._neighbour(1))

    async def previous(self, words: list[str]) -> None:
        """Go to the previous lesson."""
        self._conversation.open_lesson(self._neighbour(-1))

    def _neighbour(self, step: int) -> Lesson:
        lessons = self._conversation.session.lessons
        index = lessons.index(self._conversation.lesson) + step
        if not 0 <= index < len(lessons):
            raise CommandRefused(f"This is the {'last' if step > 0 else 'first'} lesson.")
        return lessons[index]

    async def read(self, words: list[str]) -> None:
        """Read the whole text, or one section."""
        lesson = self._conversation.lesson
        sections = speech.sections(with_program_name(lesson.body))
        if words:
            number = int(words[0]) if words[0].isdecimal() else 0
            if not 1 <= number <= len(sections):
                raise CommandRefused(f"There is no section {words[0]}: they go from 1 to {len(sections)}.")
            self._read_section(number, sections)
            return
        self._conversation.say(f"{lesson.id} {lesson.title}, {lesson.difficulty.value}. {lesson.objective.strip()}")
        self._conversation.say(
            f"{counted(len(sections), 'section')}: {speech.listed(section.title for section in sections)}. "
            "read 2 reads the second only."
        )
        for number in range(1, len(sections) + 1):
            self._read_section(number, sections)

    def _read_section(self, number: int, sections: list[speech.Section]) -> None:
        section = sections[number - 1]
        self._conversation.say(f"Section {number} of {len(sections)}: {section.title}.")
        if section.title == _ABOUT_THE_APP:
            self._conversation.say(_HERE)
        for line in section.lines:
            self._conversation.say(line)

    async def criteria(self, words: list[str]) -> None:
        """Say one line per criterion."""
        for criterion in self._conversation.lesson.criteria:
            self._conversation.say(f"{criterion.id}{' (bonus)' if criterion.bonus else ''}: {criterion.text}.")

    async def start(self, words: list[str]) -> None:
        """Copy the missing skeleton files into the workspace, and say where they are."""
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
        """Read the next hint."""
        session, lesson = self._conversation.session, self._conversation.lesson
        count = len(lesson.hints)
        number, again = 1, False
        if session.workspace.exists:
            number, again = session.workspace.progress(self._conversation.say).next_hint(lesson.id, total=count)
        self._conversation.say(
            f"Hint {number} of {count}{', again' if again else ''}: {_as_one_line(lesson.hints[number - 1])}"
        )
        if number == count:
            self._conversation.say("That was the last hint. solution reads our solution.")

    async def solution(self, words: list[str]) -> None:
        """Read the solution; before a pass, only if the learner says yes."""
        lesson = self._conversation.lesson
        if not self._conversation.session.progress().of(lesson.id).is_passed:
            answer = await self._conversation.ask(
                "You have not passed this lesson yet. Type yes to read our solution: "
            )
            if (answer or "").strip().lower() not in ("yes", "y"):
                self._conversation.say("Not read.")
                return
        self._conversation.session.show_solution(lesson)
        for file in lesson.files:
            lines = speech.code(self._conversation.session.handed_over.solution(lesson, file))
            self._conversation.say(f"{file.name}, {counted(len(lines), 'line')} of code:")
            for line in lines:
                self._conversation.say(line)
            self._conversation.say(f"End of {file.name}.")


def _as_one_line(markdown: str) -> str:
    return " ".join(line for section in speech.sections(with_program_name(markdown)) for line in section.lines)

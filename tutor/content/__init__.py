"""The course: lessons and the self-assessment checklist, as plain data, independent of ROS and the terminal."""

from tutor.content.counts import Counts
from tutor.content.live import LiveTopic, LiveView, Partner
from tutor.content.loader import load_course
from tutor.content.model import (
    Checklist,
    ChecklistGroup,
    ChecklistItem,
    Course,
    CriterionText,
    Difficulty,
    Lesson,
    LessonFile,
)
from tutor.content.predictions import Option, Prediction
from tutor.content.problem import Problem

__all__ = [
    "Checklist",
    "ChecklistGroup",
    "ChecklistItem",
    "Counts",
    "Course",
    "CriterionText",
    "Difficulty",
    "Lesson",
    "LessonFile",
    "LiveTopic",
    "LiveView",
    "Option",
    "Partner",
    "Prediction",
    "Problem",
    "load_course",
]

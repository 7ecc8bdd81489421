"""The learner's workspace: a real colcon workspace, the files in it to check, and the progress."""

from tutor.workspace.app_state import AppState, AppStateFile, RunOptions
from tutor.workspace.atomic import write_atomically
from tutor.workspace.domain import domain_of, given_domain
from tutor.workspace.errors import StorageError, SubmissionError, WorkspaceError
from tutor.workspace.place import Workspace, find_workspace
from tutor.workspace.placing import Placed, place
from tutor.workspace.progress import Attempt, ExerciseProgress, Progress
from tutor.workspace.progress_file import ProgressFile
from tutor.workspace.saving import Saved, keep_aside, read_source, save_over
from tutor.workspace.standing import Standing, State, last_met, standing
from tutor.workspace.starting import TEMPLATE, Started, start, start_in
from tutor.workspace.submissions import find_submission, is_own, is_started, solution

__all__ = [
    "TEMPLATE",
    "AppState",
    "AppStateFile",
    "Attempt",
    "ExerciseProgress",
    "Placed",
    "Progress",
    "ProgressFile",
    "RunOptions",
    "Saved",
    "Standing",
    "Started",
    "State",
    "StorageError",
    "SubmissionError",
    "Workspace",
    "WorkspaceError",
    "domain_of",
    "find_submission",
    "find_workspace",
    "given_domain",
    "is_own",
    "is_started",
    "keep_aside",
    "last_met",
    "place",
    "read_source",
    "save_over",
    "solution",
    "standing",
    "start",
    "start_in",
    "write_atomically",
]

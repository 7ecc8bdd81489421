"""The learner's workspace: a real colcon workspace, with the files to check and the saved progress."""

from tutor.workspace.app_state import AppState, AppStateFile, RunOptions
from tutor.workspace.atomic import write_atomically
from tutor.workspace.digests import Digests, digest_of_file, digest_of_text, digests_of, has_changed, version_of
from tutor.workspace.domain import domain_of, given_domain
from tutor.workspace.exercise_states import ExerciseState, State, exercise_state, last_met, states_of, versions_of
from tutor.workspace.last_checks import LastCheck
from tutor.workspace.layout import Workspace, find_workspace
from tutor.workspace.placing_files import Placed, place_files
from tutor.workspace.progress import Attempt, ExerciseProgress, Help, Predicted, Progress
from tutor.workspace.progress_file import ProgressFile
from tutor.workspace.recording import record
from tutor.workspace.saving import Saved, back_up_file, overwrite_file, read_source
from tutor.workspace.starting import TEMPLATE, Started, start, start_another, start_in
from tutor.workspace.submission_lookup import (
    NOT_STARTED,
    find_submission,
    is_own,
    is_started,
    look_up,
    missing_result,
    solution,
)

__all__ = [
    "NOT_STARTED",
    "TEMPLATE",
    "AppState",
    "AppStateFile",
    "Attempt",
    "Digests",
    "ExerciseProgress",
    "ExerciseState",
    "Help",
    "LastCheck",
    "Placed",
    "Predicted",
    "Progress",
    "ProgressFile",
    "RunOptions",
    "Saved",
    "Started",
    "State",
    "Workspace",
    "back_up_file",
    "digest_of_file",
    "digest_of_text",
    "digests_of",
    "domain_of",
    "exercise_state",
    "find_submission",
    "find_workspace",
    "given_domain",
    "has_changed",
    "is_own",
    "is_started",
    "last_met",
    "look_up",
    "missing_result",
    "overwrite_file",
    "place_files",
    "read_source",
    "record",
    "solution",
    "start",
    "start_another",
    "start_in",
    "states_of",
    "version_of",
    "versions_of",
    "write_atomically",
]

"""The entries of the catalogue, by theme; imported in the order in which they are asked.

Among entries with the same kind of evidence, the earlier one is asked first.
"""

# ruff: noqa: I001
from tutor.mistakes.themes import stopped_topics as stopped_topics
from tutor.mistakes.themes import missing_files as missing_files
from tutor.mistakes.themes import usual_messages as usual_messages
from tutor.mistakes.themes import clients as clients
from tutor.mistakes.themes import answers as answers
from tutor.mistakes.themes import missing_attributes as missing_attributes
from tutor.mistakes.themes import hidden_modules as hidden_modules
from tutor.mistakes.themes import responses as responses
from tutor.mistakes.themes import known_exceptions as known_exceptions
from tutor.mistakes.themes import logged_exceptions as logged_exceptions
from tutor.mistakes.themes import process as process
from tutor.mistakes.themes import early_ends as early_ends
from tutor.mistakes.themes import no_node as no_node
from tutor.mistakes.themes import setting_up as setting_up
from tutor.mistakes.themes import blocked_callbacks as blocked_callbacks
from tutor.mistakes.themes import spinning as spinning
from tutor.mistakes.themes import executors as executors
from tutor.mistakes.themes import launch_start as launch_start
from tutor.mistakes.themes import launch_loading as launch_loading
from tutor.mistakes.themes import launch_remappings as launch_remappings
from tutor.mistakes.themes import launch_scopes as launch_scopes
from tutor.mistakes.themes import launch_names as launch_names
from tutor.mistakes.themes import launch_effects as launch_effects
from tutor.mistakes.themes import launch_nodes as launch_nodes
from tutor.mistakes.themes import nodes as nodes
from tutor.mistakes.themes import parentheses as parentheses
from tutor.mistakes.themes import messages as messages
from tutor.mistakes.themes import published_values as published_values
from tutor.mistakes.themes import qos as qos
from tutor.mistakes.themes import topics as topics
from tutor.mistakes.themes import timer_periods as timer_periods
from tutor.mistakes.themes import parameter_effects as parameter_effects
from tutor.mistakes.themes import timer_delays as timer_delays
from tutor.mistakes.themes import replaced_timers as replaced_timers
from tutor.mistakes.themes import timers as timers
from tutor.mistakes.themes import timer_paces as timer_paces
from tutor.mistakes.themes import parameter_declarations as parameter_declarations
from tutor.mistakes.themes import parameter_values as parameter_values
from tutor.mistakes.themes import parameter_refusals as parameter_refusals
from tutor.mistakes.themes import parameter_callback_results as parameter_callback_results
from tutor.mistakes.themes import parameter_callbacks as parameter_callbacks
from tutor.mistakes.themes import bad_values as bad_values
from tutor.mistakes.themes import services as services
from tutor.mistakes.themes import wrong_answers as wrong_answers
from tutor.mistakes.themes import callback_groups as callback_groups
from tutor.mistakes.themes import threads as threads
from tutor.mistakes.themes import attributes as attributes
from tutor.mistakes.themes import clocks as clocks
from tutor.mistakes.themes import python as python
from tutor.mistakes.themes import wrong_results as wrong_results
from tutor.mistakes.themes import log_options as log_options
from tutor.mistakes.themes import logging as logging
from tutor.mistakes.themes import ending as ending
from tutor.mistakes.themes import exit_codes as exit_codes
from tutor.mistakes.themes import not_ending as not_ending
from tutor.mistakes.themes import lasting_threads as lasting_threads
from tutor.mistakes.themes import loops as loops
from tutor.mistakes.themes import unhandled as unhandled
from tutor.mistakes.themes import more_symptoms as more_symptoms
from tutor.mistakes.themes import actions as actions
from tutor.mistakes.themes import parameter_symptoms as parameter_symptoms
from tutor.mistakes.themes import symptoms as symptoms

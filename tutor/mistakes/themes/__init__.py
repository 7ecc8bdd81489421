"""The entries of the catalogue, by theme; imported in the order in which they are asked.

Among entries with the same kind of evidence, the earlier one is asked first.
"""

from tutor.mistakes import exceptions as exceptions  # isort: split

from tutor.mistakes.themes import timer_periods as timer_periods  # isort: split

from tutor.mistakes.themes import timers as timers  # isort: split

from tutor.mistakes.themes import nodes as nodes  # isort: split

from tutor.mistakes.themes import qos as qos  # isort: split

from tutor.mistakes.themes import topics as topics  # isort: split

from tutor.mistakes.themes import more_symptoms as more_symptoms
from tutor.mistakes.themes import symptoms as symptoms

"""I1.2: the mistakes that only this exercise can know, in the order in which they are asked."""

# ruff: noqa: I001
from checks.i1_2_message_statistics.mistakes import late as late
from checks.i1_2_message_statistics.mistakes import counts as counts
from checks.i1_2_message_statistics.mistakes import gaps as gaps
from checks.i1_2_message_statistics.mistakes import gap_faults as gap_faults
from checks.i1_2_message_statistics.mistakes import rates as rates
from checks.i1_2_message_statistics.mistakes import restarts as restarts
from checks.i1_2_message_statistics.mistakes import summaries as summaries
from checks.i1_2_message_statistics.mistakes import summary_contents as summary_contents
from checks.i1_2_message_statistics.mistakes.entries import CATALOGUE as CATALOGUE

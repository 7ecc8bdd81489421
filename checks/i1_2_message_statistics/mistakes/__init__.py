"""I1.2: the mistakes that only this exercise can know, in the order in which they are asked."""

# ruff: noqa: I001
from checks.i1_2_message_statistics.mistakes import late_messages as late_messages
from checks.i1_2_message_statistics.mistakes import miscounts as miscounts
from checks.i1_2_message_statistics.mistakes import gap_causes as gap_causes
from checks.i1_2_message_statistics.mistakes import gap_faults as gap_faults
from checks.i1_2_message_statistics.mistakes import stated_rates as stated_rates
from checks.i1_2_message_statistics.mistakes import after_restart as after_restart
from checks.i1_2_message_statistics.mistakes import summary_times as summary_times
from checks.i1_2_message_statistics.mistakes import summary_contents as summary_contents
from checks.i1_2_message_statistics.mistakes.entries import CATALOGUE as CATALOGUE

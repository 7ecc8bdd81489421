"""I1.3: the requirements, and the facts that the scenarios gather for the judges."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from tutor.judge.trace import CallAnswer, Ending, Exit, Level, LogRecord, OutputLine, ServedRequest, Trace
from tutor.judge.tracebacks import Frame, failed_outside_callbacks
from tutor.judge.wording import shape
from tutor.ros_model import ServiceEndpoint

SERVER, CLIENT = "calculator_server.py", "calculator_client.py"
TYPE = "example_interfaces/srv/AddTwoInts"
OPERATOR_SIGNS = {"/add": "+", "/subtract": "-", "/multiply": "*", "/divide": "/"}
EASY_OPERANDS = (6, 3)
GOOD_DIVISIONS = 3
"""How often to divide before the division by zero.

Whether the answer of a server gets out that ends in the callback is a race; a MultiThreadedExecutor raises an exception
only when it is woken up by the next call, and may answer that one.
"""
DIVISIONS_AFTER_ZERO = ((18, 3), (-9, 0), (0, 0), (35, 5))
"""Divisions to request after the first one by zero: a good one, two more by zero, and a good one."""
ANSWER_S = 5.0
"""Time limit for the answer to a service call."""
CLIENT_S = 15.0
"""Time limit for the whole run of the client."""
SERVER_DELAY_S = 0.7
"""Delay from the first service client to our servers coming up, about a second after the program's start.

A client that does not wait has sent its request by then; one that waits in steps of a second still finds them.
"""
NO_CLIENT_GRACE_S = 1.0
"""Grace period for a node without a service client: it may look for our servers before it creates one."""
NO_PROGRESS_S = 1.0
"""A client that has sent and printed nothing for so long may be stuck: another start tells."""
DELAYED_EXIT_S = 0.5
"""Time within which a node that does not survive a division by zero exits."""
STUCK_CALL_S = 1.5
"""Time given to a repeated, previously unanswered call before the node counts as stuck in it."""
LOG_DELAY_S = 2.0
"""Longest delay between the answer to a call and the log messages about it."""

_WORDS = r"""
zero null cero zéro nul\b noll nolla sıfır zerem zera nula nulla нол нул 零 ゼロ 제로 0으로 μηδέν صفر אפס शून्य
error fehler erreur errore erro\b fout fel\b feil fejl virhe błąd blad chyba hiba hata ошибк помилк 錯誤 错误 エラー
오류 σφάλμα خطأ שגיאה lỗi kesalahan
exception warn fail invalid illegal undefined impossib cannot can't unable refus reject forbid infinit nan\b
not_allowed not_possible not_defined not_permitted not_valid can_not n/a
ungültig nicht unmöglich undefiniert verboten inválid invalide interdit indéfini indefinid impossível não no_se_puede
no_permitid no_definid non_si_può non_valid non_definit
нельзя невозмож недопуст 不能 无效 無效 未定義 未定义 できません 無理 不可 불가
\bnot\b n['’]t\b never oops hoppla \bups\b problem attention caution achtung vorsicht non-?zero
(?<![^\W\x5f])err(?![^\W\x5f]) abort cancel wrong \bbad(?:\b|\x5f|request|input|divisor) \bden(?:y|ied) prohibit
disallow unsupported unaccept unsuccess \bfault \bhalt ignored ignoring undef indetermin meaningless overflow
\bdomain\b sorry ∞ \bno_(?:\w+_)?(?:result|answer|quotient|solution) \b(?:ok|success\w*|valid)["']?\s*[:=]\s*false
(?:!=|<>|≠)\s*0(?![\d.]) (?:different_from|other_than|but)_0(?![\d.])
kein ungueltig unmoeglich nöd falsch niet\b geen\b ongeldig inte\b ikke ogiltig omöjlig \bei_voi mahdoto
\bno_es \bno_puede imposib \bno_è \bnon\b \bne_peut \bne_doit pas_possible atenção cuidado \bnie\b nelze nejde
nemož nemůž nemogu nije_mog \bne_mo \bnem\b \bnu_se \bnu_po bölünem bölünmez geçersiz tanımsız \bне\b неможлив δεν
αδύνατ
لا_يمكن غير אי_אפשר לא_ניתן नहीं अमान्य không tidak \bnol\b gagal 不 除零 ません ない 없 ไม่
❌ ⚠ ✗ ✘ ✖ 🚫 ⛔ 💥 🛑
"""
_BY_ZERO = r"""
(?<!\d )\b(?:divi|teil|deel|del|dziel|dělen|делен|ділен|dijel|bölme)\w*
    [ _-](?:by|durch|par|por|per|door|przez|na|на|entre|med|s|la)[ _-]0(?![\d.])
\bdiv(?:ision|ide)?[_/-]?(?:[ _-]?by[ _-]?)?0\b
(?:divisor\w*|diviseur|d[eé]nomina\w+|nenner|teiler|noemer|deler|nämnare|jmenovatel|mianownik|знаменател\w*|делител\w*)
    \W*(?:\w{1,5}\W+)?0(?![\d.])
"""
SAYS_ERROR = re.compile(
    "|".join(word.replace("_", " ") for word in _WORDS.split())
    + "".join(f"|{form}" for form in _BY_ZERO.replace("\n    ", "").split("\n") if form),
    re.IGNORECASE,
)
"""Matches a log message that reports a problem, in any of the languages that learners write."""


ENDED_BY_A_CALL = "not judged, because a call has ended the server: `operations` shows why"


@dataclass(frozen=True)
class ServiceCalls:
    """The server's answers, in the order of the calls.

    `spins`: whether the node had answered a parameter call before. `stuck`: the node's stack, innermost frame first,
    during a call that it did not answer. `ready`: whether nothing but the calls can have ended the server, since it was
    up and, as far as can be seen, spinning when the first one was made.
    """

    trace: Trace
    answers: tuple[CallAnswer, ...]
    spins: bool = True
    stuck: tuple[Frame, ...] = ()
    ending: Ending | None = None
    ready: bool = True

    @property
    def ended_by_a_call(self) -> bool:
        """Whether a call ended the server, whether it was answered or not: that the answer gets out is a race."""
        if not self.ready or not self.answers or self.trace.exit is None:
            return False
        answered = any(answer.response is not None for answer in self.answers)
        return answered or not failed_outside_callbacks(self.trace)

    def of(self, service: str) -> tuple[CallAnswer, ...]:
        return tuple(answer for answer in self.answers if answer.service == service)


@dataclass(frozen=True)
class Division:
    """A good division, the same again, one by zero, and the calls after it.

    `again`: those after the first good one; a server that this has ended does not answer all of them. `ordinary`: what
    was logged before the division by zero, `logged`: what was logged from then on. `at_end`: if that reports no error,
    the output during shutdown.
    """

    trace: Trace
    before: CallAnswer | None = None
    again: tuple[CallAnswer, ...] = ()
    by_zero: CallAnswer | None = None
    after: tuple[CallAnswer, ...] = ()
    ordinary: tuple[LogRecord, ...] = ()
    logged: tuple[LogRecord, ...] = ()
    at_end: tuple[OutputLine, ...] = ()


MIN_CPU_WAIT_S = 0.15
"""CPU wait from which a client that exited is run again before it is reported to have given up too early."""
MIN_CPU_WAIT_AT_LIMIT_S = 2.0
"""The same for a client still running at the time limit: it has had some 13 s, less this, to find our servers."""


@dataclass(frozen=True)
class ClientRun:
    """A run of the client against our servers; `trace` is None if the submission has no client.

    `stuck`: the stack, innermost frame first, of a client that did not exit within `watched_s`. `clients`: its service
    clients. `up_s`: the time from its start until our servers came up, None if it had exited by then. `cpu_wait_s`: how
    long the client, or we, waited for a CPU until our servers were up.
    """

    trace: Trace | None
    served: tuple[ServedRequest, ...] = ()
    exit: Exit | None = None
    stuck: tuple[Frame, ...] = ()
    clients: tuple[ServiceEndpoint, ...] = ()
    up_s: float | None = None
    cpu_wait_s: float = 0.0
    watched_s: float = CLIENT_S

    @property
    def slowed(self) -> bool:
        """Whether a busy machine may have kept the client from finding our servers.

        A client with incompatible QoS would not have found them on an idle machine either.
        """
        never_met = any(
            each.reliability == "best_effort" or each.durability == "transient_local" for each in self.clients
        )
        if self.served or never_met:
            return False
        return self.cpu_wait_s >= (MIN_CPU_WAIT_S if self.exit is not None else MIN_CPU_WAIT_AT_LIMIT_S)


def correct_result(service: str, a: int, b: int) -> int:
    """Return the correct result (0 for a division by zero, where any answer is accepted)."""
    return {"/add": a + b, "/subtract": a - b, "/multiply": a * b, "/divide": a // b if b else 0}[service]


def missing_services(services: Sequence[ServiceEndpoint]) -> list[str]:
    """The required services that are not offered with the required type."""
    offered = {service.name for service in services if service.type == TYPE}
    return [name for name in OPERATOR_SIGNS if name not in offered]


def find_complaints(ordinary: Sequence[LogRecord], logged: Sequence[LogRecord]) -> list[LogRecord]:
    """Find the messages that report a problem, leaving out those that a good call logs as well."""
    usual = {(log.level, shape(log.text)) for log in ordinary}
    return [
        log
        for log in logged
        if (log.level, shape(log.text)) not in usual and (log.level >= Level.WARN or SAYS_ERROR.search(log.text))
    ]

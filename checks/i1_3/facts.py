"""I1.3: what is asked of the node, and the facts that are gathered."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from tutor.judge import causes
from tutor.judge.trace import CallAnswer, Ending, Exit, Level, LogRecord, OutputLine, ServedRequest, Trace
from tutor.judge.tracebacks import Frame
from tutor.judge.wording import shape
from tutor.ros_model import ServiceEndpoint

SERVER, CLIENT = "calculator_server.py", "calculator_client.py"
TYPE = "example_interfaces/srv/AddTwoInts"
SIGNS = {"/add": "+", "/subtract": "-", "/multiply": "*", "/divide": "/"}
EASY = (6, 3)
AFTER_ZERO = ((18, 3), (-9, 0), (0, 0), (35, 5))
"""What is divided after a division by zero: well, by zero again, and well."""
ANSWER_S = 5.0
CLIENT_S = 15.0
LATER_S = 0.7
"""Our servers come up this long after its first service client, about a second after the program's start.

Anyone who does not wait for them has called by then; anyone who waits for a second at a time finds them.
"""
NO_CLIENT_S = 1.0
"""A node that makes no service client for this long may look for our servers before it does."""
AFTERWARDS_S = 0.5
"""A node that gives up after a division by zero does so within this time."""
STUCK_S = 1.5
"""A call that was not answered once is given this long, then the node is stuck in it."""
LOG_S = 2.0
"""What a node logs about a call may come this much later than its answer."""

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
"""Words by which a log message says that something is wrong, in the languages that learners log in."""


@dataclass(frozen=True)
class ServiceCalls:
    """What the server answered: one list of answers, in the order in which they were asked for.

    `spins`: whether the node answered a parameter call before; `stuck`: where it was when a call was not answered.
    """

    trace: Trace
    answers: tuple[CallAnswer, ...]
    spins: bool = True
    stuck: tuple[Frame, ...] = ()
    ending: Ending | None = None

    def of(self, service: str) -> tuple[CallAnswer, ...]:
        return tuple(answer for answer in self.answers if answer.service == service)


@dataclass(frozen=True)
class Division:
    """A good division, one by zero, and what came after; `said` is what was logged about the division by zero.

    `at_end`: where nothing was said of an error, what the process wrote when it was ended.
    """

    trace: Trace
    before: CallAnswer | None = None
    by_zero: CallAnswer | None = None
    after: tuple[CallAnswer, ...] = ()
    ordinary: tuple[LogRecord, ...] = ()
    said: tuple[LogRecord, ...] = ()
    at_end: tuple[OutputLine, ...] = ()


ROUGH_S = 0.15
"""Where the machine takes this much from a client, it is tried again before it is said to have given up too soon."""
MUCH_S = 2.0
"""The same for one that is still there when its time is over: it has had some 13 s, less this, to find our servers."""


@dataclass(frozen=True)
class ClientRun:
    """A run of the client against our servers. None of it where the submission has no client.

    `up_s`: how long after its start our servers came up; None where it had ended by then. `stuck`: where it was when it
    did not end, for which it was watched for `watched_s`; `clients`: the service clients that it had. `cpu_wait_s`: how
    long the machine kept it, or us, from running until our servers were up.
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
        """Whether it looked for our servers later than it would have, or we brought them up later.

        One whose clients cannot be connected would have looked in vain at any time.
        """
        if self.served or causes.diagnose_incompatible_service(self.clients) is not None:
            return False
        return self.cpu_wait_s >= (ROUGH_S if self.exit is not None else MUCH_S)


def right_result(service: str, a: int, b: int) -> int:
    """What the service must answer (0 for a division by zero, where any answer will do)."""
    return {"/add": a + b, "/subtract": a - b, "/multiply": a * b, "/divide": a // b if b else 0}[service]


def missing_services(services: Sequence[ServiceEndpoint]) -> list[str]:
    """The required services that are not there with the required type."""
    there = {service.name for service in services if service.type == TYPE}
    return [name for name in SIGNS if name not in there]


def find_complaints(ordinary: Sequence[LogRecord], said: Sequence[LogRecord]) -> list[LogRecord]:
    """The messages that say that something is wrong. One of a kind that a good call brings too does not."""
    usual = {(log.level, shape(log.text)) for log in ordinary}
    return [
        log
        for log in said
        if (log.level, shape(log.text)) not in usual and (log.level >= Level.WARN or SAYS_ERROR.search(log.text))
    ]

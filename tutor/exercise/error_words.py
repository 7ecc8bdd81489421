"""Words by which a log message is recognised."""

from __future__ import annotations

import re

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

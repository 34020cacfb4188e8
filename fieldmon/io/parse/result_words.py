"""Words and signs for what was found at a plant, in the languages in which people write them."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from fieldmon.compute.wording import first_few, worded
from fieldmon.infestation.records import ABSENT, PRESENT
from fieldmon.io.import_report import (
    ImportMessage,
    Remedy,
    Severity,
    UnsureCells,
    doubtful,
    seen,
)
from fieldmon.io.parse.columns import is_average, is_confidence, is_score

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from fieldmon.io.options import RecordOptions

#: English; German; Dutch; French; Spanish; Italian; Portuguese; Polish; Turkish; Russian; Greek;
#: Hebrew; Arabic; Hindi; Chinese, Japanese; signs. First that a find was flagged, in all of them
_FOUND = """
flagged|markiert|gemarkeerd|marqué|marquée|signalé|signalée|marcado|marcada|señalado|señalada
segnato|segnata|segnalato|segnalata|sinalizado|sinalizada|oznaczony|oznaczone|işaretlendi
отмечено|помечено|σημειωμένο|מסומן|מסומנת|סומן|סומנה|معلم|معلمة|معلَّم|معلَّمة|مُعلَّم|مُعلَّمة|चिह्नित
标记|已标记|標記
yes|y|true|t|present|positive|pos|p|found|detected|infested|infected|diseased|sick|attacked|pest
pests|found infested|mite|mites|some|few|many|low|medium|high|x|v|1
ja|gefunden|befall|befallen|nachweis|nachgewiesen|positiv|vorhanden|krank|schädlinge
aanwezig|gevonden|positief|besmet|aangetast|ziek
oui|présent|présente|trouvé|trouvée|infesté|infestée|infecté|infectée|positif|positive|attaqué
attaquée|atteint|atteinte|malade
si|sí|presente|encontrado|encontrada|infestado|infestada|infectado|infectada|positivo|positiva
plaga|con plaga|con plagas|hallado|hallada|se encontró
enfermo|enferma|atacado|atacada|afectado|afectada
sì|trovato|trovata|infestato|infestata|infetto|infetta|malato|malata|attaccato|attaccata|colpito
sim|achado|doente|atacado|contaminado
tak|obecny|obecne|zakażony|zaatakowany|dodatni
evet|var|bulundu|pozitif|bulaşık|hasta
да|есть|позитив|найдено|обнаружено|заражено|заражён|заражен|положительно|положительный
ναι|βρέθηκε|θετικό|θετικός|προσβεβλημένο
כן|נמצא|נמצאה|נמצא נגוע|נמצאה נגועה|נגוע|נגועה|חיובי|חיובית|יש
نعم|موجود|مصاب|مصابة|إيجابي|ايجابي|وجد|وجدت|وُجد|وُجدت|وجدت مصابة|وُجدت مصابة|وجد مصابا
हाँ|हां|पाया गया|संक्रमित|सकारात्मक
有|是|阳性|陽性|发现|發現|感染|あり|はい
+|++|+++|✓|✔|☑|●
"""
_CLEAN = """
no|false|f|absent|negative|neg|n|none|nil|zero|clean|clear|healthy|nothing|not found|not detected
nil found|no pests|ok|okay|free|background|0
not infested|uninfested|non-infested|no infestation|none found|none seen|none detected|nothing found
no mites|no mites found|no pests found|no pest|not infected|not present|undetected|pest free
pest-free|no symptoms|looked clean
kein befund|ohne befund|nicht befallen|unbefallen|keine milben|keine schädlinge|nichts gefunden
nein|keine|keiner|kein befall|nicht gefunden|sauber|befallsfrei|gesund|negativ|nichts|ohne befall
niet aangetast|geen aantasting|geen mijten
nee|geen|niet gevonden|schoon|gezond|negatief|afwezig
pas infesté|pas infestée|non infesté|non infestée|aucune infestation|pas d'infestation
aucun acarien|non trouvé|non détecté
non|aucun|aucune|absent|absente|négatif|négative|sain|saine|propre|pas trouvé|rien|indemne
no infestado|no infestada|sin infestación|sin infestacion|sin plaga|sin plagas|sin ácaros
sin acaros|no detectado|no detectada|no presente
ausente|ninguno|ninguna|negativo|negativa|sano|sana|limpio|limpia|no encontrado|no encontrada|nada
non infestato|non infestata|nessuna infestazione|nessun acaro
não infestado|não infestada|sem infestação|sem praga|sem pragas|sem ácaros
libre|assente|nessuno|nessuna|pulito|pulita|non trovato|non trovata|niente|indenne
não|nao|nenhum|nenhuma|limpo|limpa|sadio|sadia|saudável|são|não encontrado|nao encontrado
nie|brak|zdrowy|zdrowa|ujemny|czysty
hayır|hayir|yok|temiz|sağlıklı|negatif|bulunamadı
нет|негатив|чисто|здоров|здоровый|здорово|отрицательно|отрицательный|не найдено|не обнаружено
όχι|υγιές|υγιής|καθαρό|αρνητικό|αρνητικός
לא נגוע|לא נגועה|אין נגיעות|ללא נגיעות|אין אקריות|ללא אקריות|אין מזיקים|ללא מזיקים|לא נמצאו
לא|לא נמצא|לא נמצאה|נקי|נקייה|אין|ללא|שלילי|שלילית|בריא
غير مصاب|غير مصابة|لا إصابة|لا اصابة|لا توجد إصابة|لا توجد اصابة|بدون إصابة|بدون اصابة|لا شيء
لا|غير موجود|سليم|سليمة|نظيف|سلبي|لا يوجد
नहीं|स्वस्थ|नकारात्मक|नहीं मिला
无|無|否|阴性|陰性|没有|沒有|健康|なし|いいえ
✗|✘|☐|∅
"""
_NOT_INSPECTED = """
not inspected|uninspected|could not inspect|cannot inspect|not visited|ni|n/i|skip|skipped|missed
not done|no access|nicht geprüft|ausgelassen|nicht kontrolliert|niet gecontroleerd
übersprungen|nicht untersucht|overgeslagen|sauté|sautée|saltato|saltata|pulado|pulada
pominięto|pominięty|pominięte|atlandı|пропущено|пропущен|παραλείφθηκε|छोड़ा गया|跳过|已跳过|スキップ
could not be inspected|unable to inspect
no se pudo|no se pudo inspeccionar|no se puede inspeccionar|no se ha podido inspeccionar
no fue posible inspeccionar|omitido|omitida|saltada
no inspeccionado|no inspeccionada|sin inspeccionar|saltado|non inspecté|non inspectée
non ispezionato|não inspecionado|nie sprawdzono|kontrol edilmedi|не проверено
לא נבדק|לא נבדקה|דולג|דולגה|לא ניתן|לא ניתן לבדיקה|לא ניתן לבדוק
לא ניתן היה לבדוק|אי אפשר לבדוק|לא נבדקו
لم يفحص|لم تفحص|لم يُفحص|لم تُفحص|تعذر|تعذّر|تعذر الفحص|تعذّر الفحص|تعذر فحصها|تعذّر فحصها|لم يمكن الفحص
تخطيت|تُخطّيت|未检查
"""
#: what the note of a skipped plant begins with if it does not stand there any more
GONE = "gone"
_GONE = """
gone|pulled out|removed|uprooted|entfernt|gerodet|verwijderd|arraché|arrachée|enlevé|enlevée
arrancado|arrancada|eliminado|eliminada|rimosso|rimossa|estirpato|estirpata|removido|removida
plant is gone|usunięto|söküldü|удалено|נעקר|נעקרה|הוסר|أزيل|مقلوع|拔除
"""
#: the same beside "could not inspect"; as a result alone they may be of the pest, or of the value
_MAYBE_GONE = """
missing|dead|died|not there|not there anymore|not there any more|no longer there|no plant|no tree
no vine|cut down|felled|tot|abgestorben|fehlt|gefällt|dood|ontbreekt|mort|morte|manquant|manquante
disparu|disparue|muerto|muerta|falta|desaparecido|desaparecida|ya no|ya no está|no hay planta
talado|talada|morto|morta|mancante|martwy|martwa|martwe|ölü|погиб|погибло|мёртвый|мертвый|νεκρό
מת|מתה|חסר|חסרה|נכרת|נכרתה|איננו|איננה|כבר לא שם|אין צמח|אין עץ|אין גפן
ميت|ميتة|مات|ماتت|مفقود|مفقودة|لم تعد موجودة|لا توجد نبتة|لا توجد شجرة|死|枯死|缺株
"""
# words around these that say of what they are
_THE_PLANT = """
the|this|that|it|its|it's|plant|tree|vine|palm|is|was|has|been|la|el|este|esta|árbol|planta|vid
está|fue|es|die|der|das|pflanze|baum|ist|le|plante|arbre|est
הצמח|צמח|העץ|עץ|הגפן|גפן|זה|הזה|הזאת|הוא|היא|النبتة|نبتة|النبات|الشجرة|شجرة|هذه|هذا
"""
# words in a sentence
_FEW = 5
_PERCENT = ("%", "\u066a")
# where what a note says first ends
_FIRST = re.compile(r"[:,.!\n(]|\s[-\u2013\u2014]\s")
#: clean where a column also holds a plus; alone it is an empty cell, unless one says otherwise
MINUS = frozenset({"-", "\u2212", "\u2013", "\u2014"})


def _split(words: str) -> frozenset[str]:
    return frozenset(w for line in words.strip().splitlines() for w in line.split("|"))


FOUND = {word.casefold(): PRESENT for word in _split(_FOUND)}
CLEAN = {word.casefold(): ABSENT for word in _split(_CLEAN)}
_PULLED_OUT = frozenset(word.casefold() for word in _split(_GONE))
#: words that say so of a plant beside "could not inspect", and alone leave open of what they are
MAYBE_GONE = frozenset(word.casefold() for word in _split(_MAYBE_GONE))
_OF_THE_PLANT = _split(_THE_PLANT)
_SAYS_GONE = _PULLED_OUT | MAYBE_GONE
NOT_INSPECTED = frozenset(word.casefold() for word in _split(_NOT_INSPECTED)) | _PULLED_OUT


def plain_word(cell: str) -> str:
    """Return a word as it is looked up: without capitals, spaces in excess and a last full stop."""
    return " ".join(cell.casefold().replace("_", " ").split()).rstrip(".!") or cell.strip()


def is_gone(cell: str, own: str | None = None) -> bool:
    """Return whether a word for a result says that the plant does not stand there any more.

    `own`: words that say so, too, set apart by commas.
    """
    word = plain_word(cell)
    return word in _PULLED_OUT or (own is not None and word in _own(own))


def gone_note(note: str) -> str:
    """Return the note of a plant that is gone, with what else was noted."""
    return note if begins_gone(note) else f"{GONE}: {note}" if note else GONE


def begins_gone(note: str) -> bool:
    """Return whether a note is `GONE`, or that with what else was noted: ``gone: burnt``."""
    return note.partition(":")[0].strip().casefold() == GONE


def noted_beside_gone(note: str) -> str:
    """Return what else the note of a plant that is gone says."""
    return note.partition(":")[2].strip() if begins_gone(note) else note


def says_gone(note: str) -> bool:
    """Return whether the note of a skipped plant says in one of its parts that it is gone.

    What is asked is not said.

    Examples
    --------
    >>> [says_gone(note) for note in ("gone: burnt", "Tree is dead.", "thorns; missing")]
    [True, True, True]
    >>> [says_gone(note) for note in ("dead?", "dead branches", "key missing", "")]
    [False, False, False, False]
    """
    return any(_part_says_gone(part) for part in note.split(";")) if note else False


def _part_says_gone(part: str) -> bool:
    if "?" in part:
        return begins_gone(part)
    word = plain_word(_FIRST.split(part.strip(), maxsplit=1)[0])
    rest = " ".join(one for one in word.split() if one not in _OF_THE_PLANT)
    return not {word, rest}.isdisjoint(_SAYS_GONE)


def meaning(cell: str) -> int | None:
    """Return `PRESENT` or `ABSENT` for a word that says so in any language, else None."""
    word = plain_word(cell)
    return FOUND.get(word, CLEAN.get(word))


# what no other column of yes and no says
_INFESTATION = re.compile(
    r"infest|infect|infett|infizi|infiz|befall|diseas|healthy|pest|mite|milb|acar|\u00e1car|plaga"
    r"|attack|ataca|attaq|attacc|krank|gesund|sano$|sana$|\bsain|malad|malat|enferm|besmet|aangetast"
    r"|\u05e0\u05d2\u05d5\u05e2|\u0645\u0635\u0627\u0628|\u0633\u0644\u064a\u0645"
)
_OURS = frozenset({"found", "clean"})


def tells_infestation(cells: Iterable[str]) -> bool:
    """Return whether the words of a column are of infested plants, and not of any yes and no."""
    words = {plain_word(cell) for cell in cells}
    return words >= _OURS or any(_INFESTATION.search(word) for word in words)


class ResultWords:
    """What the cells of one column of results mean.

    Parameters
    ----------
    cells
        All of them: a minus means clean in a column that has a plus somewhere.
    options
        Words of one's own in ``found`` and ``clean`` go before all others.
    """

    def __init__(self, cells: Iterable[str], options: RecordOptions) -> None:
        found, clean = _own(options.found), _own(options.clean)
        self.own = dict.fromkeys(found, PRESENT) | dict.fromkeys(clean, ABSENT)
        self.has_plus = any(cell.strip().startswith("+") for cell in set(cells))

    def __getitem__(self, cell: str) -> int | None:
        """Return `PRESENT`, `ABSENT`, or None for a cell that is no word for a result."""
        word = plain_word(cell)
        if word in self.own:
            return self.own[word]
        if word in MINUS:
            return ABSENT if self.has_plus else None
        return meaning(word)


def about_minus(cells: Iterable[str], words: ResultWords) -> list[ImportMessage]:
    """Return a doubt about cells that hold a minus alone, where nothing says what it means."""
    n = sum(plain_word(cell) in MINUS and words[cell] is None for cell in cells)
    if not n:
        return []
    said = worded(
        "{n} {n:record holds|records hold} a minus alone: taken as not filled in, not as clean.",
        n=n,
    )
    return [doubtful(said, remedy=Remedy("clean", "-", worded("Take a minus as clean")))]


def words_told(words: Iterable[str]) -> str:
    r"""Return words as one option, set apart by commas; a comma in a word is written ``\,``.

    Examples
    --------
    >>> print(words_told(["zilch", "yes, lots"]))
    zilch,yes\, lots
    """
    return ",".join(word.replace(",", r"\,") for word in words)


def words_in(told: str | None) -> list[str]:
    r"""Return the words of an option that `words_told` wrote.

    Examples
    --------
    >>> words_in(r"zilch, yes\, lots")
    ['zilch', 'yes, lots']
    """
    parts = re.split(r"(?<!\\),", told or "")
    return [word.replace(r"\,", ",").strip() for word in parts if word.strip()]


def remedy_of_words(odd: Iterable[str], options: RecordOptions) -> Remedy:
    """Return how words that say neither are taken as found, all at once, with those said before."""
    words, before = list(dict.fromkeys(odd)), words_in(options.found)
    shown = first_few([repr(word) for word in words], _FEW)
    label = worded("Take {shown} as found; clean= takes them as clean", shown=shown)
    return Remedy("found", words_told([*before, *words]), label)


def about_mark(unsure: str | None, column: str, mark: str) -> list[ImportMessage]:
    """Return what was guessed of a count whose comma or point could be either; None: of none."""
    if unsure is None:
        return []
    if mark in unsure:
        said = worded("Counts such as {unsure} were read as decimals.", unsure=unsure)
        label = worded("Read them as thousands")
    else:
        said = worded("Counts such as {unsure} were read as thousands.", unsure=unsure)
        label = worded("Read them as decimals")
    remedy = Remedy("decimal", "," if mark == "." else ".", label)
    return [UnsureCells(Severity.GUESSED, said, column, remedy)]


def are_fractions(read: Iterable[float]) -> bool:
    """Return whether numbers are between 0 and 1 and not all whole, as confidences are."""
    known = [one for one in read if one == one]  # noqa: PLR0124 - NaN
    return all(0 <= one <= 1 for one in known) and any(one % 1 for one in known)


def about_fractions(name: str, read: Iterable[float], *, is_usual: bool) -> list[ImportMessage]:
    """Return a doubt about counts that could be confidences.

    Counts a leaf are fractions too: none of a column that `is_usual` for them.
    """
    if (is_usual and not is_confidence(name)) or not are_fractions(read):
        return []
    said = worded(
        "Its numbers are between 0 and 1, as confidences are. All above 0 are taken as finds."
    )
    return [doubtful(said, name)]


def about_unsure(column: str, read: Mapping[str, float]) -> list[ImportMessage]:
    """Return a doubt about results, parts of one or percents, that could be confidences.

    `read` is the number that each cell is.
    """
    unsure = [
        cell
        for cell, one in read.items()
        if 0 < one < 1 or (cell.rstrip().endswith(_PERCENT) and one != 0)
    ]
    if not unsure or is_average(column):
        return []
    shown = first_few([repr(cell) for cell in sorted(unsure)], 3)
    said = worded(
        "Results such as {shown} are taken as finds. If they are confidences, write yes or no.",
        shown=shown,
    )
    return [doubtful(said, column)]


def about_confidences(names: Iterable[str], used: Iterable[str | None]) -> list[ImportMessage]:
    """Return which columns hold by their names confidences, which nothing uses."""
    said = worded("It is not used: each record counts in full as its result says.")
    taken = set(used)
    return [seen(said, name) for name in names if is_score(name) and name not in taken]


def _own(words: str | None) -> list[str]:
    return [plain_word(word) for word in words_in(words)]

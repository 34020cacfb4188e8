"""Which column holds what, by the names people give them in many languages."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from fieldmon.plot import plant_columns
from fieldmon.plot.plant_columns import (
    NUMBERED_COLUMNS,
    PLANT_WORDS,
    column_called,
    without_numbering,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

# Darwin Core terms, English, Spanish, French, German, Italian, Portuguese, Hebrew, Arabic, Dutch
_NAMES = {
    "lon": "lon long longitude lng londd longdd lond decimallongitude longitud longitudine "
    "laengengrad laenge längengrad länge geolänge geolaenge lengtegraad xlon longwgs84 gpslon "
    "gpslong gpslongitude verbatimlongitude קואורך קואורדינטתאורך אורך קורדאורך "
    "lengdegrad longitudedecimal longitudegps",
    "lat": "lat latitude latdd latd decimallatitude latitud latitudine breitengrad breite "
    "geobreite breedtegraad ylat latwgs84 gpslat gpslatitude verbatimlatitude קורוחב "
    "קואורדינטתרוחב רוחב קורדרוחב breddegrad latitudedecimal latitudegps",
    "position": "position coordinates coordinate coords latlon latlong latlng gps gpsposition "
    "gpscoordinates coordenadas koordinaten koordinate coordonnees location verbatimcoordinates "
    "נצ קואורדינטות נקודתציון נקודתגפס",
    "x": "x easting east e xcoord xcoordinate coordx xutm utmx utme utmeasting pointx rechtswert "
    "ostwert este xitm itmx xm gpsx xetrs coordenadax hochrechts coordinatax מזרח קואורדינטתx",
    "y": "y northing north n ycoord ycoordinate coordy yutm utmy utmn utmnorthing pointy hochwert "
    "nordwert norte yitm itmy ym gpsy yetrs coordenaday coordinatay צפון קואורדינטתy",
    "crs": "geodeticdatum crs srs epsg datum coordsys coordinatesystem",
    "accuracy": "coordinateuncertaintyinmeters accuracy accuracym hacc horizontalaccuracy "
    "gpsaccuracy precision genauigkeit precisao precisione précision דיוק epe hdopm "
    "positionalaccuracy horizontalaccuracym accuracymeters",
    "date": "date eventdate day datum fecha data datetime timestamp time dateobserved obsdate "
    "observationdate samplingdate sampledate surveydate visitdate startdate collectiondate "
    "dateofobservation recorddate fechamuestreo fechademuestreo datederelevé datereleve "
    "erfassungsdatum aufnahmedatum תאריך תאריךבדיקה תאריךניטור תאריךדיגום inspectiondate inspdate "
    "dateinspected inspectedon scoutingdate scoutdate monitoringdate datesampled sampledon "
    "dateofsampling dateofinspection creationdate when",
    "year": "year jahr año ano annee année anno שנה yr yyyy",
    "month": "month monat mes mês mois mese חודש mon mm",
    "day": "day tag dia día jour giorno יום dd dayofmonth",
    "count": "individualcount count counts total abundance organismquantity amount "
    "quantity mites nmites mitecount numberofmites pests npests pestcount insects adults females "
    "anzahl zahl menge stück stueck conteo cantidad recuento "
    "effectif comptage conteggio contagem quantidade מספר כמות ספירה כמותאקריות מספראקריות "
    "catch catches trapcatch captures captura capturas fang fänge "
    "aantal mitesperleaf tetranychus mitesleaf anzahlmilben milbenanzahl milbenzahl milben "
    "anzahlschädlinge anzahltiere numerodeacaros numeroacaros nacaros acaros conteodeacaros "
    "nombredacariens nombreacariens nbacariens acariens numerodiacari acari aantalmijten mijten "
    "אקריות מספרהאקריות ספירתאקריות "
    "عدد العدد كم howmany cuántos cuántas כמה عددالاكاروسات عددالعناكب عددالافات",
    "present": "occurrencestatus presence present presenceabsence pa detected detection infested "
    "infected positive severity befall result found status infestation presencia presente "
    "presenza présence vorhanden befallen nachweis presença "
    "resultado résultat risultato ergebnis uitslag wynik sonuç результат 结果 結果 نتيجة תוצאה "
    "נוכחות נגוע נמצא ממצא disease diseased symptom symptoms befund befunde hallazgo hallazgos "
    "constat ממצאים נגיעות الاصابة اصابة مصاب النتيجة",
    "species": "scientificname species taxon taxonname pest pestname art schädling schaedling "
    "especie espécie espèce specie plaga praga ravageur parassita מין מזיק vernacularname organism",
    "stage": "lifestage stage stadium developmentstage estadio estádio stade stadio שלב דרגה",
    "leaves": "leaves leavessampled nleaves leaf sampledleaves samplesize samplesizevalue "
    "blätter blaetter anzahlblätter hojas hojasmuestreadas feuilles foglie folhas עלים מספרעלים "
    "leavesexamined leavesinspected nleavessampled",
    "plot": "plot plotname plotid plotno fieldid field fieldname parcel parcelname block blockname "
    "parcela lote parcelle schlag feld flurstück flurstueck appezzamento campo locality site "
    "חלקה שםחלקה מגרש שדה orchard vineyard talhao talhão perceel",
}
_SYNONYMS = {
    **{role: tuple(names.split()) for role, names in _NAMES.items()},
    **{role: PLANT_WORDS[role] for role in ("block", "row", "plant", "name")},
}
plain = plant_columns.plain
_PLAIN = {role: tuple(map(plain, names)) for role, names in _SYNONYMS.items()}


def find(role: str, names: Iterable[str], taken: frozenset[str] = frozenset()) -> str | None:
    """Return the column that most likely plays a role, or None."""
    return column_called(_PLAIN[role], names, taken, NUMBERED_COLUMNS.get(role, ()))


def recognised(names: Iterable[str]) -> frozenset[str]:
    """Return the names that could play some role."""
    return frozenset(name for name in names if plain(name) in _ALL or _is_numbered(name))


def plays_the_same(name: str, other: str) -> bool:
    """Return whether both names are known, and of one role."""
    own = plain(name)
    return own in _ALL and any(own in words and plain(other) in words for words in _PLAIN.values())


def _is_numbered(name: str) -> bool:
    """Return whether a column numbers rows or plants by its name."""
    own = plain(name)
    bare = without_numbering(own)
    return bare != own and any(bare in words for words in NUMBERED_COLUMNS.values())


_SPLIT = re.compile(r"[\W_]+|(?<=[a-z])(?=[A-Z])")


def is_of_rows(name: str) -> bool:
    """Return whether a column may name rows: a word for them, and none that is not of a name."""
    words = _split(name)
    others = [word for word in words if word not in _ROW_WORDS]
    named = all(word in _OF_NAMES or not word.isascii() for word in others)
    return len(others) < len(words) and named


def _split(name: str) -> list[str]:
    return [plain(word) for word in _SPLIT.split(name) if word]


_SAID_OF_ROWS = """
label labels name code tag sign mark title vine vineyard tree orchard plot block field in of the id
no nr num number
"""
_OF_NAMES = frozenset(_SAID_OF_ROWS.split())
_ROW_WORDS = frozenset(NUMBERED_COLUMNS["row"]) | {"rows"}
_ALL = frozenset(name for names in _PLAIN.values() for name in names)


_SURE = ("confidence", "conf", "certainty", "probability", "prob", "likelihood")


def is_confidence(name: str) -> bool:
    """Return whether a column says by its name how sure a program was of each record."""
    return plain(name).endswith(_SURE) or plain(name).startswith(("confidence", "probability"))


def is_score(name: str) -> bool:
    """Return whether a column holds by its name a confidence, or a score that may be one."""
    return is_confidence(name) or plain(name).endswith(("score", "scores"))


_AVERAGE = re.compile(
    r"mean|average|^avg|avg$|mittel|durchschnitt|promedi|^media|media$|moyenne|ממוצע|متوسط|"
    r"per(leaf|leaves|plant|sample)$|(pro|je)(blatt|pflanze)$|por(hoja|planta)$"
)


def is_average(name: str) -> bool:
    """Return whether a column holds averages by its name, which may have any decimals."""
    return bool(_AVERAGE.search(plain(name)))


_IDS = frozenset(
    {"id", "fid", "gid", "oid", "objectid", "ogcfid", "nr", "no", "num", "number", "nummer"}
    | {"numero", "index", "idx", "key", "code", "uuid", "guid", "serial", "lfdnr", "feature", "pk"}
)
_FEW = 4


def is_id(name: str, cells: Iterable[str]) -> bool:
    """Return whether a column numbers its records: by its name, or by counting them through."""
    own = plain(name)
    if own in _IDS or own.endswith("id") or own.startswith("id"):
        return True
    whole = [int(cell) for cell in cells if re.fullmatch(r"\d{1,15}", cell)]
    return len(whole) > _FEW and whole == list(range(whole[0], whole[0] + len(whole)))


# what a file has of its records: detection_id, observation no, recordnumber
_RECORD_ID = re.compile(
    r"^(detection|detect|det|record|rec|observation|obs|occurrence|entry|submission|response"
    r"|gbif|frame|message|msg)(id|no|nr|num|number|index|uuid|key)$|^(frame|globalid|rownames)$"
)
_NO_NAME = re.compile(r"^(unnamed\d*|index|seq|sequence|)$")


def is_record_id(name: str, cells: Iterable[str]) -> bool:
    """Return whether a column numbers records, and no traps, plants or leaves, by its name.

    A plain ``id`` or ``no`` that repeats is of things, not of records.
    """
    own = plain(name)
    if _RECORD_ID.match(own):
        return True
    if own not in _IDS and not _NO_NAME.match(own):
        return False
    known = [cell for cell in cells if cell]
    return len(set(known)) == len(known)


_TIMES = frozenset(_PLAIN["date"])


def is_time(name: str) -> bool:
    """Return whether a column holds by its name a time or a day."""
    return plain(name) in _TIMES or plain(name).endswith(("time", "date", "stamp"))


_WRITTEN_OR_SENT = """
creation created create creationdate createdate createddate editdate lastediteddate edit edited
editor update updated modified uploaded upload exported export submitted submission synced sync
published received reported entered processed
"""
_WRITTEN = frozenset(_WRITTEN_OR_SENT.split())
_WORK = re.compile(r"insp|sampl|scout|survey|visit|monitor|observ|collect|check|assess")


def is_of_writing(name: str) -> bool:
    """Return whether a column says by its name when a record was written or sent."""
    return not _WRITTEN.isdisjoint((plain(name), *_split(name)))


def is_of_work(name: str) -> bool:
    """Return whether a column says by its name the day of the work: of an inspection, a sample."""
    if is_of_writing(name):
        return False
    own = plain(name)
    return own in _TIMES or ("date" in own and _WORK.search(own) is not None)


_HEIGHTS = frozenset({"z", "ele", "elevation", "alt", "altitude", "hdop", "vdop", "pdop"})


def is_position(name: str) -> bool:
    """Return whether a column holds by its name a part of a position, or its accuracy."""
    own = plain(name)
    return own in _HEIGHTS or any(
        own in _PLAIN[role] for role in ("lon", "lat", "position", "x", "y", "crs", "accuracy")
    )

"""What imports say: what holds for many features is one line with their number."""

from fieldmon.io.import_report import Remedy, doubtful, dropped, gathered, seen

MANY = "{n} shapes were mended"


def test_messages_of_one_kind_are_one_with_their_number_and_the_first_of_them():
    said = [doubtful(f"It was {i}.", f"plot {i}", many=MANY) for i in range(3)]
    (one,) = gathered(said)
    assert str(one) == "doubtful: 3 shapes were mended; the first is plot 0: It was 0."


def test_one_alone_and_messages_about_the_file_stay_as_they_are_and_in_their_place():
    alone = doubtful("It was mended.", "plot 1", many=MANY)
    whole = seen("Heights are not used.")
    assert gathered([whole, alone, whole]) == (whole, alone, whole)


def test_what_differs_in_severity_or_in_its_remedy_is_not_one():
    remedy = Remedy("crs", "EPSG:1", "Read as that")
    said = [doubtful("x", "a", None, MANY), dropped("x", "b", None, MANY)]
    said.append(doubtful("x", "c", remedy, MANY))
    assert gathered(said) == tuple(said)

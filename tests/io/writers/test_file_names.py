"""Names of plots as names of files."""

from fieldmon.io.writers.file_names import plain_name


def test_a_name_keeps_its_letters_and_fits_a_file():
    assert plain_name("מטע Paran/2") == "מטע_Paran_2"
    assert plain_name("..") == "__"
    assert plain_name("") == "plot"
    assert len(plain_name("ש" * 300).encode()) == 120

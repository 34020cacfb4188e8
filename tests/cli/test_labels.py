"""`fieldmon labels`: the user's table, kept and listed."""

from fieldmon.monitoring import Season

TABLE = "product,max dose,unit,waiting days,IRAC group\nAcarol,0.5,l/ha,7,6\nsoap,,,,\n"


def test_a_table_is_kept_and_listed_and_a_wrong_one_changes_nothing(run, season, tmp_path):
    (tmp_path / "labels.csv").write_text(TABLE)
    code, out, err, _ = run("labels", season, "labels.csv", "--who", "Ann")
    assert code == 0, err
    assert "labels.csv: 2 labels kept" in out
    assert "Acarol: at most 0.5 l/ha, 7 days until harvest, group 6" in out
    (tmp_path / "labels.csv").write_text(TABLE.replace("0.5", "much"))
    code, _, err, _ = run("labels", season, "labels.csv")
    assert code == 2
    assert "labels.csv, line 2: max_dose must be a number" in err
    assert [one.product for one in Season(season).labels()] == ["Acarol", "soap"]
    last = Season(season).log()[-1]
    assert (last.kind, last.who) == ("labels", "Ann")


def test_one_label_is_said_to_be_one(run, season, tmp_path):
    (tmp_path / "labels.csv").write_text("product,waiting days,max uses\nsoap,1,1\n")
    out = run("labels", season, "labels.csv")[1]
    assert "labels.csv: 1 label kept" in out
    assert "soap: 1 day until harvest, 1 use a season" in out
    assert Season(season).log()[-1].sentence() == "1 label from labels.csv"

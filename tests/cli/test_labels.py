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


def test_the_wait_of_one_product_is_said_in_one_step_beside_the_table(run, season, tmp_path):
    run("treat", season, "--efficacy", "0.5", "--date", "2026-11-02", "--product", "Wetting Oil")
    out = run("status", season, "--date", "2026-11-03")[1]
    way = (
        f"Say it as its label does: fieldmon labels {season} --product 'Wetting Oil' --waiting-days"
    )
    assert f"{way} DAYS" in out
    (tmp_path / "labels.csv").write_text("product,waiting days\nWetting oil,not known\nsoap,3\n")
    run("labels", season, "labels.csv")
    assert way in run("status", season, "--date", "2026-11-03")[1], "not known is never 0"
    code, out, err, _ = run("labels", season, "--product", "wetting  oil", "--waiting-days", "4")
    assert code == 0, err
    assert "Wetting Oil: 4 days until harvest, (said by hand)" in out
    assert "soap: 3 days" in out
    out = run("status", season, "--date", "2026-11-03")[1]
    assert "harvest                from 2026-11-07 on" in out
    run("labels", season, "--product", "Wetting Oil", "--waiting-days", "2", "--who", "Ann")
    assert [one.waiting_days for one in Season(season).labels()] == [None, 3, 2]
    assert Season(season).log()[-1].who == "Ann"


def test_a_wait_is_said_of_a_product_that_was_used_and_with_its_days(run, season):
    run("treat", season, "--efficacy", "0.5", "--date", "2026-11-02", "--product", "Oil")
    code, _, err, _ = run("labels", season, "--product", "Soil", "--waiting-days", "4")
    assert (code, "no treatment is with 'Soil'. Used were: Oil." in err) == (2, True)
    for words in (("--product", "Oil"), ("--waiting-days", "4")):
        code, _, err, _ = run("labels", season, *words)
        assert (code, "together" in err) == (2, True)
    assert Season(season).labels() == ()


def test_of_a_treatment_that_names_no_product_it_is_said_how_to_name_it(run, season):
    run("treat", season, "--efficacy", "0.5", "--date", "2026-11-02")
    out = run("status", season, "--date", "2026-11-03")[1]
    assert f"It names no product: fieldmon undo {season} --batch 1; then record it again" in out
    assert "Take the treatment back, and record it again with its product and its wait." in out

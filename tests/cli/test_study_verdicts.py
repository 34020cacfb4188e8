"""`fieldmon study verdicts`, as a person runs it."""


def test_its_folder_must_be_one(run):
    code, _, err, made = run("study", "verdicts", "-o", __file__)
    assert (code, made) == (2, set())
    assert "must be a folder" in err


def test_a_table_that_is_another_studys_is_not_gone_on_with(run, tmp_path):
    (tmp_path / "verdicts.csv").write_text("a,b\n", encoding="utf-8")
    code, _, err, _ = run("study", "verdicts", "--seeds", 2)
    assert code == 2
    assert "must be a table of this study" in err


def test_what_its_columns_mean_and_how_far_shares_may_be_off_is_told(run):
    code, out, err, _ = run("study", "verdicts", "--seeds", 2)
    assert code == 0, err
    assert "apart: the same where the share infested is 2 times the threshold or more" in out
    assert "With 2 plots a question a share may be off by 0.69 (95 %)." in out


def test_a_pest_that_is_not_there_is_a_sentence(run):
    code, _, err, made = run("study", "verdicts", "--pest", "rose")
    assert (code, made) == (2, set())
    assert "rose" in err

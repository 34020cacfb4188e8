"""`fieldmon study verdicts`, as a person runs it."""

from fieldmon.studies.verdicts import until_verdict


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


def test_maps_that_ask_nothing_are_said_to_be_left_out_and_a_changed_map_is_asked_anew(
    run, tmp_path, monkeypatch
):
    monkeypatch.setattr(until_verdict, "usual_questions", list)

    def asked(name, infested):
        rows = [f"{k // 6 + 1},{k % 6 + 1},{int(k in infested)},2.5,1" for k in range(24)]
        text = "\n".join(["row,plant,infested,row_m,plant_m", *rows])
        (tmp_path / f"{name}.map.csv").write_text(text, encoding="utf-8")
        code, out, err, _ = run("study", "verdicts", "--seeds", 2, "--maps", tmp_path)
        assert code == 0, err
        return {line.split("W walk")[0] for line in out.splitlines() if "W walk, all" in line}, err

    before, err = asked("mine", {3, 4})
    assert "Left out" not in err
    _, err = asked("clean", set())
    assert "Left out: clean. Only maps are asked about" in err
    after, _ = asked("mine", {3, 4, 5})
    assert len(before) == len(after) == 1
    assert before != after

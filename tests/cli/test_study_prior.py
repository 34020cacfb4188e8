"""`fieldmon study prior`, as a person runs it."""

import pytest

from tests.cli.estate import MITES, ZIP, table


def test_a_scenario_is_made_again_beside_its_figures(run, tmp_path):
    code, out, err, made = run("study", "prior", "--scenario", "A", "--seeds", 3)
    assert code == 0, err
    names = {"prior_A.csv", "prior_A_published.csv", "prior_A.html"}
    assert {path.name for path in made} == names
    assert "Scenario A" in out
    compared = table(tmp_path / "prior_A_published.csv")
    assert {row["part"] for row in compared} == {"A"}
    assert {"67", "53", "47"} <= {row["published"] for row in compared}
    assert len(table(tmp_path / "prior_A.csv")) == 3 * (11 + 50)
    assert "<svg" in (tmp_path / "prior_A.html").read_text(encoding="utf-8")


def test_sweeps_and_scenarios_can_be_combined(run, tmp_path):
    code, out, err, _ = run(
        *["study", "prior", "--scenario", "A", "--sweep", "spread", "--seeds", 2, "-o", tmp_path]
    )
    assert code == 0, err
    assert "Spread, 30, 50 and 80 % a day" in out
    assert len({row["rate"] for row in table(tmp_path / "prior_A_spread.csv")}) >= 3


def test_mapped_plants_are_inspected(run, tmp_path):
    lines = ["x,y,t,i", *(f"{x},{y},1991,{int(x == y)}" for x in range(1, 9) for y in range(1, 9))]
    lines[-2] = "8,7,1991,NA"
    (tmp_path / "citrus_ctv_IVI3and4.csv").write_text("\n".join(lines), encoding="utf-8")
    code, out, err, made = run("study", "prior", "--maps", tmp_path, "--seeds", 2)
    assert code == 0, err
    assert "citrus_ctv_IVI3and4: 1 plant of unknown state left out" in out.splitlines()
    assert {path.name for path in made} == {"prior_maps.csv", "prior_maps.html"}
    assert "dynamic finds" in out
    assert {row["sampler"] for row in table(tmp_path / "prior_maps.csv")} == {
        *("dynamic", "naive", "bouncy")
    }


def test_of_a_map_without_infested_plants_no_share_is_said(run, tmp_path):
    lines = ["row,plant,infested,row_m,plant_m", *(f"1,{k},no,2,1" for k in range(1, 9))]
    (tmp_path / "clean.map.csv").write_text("\n".join(lines), encoding="utf-8")
    code, out, err, _ = run("study", "prior", "--maps", tmp_path, "--seeds", 2)
    assert code == 0, err
    assert [line for line in out.splitlines() if "clean" in line] == ["clean: no plant is infested"]
    assert {row["mean"] for row in table(tmp_path / "prior_maps.csv")} <= {"", "nan"}


def test_an_own_plot_is_played_from_its_records(run, tmp_path):
    words = ["study", "prior", "--plot", ZIP, "--feature", "Nursery", "--seeds", 2]
    code, out, err, made = run(*words, "--records", MITES)
    assert code == 0, err
    assert {path.name for path in made} == {"prior_plot.csv", "prior_plot.html"}
    assert "Nursery: dynamic finds" in out
    assert "seen:" in err
    seeded = table(tmp_path / "prior_plot.csv")
    assert run(*words)[0] == 0
    assert seeded != table(tmp_path / "prior_plot.csv")


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["prior", "--scenario", "D"], "D"),
        (["prior", "--sweep", "colour"], "colour"),
        (["prior", "--scenario", "A", "--seeds", "1"], "2 seeds"),
        (["prior", "--maps", "none"], "none"),
        (["prior", "--plot", ZIP], "--feature"),
        (["prior", "-o", __file__], "must be a folder"),
    ],
)
def test_bad_words_are_a_sentence(run, words, says):
    code, _, err, made = run("study", *words)
    assert (code, made) == (2, set())
    assert says in err

"""`fieldmon study samplers`, as a person runs it."""

import pytest

from fieldmon.studies.samplers.contenders import OF_PESTS
from tests.cli.estate import table


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["-o", __file__], "must be a folder"),
        (["--scenario", "Z", "--scenario", "Y"], 'but none begins with "Z" or "Y". There are '),
        (
            ["--scenario", "C, start"],
            ', for instance "C, spread 30% to one, clus',
        ),
        (["--scenario", "C, start"], '", and more with --full.'),
        (["--maps", "."], "must hold a map of plants"),
        (["--maps", ".", "--seeds", "10"], "--maps goes without --seeds, --scenario, --full and"),
        (["--maps", ".", "--scenario", "A"], "--maps goes without --seeds, --scenario"),
        (["--pest", "whitefly", "--tune"], "--pest goes without --maps"),
        (["--sampler", "snake", "--tune"], "--sampler goes without --tune"),
        (["--sampler", "best"], "A sampler must be one of naive, bouncy"),
        (["--visit-every", "7", "--tune"], "--visit-every goes without --maps and --tune"),
        (
            ["--pest", "whitefly", "--scenario", "A, spread"],
            ', for instance "A, whitefly',
        ),
    ],
)
def test_bad_words_are_a_sentence(run, words, says):
    code, _, err, made = run("study", "samplers", *words)
    assert (code, made) == (2, set())
    assert says in err


OWN = """from fieldmon.samplers.sweeps import Naive


class Mine(Naive):
    pass
"""


def test_a_sampler_that_is_added_completes_the_table_of_before(run, tmp_path):
    words = ["study", "samplers", "--scenario", "A", "--seeds", 2, "--visit-every", 7]
    file, csv, html = (tmp_path / name for name in ("my.py", "samplers.csv", "samplers.html"))
    assert run(*words)[0] == 0
    usual, report = csv.read_bytes(), html.read_bytes()
    file.write_text(OWN)
    more = ["--sampler", "my.py:Mine", "--sampler", "naive", "--sampler", "snake"]
    code, out, err, _ = run(*words, *more)
    assert code == 0, err
    assert out.splitlines()[0].endswith("  Mine                 snake")
    assert "adaptive against Mine: surely fewer in " in out
    assert "Infested plant-days against snake: at most half in " in out
    assert "Mine: of your own, added; on the map of adaptive." in html.read_text()
    rows = table(csv)
    assert {line.decode() for line in usual.splitlines()} < {*csv.read_text().splitlines()}
    lost = {who: [] for who in ("Mine", "naive", "snake")}
    for row in rows:
        if (name := row["who"].split(",")[0]) in lost:
            lost[name].append((row["seed"], row["infested_plant_days"]))
    assert lost["Mine"] == lost["naive"]
    assert len(lost["snake"]) == 2
    # a file that has changed is another sampler, and what nobody asks for is not said
    file.write_text(OWN.replace("pass", "more = 1"))
    assert run(*words, *more[:2])[0] == 0
    assert len(table(csv)) == len(rows) + 2
    code, out, _, _ = run(*words)
    assert (code, "Mine" in out, html.read_bytes() == report) == (0, False, True)


def test_with_a_pest_every_sampler_believes_the_one_map_that_follows_it(run, tmp_path):
    words = ["--pest", "whitefly", "--scenario", "A, whitefly", "--seeds", 2, "--visit-every", 9]
    code, out, err, made = run("study", "samplers", *words)
    assert code == 0, err
    assert "pest: Tobacco whitefly" in err
    assert "A, whitefly, clusters, prior none" in out
    assert {path.name for path in made} == {"samplers.csv", "samplers.html"}
    rows = table(tmp_path / "samplers.csv")
    whole = (tmp_path / "samplers.csv").read_bytes()
    lines = whole.splitlines(keepends=True)
    (tmp_path / "samplers.csv").write_bytes(b"".join(lines[:-1]))  # a season lost a row
    assert run("study", "samplers", *words)[0] == 0
    assert (tmp_path / "samplers.csv").read_bytes() == whole
    assert {row["who"] for row in rows} == {each.name for each in OF_PESTS}
    assert "nan" not in (tmp_path / "samplers.html").read_text(encoding="utf-8")


def test_plants_of_unknown_state_are_left_out_of_a_map_and_counted(run, tmp_path):
    cells = ["NA" if k in {3, 8} else "1" for k in range(30)]
    lines = [f"{k // 10 + 1},{k % 10 + 1},{state},3,1.5" for k, state in enumerate(cells)]
    table_of = tmp_path / "vines.map.csv"
    table_of.write_text("\n".join(["row,plant,infested,row_m,plant_m", *lines]))
    (tmp_path / "north.csv").touch()
    code, out, err, _ = run("study", "samplers", "--maps", ".", "-o", "made")
    assert code == 0, err
    assert "vines: 2 plants of unknown state left out" in out.splitlines()
    assert "vines (neighbours -)" in out
    assert "Not read as a map: north.csv (1)." in err
    naive = next(row for row in table(tmp_path / "made" / "maps.csv") if row["sampler"] == "naive")
    assert (naive["neighbour_correlation"], naive["finds_per_inspection_at_40_pct"]) == (
        "",
        "1.0000",
    )

"""Many runs: what is run, what the table has, what is refused."""

import json
import math
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from sweeps import SETS, SMALL, sweep, without_costs

import bowknot
import bowknot.sweep
from bowknot import InputError
from bowknot.sweep import _design


def test_all_combinations_are_run_in_order(tmp_path):
    study = {
        **SMALL,
        "grid": {"body.sheet.friction": [0.1, 0.3], "simulation.dt": [0.01, 0.02]},
        "case": [{"body.sheet.material": "silk"}, {"body.sheet.material": "denim", "contact.delta": 0.004}],
    }
    seen = []
    done = sweep(study, tmp_path, progress=seen.append)
    values = [(row["body.sheet.friction"], row["simulation.dt"], row["body.sheet.material"]) for row in done.rows]
    assert values == [(f, dt, m) for f in (0.1, 0.3) for dt in (0.01, 0.02) for m in ("silk", "denim")]
    assert [row["run"] for row in done.rows] == list(range(8))
    assert not done.failures and len(done) == 8
    assert (seen[-1].done, seen[-1].total, seen[-1].left) == (8, 8, 0)
    # Each run is that of its keys, and the row has the numbers of its files.
    run, row = done.run(5), done.rows[5]
    assert run.scene.dt == 0.01 and "delta = 0.004" in run.scene.to_toml()
    assert row["mean.max_speed"] == run.summary["mean"]["max_speed"]
    assert row["max.energy.kinetic"] == run.summary["max"]["energy"]["kinetic"]
    assert row["last.center_of_mass.z"] == run.stats[-1]["center_of_mass"][2]
    assert row["vertices"] == run.summary["vertices"] and row["frames"] == 3
    assert row["cost.peak_memory_bytes"] > 0 and row["cost.cpu_seconds"] > 0 and row["cost.tries"] == 1
    lines = Path(done.table).read_text().splitlines()
    assert [json.loads(line)["hash"] for line in lines] == [row["hash"] for row in done.rows]
    assert not any("second" in key or "memory" in key for row in without_costs(done.rows) for key in row)


def test_warnings_of_runs_are_told_once(tmp_path, capfd):
    sets = {**SETS, "simulation.frames": 8, "simulation.newton_iterations": 1, "body.sheet.velocity": [0, 0, -4]}
    sets["body.sheet.friction"] = 0.1
    study = {**SMALL, "set": sets, "grid": {"contact.delta": [0.004 + 0.0005 * k for k in range(6)]}}
    with pytest.warns(bowknot.BowknotWarning) as caught:
        done = sweep(study, tmp_path)
    # Each run has time steps that are not solved; friction of one side alone has no effect.
    counts = [row["warnings"] for row in done.rows]
    assert sum(counts) == len(done.warnings) == len(set(done.warnings)) and min(counts) > 0
    text = str(caught.pop(bowknot.BowknotWarning).message)
    lines = text.splitlines()
    # Those that several runs have in the same words are told once.
    different = list(dict.fromkeys(words for _, words in done.warnings))
    assert lines[0].startswith("run 0 (contact.delta = 0.004) and 5 other runs: body[0].friction on obstacles")
    assert lines[1].startswith("run 0 (contact.delta = 0.004): drape: ") and "ended unsolved" in lines[1]
    assert len(different) == 7
    assert len(lines) == 6 and lines[-1].startswith(f"and {len(different) - 5} more")
    # What was made before is told again.
    with pytest.warns(bowknot.BowknotWarning):
        assert sweep(study, tmp_path).warnings == done.warnings


def test_a_latin_hypercube_has_one_point_in_each_part():
    ranges = {"a": _design.Range(2.0, 4.0), "b": _design.Range(0.001, 10.0, log=True)}
    ranges["c"] = _design.Range(3, 12, integer=True)
    points = _design.latin_hypercube(ranges, 40, 7)
    assert sorted(int((point["a"] - 2.0) / 2.0 * 40) for point in points) == list(range(40))
    assert sorted(int(math.log(point["b"] / 0.001) / math.log(1e4) * 40) for point in points) == list(range(40))
    whole = [point["c"] for point in points]
    assert all(whole.count(value) == 4 for value in range(3, 13))
    assert points == _design.latin_hypercube(ranges, 40, 7) != _design.latin_hypercube(ranges, 40, 8)
    # A key has its values whatever else is varied.
    alone = _design.latin_hypercube({"b": ranges["b"]}, 40, 7)
    assert [point["b"] for point in alone] == [point["b"] for point in points]
    # The same on all machines.
    assert points[0]["a"] == 3.2150985187449046


def test_a_file_is_a_dict(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("studies").mkdir()
    Path("studies/sheet.toml").write_text(bowknot.Scene.builtin("drape", scale=0.2).to_toml())
    Path("studies/friction.toml").write_text(
        """
        scene = "sheet.toml"
        table = "table.csv"
        check = true
        [set]
        simulation.frames = 3
        "body.sheet.shape" = { type = "sheet", size = [0.5, 0.5], edge = 0.1 }
        [latin]
        samples = 2
        seed = 4
        [latin.keys]
        body.sheet.friction = { low = 0.1, high = 0.5 }
        "simulation.dt" = { low = 0.001, high = 0.01, log = true }
        """
    )
    spread = {"body.sheet.friction": {"low": 0.1, "high": 0.5}}
    spread["simulation.dt"] = {"low": 0.001, "high": 0.01, "log": True}
    study = {
        "scene": bowknot.Scene.builtin("drape", scale=0.2),
        "table": "table.csv",
        "check": True,
        "set": {"simulation.frames": 3, "body.sheet.shape": {"type": "sheet", "size": [0.5, 0.5], "edge": 0.1}},
        "latin": {"samples": 2, "seed": 4, "keys": spread},
    }
    of_dict = sweep(study, "out/dict")
    of_file = bowknot.sweep("studies/friction.toml", workers=1, progress=False)
    assert Path(of_file.table) == tmp_path / "out/friction/table.csv"
    assert without_costs(of_file.rows) == without_costs(of_dict.rows)
    assert all(row["intersections"] == 0 and row["vertices"] == 36 for row in of_file.rows)
    head, *lines = Path(of_file.table).read_text().splitlines()
    assert head.startswith("run,hash,folder,status,reason,body.sheet.friction,simulation.dt,")
    assert len(lines) == 2
    inline = {"simulation": {"frames": 2}, "body": [{"name": "sheet", "shape": "sheet"}]}
    assert sweep({"scene": inline, "table": "t.csv"}, "out/inline").rows[0]["frames"] == 2
    several = {
        "table": "t.csv",
        "grid": {"scene": ["drape", "needle"], "scale": [0.1]},
        "set": {"simulation.frames": 1},
    }
    assert [row["scene"] for row in sweep(several, "out/several").rows] == ["drape", "needle"]


def test_only_what_is_missing_is_run(tmp_path):
    study = {**SMALL, "grid": {"body.sheet.friction": [0.1, 0.2]}}
    first = sweep(study, tmp_path)
    stamps = {path: path.stat().st_mtime_ns for path in tmp_path.glob("runs/*/sweep.json")}
    study["grid"] = {"body.sheet.friction": [0.3, 0.2, 0.1]}
    seen = []
    more = sweep(study, tmp_path, progress=seen.append)
    assert (seen[0].found, seen[-1].done) == (2, 3)
    assert more.rows[1]["hash"] == first.rows[1]["hash"] and more.rows[2]["hash"] == first.rows[0]["hash"]
    assert {path: path.stat().st_mtime_ns for path in stamps} == stamps
    assert len(list(tmp_path.glob("runs/*"))) == 3
    # Another scene, or states that are to be judged, is another run.
    study["set"] = {**SETS, "simulation.frames": 4}
    assert {row["hash"] for row in sweep(study, tmp_path).rows}.isdisjoint({row["hash"] for row in more.rows})
    # The same scene in several rows is run once.
    study["grid"] = {"contact.delta": [0.003, 0.003]}
    same = sweep(study, tmp_path, progress=seen.append)
    assert same.rows[0]["hash"] == same.rows[1]["hash"] and len(same) == 2 and seen[-1].total == 1


def test_the_content_of_mesh_files_counts(tmp_path):
    mesh = tmp_path / "cloth.obj"
    text = "v 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\nf 1 2 3\nf 2 4 3\n"
    mesh.write_text(text)
    study = {"scene": {"body": [{"name": "cloth", "mesh": str(mesh)}]}, "set": {"simulation.frames": 2}}
    study["table"] = "table.csv"
    first = sweep(study, tmp_path / "out").rows[0]["hash"]
    moved = tmp_path / "moved.obj"
    shutil.copy(mesh, moved)
    study["scene"]["body"][0]["mesh"] = str(moved)
    assert sweep(study, tmp_path / "out").rows[0]["hash"] == first
    moved.write_text(text.replace("v 1 1 1", "v 1 1 1.1"))
    assert sweep(study, tmp_path / "out").rows[0]["hash"] != first


def test_the_command(tmp_path):
    file = tmp_path / "study.toml"
    text = 'scene = "drape"\nscale = 0.2\ntable = "t.csv"\nset.simulation.frames = 2\n'
    file.write_text(text + "grid.body.sheet.translate = [[0.0, 0.0, 0.7], [0.0, 0.0, 0.25]]")
    command = [sys.executable, "-m", "bowknot.sweep", str(file), "--out", str(tmp_path / "out")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1, done.stderr
    assert "run 1 failed: " in done.stderr and "1 of 2 runs done, 1 failed" in done.stderr
    part = subprocess.run([*command, "--part", "1/2"], capture_output=True, text=True, timeout=60)
    assert part.returncode == 0 and not part.stdout and "1 of 1 runs done, 1 of them before" in part.stderr
    file.write_text('scen = "drape"')
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2 and "scen: unknown key; did you mean scene?" in done.stderr


def test_parts_make_the_whole(tmp_path):
    study = {**SMALL, "grid": {"body.sheet.friction": [0.1, 0.2, 0.3]}}
    first, second = (sweep(study, tmp_path, part=(part, 2)) for part in (1, 2))
    assert ([row["run"] for row in first.rows], [row["run"] for row in second.rows]) == ([0, 2], [1])
    assert not first.table and not (tmp_path / "table.jsonl").exists()
    seen = []
    assert len(sweep(study, tmp_path, progress=seen.append)) == 3 and seen[0].found == 3


def test_what_is_kept_of_runs(tmp_path):
    study = {**SMALL, "keep": ["frames/000003.ply"]}
    run = sweep(study, tmp_path).run(0)
    files = sorted(path.relative_to(run.folder).as_posix() for path in run.folder.rglob("*") if path.is_file())
    assert files == ["frames/000003.ply", "scene.toml", "summary.json", "sweep.json"]
    assert len(run.mesh(3).vertices) > 100


def test_results_go_where_fsspec_reaches(tmp_path):
    pytest.importorskip("fsspec")
    study = {**SMALL, "grid": {"body.sheet.friction": [0.1, 0.2]}}
    seen = []
    url = f"file://{tmp_path}/remote"
    far = sweep(study, url)
    assert far.table == f"{url}/table.jsonl" and (tmp_path / "remote/table.jsonl").is_file()
    assert without_costs(far.rows) == without_costs(sweep(study, tmp_path / "near").rows)
    for row in far.rows:
        for name in ("scene.toml", "frames/000003.ply", "stats.jsonl"):
            assert (tmp_path / "remote" / row["folder"] / name).is_file()
    sweep(study, url, progress=seen.append)
    assert seen[0].found == 2
    with pytest.raises(InputError, match="nowhere"):
        sweep(study, "nowhere://bucket")


def test_a_table_of_parquet(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    study = {**SMALL, "table": "table.parquet", "grid": {"body.sheet.translate": [[0.0, 0.0, 0.25], [0, 0, 0.7]]}}
    done = sweep(study, tmp_path)
    table = parquet.read_table(done.table)
    assert table.column("status").to_pylist() == ["failed", "done"]
    assert table.column("body.sheet.translate").to_pylist() == ["[0.0, 0.0, 0.25]", "[0, 0, 0.7]"]
    assert str(table.schema.field("mean.max_speed").type) == "double"
    assert table.column("mean.max_speed").to_pylist() == [None, done.rows[1]["mean.max_speed"]]


def test_a_table_that_cannot_be_written_is_refused_first(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(InputError, match="pip install pyarrow"):
        sweep({**SMALL, "table": "table.parquet"}, tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"grids": {}}, "grids: unknown key; did you mean grid?"),
        ({"scene": "drap"}, "did you mean drape?"),
        ({"scene": 3}, "scene: expected a name"),
        ({"scene": "no.toml"}, "no.toml"),
        ({"scene": "no.toml", "scale": 2}, "only built-in scenes have a scale"),
        ({"grid": {"body.sheet.frction": [1]}}, r"run 0 .*frction: unknown key; did you mean body\[0\].friction"),
        ({"grid": {"body.sheet.friction": [0.1, -1]}}, r"run 1 \(body.sheet.friction = -1\): .*at least 0"),
        ({"grid": {"body.sheet.friction": 0.1}}, "grid.body.sheet.friction: expected a list"),
        ({"case": {"a": 1}}, "case: expected a list of tables"),
        ({"latin": {"samples": 3}}, "latin: needs samples and keys"),
        ({"latin": {"samples": 0, "keys": {"a.b": {"low": 0, "high": 1}}}}, "latin.samples: 0 must be"),
        ({"latin": {"samples": 1, "seeds": 1, "keys": {"a.b": {"low": 0, "high": 1}}}}, "did you mean latin.seed"),
        ({"latin": {"samples": 1, "keys": {"a.b": {"low": 1, "high": 1}}}}, "latin.keys.a.b: low = 1 must be below"),
        ({"latin": {"samples": 1, "keys": {"a.b": {"low": 0, "high": 1, "log": True}}}}, "must be above 0 with log"),
        ({"latin": {"samples": 1, "keys": {"a.b": {"low": 0, "hig": 1}}}}, "expected a table with low and high"),
        ({"grid": {"a.b": [1]}, "case": [{"a.b": 1}]}, "a.b: it is varied in two ways"),
        ({"table": "table.xls"}, "table.xls.* must be a name that ends in one of .parquet"),
        ({"threads": 0}, "threads: 0 must be a whole number"),
        ({"retries": True}, "retries: True must be a whole number"),
        ({"time_limit": -1}, "time_limit: -1 must be a number above 0"),
        ({"keep": "frames"}, "keep: expected a list of patterns"),
        ({"check": 1}, "check: expected true or false"),
    ],
)
def test_bad_studies_are_refused_before_any_run(tmp_path, change, message):
    with pytest.raises(InputError, match=message):
        sweep({**SMALL, **change}, tmp_path)
    assert not list(tmp_path.iterdir())


def test_bad_arguments_are_refused(tmp_path):
    for options, message in (
        ({"backend": "slurm"}, "backend: 'slurm' must be"),
        ({"address": "auto"}, "give backend"),
        ({"workers": 0}, "workers 0"),
        ({"part": (3, 2)}, "part 3 of 2"),
    ):
        with pytest.raises(InputError, match=message):
            sweep(SMALL, tmp_path, **options)
    with pytest.raises(InputError, match="study: expected a path or a dict"):
        sweep(3, tmp_path)
    with pytest.raises(InputError, match="nowhere.toml: cannot be read"):
        sweep(tmp_path / "nowhere.toml", tmp_path)


@pytest.mark.parametrize(
    "first", ["import bowknot", "import bowknot.sweep, bowknot", "from bowknot.sweep import sweep"]
)
def test_the_function_is_there_after_any_import(first):
    program = f"{first}; import bowknot, bowknot.sweep, inspect; assert callable(bowknot.sweep) and bowknot.sweep.sweep"
    program += "; assert 'study' in inspect.signature(bowknot.sweep).parameters"
    subprocess.run([sys.executable, "-c", program], check=True)

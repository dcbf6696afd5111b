"""Sweeps from the command line, and their jobs as files for others."""

import json
import shlex

import numpy as np
import pytest

from strandline import Error, Scene, program, sweep, sweeps

SCENE = Scene(style={"style": "pixie", "strand_count": 12}, film={"frames": 2}, devices={"simulation": "cpu", "pictures": "cpu"}, picture={"width": 24, "height": 24})


@pytest.fixture
def scene(tmp_path):
    SCENE.save(tmp_path / "a.toml")
    return str(tmp_path / "a.toml")


def test_jobs_of_a_farm_are_those_of_the_sweep(tmp_path, scene, capsys):
    folder, commands, openjd = (str(tmp_path / name) for name in ("out", "list.txt", "job.json"))
    words = ["sweep", scene, "--out", folder, "--grid", "style.seed=1,2", "--grid", "motion.name=nod"]
    assert program.main([*words, "--commands", commands, "--openjd", openjd]) == 0
    assert program.main(["sweep", "--collect", folder]) == 1 and "0 of 2 done" in capsys.readouterr().out
    lines = (tmp_path / "list.txt").read_text().splitlines()
    assert len(lines) == 2 and lines[0].startswith("RAYON_NUM_THREADS=1 strandline sweep --job ")
    for line in lines:
        assert program.main(shlex.split(line)[2:]) == 0
    assert program.main(["sweep", "--collect", folder]) == 0
    template = json.loads((tmp_path / "job.json").read_text())
    assert template["specificationVersion"] == "jobtemplate-2023-09"
    samples, manifest = template["steps"]
    assert samples["parameterSpace"]["taskParameterDefinitions"] == [{"name": "Job", "type": "INT", "range": "1-2"}]
    assert template["parameterDefinitions"][0]["default"] == "out"
    values = {"{{Param.Folder}}": folder, "{{Task.Param.Job}}": "2"}
    for action in (samples, manifest):
        run = action["script"]["actions"]["onRun"]
        own = [replaced(word, values) for word in run["args"]]
        assert run["command"] == "strandline" and program.main(own) == 0, own
    wanted = sweep(Scene.load(scene), sweeps.grid({"style.seed": [1, 2], "motion.name": ["nod"]}), folder, workers=0)
    found = [json.loads((tmp_path / "out" / f"{row['key']}.json").read_text()) for row in wanted.rows]
    here = sweep(Scene.load(scene), sweeps.grid({"style.seed": [1, 2], "motion.name": ["nod"]}), tmp_path / "here", workers=0)
    assert [row["hash"] for row in found] == [row["hash"] for row in here.rows]
    capsys.readouterr()
    assert program.main([*words, "--workers", "0"]) == 0 and "2 of 2 done" in capsys.readouterr().out, "nothing is left"


def test_templates_are_jobs_of_open_job_description(tmp_path, scene, capsys):
    """The library of Open Job Description makes a job of each: beside its folder, elsewhere, and with nothing left."""
    model = pytest.importorskip("openjd.model")
    folder = str(tmp_path / "out")
    words = ["sweep", scene, "--out", folder, "--grid", "style.seed=1,2", "--threads", "3", "--openjd"]
    (tmp_path / "elsewhere").mkdir()

    def job(path, given):
        assert program.main([*words, str(path)]) == 0
        template = model.decode_job_template(template=json.loads(path.read_text()))
        values = model.preprocess_job_parameters(job_template=template, job_parameter_values=given, job_template_dir=path.parent, current_working_dir=tmp_path)
        assert values["Folder"].value == folder
        return model.create_job(job_template=template, job_parameter_values=values)

    steps = job(tmp_path / "job.json", {}).steps
    assert [len(model.StepParameterSpaceIterator(space=step.parameterSpace)) for step in steps] == [2, 1]
    assert steps[1].dependencies[0].dependsOn == steps[0].name
    assert "has to be given" not in capsys.readouterr().out
    assert len(job(tmp_path / "elsewhere/job.json", {"Folder": folder}).steps) == 2
    assert f"its parameter Folder is {folder}" in capsys.readouterr().out
    assert program.main(["sweep", scene, "--out", folder, "--grid", "style.seed=1,2", "--workers", "0"]) == 0
    assert [step.name for step in job(tmp_path / "job.json", {}).steps] == ["Manifest"]
    for wrong, text in ((["--threads", "0"], "threads is 0"), (["--openjd", str(tmp_path / "none/a.json")], "cannot write the jobs")):
        assert program.main([*words, str(tmp_path / "b.json"), *wrong]) == 1
        assert text in capsys.readouterr().err


def replaced(word, values):
    for name, value in values.items():
        word = word.replace(name, value)
    return word


def test_samples_of_the_command_line(tmp_path, scene, capsys):
    words = ["sweep", scene, "--out", str(tmp_path / "out"), "--grid", "simulation.gravity=[0,-9.81,0],[0,0,0]", "--sobol", "look.width_scale=0.5:2.0", "--count", "2"]
    assert program.main([*words, "--commands", str(tmp_path / "list.txt")]) == 0
    jobs = [json.loads((tmp_path / "out/jobs" / f"{number}.json").read_text())["sample"] for number in range(1, 5)]
    assert [job["simulation.gravity"] for job in jobs] == [[0, -9.81, 0]] * 2 + [[0, 0, 0]] * 2
    assert all(0.5 <= job["look.width_scale"] <= 2.0 for job in jobs)
    for wrong, text in ((["--grid", "style.seed"], "--grid has `style.seed`"), (["--random", "style.seed=1"], "LEAST:MOST"), (["--keep", "depht"], "keep has `depht`")):
        assert program.main(["sweep", scene, "--out", str(tmp_path / "other"), *wrong]) == 1
        assert text in capsys.readouterr().err
    assert program.main(["sweep", scene]) == 1 and "--out" in capsys.readouterr().err
    assert program.main(["sweep", "--job", str(tmp_path / "none.json")]) == 1 and "none.json" in capsys.readouterr().err


def test_channels_and_all_strands_are_kept(tmp_path):
    keep = ("strands", "depth", "direction", "normals", "strand_ids", "hair_mask")
    for drape in (False, True):
        done = sweep(SCENE, [{}], tmp_path / str(drape), keep=keep, drape=drape, workers=0)
        assert done.rows[0]["state"] == "done", done.rows[0]["error"]
        with np.load(tmp_path / str(drape) / done.rows[0]["file"]) as arrays:
            assert arrays["strands"].shape[0] == (1 if drape else 2) and arrays["strands"].shape[1] == arrays["strand_starts"][-1]
            assert len(arrays["strand_starts"]) > 13, "follow strands too"
            assert arrays["depth"].shape == (24, 24) and arrays["normals"].shape == (24, 24, 3)


def test_the_manifest_has_columns_of_one_kind(tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    samples = [{"wind.velocity": [0, 0, 1], "look.width_scale": 1}, {"look.width_scale": 1.5}, {"film.frames": 0}]
    sweep(SCENE, samples, tmp_path, workers=0)
    table = parquet.read_table(tmp_path / "manifest.parquet").to_pydict()
    assert table["parameter.look.width_scale"] == [1.0, 1.5, None] and table["parameter.wind.velocity"][0] == "[0, 0, 1]"
    assert table["state"] == ["done", "done", "failed"] and "film.frames" in table["error"][2]
    with pytest.raises(Error, match="threads is 0"):
        sweep(SCENE, samples, tmp_path, threads=0)

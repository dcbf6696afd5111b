"""``strandline sweep``: sweeps from a command line, and the same jobs as files for render farms and Slurm."""

from __future__ import annotations

import argparse
import json
import os
import shlex
import tomllib
from typing import Any

from . import jobs, samplers, sweeps
from .errors import Error
from .jobs import Job
from .scene import Scene

#: Folder of the files of jobs that others run, and the file with the keys and rows of all samples.
_JOBS, _PLAN = "jobs", "plan.json"


def main(words: list[str]) -> int:
    """Runs ``strandline sweep`` with the words behind it; 1 where samples failed."""
    chosen = _arguments().parse_args(words)
    if chosen.job is not None:
        return _run(chosen.job)
    if chosen.collect is not None:
        return _told(_collect(chosen.collect))
    if chosen.scene is None or chosen.out is None:
        raise Error("sweep has no scene or no --out, expected: strandline sweep SCENE.toml --out FOLDER --grid KEY=VALUE,VALUE", "value")
    scene = Scene.load(chosen.scene)
    samples = _samples(chosen)
    keep = tuple(chosen.keep.split(","))
    if chosen.openjd is None and chosen.commands is None:
        done = sweeps.sweep(
            scene,
            samples,
            chosen.out,
            keep=keep,
            drape=chosen.drape,
            workers=chosen.workers,
            threads=chosen.threads,
            cluster=chosen.cluster,
        )
        return _told(done)
    sweeps.check(keep, chosen.threads)
    count = _plan(scene, samples, os.path.abspath(chosen.out), keep, chosen.drape)
    out = os.path.abspath(chosen.out)
    for path, text in ((chosen.openjd, _openjd), (chosen.commands, _commands)):
        if path is not None:
            _write(os.path.abspath(path), text(out, count, chosen.threads, os.path.dirname(os.path.abspath(path))))
            print(f"wrote {count} jobs to {path}")
            if path == chosen.openjd and _below(out, os.path.dirname(os.path.abspath(path))) is None:
                print(f"its parameter Folder is {out}, which is not below the template and has to be given")
    return 0


def _write(path: str, text: str) -> None:
    try:
        jobs.write(path, text.encode())
    except OSError as error:
        raise Error(f"cannot write the jobs: {error.strerror}: {path}", "file") from None


def _arguments() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("strandline sweep", description="Run a scene with many samples of its settings; the same command goes on with what is left.")
    parser.add_argument("scene", nargs="?", metavar="SCENE.toml", help="the scene")
    parser.add_argument("--out", metavar="FOLDER", help="folder of the files and of manifest.csv and manifest.parquet")
    parser.add_argument("--grid", action="append", default=[], metavar="KEY=VALUE,VALUE", help="every combination of these values, TOML; given again: of further settings")
    parser.add_argument("--random", action="append", default=[], metavar="KEY=LEAST:MOST", help="samples between two numbers at random, --count of them")
    parser.add_argument("--sobol", action="append", default=[], metavar="KEY=LEAST:MOST", help="samples between two numbers, spread evenly")
    parser.add_argument("--count", type=int, default=16, metavar="N", help="number of such samples [default: 16]")
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="seed of such samples [default: 0]")
    parser.add_argument("--keep", default="guides", metavar="NAMES", help=f"some of {','.join(jobs.KEPT)} [default: guides]")
    parser.add_argument("--drape", action="store_true", help="run to rest in place of the film")
    parser.add_argument("--workers", type=int, metavar="N", help="jobs at a time on this machine")
    parser.add_argument("--threads", type=int, default=1, metavar="N", help="CPUs of a job [default: 1]")
    parser.add_argument("--cluster", metavar="ADDRESS", help="run on Ray: local, auto or an address")
    parser.add_argument("--openjd", metavar="FILE", help="write the jobs as an OpenJD template in place of running them")
    parser.add_argument("--commands", metavar="FILE", help="write the jobs as a command a line in place of running them")
    parser.add_argument("--job", metavar="FILE.json", help="run one job of those")
    parser.add_argument("--collect", metavar="FOLDER", help="write the manifest of jobs that others ran")
    return parser


def _samples(chosen: argparse.Namespace) -> list[dict[str, Any]]:
    grid = samplers.grid(dict(_listed(text) for text in chosen.grid))
    for flag, sampler in (("random", samplers.random), ("sobol", samplers.sobol)):
        texts = getattr(chosen, flag)
        if texts:
            drawn = sampler(dict(_range(flag, text) for text in texts), chosen.count, seed=chosen.seed)
            grid = [{**one, **other} for one in grid for other in drawn]
    return grid


def _value(text: str) -> Any:
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except tomllib.TOMLDecodeError:
        return text


def _listed(text: str) -> tuple[str, list[Any]]:
    """Key and values of a text such as ``style.seed=1,2``; vectors stand in brackets."""
    name, joined, values = text.partition("=")
    try:
        found: Any = tomllib.loads(f"value = [{values}]")["value"]
    except tomllib.TOMLDecodeError:
        found = [_value(part) for part in values.split(",")]
    if not joined or not values:
        raise Error(f"--grid has `{text}`, expected KEY=VALUE,VALUE", "value")
    return name, found


def _range(flag: str, text: str) -> tuple[str, tuple[Any, Any]]:
    name, joined, span = text.partition("=")
    ends = [_value(end) for end in span.split(":")]
    if not joined or len(ends) != 2 or not all(isinstance(end, int | float) for end in ends):
        raise Error(f"--{flag} has `{text}`, expected KEY=LEAST:MOST, two numbers", "value")
    return name, (ends[0], ends[1])


def _plan(scene: Scene, samples: list[dict[str, Any]], folder: str, keep: tuple[str, ...], drape: bool) -> int:
    """Writes a file for each job that is left, numbered from 1, and the plan; returns the number of jobs."""
    os.makedirs(os.path.join(folder, _JOBS), exist_ok=True)
    todo, rows, order = sweeps.plan(scene, samples, folder, keep, drape)
    for number, job in enumerate(todo, 1):
        jobs.write(os.path.join(folder, _JOBS, f"{number}.json"), job.to_json().encode())
    waiting = {job.key: jobs.row(job.key, job.sample) | {"state": "waiting"} for job in todo}
    jobs.write(os.path.join(folder, _PLAN), json.dumps([{**rows, **waiting}[name] for name in order]).encode())
    return len(todo)


def _run(path: str) -> int:
    """Runs the job of a file, beside whose folder its files go."""
    try:
        with open(path, encoding="utf-8") as file:
            job = Job.from_json(file.read())
    except (OSError, ValueError, KeyError) as error:
        raise Error(f"cannot read the job: {error}: {path}", "file") from None
    row = jobs.run(job, os.path.dirname(os.path.dirname(os.path.abspath(path))))
    print(f"{row['key']} {row['state']} in {row['seconds']} s" + (f": {row['error']}" if row["error"] else ""))
    return 0 if row["state"] == "done" else 1


def _collect(folder: str) -> sweeps.Sweep:
    """The manifest of a plan: rows of jobs that ran, and of those that still wait."""
    try:
        with open(os.path.join(folder, _PLAN), encoding="utf-8") as file:
            planned: list[dict[str, Any]] = json.load(file)
    except (OSError, ValueError) as error:
        raise Error(f"cannot read the plan: {error}: {os.path.join(folder, _PLAN)}", "file") from None
    rows = []
    for row in planned:
        try:
            with open(os.path.join(folder, f"{row['key']}.json"), encoding="utf-8") as file:
                row = json.load(file)
        except OSError:
            pass
        rows.append(row)
    sweeps.write_manifest(folder, rows)
    return sweeps.Sweep(folder, rows)


def _told(done: sweeps.Sweep) -> int:
    states = [row["state"] for row in done.rows]
    for row in done.failed[:10]:
        print(f"failed: {row['error']}")
    print(f"{states.count('done')} of {len(states)} done, {states.count('failed')} failed: {os.path.join(done.folder, 'manifest.csv')}")
    return 0 if states.count("done") == len(states) else 1


def _commands(folder: str, count: int, threads: int, beside: str) -> str:
    """A command a line; each can run on any machine that sees the folder."""
    line = "RAYON_NUM_THREADS={} strandline sweep --job {}\n"
    return "".join(line.format(threads, shlex.quote(os.path.join(folder, _JOBS, f"{number}.json"))) for number in range(1, count + 1))


def _below(folder: str, beside: str) -> str | None:
    """The way to a folder from one that it is below."""
    inside = os.path.normcase(folder).startswith(os.path.join(os.path.normcase(beside), ""))
    return os.path.relpath(folder, beside).replace(os.sep, "/") if inside else None


def _openjd(folder: str, count: int, threads: int, beside: str) -> str:
    """A template of Open Job Description in a folder: a task for each job, and at the end the manifest, which is all where
    no job is left. Default paths of templates are relative to them and below."""
    strandline = {"command": "strandline"}
    run = {**strandline, "args": ["sweep", "--job", f"{{{{Param.Folder}}}}/{_JOBS}/{{{{Task.Param.Job}}}}.json"]}
    collect = {**strandline, "args": ["sweep", "--collect", "{{Param.Folder}}"]}
    samples = {
        "name": "Samples",
        "parameterSpace": {"taskParameterDefinitions": [{"name": "Job", "type": "INT", "range": f"1-{count}"}]},
        "hostRequirements": {"amounts": [{"name": "amount.worker.vcpu", "min": threads}]},
        "stepEnvironments": [{"name": "Threads", "variables": {"RAYON_NUM_THREADS": str(threads)}}],
        "script": {"actions": {"onRun": run}},
    }
    manifest: dict[str, Any] = {"name": "Manifest", "script": {"actions": {"onRun": collect}}}
    if count > 0:
        manifest["dependencies"] = [{"dependsOn": "Samples"}]
    parameter = {"name": "Folder", "type": "PATH", "objectType": "DIRECTORY", "dataFlow": "INOUT"}
    if (path := _below(folder, beside)) is not None:
        parameter["default"] = path
    template = {
        "specificationVersion": "jobtemplate-2023-09",
        "name": "strandline sweep",
        "parameterDefinitions": [parameter],
        "steps": [samples, manifest] if count > 0 else [manifest],
    }
    return json.dumps(template, indent=2) + "\n"

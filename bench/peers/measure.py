#!/usr/bin/env python3
"""Measures squall beside SPlisHSPlasH and DualSPHysics on one machine, in one go; README.md beside this file says how.

    measure.py --squall PATH [--splishsplash PATH] [--dualsphysics PATH] --out FILE.json [--stages small,busy] [--note KEY=TEXT]
"""
import argparse
import dataclasses
import datetime
import json
import math
import os
import platform
import statistics
import subprocess
import sys

import table
from column import Column
from programs import Dualsphysics, Failed, Splishsplash, Squall


@dataclasses.dataclass
class Samples:
    """How long one run is: frames of squall (a few sub-steps each), steps of the others, after some that do not count."""
    rounds: int
    warm_up_frames: int
    frames: int
    warm_up_steps: int
    steps: int
    until_s: float = math.inf
    frame_rate_hz: int | None = None  # of squall; None: as short as the size allows


SIZES = {
    "small": (18, Samples(rounds=5, warm_up_frames=5, frames=120, warm_up_steps=10, steps=120)),
    "medium": (37, Samples(rounds=3, warm_up_frames=2, frames=60, warm_up_steps=3, steps=60)),
    "large": (79, Samples(rounds=3, warm_up_frames=1, frames=2, warm_up_steps=1, steps=6)),
}
STAGES = [*SIZES, "busy", "solution"]
BUSY = Samples(rounds=5, warm_up_frames=5, frames=60, warm_up_steps=10, steps=40)
# A second at a game's frame rate: frames of 1/600 s would cut dfsph's steps short.
SOLUTION = Samples(rounds=3, warm_up_frames=0, frames=60, warm_up_steps=0, steps=100000, until_s=1.0, frame_rate_hz=60)


class Busy:
    """Another process that keeps the last core busy, as long as the context lasts and five minutes at most."""
    CODE = "import os, time\nos.sched_setaffinity(0, {max(os.sched_getaffinity(0))})\nend = time.time() + 300\nwhile time.time() < end: pass"

    def __enter__(self):
        self.process = subprocess.Popen([sys.executable, "-c", self.CODE])

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()


def summary(name, threads, runs, failure):
    """What a row's runs say together: the median over all their steps, and each run's own median, so that its spread shows."""
    row = {"program": name, "threads": threads}
    if failure or not runs:
        return row | {"error": failure or "did not run"}
    steps = sorted(step for run in runs for step in run["step_ms"])
    row |= {"particles": runs[0]["particles"], "samples": len(steps), "steps": sum(run["steps"] for run in runs),
            "step_ms": {"median": statistics.median(steps), "p95": steps[min(len(steps) - 1, int(0.95 * len(steps)))]},
            "run_medians_ms": [statistics.median(run["step_ms"]) for run in runs],
            "particle_steps_per_s": 1000 * runs[0]["particles"] / statistics.median(steps),
            "simulated_s": [run["simulated_s"] for run in runs]}
    row |= {key: runs[-1][key] for key in ("neighbours_mean",) if key in runs[-1]}
    if "density_error_mean" in runs[-1]:
        row |= {"density_error_mean_median": statistics.median(runs[-1]["density_error_mean"]),
                "density_error_mean_worst": max(runs[-1]["density_error_mean"]),
                "density_error_max_median": statistics.median(runs[-1]["density_error_max"])}
    return row


def in_turn(jobs, rounds):
    """Runs [(key, call)] one after the other, rounds times, every other time backwards; {key: (results, failure)}."""
    results = {key: ([], None) for key, _ in jobs}
    for turn in range(rounds):
        for key, call in jobs if turn % 2 == 0 else reversed(jobs):
            runs, failure = results[key]
            if failure:
                continue
            try:
                runs.append(call())
            except Failed as problem:
                results[key] = (runs, str(problem))
    return results


def run_size(programs, layers, samples, threads):
    column = Column(layers)
    rows = [(program, threads) for program in programs]
    rows += [(program, 1) for program in programs if program.name.startswith("squall omp") and threads > 1]
    jobs = [((program.name, count), lambda program=program, count=count: program.measure(column, count, samples))
            for program, count in rows]
    return [summary(*key, *result) for key, result in in_turn(jobs, samples.rounds).items()]


def run_busy(programs, threads):
    column = Column(SIZES["small"][0])

    def beside_busy(program):
        with Busy():
            return program.measure(column, threads, BUSY)

    jobs = []
    for program in programs:
        jobs += [((program.name, "quiet"), lambda program=program: program.measure(column, threads, BUSY)),
                 ((program.name, "busy"), lambda program=program: beside_busy(program))]
    results = in_turn(jobs, BUSY.rounds)
    rows = []
    for program in programs:
        row = {"program": program.name, "threads": threads}
        for state in ("quiet", "busy"):
            row[state] = summary(program.name, threads, *results[program.name, state])
        if not any("error" in row[state] for state in ("quiet", "busy")):
            # Of the medians of runs made right after one another: what the machine does meanwhile hits both.
            ratios = [busy / quiet for quiet, busy in zip(row["quiet"]["run_medians_ms"], row["busy"]["run_medians_ms"])]
            row |= {"slow_down": statistics.median(ratios), "slow_downs": ratios}
        rows.append(row)
    return rows


def run_solution(programs, threads):
    column = Column(SIZES["small"][0])
    jobs = [((program.name, threads), lambda program=program: program.measure(column, threads, SOLUTION)) for program in programs]
    rows = []
    for (name, count), (runs, failure) in in_turn(jobs, SOLUTION.rounds).items():
        row = summary(name, count, runs, failure)
        if "error" not in row:
            row["simulated_s_per_s"] = statistics.median(run["simulated_s"] * 1000 / run["wall_ms"] for run in runs)
        rows.append(row)
    return rows


def run_stage(stage, options):
    squall = lambda backend, pressure: Squall(options.squall, backend, pressure)
    wcsph_peers = []
    if options.splishsplash:
        wcsph_peers.append(Splishsplash(options.splishsplash, "wcsph"))
    if options.dualsphysics:
        wcsph_peers.append(Dualsphysics(options.dualsphysics))
    if stage in SIZES:
        own = [squall(backend, pressure) for backend in ("omp", "opencl") for pressure in ("mueller", "wcsph")]
        layers, samples = SIZES[stage]
        rows = run_size(own + wcsph_peers, layers, samples, options.threads)
    elif stage == "busy":
        rows = run_busy([squall("omp", "wcsph"), squall("opencl", "wcsph")] + wcsph_peers, options.threads)
    else:
        dfsph = [Splishsplash(options.splishsplash, "dfsph")] if options.splishsplash else []
        rows = run_solution([squall("omp", "wcsph"), squall("omp", "dfsph")] + dfsph, options.threads)
    return rows


def command_output(command):
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True, cwd=os.path.dirname(os.path.abspath(__file__))).stdout
    except (OSError, subprocess.CalledProcessError):
        return ""


def context(options):
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")), "")
    return {"date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"), "cpu": cpu, "cores": os.cpu_count(),
            "kernel": platform.release(), "compiler": command_output(["g++", "--version"]).split("\n")[0], "threads": options.threads,
            "git_revision": command_output(["git", "describe", "--always", "--dirty", "--abbrev=12"]).strip(),
            "notes": dict(note.split("=", 1) for note in options.note), "load_before": os.getloadavg()[0]}


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--squall", required=True, help="squall_steps, of a build with SQUALL_BUILD_BENCH")
    parser.add_argument("--splishsplash", help="splishsplash_steps; without it this peer is left out")
    parser.add_argument("--dualsphysics", help="DualSPHysics5.4CPU_linux64; without it this peer is left out")
    parser.add_argument("--out", required=True, help="JSON; the stages that are not run again are kept")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--stages", default=",".join(STAGES), help="of " + ", ".join(STAGES))
    parser.add_argument("--note", action="append", default=[], metavar="KEY=TEXT", help="kept in the result: versions, flags")
    parser.add_argument("--rounds", type=int, help="instead of each stage's own number: 5 for small and busy, else 3")
    options = parser.parse_args()
    options.stages = options.stages.split(",")
    unknown = [stage for stage in options.stages if stage not in STAGES]
    if unknown:
        parser.error(f"unknown stage {', '.join(unknown)}; there are {', '.join(STAGES)}")
    if options.rounds is not None:
        if options.rounds < 1:
            parser.error("--rounds is at least 1")
        for samples in [samples for _, samples in SIZES.values()] + [BUSY, SOLUTION]:
            samples.rounds = options.rounds
    if options.threads < 1 or any("=" not in note for note in options.note):
        parser.error("--threads is at least 1, a --note is KEY=TEXT")
    for name in ("squall", "splishsplash", "dualsphysics"):
        path = getattr(options, name)
        if path and not os.access(path, os.X_OK):
            parser.error(f"--{name} {path} is no program")
        setattr(options, name, path and os.path.abspath(path))
    os.makedirs(os.path.dirname(os.path.abspath(options.out)), exist_ok=True)
    options.earlier = {"schema": 1, "stages": {}}
    if os.path.exists(options.out):
        try:
            with open(options.out, encoding="utf-8") as file:
                options.earlier = json.load(file)
            options.earlier["stages"].items()
        except (OSError, ValueError, KeyError, TypeError, AttributeError) as problem:
            parser.error(f"--out {options.out} exists and is no result of this program: {problem}")
    return options


def main():
    options = parse()
    result = options.earlier
    for stage in options.stages:
        entry = {"context": context(options)}
        entry["rows"] = run_stage(stage, options)
        entry["context"]["load_after"] = os.getloadavg()[0]
        result["stages"][stage] = entry
        with open(options.out + ".new", "w", encoding="utf-8") as file:
            json.dump(result, file, indent=1)
            file.write("\n")
        os.replace(options.out + ".new", options.out)
        table.show(stage, entry)
    # What this version of squall does not have yet is a row that says so, not a failure.
    failed = [row for stage in options.stages for row in result["stages"][stage]["rows"]
              if any("error" in part and "is not in this version" not in part["error"]
                     for part in (row, row.get("quiet", {}), row.get("busy", {})))]
    return 1 if failed else 0


sys.exit(main())

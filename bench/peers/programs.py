"""Runs one program once on a column and says how long its steps took. Every run is a process of its own."""
import csv
import json
import os
import subprocess
import tempfile

import dualsphysics_case
from column import VISCOSITY_M2_S


class Failed(Exception):
    """The program did not give a result; the text says why."""


def run(command, threads, folder=None, timeout=300):
    # Asked for in every way the programs know: OpenMP, and PoCL before and since version 4.
    environment = dict(os.environ, OMP_NUM_THREADS=str(threads), POCL_MAX_PTHREAD_COUNT=str(threads), POCL_CPU_MAX_CU_COUNT=str(threads))
    try:
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=timeout, check=False)
    except (OSError, subprocess.TimeoutExpired) as error:
        raise Failed(str(error)) from error
    if done.returncode != 0:
        lines = (done.stderr or done.stdout).strip().splitlines()
        raise Failed(f"exit code {done.returncode}: {lines[-1] if lines else 'no message'}")
    return done.stdout


class Squall:
    def __init__(self, path, backend, pressure):
        self.path, self.backend, self.pressure = path, backend, pressure
        self.name = f"squall {backend} {pressure}"

    def measure(self, column, threads, samples):
        with tempfile.TemporaryDirectory() as folder:
            scene = f"{folder}/column.toml"
            with open(scene, "w", encoding="utf-8") as file:
                file.write(column.toml(samples.frame_rate_hz))
            result = json.loads(run([self.path, scene, self.backend, self.pressure, str(threads), str(samples.warm_up_frames),
                                     str(samples.frames)], threads))
        result["wall_ms"] = sum(result["frame_ms"])
        result["step_ms"] = [frame / steps for frame, steps in zip(result.pop("frame_ms"), result["substeps"])]
        result["steps"] = int(sum(result.pop("substeps")))
        return result


class Splishsplash:
    def __init__(self, path, solver):
        self.path, self.solver = path, solver
        self.name = f"SPlisHSPlasH {solver}"

    def measure(self, column, threads, samples):
        # wcsph has no bound of its own from the speed of sound: a quarter of H/c is stable. dfsph: 0.1 %, as in its scenes 5 ms.
        dt_max = 0.005 if self.solver == "dfsph" else 0.25 * dualsphysics_case.support(column) / column.speed_of_sound
        result = json.loads(run([self.path, self.solver, str(column.layers), str(samples.warm_up_steps), str(samples.steps),
                                 str(samples.until_s), repr(dt_max), repr(column.tait_b), repr(VISCOSITY_M2_S), "0.1"], threads))
        result["wall_ms"] = sum(result["step_ms"])
        result["steps"] = len(result["step_ms"])
        return result


class Dualsphysics:
    name = "DualSPHysics"

    def __init__(self, path):
        self.path = path

    def measure(self, column, threads, samples):
        with tempfile.TemporaryDirectory() as folder:
            dualsphysics_case.write_case(column, folder)
            count = samples.warm_up_steps + samples.steps
            # One line of RunPARTs.csv per step, no particles on disk.
            run([self.path, f"{folder}/column", f"{folder}/out", "-cpu", f"-ompthreads:{threads}", "-svsteps:1", f"-nsteps:{count}",
                 "-sv:none,info", "-svres:0"], threads, folder)
            with open(f"{folder}/out/RunPARTs.csv", encoding="utf-8") as file:
                rows = [row for row in csv.reader((line for line in file if line[0].isdigit()), delimiter=";")]
        # The first line is the state before any step.
        steps = [row for row in rows if int(row[2].replace(",", "")) == 1][samples.warm_up_steps:]
        if not steps:
            raise Failed("RunPARTs.csv has no steps")
        excluded = sum(int(row[8].replace(",", "")) for row in rows)
        if excluded:
            raise Failed(f"it excluded {excluded} particles")
        return {"particles": column.particles, "step_ms": [1000 * float(row[4]) for row in steps], "steps": len(steps),
                "simulated_s": float(steps[-1][1]) - float(steps[0][1])}

#!/usr/bin/env python3
"""soak.py SQUALL SCENE MINUTES PRESSURE: rain for so many minutes of wall clock under a memory limit, stopped by Ctrl-C.

Watched: lost particles, energy, level, memory. The scene has one [[rain]], no block, and a level gauge called "level".
Bounds are computed from the scene; each is printed with what was measured. Exit code 1 if one does not hold.
"""
import csv
import json
import math
import resource
import signal
import statistics
import subprocess
import sys
import tempfile
import time
import tomllib

MEMORY_LIMIT = 4 << 30  # bytes of addresses, for which threads and libraries ask generously
GRAVITY = 9.81
INTERRUPTED = 130  # the exit code after Ctrl-C
SETTLING = 0.07  # wcsph and mueller settle some 5 % denser than their lattice (README.md); and a share for waves
BYTES_PER_FRAME = 2048  # a run keeps a record of each frame until it ends


def resident_bytes(process):
    with open(f"/proc/{process.pid}/status") as status:
        for line in status:
            if line.startswith("VmRSS:"):
                return 1024 * int(line.split()[1])
    return 0


def rain_on(squall, scene, minutes, pressure, out):
    """Runs the scene for so long; returns the exit code and (seconds, bytes) samples of its memory."""
    command = [squall, "run", scene, "--pressure", pressure, "--quiet", "--out", out, "--json", out + "/run.json"]
    limit = lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY_LIMIT, MEMORY_LIMIT))
    process = subprocess.Popen(command, preexec_fn=limit, stdout=subprocess.DEVNULL)
    samples, start = [], time.monotonic()
    try:
        while process.poll() is None and time.monotonic() - start < 60 * minutes:
            time.sleep(min(1.0, 0.6 * minutes))
            samples.append((time.monotonic() - start, resident_bytes(process) if process.poll() is None else 0))
        process.send_signal(signal.SIGINT)
        code = process.wait(timeout=120)
    finally:
        process.kill()
    return code, [sample for sample in samples if sample[1] > 0]


def columns(path):
    """The numbers of a CSV file by column; NaN for a cell without a value: lengths, before the first drop."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [float(row[name] or "nan") for row in rows] for name in rows[0]}


def total_energy(series, i):
    return series["kinetic_j"][i] + series["potential_j"][i]


class Verdict:
    def __init__(self):
        self.failed = False

    def expect(self, what, value, low, high):
        fine = math.isfinite(value) and low <= value <= high
        self.failed |= not fine
        print(f"{'ok' if fine else 'FAILED':6} {what}: {value:.6g}, allowed {low:.6g} to {high:.6g}")


def drop_energy(scene):
    """At most what a drop brings along [J]: released within a frame's fall above the height, at terminal speed."""
    rain, fluid = scene["rain"][0], scene["fluid"]
    mass = fluid.get("rest_density_kg_m3", 1000.0) * fluid["spacing_m"] ** 3
    speed = 9.65 - 10.3 * math.exp(-0.6 * rain["drop_diameter_mm"])  # Atlas, Srivastava, Sekhon 1973
    top = rain["height_m"] - scene["container"]["min_m"][1] + speed / 60.0
    return mass * (GRAVITY * top + 0.5 * speed**2)


def judge_water(verdict, scene, particles, series, gauges):
    rain, spacing = scene["rain"][0], scene["fluid"]["spacing_m"]
    # Nothing but drops brings energy, so that no frame has more than they brought.
    brought = [drop_energy(scene) * min(rain["max_particles"], rain["particles_per_s"] * t) for t in series["time_s"]]
    share = max(total_energy(series, i) / brought[i] for i in range(len(brought)))
    verdict.expect("energy, of what drops brought", share, 0.0, 1.0)

    # Level of the last quarter, its median: waves and splashes go up and down.
    low, high = scene["container"]["min_m"], scene["container"]["max_m"]
    area = (high[0] - low[0]) * (high[2] - low[2])
    last = range(3 * len(brought) // 4, len(brought))
    deepest = particles * spacing**3 / area
    level = statistics.median(gauges["level"][i] for i in last)
    filled = min(rain["max_particles"], rain["particles_per_s"] * statistics.median(series["time_s"][i] for i in last))
    depth = filled * spacing**3 / area
    verdict.expect("level [m]", level, (1 - SETTLING) * depth - 2 * spacing, min(depth, deepest) + 2 * spacing)


def judge(scene, pressure, out, code, samples):
    verdict = Verdict()
    with open(out + "/run.json") as file:
        run = json.load(file)["runs"][0]
    series, gauges = columns(out + "/series.csv"), columns(out + "/gauges.csv")
    frames, particles = run["frames"], run["particles"]
    rain = scene["rain"][0]
    print(f"       {frames} frames, {run['steps']} sub-steps, {particles} particles, {series['time_s'][-1]:.0f} s of rain")
    verdict.expect("exit code", code, INTERRUPTED, INTERRUPTED)
    verdict.expect("rows of series.csv", len(series["time_s"]), frames, frames)
    verdict.expect("lost particles", run["lost_particles"], 0, 0)
    due = min(rain["max_particles"], rain["particles_per_s"] * (frames - 1) / 60.0)
    verdict.expect("particles", particles, math.floor(due), math.floor(due))

    if pressure == "mueller":
        print("left out: energy and level: mueller makes energy (docs/validation.md)")
    else:
        judge_water(verdict, scene, particles, series, gauges)

    # Memory: room for all drops is claimed as they come; what is left may grow by a record a frame.
    middle = samples[len(samples) // 2][1]
    allowed = middle + BYTES_PER_FRAME * frames + 4096 * particles
    verdict.expect("resident MiB at the end", samples[-1][1] / 2**20, 0, allowed / 2**20)
    return verdict.failed


def main():
    squall, path, minutes, pressure = sys.argv[1:]
    with open(path, "rb") as file:
        scene = tomllib.load(file)
    with tempfile.TemporaryDirectory() as out:
        code, samples = rain_on(squall, path, float(minutes), pressure, out)
        return judge(scene, pressure, out, code, samples)


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""bench_table.py FOLDER: what bench.sh measured, as tables for people: medians over the repetitions."""
import collections
import json
import statistics
import sys


def load(path):
    """{row: {"values": {counter: median}, "label": most frequent, "error": text or None}}, and the context."""
    with open(path, encoding="utf-8") as file:
        result = json.load(file)
    samples = collections.defaultdict(list)
    for entry in result["benchmarks"]:
        if entry["run_type"] == "iteration":
            samples[entry["run_name"].split("/iterations:")[0]].append(entry)
    rows = {}
    for name, entries in samples.items():
        errors = [entry["error_message"] for entry in entries if entry.get("error_occurred")]
        numbers = collections.defaultdict(list)
        for entry in entries:
            for key, value in entry.items():
                if isinstance(value, (int, float)) and not isinstance(value, bool):
                    numbers[key].append(value)
        labels = collections.Counter(entry.get("label", "") for entry in entries)
        rows[name] = {
            "values": {key: statistics.median(values) for key, values in numbers.items()},
            "label": labels.most_common(1)[0][0],
            "error": errors[0] if errors else None,
        }
    return result["context"], rows


def table(header, lines):
    widths = [max(len(line[column]) for line in [header] + lines) for column in range(len(header))]
    for line in [header] + lines:
        cells = [cell.ljust(width) if column == 0 else cell.rjust(width)
                 for column, (cell, width) in enumerate(zip(line, widths))]
        print("  ".join(cells).rstrip())
    print()


def print_machine(rows):
    lines = []
    for threads, simd in sorted({(name.split("/")[-1], name.split("/")[-2]) for name in rows}):
        end = f"{simd}/{threads}"
        rate = lambda operation: rows[f"rate/{operation}/{end}"]["values"]["operations_per_s"] / 1e9
        copy = lambda where: rows[f"stream/copy/{where}/{end}"]["values"]["bytes_per_s"] / 1e9
        lines.append([f"{simd}, {threads.replace(':', ' ')}", f"{2 * rate('fma'):.1f}"]
                     + [f"{rate(operation):.1f}" for operation in ("mul", "add", "mul+add", "sqrt", "div")]
                     + [f"{copy(where):.1f}" for where in ("16KiB_each", "256KiB_each", "8MiB", "256MiB")])
    table(["machine", "fma GFLOP/s", "mul G/s", "add G/s", "mul+add G/s", "sqrt G/s", "div G/s", "copy GB/s 16 KiB each",
           "256 KiB each", "8 MiB", "256 MiB"], lines)


def size_of(name):
    return int(name.split("/")[2])


def print_solvers(title, rows):
    """One line per whole step; stages beside it where there are any."""
    lines = []
    steps = [name for name in rows if name.startswith("step/")]
    for name in sorted(steps, key=lambda name: (name.split("/")[1], size_of(name), name)):
        row = rows[name]
        _, pressure, size, means = name.split("/", 3)
        head = [f"{pressure} {int(size):,} {means.removeprefix(title)[1:].replace('/', ' ').replace(':', ' ')}"]
        if row["error"]:
            lines.append(head + ["error: " + row["error"]] + [""] * 7)
            continue
        value = row["values"]
        line = head + [f"{value['real_time']:.0f}", f"{value['ns_per_particle']:.1f}",
                       f"{value['particle_steps_per_s'] / 1e6:.2f}", f"{value['pairs_per_s'] / 1e6:.0f}",
                       f"{100 * value['share_of_bound']:.0f} %"]
        for stage in ("sort", "density", "forces"):
            part = rows.get(f"{stage}/{pressure}/{size}/{means}")
            if part is None:
                line.append("")
            elif part["error"]:
                line.append("error")
            else:
                line.append(f"{part['values']['ns_per_particle']:.1f} ns, {100 * part['values']['share_of_bound']:.0f} % of "
                            + part["label"].removeprefix("bound by "))
        lines.append(line)
    table([title, "us/step", "ns/particle", "M steps/s", "M pairs/s", "of bound", "sort", "density", "forces"], lines)


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: bench_table.py FOLDER")
    folder = sys.argv[1]
    context, machine = load(f"{folder}/machine.json")
    print(f"{context['cpu']}, {context['cores']} cores, {context['compiler']}, squall {context['squall_version']} "
          f"({context['git_revision']}), {context['date']}, {context['effort']}: medians\n")
    print_machine(machine)
    for part in ("omp", "opencl"):
        print_solvers(part, load(f"{folder}/{part}.json")[1])


main()

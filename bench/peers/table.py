"""Prints what measure.py measured, as tables for people."""


def lines_of(header, lines):
    widths = [max(len(line[column]) for line in [header] + lines) for column in range(len(header))]
    for line in [header] + lines:
        print("  ".join(cell.ljust(width) if column == 0 else cell.rjust(width)
                        for column, (cell, width) in enumerate(zip(line, widths))).rstrip())
    print()


def steps_line(row):
    head = [row["program"], str(row["threads"])]
    if "error" in row:
        return head + ["error", "", "", "", ""]
    medians = row["run_medians_ms"]
    return head + [f"{row['particle_steps_per_s'] / 1e6:.2f}", f"{row['step_ms']['median']:.2f}", f"{min(medians):.2f} to {max(medians):.2f}",
                   f"{row['samples']} ({row['steps']})", f"{row['neighbours_mean']:.1f}" if "neighbours_mean" in row else ""]


def busy_line(row):
    if "slow_down" not in row:
        return [row["program"], "error", "", "", ""]
    return [row["program"], f"{row['quiet']['step_ms']['median']:.2f}", f"{row['busy']['step_ms']['median']:.2f}", f"{row['slow_down']:.2f}",
            " ".join(f"{ratio:.2f}" for ratio in row["slow_downs"])]


def solution_line(row):
    if "error" in row:
        return [row["program"], "error", "", "", "", ""]
    return [row["program"], f"{row['simulated_s_per_s']:.3f}", f"{row['steps'] / len(row['simulated_s']):.0f}", f"{row['step_ms']['median']:.2f}",
            f"{100 * row['density_error_mean_median']:.3f} %", f"{100 * row['density_error_mean_worst']:.3f} %"]


KINDS = {
    "busy": (["beside a busy process", "ms/step quiet", "busy", "slow-down", "of each pair"], busy_line),
    "solution": (["the first second", "simulated s/s", "steps", "ms/step", "density error, median", "worst"], solution_line),
}
SIZES = (["", "threads", "M particle-steps/s", "ms/step", "medians of runs", "samples (steps)", "neighbours"], steps_line)


def show(stage, entry):
    header, line = KINDS.get(stage, SIZES)
    if stage not in KINDS:
        counts = [row["particles"] for row in entry["rows"] if "particles" in row]
        header = [f"{counts[0]:,} particles" if counts else stage] + header[1:]
    context = entry["context"]
    print(f"{context['cpu']}, {context['date']}, load {context['load_before']:.1f} before, {context['load_after']:.1f} after")
    lines_of(header, [line(row) for row in entry["rows"]])
    for row in entry["rows"]:
        for part in (row, row.get("quiet", {}), row.get("busy", {})):
            if "error" in part:
                print(f"{row['program']}: {part['error']}\n")

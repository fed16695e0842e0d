#!/usr/bin/env python3
"""bench_rows.py FROM TO: a Google Benchmark result with a line per row. Without the rows that follow from others."""
import json
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    result = json.load(file)
rows = [json.dumps(row) for row in result.pop("benchmarks") if row["run_type"] == "iteration"]
with open(sys.argv[2], "w", encoding="utf-8") as file:
    file.write(json.dumps(result)[:-1] + ',\n"benchmarks": [\n' + ",\n".join(rows) + "\n]}\n")

"""Results folders that no run made, for tests of what is drawn and written from them."""
import csv
import json
import os
import sys

from support import SOURCE

sys.path.insert(0, os.path.join(SOURCE, "experiments"))
from plots.data import Results  # noqa: E402

FIRST = ["run_id", "run_number", "scene", "view", "width", "height", "frame", "technique"]
USUAL = {"run_number": 0, "scene": "s", "view": "default", "width": 80, "height": 60, "frame": 0, "trace_ms_median": 1, "trace_ms_ci_low": "", "trace_ms_ci_high": "",
         "repeats": 9, "fetches_mean": 1, "rays": 1000, "outcome": "ok"}


def write_table(path, rows):
    """Rows as dictionaries; a field that one lacks is empty."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, names, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def made_results(case, rows, inputs=(), **environment):
    """Results in the test's folder out/. inputs: the columns that are settings or parameters; the others are measures. A row's
    "passes" is {pass: (milliseconds or None, reason)}."""
    passes = [{"run_id": f"r{i}", "pass": name, "ran": ms is not None, "ms_median": "" if ms is None else ms, "reason": reason}
              for i, row in enumerate(rows) for name, (ms, reason) in row.get("passes", {}).items()]
    rows = [{name: value for name, value in row.items() if name != "passes"} for row in rows]
    first = [name for name in FIRST if name != "frame" or any("frame" in row for row in rows)]
    measures = dict.fromkeys(name for row in rows for name in [*USUAL, *row] if name not in (*FIRST, *inputs))
    names = [*first, *inputs, *sorted(measures, key=lambda name: name != "trace_ms_median")]
    os.makedirs(case.path("out"), exist_ok=True)
    write_table(case.path("out/results.csv"), [{name: {"run_id": f"r{i}", **USUAL, **row}.get(name, "") for name in names} for i, row in enumerate(rows)])
    if passes:
        write_table(case.path("out/passes.csv"), passes)
    with open(case.path("out/environment.json"), "w", encoding="utf-8") as file:
        json.dump(environment, file)
    return Results(case.path("out"))

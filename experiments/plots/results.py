"""Results as a pandas table. One file that needs only pandas: copy it beside your own script, or put experiments/ into PYTHONPATH.

    from plots.results import load
    rows = load("results/cost_of_accuracy")     # a row a run that succeeded; typed; without columns that never change
    rows.groupby("technique").cost_ms_median.min()
    rows.attrs["units"]["cost_ms_median"]            # "ms"
    rows.attrs["constants"]["thickness_m"]      # 0.1: what was dropped

Added columns: cost_ms_median, cost_ms_ci_low and cost_ms_ci_high are the time of the trace and of the structures that only it needs, with the
95 % interval of the trace; frame_name is "scene, view, WIDTH×HEIGHT"; series is the technique with the choices that vary, a line of a plot.
"""
import csv
import json
import os
import re
import tomllib

import pandas as pd

TEXT = ["run_id", "experiment", "scene", "view", "technique", "outcome", "message", "picture", "truth_picture", "no_scene_truth", "no_screen_truth",
        "technique_ignores", "frame_lacks", "sources", "hand_on"]
FRAME = ["scene", "view", "width", "height", "frame"]
# What a clock decides, and differs from one run to the next.
OF_TIME = re.compile(r"(^|[_.])ms(_|$)|^(fps|inverse_fps_s|trace_drift|frames_per_submit)$")
# Of columns that are no measures, by the end of their name, longest first; "" is a count or a setting's own value.
UNITS = {"per_million": "rays per million", "_ms_median": "ms", "_ms_mad": "ms", "_ms_ci_low": "ms", "_ms_ci_high": "ms", "_ms": "ms",
         "_px": "px", "_m": "m", "_db": "dB", "_s": "s", "_share": "share", "recall_1px": "share",
         "precision_1px": "share", "f1_1px": "share", "recall_4px": "share", "all_recall": "share", "all_precision": "share", "all_f1": "share", "fetches_mean": "fetches", "steps_mean": "steps",
         "_iterations_mean": "steps"}


class Unreadable(Exception):
    """Results that are damaged, or in the form of an older version."""


def check_form(path):
    """Every row has as many fields as the first, and the last row ends."""
    with open(path, encoding="utf-8", newline="") as file:
        rows = csv.reader(file)
        head = next(rows, [])
        for number, row in enumerate(rows, 1):
            if row and len(row) != len(head):
                at = f"column '{head[len(row)]}' is not there" if len(row) < len(head) else f"one too many behind column '{head[-1]}'"
                raise Unreadable(f"{path}: damaged: row {number} (line {rows.line_num}): expected {len(head)} fields, got {len(row)}: {at}")
    with open(path, "rb") as file:
        file.seek(-1 if head else 0, os.SEEK_END)
        if head and file.read() != b"\n":
            raise Unreadable(f"{path}: damaged: expected an end of line behind the last row, got the end of the file: it is cut")


def read_csv(path, words, numbers=lambda table: (), **how):
    """words: columns that are never numbers; numbers: of a table the columns that always are."""
    try:
        check_form(path)
        table = pd.read_csv(path, dtype={name: str for name in words}, index_col=False, **how)
    except (pd.errors.EmptyDataError, pd.errors.ParserError, UnicodeDecodeError, csv.Error) as error:
        raise Unreadable(f"{path}: damaged: {error}") from error
    for name in numbers(table):
        if is_number(table[name]):
            continue
        values = pd.to_numeric(table[name], errors="coerce")
        for row in table.index[values.isna() & table[name].notna()][:1]:
            raise Unreadable(f"{path}: damaged: row {row + 1} (run {table.run_id[row]}), column '{name}': expected a number, got '{table[name][row]}'")
        table[name] = values
    return table


def measures_of(rows):
    """Columns of results.csv that are numbers in every row, or empty."""
    columns = list(rows.columns)
    behind = columns[columns.index("trace_ms_median"):] if "trace_ms_median" in columns else []
    return [name for name in ("run_number", "width", "height", "frame", *behind) if name in columns and name not in TEXT]


def read_rows(folder):
    """Every row of results.csv, failed ones too; empty fields are missing values, words stay words."""
    path = os.path.join(folder, "results.csv")
    if not os.path.exists(path):
        raise FileNotFoundError(f"{folder}: holds no results.csv; make one with ssrlab run")
    rows = read_csv(path, TEXT, measures_of, keep_default_na=False, na_values=[""])
    lacking = [name for name in (*FRAME[:-1], "run_id", "technique", "trace_ms_median", "outcome") if name not in rows]
    if lacking:
        raise Unreadable(f"{path}: damaged: its first line has no column '{lacking[0]}'")
    if "passes" in rows or "passes_why" in rows:
        raise Unreadable(f"{path}: an older ssrlab wrote it, without passes.csv; measure it anew: ssrlab run SPECIFICATION.toml -o ANOTHER_FOLDER")
    if rows.empty:
        raise Unreadable(f"{path}: holds no row, only the names of its columns; ssrlab run --resume measures what is missing")
    return rows


def read_environment(folder):
    """Device, commit, specification …: environment.json; empty without it."""
    path = os.path.join(folder, "environment.json")
    if not os.path.exists(path):
        return {}
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (json.JSONDecodeError, UnicodeDecodeError) as error:
        raise Unreadable(f"{path}: damaged: {error}") from error


def read_samples(folder):
    """Every timed frame: run_id, round, pass, ms, cpu_ms."""
    return read_csv(os.path.join(folder, "samples.csv"), ["run_id", "pass"], lambda table: [name for name in ("round", "ms", "cpu_ms") if name in table])


def read_passes(folder):
    """The passes of every run's frame: run_id, pass, ran, ms_median, ms_ci_low, ms_ci_high, reason and, but for old ones, bytes; empty without passes.csv."""
    path = os.path.join(folder, "passes.csv")
    if not os.path.exists(path):
        return pd.DataFrame(columns=["run_id", "pass", "ran", "ms_median", "ms_ci_low", "ms_ci_high", "reason"])
    return read_csv(path, ["run_id", "pass", "reason"], lambda table: [name for name in table if name.startswith("ms_")],
                    keep_default_na=False, na_values=[""])


def read_sources(folder):
    """Each source of every run's list: run_id, place, source, and the columns of `ssrlab measures`; empty if none was asked."""
    path = os.path.join(folder, "sources.csv")
    if not os.path.exists(path):
        return pd.DataFrame(columns=["run_id", "place", "source"])
    return read_csv(path, ["run_id", "source"], lambda table: [name for name in table if name not in ("run_id", "source")])


def counted(count, singular):
    """"1 row", "2 rows"."""
    return f"{count} {singular}{'' if count == 1 else 's'}"


def specification(folder):
    """The experiment's TOML file as a dictionary."""
    return tomllib.loads(read_environment(folder).get("specification", ""))


def unit_of(column, environment):
    """What the environment says of a measure, else what the name does: "trace_ms_median" is in ms."""
    measures = dict(entry.split("=", 1) for entry in environment.get("units", "").split("; ") if "=" in entry)
    if column in measures:
        return measures[column]
    ends = [end for end in sorted(UNITS, key=len, reverse=True) if column.endswith(end)]
    return UNITS[ends[0]] if ends else ""


def inputs_of(rows):
    """Settings of a run and parameters of techniques, as results.csv orders them."""
    columns = list(rows.columns)
    return columns[columns.index("technique") + 1:columns.index("trace_ms_median")]


def is_number(column):
    return column.dtype.kind in "if"


def varying(rows, inputs):
    """Inputs that take more than one value within a technique."""
    return [name for name in inputs if (rows.groupby("technique")[name].nunique(dropna=True) > 1).any()]


def said_as(name, value):
    """True is written as its name, False is not written, a choice is written as itself."""
    if value in (True, "true", "True"):
        return name
    if value in (False, "false", "False"):
        return ""
    return str(value)


def series_of(rows, inputs):
    """Technique with its varying choices (space, depth_pyramid.kind …): a line in a plot."""
    chosen = [name for name in varying(rows, inputs) if not is_number(rows[name])]
    varies = {name: rows.groupby("technique")[name].nunique() > 1 for name in chosen}
    labels = []
    for _, row in rows.iterrows():
        said = [said_as(name, row[name]) for name in chosen if pd.notna(row[name]) and varies[name][row.technique]]
        labels.append(", ".join([row.technique] + [text for text in said if text]))
    return labels


def add_derived(rows):
    """Adds cost_ms_*, series and frame_name in place."""
    structures = rows.structures_ms_median.fillna(0) if "structures_ms_median" in rows else 0
    for end in ("median", "ci_low", "ci_high"):
        if f"trace_ms_{end}" in rows:
            rows[f"cost_ms_{end}"] = rows[f"trace_ms_{end}"] + structures
    rows["series"] = series_of(rows, inputs_of(rows))
    rows["frame_name"] = [frame_name(row) for _, row in rows.iterrows()]


def frame_name(row):
    """Scene, view, size; the number of the frame where there is more than the first."""
    number = f", frame {row.frame:g}" if "frame" in row and row.frame > 0 else ""
    return f"{row.scene}, view {row['view']}, {row.width}×{row.height}{number}"


def load(folder, keep_constants=False, failed=False):
    """The table of a results folder. attrs: units, constants (dropped columns and their value), inputs, environment."""
    rows = read_rows(folder)
    inputs = inputs_of(rows)
    if not failed:
        rows = rows[rows.outcome == "ok"].copy()
    add_derived(rows)
    constants = {}
    if not keep_constants and len(rows) > 1:
        always = {"run_id", "scene", "technique", "series", "frame_name", "cost_ms_median"}
        same = [name for name in rows if name not in always and (rows[name].isna().all() or rows[name].nunique(dropna=False) == 1)]
        constants = {name: rows[name].iloc[0] for name in same if pd.notna(rows[name].iloc[0])}
        rows = rows.drop(columns=same)
    rows = rows.reset_index(drop=True)
    environment = read_environment(folder)
    rows.attrs = {"units": {name: unit_of(name, environment) for name in rows}, "constants": constants, "environment": environment,
                  "inputs": [name for name in inputs if name in rows]}
    return rows

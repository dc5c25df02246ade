"""Results of a folder for plots: rows that succeeded, their styles, what an experiment aims at."""
import tomllib

import numpy as np
import pandas as pd

from .pairs import cost_samples
from .styles import chart_styles, styles
from .results import add_derived, inputs_of, is_number, read_environment, read_passes, read_rows, read_sources, varying  # noqa: F401

# Where a specification names no [targets].
TARGETS = {"recall_1px": [0.90, 0.95, 0.99, 0.995], "screen_recall_1px": [0.90, 0.95, 0.99, 0.995]}


class Results:
    """Rows that succeeded, their settings and parameters (`inputs`), and the environment they came from."""

    def __init__(self, folder, bandwidth_gbps=None):
        self.folder, self.bandwidth_gbps = folder, bandwidth_gbps  # of the device's memory; None: not given
        self.all_rows = read_rows(folder)
        self.rows = self.all_rows[self.all_rows.outcome == "ok"].copy()
        self.inputs = inputs_of(self.all_rows)
        self.environment = read_environment(folder)
        self.targets = targets_of(self.environment)
        self.accuracy = accuracy_of(self.environment)
        self.costs = cost_samples(folder)
        self.passes = read_passes(folder)
        self.sources = read_sources(folder)
        add_derived(self.rows)
        self.techniques = sorted(self.rows.technique.unique())
        series = {name: sorted(self.rows[self.rows.technique == name].series.unique()) for name in self.techniques}
        self.styles, self.chart_styles = styles(series), chart_styles(series)

    def has(self, *columns):
        """Whether every column is there with at least one value."""
        return all(column in self.rows and self.rows[column].notna().any() for column in columns)

    def pass_ms(self, rows, name):
        """Milliseconds of a pass in each of these rows; 0 where it did not run."""
        times = self.passes[self.passes["pass"] == name].set_index("run_id").ms_median
        return rows.run_id.map(times).astype(float).fillna(0)

    def pictures(self):
        """(title, file-name part, rows) for each scene, view, size and frame of a sequence."""
        frame = ["frame"] if self.has("frame") and self.rows.frame.nunique() > 1 else []
        for key, rows in self.rows.groupby(["scene", "view", "width", "height"] + frame, sort=False):
            name = "{}_{}_{}x{}".format(*key) + "".join(f"_{number:g}" for number in key[4:])
            yield rows.frame_name.iloc[0], "".join(c if c.isalnum() or c in "_-" else "_" for c in name), rows

    def varying(self, rows):
        return varying(rows, self.inputs)

    def swept(self, rows):
        """Varying inputs that are numbers, those with most values first."""
        names = [name for name in self.varying(rows) if is_number(rows[name])]
        return sorted(names, key=lambda name: -rows[name].nunique())


def targets_of(environment):
    """{measure: values} of the specification's [targets]."""
    stated = tomllib.loads(environment.get("specification", "")).get("targets", {})
    return {name: values if isinstance(values, list) else [values] for name, values in stated.items()} or TARGETS


def accuracy_of(environment):
    """{technique: {parameter: "higher" or "lower"}}: what buys accuracy with time."""
    accuracy = {}
    for entry in environment.get("accuracy", "").split():
        name, better = entry.split("=")
        technique, parameter = name.split(".")
        accuracy.setdefault(technique, {})[parameter] = better
    return accuracy


def describe(results, row, rows):
    """Technique, choices and numbers in words, for tables."""
    same = rows[rows.technique == row.technique]
    parts = [f"{name} {row[name]:g}" for name in results.swept(rows)
             if same[name].nunique() > 1 and pd.notna(row[name])]
    return ", ".join([row.series] + parts)


def to_ends(rows, name):
    """Distances from median to both ends of the interval; NaN where it is not known."""
    low, high = (rows.get(f"{name}_{end}", rows[f"{name}_median"] * np.nan) for end in ("ci_low", "ci_high"))
    return [(rows[f"{name}_median"] - low).clip(lower=0).to_numpy(), (high - rows[f"{name}_median"]).clip(lower=0).to_numpy()]


ALIKE = "do not differ by more than their intervals"
APART, OVERLAPPING, UNKNOWN = "apart", "overlapping", "unknown"


def order_of(quick, slow, name="cost_ms"):
    """Whether the drawn intervals of two rows are apart, so that one may be called faster than the other."""
    high, low = quick.get(f"{name}_ci_high", np.nan), slow.get(f"{name}_ci_low", np.nan)
    if pd.isna(high) or pd.isna(low):
        return UNKNOWN
    return APART if low > high else OVERLAPPING


def listed(names):
    """"a", "a and b", "a, b and c"."""
    *rest, last = names
    return f"{', '.join(rest)} and {last}" if rest else last


def errors(rows, name):
    """The same for matplotlib, which warns of bars that are NaN alone: None where no interval is known."""
    ends = to_ends(rows, name)
    return None if np.isnan(ends).all() else ends


def known(rows, name):
    """Which rows have an interval: the others are drawn hollow."""
    return ~np.isnan(to_ends(rows, name)).any(axis=0)

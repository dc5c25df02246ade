"""results.csv as a table, and the style of each technique in every plot."""
import json
import os
import tomllib

import pandas as pd

from pairs import cost_samples

# Okabe and Ito 2008: told apart by the colour-blind; markers and dashes repeat the distinction.
COLOURS = ["#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9", "#000000", "#F0E442"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "*"]
DASHES = ["-", "--", ":", "-."]
PICTURE = ["scene", "view", "width", "height"]
# Where a specification names no [targets].
TARGETS = {"recall_1px": [0.90, 0.95, 0.99, 0.995], "screen_recall_1px": [0.90, 0.95, 0.99, 0.995]}


class Results:
    """Rows that succeeded, their settings and parameters (`inputs`), and the environment they came from."""

    def __init__(self, folder):
        self.folder = folder
        text = {name: str for name in ("run_id", "experiment", "scene", "view", "technique", "outcome", "message", "picture")}
        self.all_rows = pd.read_csv(os.path.join(folder, "results.csv"), dtype=text, keep_default_na=False,
                                    na_values=[""])
        self.rows = self.all_rows[self.all_rows.outcome == "ok"].copy()
        columns = list(self.all_rows.columns)
        self.inputs = columns[columns.index("technique") + 1:columns.index("trace_ms_median")]
        path = os.path.join(folder, "environment.json")
        self.environment = {}
        if os.path.exists(path):
            with open(path, encoding="utf-8") as file:
                self.environment = json.load(file)
        self.targets = targets_of(self.environment)
        self.accuracy = accuracy_of(self.environment)
        self.costs = cost_samples(folder)
        # What a technique costs: its trace and the structures that only it needs.
        for end in ("median", "ci_low", "ci_high"):
            column = f"trace_ms_{end}"
            if column in self.rows:
                self.rows[f"cost_ms_{end}"] = self.rows[column] + self.rows.structures_ms_median.fillna(0)
        self.rows["series"] = self._series()
        self.techniques = list(dict.fromkeys(self.rows.technique.sort_values()))
        self.styles = self._styles()

    def has(self, *columns):
        """Whether every column is there with at least one value."""
        return all(column in self.rows and self.rows[column].notna().any() for column in columns)

    def pictures(self):
        """(title, file-name part, rows) for each scene, view and size."""
        for (scene, view, width, height), rows in self.rows.groupby(PICTURE, sort=False):
            name = f"{scene}_{view}_{width}x{height}"
            safe = "".join(c if c.isalnum() or c in "_-" else "_" for c in name)
            yield f"{scene}, view {view}, {width}×{height}", safe, rows

    def varying(self, rows):
        """Inputs that take more than one value within a technique."""
        return [name for name in self.inputs
                if (rows.groupby("technique")[name].nunique(dropna=True) > 1).any()]

    def swept(self, rows):
        """Varying inputs that are numbers, those with most values first."""
        names = [name for name in self.varying(rows) if is_number(rows[name])]
        return sorted(names, key=lambda name: -rows[name].nunique())

    def _series(self):
        """Technique with its varying choices (space, depth_pyramid.kind …): a line in a plot."""
        rows = self.rows
        chosen = [name for name in self.varying(rows) if not is_number(rows[name])]
        labels = []
        for _, row in rows.iterrows():
            said = [said_as(name, row[name]) for name in chosen
                    if pd.notna(row[name]) and rows[rows.technique == row.technique][name].nunique() > 1]
            labels.append(", ".join([row.technique] + [text for text in said if text]))
        return labels

    def _styles(self):
        styles = {}
        for i, technique in enumerate(self.techniques):
            series = sorted(self.rows[self.rows.technique == technique].series.unique())
            for j, name in enumerate(series):
                styles[name] = dict(color=COLOURS[i % len(COLOURS)], marker=MARKERS[(i + 4 * j) % len(MARKERS)],
                                    linestyle=DASHES[j % len(DASHES)], alpha=1 - 0.18 * (j % 4))
        return styles


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


def is_number(column):
    return column.dtype.kind in "if"


def said_as(name, value):
    """True is written as its name, False is not written, a choice is written as itself."""
    if value in (True, "true", "True"):
        return name
    if value in (False, "false", "False"):
        return ""
    return str(value)


def label_of(results, row, rows):
    """The numbers that tell this row from its neighbours: "steps 500"."""
    same = rows[rows.series == row.series]
    parts = [f"{row[name]:g}" for name in results.swept(rows) if same[name].nunique() > 1 and pd.notna(row[name])]
    return " / ".join(parts)


def describe(results, row, rows):
    """Technique, choices and numbers in words, for tables."""
    same = rows[rows.technique == row.technique]
    parts = [f"{name} {row[name]:g}" for name in results.swept(rows)
             if same[name].nunique() > 1 and pd.notna(row[name])]
    return ", ".join([row.series] + parts)


def errors(rows, name):
    """Distances from median to both ends of the interval, for matplotlib; NaN, which draws no bar, where it is not known."""
    low = (rows[f"{name}_median"] - rows[f"{name}_ci_low"]).clip(lower=0)
    high = (rows[f"{name}_ci_high"] - rows[f"{name}_median"]).clip(lower=0)
    return [low.to_numpy(), high.to_numpy()]


def known(rows, name):
    """Which rows have an interval: the others are drawn hollow."""
    return rows[f"{name}_ci_low"].notna() & rows[f"{name}_ci_high"].notna()

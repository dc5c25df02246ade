"""The defaults of passes and surface against each of them changed, from the rows of experiments/defaults.toml.

A change is told by its errors relative to the defaults', as geometric means over all scenes; picture_flip decides."""
import numpy as np
import pandas as pd

from .results import inputs_of, read_environment, read_rows

MEASURES = ["picture_rmse", "picture_flip"]  # the last decides


def text_of(value):
    if isinstance(value, (bool, np.bool_)):
        return str(bool(value)).lower()
    return f'"{value}"' if isinstance(value, str) else f"{value:g}"


def changes(rows, settings):
    """(label, ratios): of each run but the first, a row a scene and a column a measure."""
    found = {}
    for scene, part in rows.groupby("scene", sort=False):
        default = part[part.run_number == 0].iloc[0]
        for _, row in part[part.run_number > 0].iterrows():
            changed = [name for name in settings if row[name] != default[name] and not (pd.isna(row[name]) and pd.isna(default[name]))]
            label = ", ".join(f"`{name} = {text_of(row[name])}`" for name in changed)
            ratios = found.setdefault(label, [])
            ratios.append([row[name] / default[name] for name in MEASURES])
    scenes = rows.scene.nunique()
    for label, ratios in found.items():
        if label and len(ratios) != scenes:
            raise SystemExit(f"{label} has {len(ratios)} rows, expected one for each of {scenes} scenes")
    # A value that is the default's is no change.
    return [(label, np.array(ratios)) for label, ratios in found.items() if label]


def geometric_mean(values):
    return float(np.exp(np.log(values).mean()))


def tables(folder):
    """The tables as Markdown, and the labels of the changes that beat the defaults."""
    rows = read_rows(folder).sort_values("run_number", kind="stable")
    if (rows.outcome != "ok").any():
        raise SystemExit(f"{folder}: {(rows.outcome != 'ok').sum()} runs failed")
    effects = ["surface", "behind"] + read_environment(folder).get("pass_parameters", "").split()
    default = rows[rows.run_number == 0]
    lines = [f"| changed, mean of {len(default)} scenes | RMSE | FLIP | both smaller in |", "|---|---|---|---|"]
    beaten_by = []
    for label, ratios in changes(rows, [name for name in inputs_of(rows) if name in effects]):
        means = [geometric_mean(column) for column in ratios.T]
        lines.append(f"| {label} | {means[0]:.3f} | {means[1]:.3f} | {int((ratios < 1).all(axis=1).sum())} |")
        if round(means[-1], 3) < 1:  # as the table says it
            beaten_by.append(label)
    lines += ["", "| scene | `picture_rmse` | `picture_flip` |", "|---|---|---|"]
    lines += [f"| {row.scene} | {row.picture_rmse:.3f} | {row.picture_flip:.3f} |" for _, row in default.iterrows()]
    return "\n".join(lines) + "\n", beaten_by

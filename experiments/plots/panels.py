"""Figures that a specification names in [figures.NAME]: pictures of its runs side by side, with what differs and how right they are."""
import os
import tomllib

import matplotlib.pyplot as plt
import pandas as pd

MEASURES = {"recall_1px": "recall", "precision_1px": "precision", "hit_share": "hits", "picture_rmse": "picture RMSE",
            "picture_visible_border_rmse": "at borders"}
SHOWN = {"off": "no reflections", "truth": "true reflection", "agreement": "green right, yellow displaced, orange missed, pink false",
         "causes": "why rays are wrong"}


def is_value(cell, value):
    """Whether a field of results.csv holds a value of the specification."""
    if isinstance(value, bool):
        return str(cell).lower() == str(value).lower()
    if isinstance(value, (int, float)):
        return pd.notna(cell) and not isinstance(cell, str) and abs(cell - value) <= 1e-6 * max(1, abs(value))
    return str(cell) == value


def row_of(rows, panel, figure):
    """The one row that holds all values of a panel."""
    for name, value in panel.items():
        if name == "show":
            continue
        if name not in rows:
            raise SystemExit(f"plot: [figures.{figure}]: '{name}' is no column of results.csv")
        rows = rows[[is_value(cell, value) for cell in rows[name]]]
    if len(rows) != 1:
        raise SystemExit(f"plot: [figures.{figure}]: a panel must name one run, {panel} names {len(rows)}")
    return rows.iloc[0]


def picture_of(panel, row):
    """The file that a panel shows, relative to the results."""
    shown = panel.get("show", "")
    if shown == "truth":
        return row.truth_picture
    if shown == "off":
        return row.truth_picture[:-len(".png")] + "_off.png"
    return row.picture[:-len(".png")] + (f"_{shown}.png" if shown else ".png")


def caption(panel, figure, row):
    """What tells a panel from its neighbours, and how right its run is."""
    shown = panel.get("show", "")
    words = [] if shown in ("off", "truth") else [
        f"{name} {value}" for name, value in panel.items()
        if name != "show" and any(other.get(name, value) != value for other in figure["panels"])]
    lines = [", ".join(([SHOWN[shown]] if shown in SHOWN else []) + words)]
    if shown not in ("off", "truth"):
        lines.append(", ".join(f"{said} {row[name]:.3f}" for name, said in MEASURES.items()
                               if name in figure["measures"] and pd.notna(row[name])))
    return "\n".join(line for line in lines if line)


def figures_of(results):
    """{name: table} of the specification's [figures]."""
    return tomllib.loads(results.environment.get("specification", "")).get("figures", {})


def panels_of(results, _):
    """One figure for each [figures.NAME] table."""
    for name, figure in figures_of(results).items():
        panels = figure["panels"]
        columns = min(len(panels), 2)
        lines = -(-len(panels) // columns)
        rows = [row_of(results.rows, panel, name) for panel in panels]
        shape = rows[0].height / rows[0].width
        drawn, axes = plt.subplots(lines, columns, figsize=(5.4 * columns, lines * (5.4 * shape + 0.55) + 0.4), squeeze=False)
        for axis in axes.flat:
            axis.axis("off")
        for axis, panel, row in zip(axes.flat, panels, rows):
            axis.imshow(plt.imread(os.path.join(results.folder, picture_of(panel, row))))
            axis.set_title(caption(panel, figure, row), fontsize=8.5, loc="left")
        drawn.suptitle(figure["says"], fontsize=10.5)
        yield name, drawn


ALL = [panels_of]

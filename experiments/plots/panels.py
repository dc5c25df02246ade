"""Figures that a specification names in [figures.NAME]: pictures of its runs side by side, with what differs and how right they are."""
import os
import textwrap

import matplotlib.pyplot as plt
import pandas as pd

from .paper import WIDTH_INCHES, sheet, titled

MEASURES = {"recall_1px": "recall", "precision_1px": "precision", "hit_share": "hits", "picture_rmse": "picture RMSE",
            "picture_visible_border_rmse": "at borders"}
SHOWN = {"off": "no reflections", "truth": "true reflection", "agreement": "agreement with the truth",
         "causes": "why rays are wrong"}


COLOURS_OF = {"agreement": "green: right, yellow: displaced, orange: missed, pink: false, grey: rightly nothing"}


def row_of(rows, panel, figure):
    """The row of a panel's run."""
    found = rows[rows.run_id == panel["run_id"]]
    if found.empty:
        raise SystemExit(f"plot: [figures.{figure}]: run {panel['run_id']} has no picture: results.csv says why")
    return found.iloc[0]


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
        if name not in ("run_id", "show") and any(other.get(name, value) != value for other in figure["panels"])]
    lines = [", ".join(([SHOWN[shown]] if shown in SHOWN else []) + words)]
    if shown not in ("off", "truth"):
        lines.append(", ".join(f"{MEASURES.get(name, name)} {row[name]:.3f}" for name in figure["measures"] if pd.notna(row[name])))
    return "\n".join(line for line in lines if line)


def figures_of(results):
    """{name: figure}: the specification's [figures], as `ssrlab run` has checked them, with the run that each panel names."""
    return results.environment.get("figures", {})


def cropped(picture, figure):
    """The figure's `crop = [x, y, width, height]` of the picture, in pixels."""
    x, y, width, height = figure.get("crop", (0, 0, picture.shape[1], picture.shape[0]))
    return picture[y:y + height, x:x + width]


def panels_of(results, _):
    """One figure for each [figures.NAME] table."""
    for name, figure in figures_of(results).items():
        panels = figure["panels"]
        columns = min(len(panels), 2)
        rows = [row_of(results.rows, panel, name) for panel in panels]
        captions = ["\n".join(textwrap.fill(line, 72 // columns) for line in caption(panel, figure, row).split("\n"))
                    for panel, row in zip(panels, rows)]
        width, height = figure.get("crop", (0, 0, rows[0].width, rows[0].height))[2:]
        line_inches = WIDTH_INCHES / columns * height / width + 0.12 * max(text.count("\n") + 1 for text in captions)
        drawn, axes = sheet(*[line_inches] * -(-len(panels) // columns), columns=columns)
        for axis in axes.flat:
            axis.axis("off")
        for axis, panel, row, text in zip(axes.flat, panels, rows, captions):
            axis.imshow(cropped(plt.imread(os.path.join(results.folder, picture_of(panel, row))), figure), interpolation="nearest")
            axis.set_title(text, fontsize=6)
        titled(drawn, figure["says"], "; ".join(text for show, text in COLOURS_OF.items() if any(panel.get("show") == show for panel in panels)))
        yield name, drawn


ALL = [panels_of]

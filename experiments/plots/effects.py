"""Passes: milliseconds added against error removed, one point per setting, relative to the first run of the frame."""
import textwrap

import numpy as np
import pandas as pd

from .data import OVERLAPPING, errors, known, order_of
from .paper import sheet, titled

ERRORS = [("picture_rmse", "all that reflects"), ("picture_visible_border_rmse", "at borders of materials")]


def told(name, value):
    """A pass's setting in words: "gloss cone", "environment", "no downsample_cross_blur", "rays_per_pixel 4"."""
    if isinstance(value, (bool, np.bool_)):
        return name if value else f"no {name}"
    return f"{name} {value:g}" if not isinstance(value, str) else f"{name} {value}"


def compared(results):
    """(title, file-name part, first row, [(label, row)]) for each frame and technique whose runs differ in passes."""
    effects = [name for name in results.environment.get("pass_parameters", "").split() if name in results.rows]
    if not effects or "run_number" not in results.rows or not results.has("picture_rmse", "frame_ms_median"):
        return
    for title, name, rows in results.pictures():
        for technique, part in rows.groupby("technique", sort=False):
            part = part.sort_values("run_number")
            first = part.iloc[0]
            inputs = [column for column in results.varying(part) if pd.notna(first[column])]
            if len(part) < 2 or not any(column in effects for column in inputs):
                continue
            points = []
            for _, row in part.iloc[1:].iterrows():
                changed = [told(column, row[column]) for column in inputs if row[column] != first[column]]
                points.append((" + ".join(changed), row))
            yield f"{title}, {technique}", f"{name}_{technique}", first, points


def trades(results, tables):
    """What error each pass removes, and what it costs: a line a setting, the most helpful first."""
    for title, name, first, points in compared(results) or ():
        shown = [(error, where) for error, where in ERRORS
                 if error in first and pd.notna(first[error]) and all(pd.notna(row[error]) for _, row in points)]
        if not shown:
            continue
        points.sort(key=lambda point: point[1][shown[0][0]])
        labels = [textwrap.fill(label, 38) for label, _ in points]
        heights = [0.14 + 0.11 * label.count("\n") for label in labels]
        places = np.cumsum(heights) - np.array(heights) / 2
        rows = pd.DataFrame([row for _, row in points])
        figure, ((removed, added),) = sheet(0.8 + sum(heights), columns=2, sharey=True)
        for (error, where), colour, marker in zip(shown, ("#0072B2", "#E69F00"), "os"):
            removed.plot(first[error] - rows[error], places, color=colour, marker=marker, ls="none", label=where)
        sure, more = known(rows, "frame_ms"), rows.frame_ms_median - first.frame_ms_median
        added.errorbar(more, places, xerr=errors(rows, "frame_ms"), color="#0072B2", fmt="o", elinewidth=0.7)
        added.plot(more[~sure], places[~sure], "o", color="#0072B2", markerfacecolor="white")
        for axis in (removed, added):
            axis.axvline(0, color="#888888", lw=0.6)
        removed.set_yticks(places, labels, fontsize=6)
        removed.set_ylim(sum(heights), 0)
        removed.set_xlabel("error removed")
        removed.legend(loc="lower right", bbox_to_anchor=(1.1, 1), borderaxespad=0.2, handletextpad=0.1)
        # An interval that a busy machine made long is cut at the frame.
        margin = 0.15 * max(np.ptp(np.append(more, 0)), 1e-3)
        added.set_xlim(min(more.min(), 0) - margin, max(more.max(), 0) + margin)
        added.set_xlabel("ms added")
        error, label, row = shown[0][0], *points[0]
        helps, added_ms = row[error] < first[error], row.frame_ms_median - first.frame_ms_median
        quick, slow = (first, row) if added_ms >= 0 else (row, first)
        price = f"for {added_ms:.2f} ms" if order_of(quick, slow, "frame_ms") != OVERLAPPING else "in a time that does not differ by more than the intervals"
        titled(figure, f"{label} takes {error} from {first[error]:.4f} to {row[error]:.4f} {price}"
               if helps else f"No change lowers {error} below the first run's {first[error]:.3f}", f"{title}; against the first run")
        for label, row in points:
            tables.setdefault("Passes: milliseconds added and error removed, relative to the first run", []).append(
                {"frame": title, "changed": label, "ms added": f"{row.frame_ms_median - first.frame_ms_median:.2f}",
                 **{f"{error} removed": f"{first[error] - row[error]:+.4f}" for error, _ in shown}})
        yield f"effects_{name}", figure


ALL = [trades]

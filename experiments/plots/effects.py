"""Passes: milliseconds added against error removed, one point per setting, relative to the first run of the frame."""
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd

ERRORS = [("picture_rmse", "all reflecting pixels"), ("picture_visible_border_rmse", "borders between materials, visible hits")]


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


def spread(x, y, room, low, high):
    """Heights for the names of points: near theirs, at least `room` apart and within the bounds as far as they suffice. Of points that
    are about equally high the one at the right is named first, from below, so that few lines cross."""
    order = np.lexsort((-x, np.round(y / (0.25 * room))))
    room = min(room, (high - low) / max(1, len(y) - 1))
    placed = y[order]
    for i in range(1, len(placed)):
        placed[i] = max(placed[i], placed[i - 1] + room)
    placed = np.minimum(placed, high - room * np.arange(len(placed) - 1, -1, -1))
    for i in range(len(placed) - 2, -1, -1):
        placed[i] = min(placed[i], placed[i + 1] - room)
    result = np.empty(len(placed))
    result[order] = placed
    return result


def trade(axis, first, points, error, where):
    """Points with their names in a column at the right, joined by thin lines."""
    added = np.array([row.frame_ms_median - first.frame_ms_median for _, row in points])
    removed = np.array([first[error] - row[error] for _, row in points])
    low = np.array([row.frame_ms_median - row.frame_ms_ci_low for _, row in points])
    high = np.array([row.frame_ms_ci_high - row.frame_ms_median for _, row in points])
    sure = ~np.isnan(low) & ~np.isnan(high)
    axis.axhline(0, color="#888888", lw=1)
    axis.axvline(0, color="#888888", lw=1)
    axis.errorbar(added[sure], removed[sure], xerr=[low[sure], high[sure]], fmt="o", color="#0072B2", ecolor="#0072B2", elinewidth=1, ms=5)
    axis.plot(added[~sure], removed[~sure], "o", color="#0072B2", markerfacecolor="white", ms=5)
    axis.plot(0, 0, "s", color="#000000", ms=6)
    # An interval that a busy machine made long is cut at the frame.
    margin = 0.15 * max(np.ptp(np.append(added, 0)), 1e-3)
    axis.set_xlim(min(added.min(), 0) - margin, max(added.max(), 0) + margin)
    margin = 0.08 * max(np.ptp(np.append(removed, 0)), 1e-6)
    axis.set_ylim(min(removed.min(), 0) - margin, max(removed.max(), 0) + margin)
    bottom, top = axis.get_ylim()
    places = spread(np.append(added, 0), np.append(removed, 0), 0.058 * (top - bottom), bottom, top)
    names = [label for label, _ in points] + ["first run"]
    for label, x, y, place in zip(names, np.append(added, 0), np.append(removed, 0), places):
        axis.annotate(label, (x, y), xytext=(1.03, place), textcoords=axis.get_yaxis_transform(), fontsize=8, va="center",
                      annotation_clip=False,
                      arrowprops=dict(arrowstyle="-", color="#999999", lw=0.6, shrinkA=0, shrinkB=3, relpos=(0, 0.5)))
    axis.set(xlabel="added to the frame, ms (median, 95 % CI; hollow: not known)", ylabel=f"{error} removed")
    axis.set_title(f"{where}: {first[error]:.4f} in the first run", loc="left", fontsize=10)


def trades(results, tables):
    """What each pass costs and what error it removes; above zero the image is nearer to the truth."""
    for title, name, first, points in compared(results) or ():
        shown = [(error, where) for error, where in ERRORS
                 if error in first and pd.notna(first[error]) and all(pd.notna(row[error]) for _, row in points)]
        if not shown:
            continue
        figure, axes = plt.subplots(1, len(shown), figsize=(8.4 * len(shown), max(4.4, 0.27 * len(points) + 1.6)), squeeze=False)
        for axis, (error, where) in zip(axes[0], shown):
            trade(axis, first, points, error, where)
        figure.suptitle(title)
        error, where = shown[0]
        label, row = max(points, key=lambda point: first[error] - point[1][error])
        figure.finding = (f"Milliseconds added against error removed, {title}. {label} removes most {error}: "
                          f"{first[error] - row[error]:+.4f} for {row.frame_ms_median - first.frame_ms_median:.2f} ms")
        for label, row in points:
            tables.setdefault("Passes: milliseconds added and error removed, relative to the first run", []).append(
                {"frame": title, "changed": label, "ms added": f"{row.frame_ms_median - first.frame_ms_median:.2f}",
                 **{f"{error} removed": f"{first[error] - row[error]:+.4f}" for error, _ in shown}})
        yield f"effects_{name}", figure


ALL = [trades]

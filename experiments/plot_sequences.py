"""Frames that follow each other: flips under jitter, and how far a surface's motion is from that of its reflection."""
import os

import pandas as pd
from matplotlib import pyplot as plt


def read_summary(results):
    """sequence_summary.csv, or nothing."""
    path = os.path.join(results.folder, "sequence_summary.csv")
    return pd.read_csv(path, keep_default_na=False, na_values=[""]) if os.path.exists(path) else pd.DataFrame()


def flips_under_jitter(results, tables):
    """Flip rate against steps: a technique with steps is a line, one without is level."""
    summary = read_summary(results)
    if "flip_rate" not in summary or summary.flip_rate.isna().all() or "steps" not in summary:
        return
    scenes = list(dict.fromkeys(summary.scene))
    figure, axes = plt.subplots(1, len(scenes), figsize=(4.6 * len(scenes), 4.2), squeeze=False, sharey=True)
    for axis, scene in zip(axes[0], scenes):
        for technique, rows in summary[summary.scene == scene].groupby("technique", sort=True):
            style = results.styles.get(technique, {})
            colour = style.get("color") if isinstance(style, dict) else None
            stepped = rows[rows.steps.notna()].sort_values("steps")
            if len(stepped) > 1:
                axis.plot(stepped.steps, 100 * stepped.flip_rate, marker="o", ms=5, color=colour, label=technique)
            else:
                axis.axhline(100 * rows.flip_rate.iloc[0], ls={"dda": "-", "hiz": "--"}.get(technique, ":"),
                             color=colour, lw=1.8, label=technique)
        axis.set(xscale="log", xlabel="steps", title=scene)
        axis.set_ylim(bottom=0)
        axis.grid(alpha=0.3)
    axes[0][0].set_ylabel("rays that flip from one phase to the next, %")
    axes[0][-1].legend(fontsize=8)
    figure.suptitle("Flips of raw hits under sub-pixel jitter")
    figure.tight_layout()
    yield "jitter_flips", figure


def motion_errors(results, tables):
    """By view: median and 95th percentile of the surface motion's error, and what no reprojection can find."""
    summary = read_summary(results)
    if "surface_motion_error_median_px" not in summary or summary.surface_motion_error_median_px.isna().all():
        return
    rows = summary[summary.surface_motion_error_median_px.notna()].reset_index(drop=True)
    labels = rows.view if rows.scene.nunique() == 1 else rows.scene + ", " + rows.view
    figure, (error, unseen) = plt.subplots(1, 2, figsize=(9.5, 4))
    places = range(len(rows))
    error.bar([p - 0.2 for p in places], rows.surface_motion_error_median_px, 0.4, label="median", color="#0072B2")
    error.bar([p + 0.2 for p in places], rows.surface_motion_error_p95_px, 0.4, label="95th percentile", color="#E69F00")
    error.set(ylabel="error per frame, px", title="Surface's motion vector against the reflection's")
    error.legend()
    unseen.bar(places, 100 * rows.disocclusion_share, 0.6, color="#009E73")
    unseen.set(ylabel="rays, %", title="Reflections that the frame before did not show")
    for axis in (error, unseen):
        axis.set_xticks(list(places), labels)
        axis.grid(axis="y", alpha=0.3)
    figure.tight_layout()
    yield "motion_errors", figure


ALL = [flips_under_jitter, motion_errors]

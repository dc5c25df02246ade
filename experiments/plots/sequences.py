"""Frames that follow each other: flips under jitter, motion of surfaces and of reflections, reprojection and what a history adds."""
import os

import pandas as pd
from matplotlib import pyplot as plt


def read_summary(results, column):
    """sequence_summary.csv, or nothing where no row has this column's value."""
    path = os.path.join(results.folder, "sequence_summary.csv")
    summary = pd.read_csv(path, keep_default_na=False, na_values=[""]) if os.path.exists(path) else pd.DataFrame()
    return summary if column in summary and summary[column].notna().any() else pd.DataFrame()


def finish(figure, axes, label, title):
    """A row of axes that share what lies up."""
    for axis in axes:
        axis.grid(alpha=0.3)
    axes[0].set_ylabel(label)
    axes[-1].legend(fontsize=8)
    figure.suptitle(title)
    figure.tight_layout()


def flips_under_jitter(results, tables):
    """Flip rate against steps: a technique with steps is a line, one without is level."""
    summary = read_summary(results, "flip_rate")
    if summary.empty or "steps" not in summary:
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
    finish(figure, axes[0], "rays that flip from one phase to the next, %", "Flips of raw hits under sub-pixel jitter")
    yield "jitter_flips", figure


def motion_errors(results, tables):
    """By view: median and 95th percentile of the surface motion's error, and what no reprojection can find."""
    summary = read_summary(results, "surface_motion_error_median_px")
    if summary.empty:
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


# From the simplest to the exact one; others come after them.
STRATEGIES = ["surface", "hit", "surface_parallax", "hit_parallax", "smallest", "plane", "carried_plane"]
COLOURS = ["#D55E00", "#E69F00", "#CC79A7", "#8A6D00", "#0072B2", "#009E73", "#56B4E9", "#1A1A1A"]


def reprojection_errors(results, tables):
    """By view: error and ghosts of each strategy, and the ghosts without any history."""
    summary = read_summary(results, "reprojection_error_median_px")
    if summary.empty:
        return
    rows = summary[summary.reprojection_error_median_px.notna()]
    strategies = sorted(rows.reprojection.unique(), key=lambda name: (STRATEGIES + [name]).index(name))
    if len(strategies) < 2:
        return
    without = summary[summary.history_weight == 0]
    measures = [("reprojection_error_median_px", "median error, px"), ("reprojection_error_p95_px", "95th percentile, px"),
                ("ghosting_rmse", "error behind moving edges, RMSE")]
    scenes = list(dict.fromkeys(rows.scene))
    figure, axes = plt.subplots(len(scenes), 3, figsize=(13, 3.6 * len(scenes)), squeeze=False, layout="tight")
    for line, scene in zip(axes, scenes):
        views = list(dict.fromkeys(rows[rows.scene == scene].view))
        for axis, (measure, label) in zip(line, measures):
            width = 0.8 / len(strategies)
            for i, strategy in enumerate(strategies):
                own = rows[(rows.scene == scene) & (rows.reprojection == strategy)].groupby("view")[measure].mean()
                places = [v - 0.4 + width * (i + 0.5) for v in range(len(views))]
                axis.bar(places, [own.get(view, float("nan")) for view in views], width, color=COLOURS[i % len(COLOURS)], label=strategy)
            if measure == "ghosting_rmse":
                floor = without[without.scene == scene].groupby("view")[measure].mean()
                for v, view in enumerate(views):
                    if view in floor:
                        axis.hlines(floor[view], v - 0.45, v + 0.45, color="black", ls="--", lw=1.2,
                                    label="no history" if v == 0 else None)
            else:
                axis.set_yscale("symlog", linthresh=0.01)
                axis.set_ylim(bottom=0)
            axis.set(title=scene, ylabel=label)
            axis.set_xticks(range(len(views)), ["objects only" if view == "default" else view for view in views])
            axis.grid(axis="y", alpha=0.3)
    handles, labels = axes[0][2].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=8, ncols=len(labels), loc="lower center")
    figure.suptitle("Where a reflection was in the frame before: strategies against the truth")
    figure.get_layout_engine().set(rect=(0, 0.05, 1, 1))  # the legend stands below
    yield "reprojection_errors", figure


def rippled(summary):
    """Rows of views like waves_2_roughness_0.1, with both numbers."""
    found = summary.view.astype(str).str.extract(r"^waves_([\d.]+)_roughness_([\d.]+)$").astype(float)
    return summary.assign(waves_per_m=found[0], roughness=found[1]).dropna(subset=["waves_per_m"])


def clamped_history(results, tables):
    """Share of clamped pixels against the frequency of the normal map."""
    summary = read_summary(results, "clamped_share")
    if summary.empty:
        return
    rows = rippled(summary[summary.clamped_share.notna() & (summary.history_clamping != "off")])
    if not len(rows):
        return
    clampings = list(dict.fromkeys(rows.history_clamping))
    figure, axes = plt.subplots(1, len(clampings), figsize=(4.6 * len(clampings), 4), squeeze=False, sharey=True)
    for axis, clamping in zip(axes[0], clampings):
        for i, (roughness, own) in enumerate(rows[rows.history_clamping == clamping].groupby("roughness")):
            own = own.sort_values("waves_per_m")
            axis.plot(own.waves_per_m, 100 * own.clamped_share, marker="os^D"[i % 4], color=COLOURS[[0, 4, 5, 6][i % 4]],
                      label=f"roughness {roughness:g}")
        axis.set_xscale("symlog", linthresh=0.5)
        axis.set_xticks(sorted(rows.waves_per_m.unique()), [f"{value:g}" for value in sorted(rows.waves_per_m.unique())])
        axis.set(title=clamping, xlabel="waves per metre in the normal map")
        axis.set_ylim(0, 108 * rows.clamped_share.max())
    finish(figure, axes[0], "accumulated pixels that clamping changed, %", "Clamping against detail")
    yield "clamped_history", figure


def convergence(results, tables):
    """Error of the accumulated picture over the frames, the mean of the views with the same waves."""
    if not results.has("converged_rmse"):
        return
    rows = rippled(results.rows[results.rows.converged_rmse.notna()])
    if not len(rows):
        return
    waves = sorted(rows.waves_per_m.unique())
    figure, axes = plt.subplots(1, len(waves), figsize=(3.6 * len(waves), 3.8), squeeze=False)
    for axis, number in zip(axes[0], waves):
        here = rows[rows.waves_per_m == number]
        kinds = [("no history", here[here.history_weight == 0])]
        kinds += [(name, own) for name, own in here[here.history_weight != 0].groupby("history_clamping", sort=False)]
        for i, (name, own) in enumerate(kinds):
            mean = own.groupby("frame").converged_rmse.mean()
            axis.plot(mean.index + 1, mean, marker="os^D"[i % 4], color=["black", "#D55E00", "#0072B2", "#009E73"][i % 4], label=name)
        axis.set(title=f"{number:g} waves per metre", xlabel="frames", xscale="log")
        axis.set_xticks(sorted(rows.frame.unique() + 1), [f"{frame + 1:g}" for frame in sorted(rows.frame.unique())])
        axis.minorticks_off()
    finish(figure, axes[0], "RMSE against the converged picture", "Accumulated reflections under jitter")
    yield "convergence", figure


ALL = [flips_under_jitter, motion_errors, reprojection_errors, clamped_history, convergence]

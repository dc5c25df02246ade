"""Frames that follow each other: flips under jitter, motion of surfaces and of reflections, reprojection and what a history adds."""
import os

import numpy as np
import pandas as pd

from .data import listed
from .paper import COLOURS, key_below, name_lines, plain_ticks, sheet, titled
from .results import read_csv


def read_summary(results, column):
    """sequence_summary.csv, or nothing where no row has this column's value."""
    path = os.path.join(results.folder, "sequence_summary.csv")
    summary = read_csv(path, ["scene", "view", "technique"], keep_default_na=False, na_values=[""]) if os.path.exists(path) else pd.DataFrame()
    return summary if column in summary and summary[column].notna().any() else pd.DataFrame()


def flips_under_jitter(results, tables):
    """Flip rate against steps: a technique with steps is a line, one without is level."""
    summary = read_summary(results, "flip_rate")
    if summary.empty or "steps" not in summary:
        return
    scenes = list(dict.fromkeys(summary.scene))
    figure, axes = sheet(*[1.3] * len(scenes), sharex=True)
    for (axis,), scene in zip(axes, scenes):
        ends = []
        for technique, rows in summary[summary.scene == scene].groupby("technique", sort=True):
            colour = results.styles.get(technique, {}).get("color", "#444444")
            stepped = rows[rows.steps.notna()].sort_values("steps")
            if len(stepped) > 1:
                axis.plot(stepped.steps, 100 * stepped.flip_rate, marker="o", color=colour, label=technique)
            else:
                axis.axhline(100 * rows.flip_rate.iloc[0], ls={"dda": "-", "hiz": "--"}.get(technique, ":"), color=colour, label=technique)
            rate = stepped.flip_rate.iloc[-1] if len(stepped) > 1 else rows.flip_rate.iloc[0]
            ends.append((technique, summary.steps.max(), 100 * rate, colour))
        axis.set(xscale="log", title=scene, ylabel="rays, %")
        axis.set_ylim(bottom=0)
        name_lines(axis, ends)
    axes[-1][0].set_xlabel("steps")
    plain_ticks(axes[-1][0].xaxis, set(summary.steps.dropna()))
    means = 100 * summary.groupby("technique").flip_rate.mean()
    titled(figure, f"Under sub-pixel jitter rays of {means.idxmin()} flip least: {means.min():.2g} %; most of {means.idxmax()}: {means.max():.2g} %"
           if means.max() > means.min() else f"Under sub-pixel jitter {means.max():.2g} % of the rays of {listed(means.index)} flip",
           "flip_rate from one phase to the next; means over scenes and steps")
    yield "jitter_flips", figure


def view_names(views):
    """Of (scene, view): the scene only where there are several; the default camera stands still."""
    several = len({scene for scene, _ in views}) > 1
    return [(f"{scene.removeprefix('builtin:')}, " if several else "") + ("objects only" if view == "default" else view) for scene, view in views]


def motion_errors(results, tables):
    """By view: median and 95th percentile of the surface motion's error, and what no reprojection can find."""
    summary = read_summary(results, "surface_motion_error_median_px")
    if summary.empty:
        return
    rows = summary[summary.surface_motion_error_median_px.notna()].drop_duplicates(["scene", "view"]).reset_index(drop=True)
    labels = view_names(list(zip(rows.scene, rows["view"])))
    figure, ((error,), (unseen,)) = sheet(1.5, 1.2, sharex=True)
    places = range(len(rows))
    error.bar([p - 0.2 for p in places], rows.surface_motion_error_median_px, 0.4, label="median", color="#0072B2")
    error.bar([p + 0.2 for p in places], rows.surface_motion_error_p95_px, 0.4, label="95th percentile", color="#E69F00")
    error.set(ylabel="error a frame, px")
    error.legend(ncols=2, loc="lower left", bbox_to_anchor=(0, 1), borderaxespad=0.2)
    unseen.bar(places, 100 * rows.disocclusion_share, 0.6, color="#009E73")
    unseen.set(ylabel="not shown in the\nframe before, %")
    unseen.set_xticks(list(places), labels, rotation=40, ha="right", rotation_mode="anchor")
    for axis in (error, unseen):
        axis.grid(False, axis="x")
    worst = rows.surface_motion_error_median_px.idxmax()
    titled(figure, f"The surface's motion misses the reflection's by up to {rows.surface_motion_error_median_px[worst]:.2g} px "
           f"in the median ({labels[worst]})")
    yield "motion_errors", figure


# From the simplest to the exact one; others come after them.
STRATEGIES = ["surface", "hit", "surface_parallax", "hit_parallax", "smallest", "plane", "carried_plane"]


def reprojection_errors(results, tables):
    """By view: error and ghosts of each strategy, and the ghosts without any history."""
    summary = read_summary(results, "reprojection_error_median_px")
    if summary.empty:
        return
    rows = summary[summary.reprojection_error_median_px.notna()]
    strategies = sorted(rows.reprojection.unique(), key=lambda name: (STRATEGIES + [name]).index(name))
    if len(strategies) < 2:
        return
    measures = [("reprojection_error_median_px", "median error, px"), ("reprojection_error_p95_px", "95th percentile of the error, px"),
                ("ghosting_rmse", "error behind moving edges, RMSE")]
    named = list(dict.fromkeys(zip(rows.scene, rows["view"])))
    figure, axes = sheet(*[0.45 + 0.14 * len(named)] * 3, 0.01 + 0.14 * -(-(len(strategies) + 1) // 3))
    for (axis,), (measure, label) in zip(axes, measures):
        for i, strategy in enumerate(strategies):
            own = rows[rows.reprojection == strategy].groupby(["scene", "view"])[measure].mean().reindex(named)
            axis.plot(own, range(len(named)), "osD^v<>P"[i % 8], color=COLOURS[i % len(COLOURS)], label=strategy, alpha=0.8)
        if measure == "ghosting_rmse":
            floor = summary[summary.history_weight == 0].groupby(["scene", "view"])[measure].mean().reindex(named)
            axis.plot(floor, range(len(named)), "|", color="black", ms=8, label="no history")
        else:
            axis.set_xscale("symlog", linthresh=0.01)
        axis.set_xlim(left=0)
        axis.set_xlabel(label)
        axis.set_yticks(range(len(named)), view_names(named), fontsize=6)
        axis.set_ylim(len(named) - 0.5, -0.5)
    key_below(axes[-1][0], *axes[2][0].get_legend_handles_labels(), 3)
    means = rows.groupby("reprojection").reprojection_error_p95_px.mean().sort_values()
    titled(figure, f"{means.index[0]} knows best where a reflection was: 95 % within {means.iloc[0]:.2g} px; {means.index[-1]} within "
           f"{means.iloc[-1]:.2g} px", "means over the views")
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
    figure, axes = sheet(*[1.3] * len(clampings), sharex=True, sharey=True)
    for (axis,), clamping in zip(axes, clampings):
        ends = []
        for i, (roughness, own) in enumerate(rows[rows.history_clamping == clamping].groupby("roughness")):
            own, colour = own.sort_values("waves_per_m"), COLOURS[[0, 4, 5, 6][i % 4]]
            axis.plot(own.waves_per_m, 100 * own.clamped_share, marker="os^D"[i % 4], color=colour, label=f"roughness {roughness:g}")
            ends.append((f"roughness {roughness:g}", own.waves_per_m.iloc[-1], 100 * own.clamped_share.iloc[-1], colour))
        axis.set_xscale("symlog", linthresh=0.5)
        axis.set_xticks(sorted(rows.waves_per_m.unique()), [f"{value:g}" for value in sorted(rows.waves_per_m.unique())])
        axis.set(title=clamping, ylabel="pixels changed, %")
        axis.set_ylim(0, 108 * rows.clamped_share.max())
        name_lines(axis, ends)
    axes[-1][0].set_xlabel("waves per metre in the normal map")
    low, high = (100 * rows[rows.waves_per_m == end].clamped_share.mean() for end in (rows.waves_per_m.min(), rows.waves_per_m.max()))
    titled(figure, f"Clamping changes {low:.0f} % of the accumulated pixels without waves and {high:.0f} % with the densest ones"
           if rows.waves_per_m.min() == 0 else f"Clamping changes {low:.0f} to {high:.0f} % of the accumulated pixels")
    yield "clamped_history", figure


def convergence(results, tables):
    """Error of the accumulated picture over the frames, the mean of the views with the same waves."""
    if not results.has("converged_rmse"):
        return
    rows = rippled(results.rows[results.rows.converged_rmse.notna()])
    if not len(rows):
        return
    waves = sorted(rows.waves_per_m.unique())
    figure, axes = sheet(*[1.2] * len(waves), sharex=True)
    last = {}
    for (axis,), number in zip(axes, waves):
        here, ends = rows[rows.waves_per_m == number], []
        kinds = [("no history", here[here.history_weight == 0])]
        kinds += [(name, own) for name, own in here[here.history_weight != 0].groupby("history_clamping", sort=False)]
        for i, (name, own) in enumerate(kinds):
            mean, colour = own.groupby("frame").converged_rmse.mean(), ["black", "#D55E00", "#0072B2", "#009E73"][i % 4]
            axis.plot(mean.index + 1, mean, marker="os^D"[i % 4], color=colour, label=name)
            if len(mean):
                ends.append((name, mean.index[-1] + 1, mean.iloc[-1], colour))
                last.setdefault(name, []).append(mean.iloc[-1])
        axis.set(title=f"{number:g} waves per metre", ylabel="RMSE", xscale="log")
        axis.set_xticks(sorted(rows.frame.unique() + 1), [f"{frame + 1:g}" for frame in sorted(rows.frame.unique())])
        axis.minorticks_off()
        name_lines(axis, ends)
    axes[-1][0].set_xlabel("frames")
    ends = {name: np.mean(values) for name, values in last.items()}
    best = min(ends, key=ends.get)
    titled(figure, f"After {rows.frame.max() + 1:g} frames {best} is nearest to the converged picture: RMSE {ends[best]:.3f}"
           + (f"; no history: {ends['no history']:.3f}" if "no history" in ends and best != "no history" else ""))
    yield "convergence", figure


ALL = [flips_under_jitter, motion_errors, reprojection_errors, clamped_history, convergence]

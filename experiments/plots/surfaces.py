"""What a pixel is taken to hold: precision against recall as thickness grows, and F1 against time. Each function returns its figures."""
import zlib

import numpy as np

from .paper import log_axis, name_lines, sheet, titled
from .results import counted

# One colour and marker a surface model, in the order of the ladder; a line's dash says what becomes of rays from behind.
STYLES = {"box": ("#0072B2", "o"), "box_two_sided": ("#56B4E9", "s"), "box_infinite": ("#999999", "X"), "plane": ("#E69F00", "^"),
          "plane_solid": ("#009E73", "D"), "plane_infinite": ("#CC79A7", "v")}
DASHES = {"hit": ":", "pass": "--", "stop": "-"}
OWN = [("#000000", "P"), ("#7A1340", "*"), ("#5C8F00", "<"), ("#6B3A00", ">")]  # models from elsewhere, by their name


def look_of(surface):
    return STYLES.get(surface) or OWN[zlib.crc32(surface.encode()) % len(OWN)]


def place_of(surface):
    """For sorting: models from elsewhere stand behind the ladder, by their name."""
    return (list(STYLES).index(surface), "") if surface in STYLES else (len(STYLES), surface)


def style_of(surface, behind):
    colour, marker = look_of(surface)
    return dict(color=colour, marker=marker, linestyle=DASHES.get(behind, "-"),
                markerfacecolor=colour if behind == "stop" else "white", label=f"{surface}, {behind}")


def models_of(rows):
    """(surface, behind, rows) of each pair that occurs."""
    for (surface, behind), line in rows.groupby(["surface", "behind"], sort=False):
        yield surface, behind, line


def one_tracer(rows):
    """Rows of the tracer that has the most models; of several, the one with the best F1."""
    by_tracer = rows.groupby("technique", sort=False).agg(models=("surface", "nunique"), f1=("f1_1px", "mean"))
    return rows[rows.technique == by_tracer.sort_values(["models", "f1"], kind="stable").index[-1]]


def has_models(results):
    return results.has("surface", "precision_1px", "recall_1px") and results.rows.surface.nunique() > 1


def model_name(row):
    return f"{row.surface}, {row.behind}"


def gain(rows, column):
    """The message: the best model by a column that holds shares, and what the best plain box reaches."""
    best, boxes = rows.loc[rows[column].idxmax()], rows[rows.surface == "box"]
    text = f"{model_name(best)} is the best: F1 {100 * best[column]:.1f} %"
    return text + (f"; a box reaches {100 * boxes[column].max():.1f} %" if len(boxes) and best.surface != "box" else "")


def precision_against_recall(results, tables):
    """A curve a model: along it the thickness grows. A model that needs none is one point."""
    if not has_models(results) or results.rows.thickness_m.nunique() < 2:
        return
    for title, name, rows in results.pictures():
        figure, ((axis,),) = sheet(2.4)
        ends = []
        rows = one_tracer(rows)
        for surface, behind, line in models_of(rows):
            line = line.sort_values("thickness_m").drop_duplicates(["recall_1px", "precision_1px"])
            axis.plot(100 * line.recall_1px, 100 * line.precision_1px, **style_of(surface, behind))
            best = line.loc[line.f1_1px.idxmax()]
            ends.append((model_name(best), 100 * best.recall_1px, 100 * best.precision_1px, look_of(surface)[0]))
            if surface == "box" and behind == "stop":
                for _, row in line.iloc[[0, -1]].iterrows():
                    axis.annotate(f"{row.thickness_m:g} m", (100 * row.recall_1px, 100 * row.precision_1px), textcoords="offset points",
                                  xytext=(-4, 0), fontsize=6, color=look_of("box")[0], ha="right", va="center")
        axis.set(xlabel="recall: visible points found within 1 px, %", ylabel="precision: hits that are right, %")
        axis.margins(x=0.12)
        name_lines(axis, ends)
        titled(figure, gain(rows, "f1_1px"), f"{title}; lines: growing thickness; empty: rays from behind do not stop")
        yield f"surfaces_precision_recall_{name}", figure


def over_scenes(rows):
    return f"means over {counted(rows.scene.nunique(), 'scene')}" if rows.scene.nunique() > 1 else rows.scene.iloc[0]


def means_of(rows, by):
    """Means over the scenes, geometric for times, of the models."""
    rows = rows.assign(log_ms=np.log(rows.cost_ms_median + rows.solid_ms))
    means = rows.groupby(["surface", "behind"] + by, sort=False)[["f1_1px", "log_ms"]].mean().reset_index()
    return means.assign(ms=np.exp(means.log_ms))


def single_rows(results):
    """Rows of one tracer, in one layer, with the time of the pass that draws the backs of solids."""
    rows = one_tracer(results.rows)
    if "layers" in rows:
        rows = rows[rows.layers == rows.layers.min()]
    return rows.assign(solid_ms=results.pass_ms(rows, "solid_backs"))


def f1_against_time(results, tables):
    """What each model costs: the trace, its structures and, for solids, the pass that draws their backs. Pale: each scene."""
    if not has_models(results) or not results.has("f1_1px", "cost_ms_median") or results.rows.thickness_m.nunique() > 1:
        return
    rows = single_rows(results)
    rows = rows[rows.width == rows.width.max()]
    means = means_of(rows, [])
    figure, ((axis,),) = sheet(2.1)
    for row, (surface, behind, line) in zip(means.itertuples(), models_of(rows)):
        style = dict(style_of(surface, behind), linestyle="none")
        axis.plot(line.cost_ms_median + line.solid_ms, 100 * line.f1_1px, **{**style, "alpha": 0.35, "markersize": 3})
        axis.plot(row.ms, 100 * row.f1_1px, **{**style, "markersize": 6, "label": None})
    axis.set(xlabel="trace, structures and backs of solids, ms", ylabel="F1 against the scene, %")
    log_axis(axis.xaxis)
    name_lines(axis, [(model_name(row), row.ms, 100 * row.f1_1px, look_of(row.surface)[0]) for row in means.itertuples()])
    titled(figure, gain(means, "f1_1px") + (", in the mean" if rows.scene.nunique() > 1 else ""),
           f"{rows.technique.iloc[0]}, {rows.width.iloc[0]}×{rows.height.iloc[0]}; {'large: ' if rows.scene.nunique() > 1 else ''}{over_scenes(rows)}")
    yield "surfaces_f1_time", figure


def f1_against_size(results, tables):
    """Resolution does not cure a box. Means over the scenes."""
    if not has_models(results) or results.rows.height.nunique() < 3 or results.rows.thickness_m.nunique() > 1:
        return
    rows = single_rows(results)
    means = means_of(rows, ["height"]).sort_values("height")
    figure, ((axis,),) = sheet(2.1)
    ends = []
    for surface, behind, line in models_of(means):
        axis.plot(line.height, 100 * line.f1_1px, **style_of(surface, behind))
        ends.append((f"{surface}, {behind}", line.height.iloc[-1], 100 * line.f1_1px.iloc[-1], look_of(surface)[0]))
    axis.set(xlabel="image height, px", ylabel="F1 against the scene, %")
    axis.set_xticks(sorted(means.height.unique()))
    name_lines(axis, ends)
    low, high = means[means.height == means.height.min()], means[means.height == means.height.max()]
    titled(figure, f"At {low.height.iloc[0]}p {gain(low, 'f1_1px')}, at {high.height.iloc[0]}p {100 * high[high.surface == 'box'].f1_1px.max():.1f} %"
           if "box" in set(low.surface) & set(high.surface) else gain(high, "f1_1px"), over_scenes(rows))
    yield "surfaces_f1_size", figure


def rungs_of(rows):
    """Surface models with their layers in the order of the ladder, as (label, rows)."""
    keys = ["surface", "behind", "layers"]
    rungs = sorted(rows.groupby(keys, sort=False), key=lambda rung: (place_of(rung[0][0]), rung[0][2], rung[0][1]))
    return [(f"{surface}, {behind}" + (f", {layers} layers" if layers > 1 else ""), rung) for (surface, behind, layers), rung in rungs]


def ladder_of_layers(results, tables):
    """What each step of the ladder finds, and the time that it takes."""
    if not has_models(results) or not results.has("layers", "hidden_too_recall_1px") or results.rows.layers.nunique() < 2:
        return
    rungs = rungs_of(results.rows)
    figure, ((found,), (cost,)) = sheet(1.7, 1.5, sharex=True)
    places, ends = range(len(rungs)), []
    for number, scene in enumerate(dict.fromkeys(results.rows.scene)):
        values = [100 * rows[rows.scene == scene].hidden_too_f1_1px.mean() for _, rows in rungs]
        colour, marker = list(STYLES.values())[number % len(STYLES)]
        found.plot(places, values, color=colour, marker=marker, label=scene)
        ends.append((scene, places[-1], values[-1], colour))
    found.set(ylabel="F1, visible\nand hidden rays, %")
    parts = {"trace": [rows.trace_ms_median for _, rows in rungs], "structures": [rows.structures_ms_median for _, rows in rungs],
             "backs of solids": [results.pass_ms(rows, "solid_backs") for _, rows in rungs],
             "layers": [results.pass_ms(rows, "layers") for _, rows in rungs]}
    below, middles = [0.0] * len(rungs), []
    for colour, (name, columns) in zip(("#0072B2", "#56B4E9", "#E69F00", "#009E73"), parts.items()):
        heights = [column.mean() for column in columns]
        cost.bar(places, heights, bottom=below, width=0.6, color=colour, label=name)
        middles.append((name, places[-1] + 0.3, below[-1] + heights[-1] / 2, colour))
        below = [a + b for a, b in zip(below, heights)]
    cost.set(ylabel="ms a frame")
    cost.set_xticks(list(places), [label for label, _ in rungs], rotation=40, ha="right", rotation_mode="anchor", linespacing=0.9)
    name_lines(found, ends)
    name_lines(cost, middles)
    means = [100 * rows.hidden_too_f1_1px.mean() for _, rows in rungs]
    best = int(np.argmax(means))
    titled(figure, f"From {rungs[0][0]} to {rungs[best][0]} F1 rises from {means[0]:.0f} to {means[best]:.0f} %, in {below[0]:.3g} and {below[best]:.3g} ms"
           if means[best] > means[0] else f"No rung has a better F1 than {rungs[0][0]}: {means[0]:.0f} %, in {below[0]:.3g} ms", over_scenes(results.rows))
    yield "surfaces_ladder", figure


def ladder(results):
    """A row a scene, size and model, at the thickness with the best F1: what surfaces.csv holds."""
    if not has_models(results):
        return []
    rows = results.rows.copy()
    rows["solid_backs_ms"] = results.pass_ms(rows, "solid_backs")
    keys = ["scene", "view", "width", "height", "technique", "surface", "behind"] + ["layers"] * ("layers" in rows)
    best = rows.loc[rows.groupby(keys, sort=False).f1_1px.idxmax()]
    shown = ["thickness_m", "recall_1px", "precision_1px", "f1_1px", "hidden_too_recall_1px", "hidden_too_precision_1px", "hidden_too_f1_1px", "stopped_share", "stopped_right_share", "false_hits",
             "steps_mean", "trace_ms_median", "structures_ms_median", "solid_backs_ms"]
    return best[keys + [name for name in shown if name in best]]


ALL = [precision_against_recall, f1_against_time, f1_against_size, ladder_of_layers]

"""What a pixel is taken to hold: precision against recall as thickness grows, and F1 against time. Each function returns its figures."""
import zlib

from matplotlib import pyplot as plt

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
    return dict(color=colour, marker=marker, linestyle=DASHES.get(behind, "-"), ms=6, lw=1.3,
                markerfacecolor=colour if behind == "stop" else "white", label=f"{surface}, {behind}")


def models_of(rows):
    """(surface, behind, rows) of each pair that occurs."""
    for (surface, behind), line in rows.groupby(["surface", "behind"], sort=False):
        yield surface, behind, line


def sorted_legend(axis):
    """In the order of the ladder; a model's two rules side by side."""
    handles, labels = axis.get_legend_handles_labels()
    pairs = sorted(zip(labels, handles), key=lambda pair: (place_of(pair[0].split(",")[0]), pair[0]))
    return [handle for _, handle in pairs], [label for label, _ in pairs]


def has_models(results):
    return results.has("surface", "precision_1px", "recall_1px") and results.rows.surface.nunique() > 1


def precision_against_recall(results, tables):
    """A curve a model: along it the thickness grows. A model that needs none is one point."""
    if not has_models(results) or results.rows.thickness_m.nunique() < 2:
        return
    for title, name, rows in results.pictures():
        figure, axis = plt.subplots(figsize=(7.2, 5.2))
        for surface, behind, line in models_of(rows):
            line = line.sort_values("thickness_m").drop_duplicates(["recall_1px", "precision_1px"])
            axis.plot(100 * line.recall_1px, 100 * line.precision_1px, **style_of(surface, behind))
            if surface != "box":
                continue
            side = (8, 3) if behind == "stop" else (-8, -9)
            for _, row in line.iterrows():
                axis.annotate(f"{row.thickness_m:g} m", (100 * row.recall_1px, 100 * row.precision_1px), textcoords="offset points",
                              xytext=side, fontsize=7, color=look_of("box")[0], ha="left" if behind == "stop" else "right")
        axis.set(xlabel="recall: visible points found within 1 px, %", ylabel="precision: hits that are right, %",
                 title=f"Surface models: {title}")
        axis.legend(*sorted_legend(axis), fontsize=7.5, loc="best")
        best = rows.loc[rows.f1_1px.idxmax()]
        figure.finding = (f"Precision against recall of each surface model, {title}. Best F1: {best.surface}, {best.behind}, "
                          f"{100 * best.f1_1px:.1f} %")
        yield f"surfaces_precision_recall_{name}", figure


def f1_against_time(results, tables):
    """What each model costs: the trace, its structures and, for solids, the pass that draws their backs."""
    if not has_models(results) or not results.has("f1_1px", "cost_ms_median") or results.rows.thickness_m.nunique() > 1:
        return
    rows = results.rows[results.rows.width == results.rows.width.max()]
    rows = rows[rows.technique == rows.technique.iloc[0]]
    figure, axis = plt.subplots(figsize=(7.2, 5.2))
    for surface, behind, line in models_of(rows):
        solid_ms = results.pass_ms(line, "solid_backs")
        axis.plot(line.cost_ms_median + solid_ms, 100 * line.f1_1px, **{**style_of(surface, behind), "linestyle": "none"})
        for (_, row), more in zip(line.iterrows(), solid_ms):
            axis.annotate(row.scene.split("_")[0], (row.cost_ms_median + more, 100 * row.f1_1px), textcoords="offset points",
                          xytext=(5, 3), fontsize=7)
    width, height = rows.width.iloc[0], rows.height.iloc[0]
    axis.set(xlabel="trace, structures and backs of solids, ms", ylabel="F1 against the scene, %", title=f"Surface models at {width}×{height}")
    axis.legend(fontsize=8)
    yield "surfaces_f1_time", figure


def f1_against_size(results, tables):
    """Resolution does not cure a box."""
    if not has_models(results) or results.rows.height.nunique() < 3 or results.rows.thickness_m.nunique() > 1:
        return
    scenes = list(dict.fromkeys(results.rows.scene))
    figure, axes = plt.subplots(1, len(scenes), figsize=(3.1 * len(scenes), 3.6), sharey=True, squeeze=False)
    for axis, scene in zip(axes[0], scenes):
        rows = results.rows[results.rows.scene == scene]
        rows = rows[rows.technique == rows.technique.iloc[0]]
        for surface, behind, line in models_of(rows):
            line = line.sort_values("height")
            axis.plot(line.height, 100 * line.f1_1px, **style_of(surface, behind))
        axis.set(title=scene, xlabel="image height, px")
        axis.set_xticks(sorted(rows.height.unique()))
    axes[0][0].set_ylabel("F1 against the scene, %")
    axes[0][0].legend(fontsize=7)
    yield "surfaces_f1_size", figure


def rungs_of(rows):
    """Surface models with their layers in the order of the ladder, as (label, rows)."""
    keys = ["surface", "behind", "layers"]
    rungs = sorted(rows.groupby(keys, sort=False), key=lambda rung: (place_of(rung[0][0]), rung[0][2], rung[0][1]))
    return [(f"{surface}, {behind}" + (f",\n{layers} layers" if layers > 1 else ""), rung) for (surface, behind, layers), rung in rungs]


def ladder_of_layers(results, tables):
    """What each step of the ladder finds, and the time that it takes."""
    if not has_models(results) or not results.has("layers", "hidden_too_recall_1px") or results.rows.layers.nunique() < 2:
        return
    rungs = rungs_of(results.rows)
    figure, (found, cost) = plt.subplots(2, 1, figsize=(8.4, 7.2), sharex=True)
    places = range(len(rungs))
    for number, scene in enumerate(dict.fromkeys(results.rows.scene)):
        values = [100 * rows[rows.scene == scene].hidden_too_f1_1px.mean() for _, rows in rungs]
        colour = list(STYLES.values())[number % len(STYLES)]
        found.plot(places, values, color=colour[0], marker=colour[1], lw=1.2, label=scene)
    found.set(ylabel="F1 over visible and hidden rays, %", title="The ladder of surface models")
    found.legend(fontsize=8)
    parts = {"trace": [rows.trace_ms_median for _, rows in rungs], "structures": [rows.structures_ms_median for _, rows in rungs],
             "backs of solids": [results.pass_ms(rows, "solid_backs") for _, rows in rungs],
             "layers": [results.pass_ms(rows, "layers") for _, rows in rungs]}
    below = [0.0] * len(rungs)
    for colour, (name, columns) in zip(("#0072B2", "#56B4E9", "#E69F00", "#009E73"), parts.items()):
        heights = [column.mean() for column in columns]
        cost.bar(places, heights, bottom=below, width=0.6, color=colour, label=name)
        below = [a + b for a, b in zip(below, heights)]
    cost.set(ylabel="ms a frame, mean of the scenes")
    cost.set_xticks(list(places), [label for label, _ in rungs])
    cost.legend(fontsize=8)
    figure.finding = "F1 over visible and hidden rays, and the time of each part, from boxes to planes with solids in layers"
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

"""Time and work: against steps, thickness, resolution, and between techniques. Each function returns its figures."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.colors import to_rgba  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator  # noqa: E402

from .data import errors, is_number, known  # noqa: E402

BEST_THICKNESS = "Best thickness: fewest missed points and false hits"
LAW_FROM_STEPS = 50  # the report's frame rate is capped below
# Frames per second by linear steps on a GTX 1650: the table of the OpenGL report, and the scene here that stands for its scene.
REPORTED_FPS = {25: 120, 50: 118, 100: 91, 250: 53, 500: 31, 1000: 18, 2500: 9}
REPORTED_SCENE, REPORTED_AT = "animal_on_metal", 500

plt.rcParams.update({"font.size": 10, "axes.grid": True, "grid.alpha": 0.3, "axes.axisbelow": True,
                     "figure.constrained_layout.use": True, "savefig.dpi": 140, "legend.frameon": False,
                     "axes.spines.top": False, "axes.spines.right": False, "svg.fonttype": "none"})


def fit_line(x, y):
    """Slope, intercept and R² of the least-squares line; weights are equal."""
    slope, intercept = np.polyfit(x, y, 1)
    rest = y - (slope * x + intercept)
    spread = ((y - y.mean()) ** 2).sum()
    return slope, intercept, 1 - (rest ** 2).sum() / spread if spread > 0 else float("nan")


def plain_ticks(axis, values):
    """Measured values of a logarithmic axis labelled as they are written, but for those with no room beside the one before."""
    places = sorted(value for value in values if 0 < value < np.inf)
    labelled = places[:1]
    for value in places[1:]:
        if value >= (places[-1] / places[0]) ** (1 / 20) * labelled[-1]:
            labelled.append(value)
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_ticks(labelled)
    axis.set_minor_locator(matplotlib.ticker.NullLocator())


def log_axis(axis):
    """Logarithmic, labelled 1, 2, 5, 10 … in plain numbers."""
    axis.axes.set(**{f"{axis.axis_name}scale": "log"})
    axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(matplotlib.ticker.NullFormatter())


def steps_lines(results, rows):
    """Lines over steps: per series, at the value of each other swept input that is nearest to the report's 0.1."""
    others = [name for name in results.swept(rows) if name not in ("steps", "max_steps", "thickness_m")]
    if "thickness_m" in results.varying(rows):
        nearest = rows.thickness_m.iloc[(np.log(rows.thickness_m / 0.1)).abs().argmin()]
        rows = rows[rows.thickness_m == nearest]
    for series, line in rows[rows.steps.notna()].groupby("series"):
        for name in others:
            line = line[line[name].isna() | (line[name] == line[name].dropna().max())]
        line = line.drop_duplicates("steps").sort_values("steps")
        if len(line) >= 4:
            yield series, line


def without_steps(results, rows, axes):
    """Flat lines of techniques that take no steps."""
    for series, line in rows[rows.steps.isna()].groupby("series"):
        style = dict(results.styles[series], marker="", linestyle=":")
        axes[0].axhline(line.fps.iloc[0], label=series, **style)
        axes[1].axhline(line.frame_ms_median.iloc[0], label=f"{series}: {line.frame_ms_median.iloc[0]:.3g} ms", **style)


def reported(rows, lines, axes):
    """The report's own table, scaled so that it meets the linear march here at 500 steps."""
    ours = [line[line.steps == REPORTED_AT].fps for series, line in lines if series == "linear"]
    if rows.scene.iloc[0] != REPORTED_SCENE or not ours or ours[0].empty:
        return False
    steps, fps = np.array(list(REPORTED_FPS)), np.array(list(REPORTED_FPS.values()), dtype=float)
    fps *= ours[0].iloc[0] / REPORTED_FPS[REPORTED_AT]
    style = dict(color="#777777", marker="x", linestyle="--", label=f"OpenGL report, GTX 1650, × {ours[0].iloc[0] / REPORTED_FPS[REPORTED_AT]:.2g}")
    axes[0].plot(steps, fps, **style)
    axes[1].plot(steps, 1000 / fps, **style)
    return True


def law_of_steps(results, tables):
    """FPS and 1/FPS against steps, with the fitted line from 50 steps up: figures 11 and 12 of the OpenGL report."""
    if not results.has("steps", "fps"):
        return
    for title, name, rows in results.pictures():
        lines = list(steps_lines(results, rows))
        if not lines:
            continue
        figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.4))
        for series, line in lines:
            style = results.styles[series]
            left.plot(line.steps, line.fps, label=series, **style)
            sure = known(line, "frame_ms")
            for part, face in ((line[sure], style["color"]), (line[~sure], "none")):
                right.errorbar(part.steps, part.inverse_fps_s * 1000, yerr=errors(part, "frame_ms"), capsize=2,
                               **{**style, "linestyle": "none", "markerfacecolor": face})
            high = line[line.steps >= LAW_FROM_STEPS]
            if len(high) < 3:
                continue
            slope, intercept, r2 = fit_line(high.steps.to_numpy(), high.frame_ms_median.to_numpy())
            x = np.array([high.steps.min(), high.steps.max()])
            right.plot(x, slope * x + intercept, color=style["color"], linestyle=style["linestyle"],
                       label=f"{series}: {slope:.3g} ms/step + {intercept:.3g} ms, R² {r2:.4f}")
            tables.setdefault("Law of steps: frame time = slope · steps + intercept, from 50 steps up", []).append(
                {"frame": title, "series": series, "slope, ms per step": f"{slope:.4g}",
                 "intercept, ms": f"{intercept:.4g}", "R²": f"{r2:.4f}"})
        without_steps(results, rows, (left, right))
        numbered = "s0_fig11_fig12_" if reported(rows, lines, (left, right)) else ""
        left.set(xscale="log", xlabel="steps", ylabel="frames per second", title="FPS")
        log_axis(left.yaxis)
        plain_ticks(left.xaxis, {int(s) for _, line in lines for s in line.steps})
        left.tick_params(axis="x", rotation=45)
        right.set(xlabel="steps", ylabel="1 / FPS, ms", title="1/FPS", xlim=(0, None), ylim=(0, None))
        left.legend()
        right.legend(fontsize=8.5, loc="upper center", bbox_to_anchor=(0.5, -0.16))
        figure.suptitle(title)
        fits = [line.get_label() for line in right.get_lines() if " ms/step" in str(line.get_label())]
        figure.finding = f"Frame time against steps, {title}. " + "; ".join(fits)
        yield f"{numbered}fps_steps_{name}", figure


def heat(axis, grid, title, colours, low, high, text):
    image = axis.imshow(grid.to_numpy(), cmap=colours, vmin=low, vmax=high, aspect="auto", origin="lower")
    axis.grid(False)
    axis.set_xticks(range(len(grid.columns)), [f"{v:g}" for v in grid.columns])
    axis.set_yticks(range(len(grid.index)), [f"{v:g}" for v in grid.index])
    axis.set(xlabel="steps", ylabel="thickness, m", title=title)
    for (y, x), value in np.ndenumerate(grid.to_numpy()):
        if np.isfinite(value):
            r, g, b, _ = image.cmap(image.norm(value))
            axis.text(x, y, text(value), ha="center", va="center", fontsize=8,
                      color="black" if 0.3 * r + 0.6 * g + 0.1 * b > 0.5 else "white")


def thickness_maps(results, _):
    """Recall, false hits and time over thickness × steps, one row of maps per series."""
    if not results.has("steps", "recall_1px", "false_hits"):
        return
    for title, name, rows in results.pictures():
        maps = [(series, part) for series, part in rows[rows.steps.notna()].groupby("series")
                if part.thickness_m.nunique() >= 3 and part.steps.nunique() >= 3]
        if not maps:
            continue
        figure, axes = plt.subplots(len(maps), 3, figsize=(12.5, 3.6 * len(maps)), squeeze=False)
        for line, (series, part) in zip(axes, maps):
            grid = {column: part.pivot_table(index="thickness_m", columns="steps", values=column)
                    for column in ("recall_1px", "false_hits", "trace_ms_median")}
            heat(line[0], 100 * grid["recall_1px"], f"{series}: found within 1 px, % of visible", "viridis", 0, 100,
                 lambda v: f"{v:.0f}")
            top = max(1e-9, 100 * float(rows.false_hits.max()))
            heat(line[1], 100 * grid["false_hits"], f"{series}: false hits, % of rays", "magma", 0, top,
                 lambda v: f"{v:.1f}")
            heat(line[2], grid["trace_ms_median"], f"{series}: trace, ms", "cividis", 0,
                 float(rows.trace_ms_median.max()), lambda v: f"{v:.3g}")
        figure.suptitle(title)
        yield f"thickness_steps_{name}", figure


def thickness_curves(results, tables):
    """Points found and false hits against thickness; the optimum has the fewest wrong rays."""
    if not results.has("screen_missed", "recall_1px", "false_hits", "truth_visible"):
        return
    for title, name, rows in results.pictures():
        if rows.thickness_m.nunique() < 4:
            continue
        figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.4))
        for series, part in rows.groupby("series"):
            stepped = "steps" in part and part.steps.notna().any()
            if stepped:
                part = part[part.steps == part.steps.max()]
            part = part.drop_duplicates("thickness_m").sort_values("thickness_m")
            if len(part) < 4:
                continue
            said = f"{series}, {part.steps.max():g} steps" if stepped else series
            missed = 100 * (1 - part.recall_1px) * part.truth_visible
            false = 100 * part.false_hits
            wrong = missed + false
            best = wrong.idxmin()
            style = results.styles[series]
            left.plot(part.thickness_m, wrong, label=said, **style)
            left.plot(part.thickness_m[best], wrong[best], "o", ms=13, mfc="none", mec=style["color"], mew=2)
            right.plot(false, missed, label=said, **style)
            for thickness, x, y in zip(part.thickness_m, false, missed):
                right.annotate(f"{thickness:g}", (x, y), textcoords="offset points", xytext=(4, 4), fontsize=7.5,
                               color=style["color"])
            tables.setdefault(BEST_THICKNESS, []).append(
                {"frame": title, "series": said, "thickness, m": f"{part.thickness_m[best]:g}",
                 "missed, % of rays": f"{missed[best]:.2f}", "false, % of rays": f"{false[best]:.2f}"})
        left.set(xscale="log", xlabel="thickness, m", ylabel="wrong, % of rays (missed + false)",
                 title="Optimum (circled)", ylim=(0, None))
        plain_ticks(left.xaxis, set(rows.thickness_m))
        left.tick_params(axis="x", rotation=45)
        right.set(xlabel="false hits, % of rays", ylabel="visible points missed, % of rays",
                  title="Trade-off, labelled with thickness in m")
        log_axis(right.xaxis)
        log_axis(right.yaxis)
        left.legend(fontsize=8.5)
        figure.suptitle(title)
        best = [row for row in tables.get(BEST_THICKNESS, []) if row["frame"] == title]
        figure.finding = f"Wrong rays against thickness, {title}. Fewest at " + ", ".join(f"{row['thickness, m']} m ({row['series']})" for row in best)
        yield f"thickness_trade_{name}", figure


def bars(axis, rows, results, value, spread, ylabel):
    """Groups of bars, one group per scene and one bar per series."""
    scenes = list(dict.fromkeys(rows.scene))
    series = sorted(rows.series.unique())
    width = 0.8 / len(series)
    for i, name in enumerate(series):
        part = rows[rows.series == name].drop_duplicates("scene").set_index("scene").reindex(scenes)
        at = np.arange(len(scenes)) + (i - (len(series) - 1) / 2) * width
        style = results.styles[name]
        unknown = ~known(part, spread) if spread else part[value].isna()
        # In the colour: bar's own alpha would fill what has none.
        colour = to_rgba(style["color"], style["alpha"])
        axis.bar(at, part[value], width * 0.92, label=name, color=["none" if hollow else colour for hollow in unknown], edgecolor=colour,
                 yerr=errors(part, spread) if spread and not unknown.all() else None, error_kw={"lw": 1, "capsize": 2, "ecolor": "#333333"})
        tops = part[f"{spread}_ci_high"].fillna(part[value]) if spread else part[value]
        for x, height, top in zip(at, part[value], tops):
            if np.isfinite(height):
                axis.annotate(f"{height:.0f}" if height >= 100 else f"{height:.3g}", (x, top), ha="center", va="bottom", fontsize=7, xytext=(0, 3),
                              textcoords="offset points", rotation=90 if len(scenes) * len(series) > 12 else 0)
    axis.set_xticks(range(len(scenes)), scenes)
    axis.set(ylabel=ylabel)
    log_axis(axis.yaxis)
    axis.set_ylim(top=axis.get_ylim()[1] * 2)  # room for the numbers above the bars
    axis.grid(axis="x", visible=False)


def comparison_bars(results, _):
    """Time with its interval and fetches of every technique, where each has one setting per frame."""
    for (view, width, height), rows in results.rows.groupby(["view", "width", "height"], sort=False):
        single = rows.groupby(["scene", "series"]).size().max() == 1
        if not single or rows.series.nunique() < 2 or rows.series.nunique() > 8:
            continue
        figure, (top, bottom) = plt.subplots(2, 1, figsize=(max(7, 2.3 * rows.scene.nunique()), 7.4))
        bars(top, rows, results, "cost_ms_median", "cost_ms", "trace + structures, ms")
        bars(bottom, rows, results, "fetches_mean", None, "fetches per ray")
        figure.suptitle(f"View {view}, {width}×{height}")
        top.set_title("Time: median and 95 % CI (hollow: not known)")
        bottom.set_title("Work: fetches of depth and structures per traced ray")
        top.legend(ncol=4, loc="upper center", bbox_to_anchor=(0.5, -0.08))
        fastest = rows.loc[rows.groupby("scene", sort=False).cost_ms_median.idxmin()]
        figure.finding = (f"Time and fetches of every technique, {width}×{height}. Fastest: " +
                          ", ".join(f"{row.series} on {row.scene} ({row.cost_ms_median:.3g} ms)" for _, row in fastest.iterrows()))
        yield f"compare_{view}_{width}x{height}", figure


def growth(results, tables):
    """Time and fetches against the number of pixels, with the exponent of the fitted power law."""
    for (scene, view), rows in results.rows.groupby(["scene", "view"], sort=False):
        rows = rows.assign(pixels=rows.width * rows.height / 1e6)
        numbers = [name for name in results.swept(rows) if is_number(rows[name])]
        if rows.pixels.nunique() < 3 or any(rows[name].nunique() > 1 for name in numbers):
            continue
        figure, axes = plt.subplots(1, 2, figsize=(11, 4.4))
        for axis, column, label in ((axes[0], "cost_ms_median", "trace + structures, ms"),
                                    (axes[1], "fetches_mean", "fetches per ray")):
            for series, line in rows.groupby("series"):
                line = line.sort_values("pixels")
                good = line[line[column] > 0]
                exponent = fit_line(np.log(good.pixels.to_numpy()), np.log(good[column].to_numpy()))[0]
                axis.plot(line.pixels, line[column], label=f"{series}: pixels^{exponent:.2f}", **results.styles[series])
                tables.setdefault("Growth with the number of pixels: fitted exponents", []).append(
                    {"scene": scene, "series": series, "of": label, "exponent": f"{exponent:.3f}"})
            axis.set(xscale="log", ylabel=label)
            log_axis(axis.yaxis)
            sizes = rows.drop_duplicates("pixels")
            axis.set_xticks(sizes.pixels, [f"{row.width}×{row.height}" for _, row in sizes.iterrows()], rotation=30,
                            ha="right")
            axis.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())
            axis.set_ylim(top=axis.get_ylim()[1] * 4)  # room for the legend
            axis.legend(fontsize=9, loc="upper left")
        figure.suptitle(f"{scene}, view {view}")
        figure.finding = f"Growth of time with the number of pixels, {scene}. " + ", ".join(
            str(line.get_label()) for line in axes[0].get_lines() if "pixels^" in str(line.get_label()))
        yield f"growth_{''.join(c if c.isalnum() else '_' for c in scene)}_{view}", figure


ALL = [law_of_steps, thickness_maps, thickness_curves, comparison_bars, growth]

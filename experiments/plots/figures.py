"""Time and work: against steps, thickness, resolution, and between techniques. Each function returns its figures."""
import numpy as np
from matplotlib.ticker import NullLocator

from .data import ALIKE, APART, OVERLAPPING, UNKNOWN, errors, known, listed, order_of
from .paper import key_below, log_axis, name_lines, plain_ticks, sheet, short_names, titled
from .results import is_number

BEST_THICKNESS = "Best thickness: fewest missed points and false hits"
LAW_FROM_STEPS = 50  # the report's frame rate is capped below
# Frames per second by linear steps on a GTX 1650: the table of the OpenGL report, and the scene here that stands for its scene.
REPORTED_FPS = {25: 120, 50: 118, 100: 91, 250: 53, 500: 31, 1000: 18, 2500: 9}
REPORTED_SCENE, REPORTED_AT = "animal_on_metal", 500


def fit_line(x, y):
    """Slope, intercept and R² of the least-squares line; weights are equal."""
    slope, intercept = np.polyfit(x, y, 1)
    rest = y - (slope * x + intercept)
    spread = ((y - y.mean()) ** 2).sum()
    return slope, intercept, 1 - (rest ** 2).sum() / spread if spread > 0 else float("nan")


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


def reported(rows, lines):
    """The report's own table, (steps, frames per second, factor), scaled so that it meets the linear march here at 500 steps; or None."""
    ours = [line[line.steps == REPORTED_AT].fps for series, line in lines if series == "linear"]
    if rows.scene.iloc[0] != REPORTED_SCENE or not ours or ours[0].empty:
        return None
    factor = ours[0].iloc[0] / REPORTED_FPS[REPORTED_AT]
    return np.array(list(REPORTED_FPS)), factor * np.array(list(REPORTED_FPS.values()), dtype=float), factor


def law_line(axis, series, line, style):
    """Measured times with their intervals, and the fitted line from 50 steps up: (slope, intercept, R²), or None for too few points."""
    sure = known(line, "frame_ms")
    for part, face in ((line[sure], style["color"]), (line[~sure], "none")):
        axis.errorbar(part.steps, part.inverse_fps_s * 1000, yerr=errors(part, "frame_ms"), capsize=1.5,
                      **{**style, "linestyle": "none", "markerfacecolor": face})
    high = line[line.steps >= LAW_FROM_STEPS]
    if len(high) < 3:
        return None
    slope, intercept, r2 = fit_line(high.steps.to_numpy(), high.frame_ms_median.to_numpy())
    x = np.array([high.steps.min(), high.steps.max()])
    axis.plot(x, slope * x + intercept, color=style["color"], linestyle=style["linestyle"], label=f"{series}: fit")
    return slope, intercept, r2


def message_of_steps(series, line, fit):
    """What the times of a line say: the fitted law, where its two ends are apart."""
    high = line[line.steps >= LAW_FROM_STEPS] if fit else line
    few, many = high.iloc[0], high.iloc[-1]
    rising = many.frame_ms_median > few.frame_ms_median
    quick, slow = (few, many) if rising else (many, few)
    order = order_of(quick, slow, "frame_ms")
    if order == OVERLAPPING:
        return f"From {few.steps:g} to {many.steps:g} steps the times of {series} {ALIKE}"
    ends = f"From {few.steps:g} to {many.steps:g} steps {series} goes from {few.frame_ms_median:.3g} to {many.frame_ms_median:.3g} ms"
    said = f"From {LAW_FROM_STEPS} steps on, each step of {series} adds {fit[0]:.3g} ms (R² {fit[2]:.4f})" if fit and fit[0] > 0 and rising else ends
    return said + ("; intervals not known" if order == UNKNOWN else "")


def law_of_steps(results, tables):
    """FPS and 1/FPS against steps, with the fitted line from 50 steps up: figures 11 and 12 of the OpenGL report."""
    if not results.has("steps", "fps"):
        return
    for title, name, rows in results.pictures():
        lines = list(steps_lines(results, rows))
        if not lines:
            continue
        figure, ((top,), (bottom,)) = sheet(1.7, 1.9)
        message, ends = "", ([], [])
        for series, line in lines:
            style = results.styles[series]
            top.plot(line.steps, line.fps, label=series, **style)
            fit = law_line(bottom, series, line, style)
            for axis_ends, y in zip(ends, (line.fps, line.inverse_fps_s * 1000)):
                axis_ends.append((series, line.steps.iloc[-1], y.iloc[-1], style["color"]))
            message = message or message_of_steps(series, line, fit)
            if fit is None:
                continue
            tables.setdefault("Law of steps: frame time = slope · steps + intercept, from 50 steps up", []).append(
                {"frame": title, "series": series, "slope, ms per step": f"{fit[0]:.4g}", "intercept, ms": f"{fit[1]:.4g}", "R²": f"{fit[2]:.4f}"})
        flat = rows[rows.steps.isna()].drop_duplicates("series")
        for _, row in flat.iterrows():
            style = dict(results.styles[row.series], marker="", linestyle=":")
            for axis, axis_ends, y in ((top, ends[0], row.fps), (bottom, ends[1], row.frame_ms_median)):
                axis.axhline(y, label=row.series, **style)
                axis_ends.append((row.series, max(line.steps.max() for _, line in lines), y, style["color"]))
        table = reported(rows, lines)
        if table is not None:
            steps, fps, factor = table
            for axis, axis_ends, y in ((top, ends[0], fps), (bottom, ends[1], 1000 / fps)):
                axis.plot(steps, y, color="#777777", marker="x", linestyle="--", label="OpenGL report")
                axis_ends.append((f"OpenGL report, GTX 1650, × {factor:.2g}", steps[-1], y[-1], "#777777"))
        top.set(xscale="log", ylabel="frames per second")
        log_axis(top.yaxis)
        plain_ticks(top.xaxis, {int(s) for _, line in lines for s in line.steps})
        bottom.set(xlabel="steps", ylabel="1 / FPS, ms", xlim=(0, None), ylim=(0, None))
        for axis, axis_ends in zip((top, bottom), ends):
            name_lines(axis, axis_ends)
        if len(flat):
            message += "; level lines: tracers without steps"
        titled(figure, message, title)
        yield ("s0_fig11_fig12_" if table is not None else "") + f"fps_steps_{name}", figure


def several_surfaces(results):
    return "surface" in results.rows and results.rows.surface.nunique() > 1


def heat(axis, grid, title, colours, low, high, text):
    image = axis.imshow(grid.to_numpy(), cmap=colours, vmin=low, vmax=high, aspect="auto", origin="lower")
    axis.grid(False)
    axis.set_xticks(range(len(grid.columns)), [f"{v:g}" for v in grid.columns])
    axis.set_yticks(range(len(grid.index)), [f"{v:g}" for v in grid.index])
    axis.set(ylabel="thickness, m", title=title)
    for (y, x), value in np.ndenumerate(grid.to_numpy()):
        if np.isfinite(value):
            r, g, b, _ = image.cmap(image.norm(value))
            axis.text(x, y, text(value), ha="center", va="center", fontsize=6, color="black" if 0.3 * r + 0.6 * g + 0.1 * b > 0.5 else "white")


def thickness_maps(results, _):
    """Recall, false hits and time over thickness × steps, a figure per series."""
    if not results.has("steps", "recall_1px", "false_hits"):
        return
    for title, name, rows in results.pictures():
        maps = [(series, part) for series, part in rows[rows.steps.notna()].groupby("series")
                if part.thickness_m.nunique() >= 3 and part.steps.nunique() >= 3]
        for place, (series, part) in enumerate(maps):
            figure, ((recall,), (false,), (time,)) = sheet(1.6, 1.6, 1.6, sharex=True)
            grid = {column: part.pivot_table(index="thickness_m", columns="steps", values=column)
                    for column in ("recall_1px", "false_hits", "trace_ms_median")}
            heat(recall, 100 * grid["recall_1px"], "found within 1 px, % of visible", "viridis", 0, 100, lambda v: f"{v:.0f}")
            top = max(1e-9, 100 * float(rows.false_hits.max()))
            heat(false, 100 * grid["false_hits"], "false hits, % of rays", "magma", 0, top, lambda v: f"{v:.0f}")
            heat(time, grid["trace_ms_median"], "trace, ms", "cividis", 0, float(rows.trace_ms_median.max()), lambda v: f"{v:.3g}")
            time.set_xlabel("steps")
            most, fewest = part.loc[part.recall_1px.idxmax()], part.loc[part.false_hits.idxmin()]
            titled(figure, f"{series} finds most with {most.steps:g} steps of {most.thickness_m:g} m, and has the fewest false hits "
                   f"with {fewest.steps:g} steps of {fewest.thickness_m:g} m", title)
            yield f"thickness_steps_{name}" + (f"_{place}" if place > 0 else ""), figure


def thickness_curves(results, tables):
    """Wrong rays against thickness: visible points that are missed, and false hits. Surface models have their own figure."""
    if not results.has("screen_missed", "recall_1px", "false_hits", "truth_visible") or several_surfaces(results):
        return
    for title, name, rows in results.pictures():
        if rows.thickness_m.nunique() < 4:
            continue
        figure, ((axis,),) = sheet(2.1)
        lowest, ends = [], []
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
            axis.plot(part.thickness_m, wrong, label=said, **style)
            axis.plot(part.thickness_m[best], wrong[best], "o", ms=8, mfc="none", mec=style["color"], mew=1.2)
            ends.append((said, part.thickness_m.iloc[-1], wrong.iloc[-1], style["color"]))
            lowest.append((wrong[best], said, part.thickness_m[best]))
            tables.setdefault(BEST_THICKNESS, []).append(
                {"frame": title, "series": said, "thickness, m": f"{part.thickness_m[best]:g}",
                 "missed, % of rays": f"{missed[best]:.2f}", "false, % of rays": f"{false[best]:.2f}"})
        if not lowest:
            continue
        axis.set(xscale="log", xlabel="thickness, m; circles: fewest wrong", ylabel="wrong, % of rays (missed + false)", ylim=(0, None))
        plain_ticks(axis.xaxis, set(rows.thickness_m))
        name_lines(axis, ends)
        wrong, said, thickness = min(lowest)
        titled(figure, f"Fewest rays are wrong at a thickness of {thickness:g} m: {wrong:.1f} % ({said})", title)
        yield f"thickness_trade_{name}", figure


def dots(axis, places, rows, results, value, spread, xlabel):
    """A mark a run in its line, hollow where its interval is not known."""
    for series, part in rows.groupby("series", sort=False):
        style = dict(results.styles[series], linestyle="none", label=series)
        sure = known(part, spread) if spread else part[value].notna()
        y = np.array([places[key] for key in zip(part.scene, part.series)])
        axis.errorbar(part[value], y, xerr=errors(part, spread) if spread else None, elinewidth=0.7, **style)
        axis.plot(part[value][~sure], y[~sure], **{**style, "markerfacecolor": "white", "label": None})
    axis.set_xlabel(xlabel)
    log_axis(axis.xaxis)


def fastest_of(rows):
    """The message of a comparison: who is fastest, where, and how much faster than the next. Whose intervals overlap are not ranked."""
    short, scenes = short_names(rows.series.unique()), rows.scene.nunique()
    if scenes > 1:
        wins = [best.series for best, orders in map(orders_of, dict(list(rows.groupby("scene", sort=False))).values()) if set(orders) == {APART}]
        if not wins:
            return f"In none of {scenes} scenes is one faster than all others by more than the intervals"
        winner = max(wins, key=wins.count)
        return f"{short[winner]} is the fastest in {wins.count(winner)} of {scenes} scenes by more than the intervals"
    best, orders = orders_of(rows)
    rows = rows.sort_values("cost_ms_median").iloc[1:].assign(order=orders)
    alike, later = rows[rows.order == OVERLAPPING], rows[rows.order != OVERLAPPING]
    if later.empty:
        return f"The times {ALIKE}"
    text = f"{short[best.series]} is the fastest"
    if len(alike):
        text = f"The times of {listed([short[name] for name in (best.series, *alike.series)])} {ALIKE}"
    text += f"; {short[later.series.iloc[0]]} takes {later.cost_ms_median.iloc[0] / best.cost_ms_median:.3g} times as long" + (
        f" as {short[best.series]}" if len(alike) else "")
    return text + ("; not all intervals are known" if UNKNOWN in orders else "")


def orders_of(rows):
    """(the fastest of one scene, how its interval and that of each other one lie: in the order of their times)."""
    rows = rows.sort_values("cost_ms_median")
    return rows.iloc[0], [order_of(rows.iloc[0], row) for _, row in rows.iloc[1:].iterrows()]


def comparison(results, _):
    """Time with its interval and fetches of every technique, where each has one setting per frame. Growth shows several sizes."""
    for (view, width, height), rows in results.rows.groupby(["view", "width", "height"], sort=False):
        single = rows.groupby(["scene", "series"]).size().max() == 1
        if not single or rows.series.nunique() < 2 or rows.series.nunique() > 8 or results.rows.width.nunique() >= 3:
            continue
        scenes, rows = list(dict.fromkeys(rows.scene)), rows.sort_values("cost_ms_median")
        named = list(dict.fromkeys(rows.series)) if len(scenes) == 1 else scenes
        places = {(row.scene, row.series): named.index(row.series if len(scenes) == 1 else row.scene) for row in rows.itertuples()}
        key_lines = -(-rows.series.nunique() // 2) if len(scenes) > 1 else 0
        figure, ((left, right), (key, unused)) = sheet(0.6 + 0.16 * len(named), 0.01 + 0.14 * key_lines, columns=2, sharey="row")
        dots(left, places, rows, results, "cost_ms_median", "cost_ms", "trace + structures, ms")
        dots(right, places, rows, results, "fetches_mean", None, "fetches per ray")
        left.set_yticks(range(len(named)), named)
        left.set_ylim(len(named) - 0.5, -0.5)
        unused.axis("off")
        key_below(key, *(right.get_legend_handles_labels() if len(scenes) > 1 else ([], [])), 2)
        titled(figure, fastest_of(rows), f"view {view}, {width}×{height}" + (f", {scenes[0]}" if len(scenes) == 1 else "; hollow: interval not known"))
        yield f"compare_{view}_{width}x{height}", figure


def draw_growth(results, rows, measured_on, tables):
    """Time and fetches per ray against pixels, with the exponent of the fitted power law: 0 does not grow, 0.5 grows with the width."""
    rows = rows.assign(pixels=rows.width * rows.height, ns_per_ray=rows.cost_ms_median * 1e6 / rows.rays)
    sizes = rows.drop_duplicates("pixels").sort_values("pixels")
    figure, ((top,), (bottom,)) = sheet(1.7, 1.7, sharex=True)
    short = short_names(rows.series.unique())
    for axis, column, label in ((top, "ns_per_ray", "time per ray, ns"), (bottom, "fetches_mean", "fetches per ray")):
        ends, growth = [], {}
        for series, line in rows.groupby("series"):
            line = line.sort_values("pixels")
            good = line[line[column] > 0]
            slope = fit_line(np.log(good.pixels.to_numpy()), np.log(good[column].to_numpy()))[0] if len(good) > 1 else np.nan
            axis.plot(line.pixels, line[column], label=series, **results.styles[series])
            ends.append((f"{short[series]}, {slope + 0:+.2f}", line.pixels.iloc[-1], line[column].iloc[-1], results.styles[series]["color"]))
            growth[short[series]] = line[column].iloc[-1] / line[column].iloc[0]
            tables.setdefault("Growth with the number of pixels: fitted exponents", []).append(
                {"frame": measured_on, "series": series, "of": label, "exponent": f"{slope:.3f}"})
        axis.set(xscale="log", ylabel=label)
        log_axis(axis.yaxis)
        name_lines(axis, ends)
    bottom.set_xticks(sizes.pixels, [f"{row.height}p" for row in sizes.itertuples()])
    bottom.xaxis.set_minor_locator(NullLocator())
    bottom.set_xlabel("picture; numbers: exponent of the pixels")
    most, least = max(growth, key=growth.get), min(growth, key=growth.get)
    message = f"From {sizes.height.iloc[0]}p to {sizes.height.iloc[-1]}p a ray of {most} fetches {growth[most]:.2g} times as much"
    titled(figure, message + (f", one of {least} {growth[least]:.2g} times" if most != least else ""), measured_on)
    return figure


def growth(results, tables):
    """Surface models have their own figure."""
    for (scene, view), rows in results.rows.groupby(["scene", "view"], sort=False):
        numbers = [name for name in results.swept(rows) if is_number(rows[name])]
        if not several_surfaces(results) and (rows.width * rows.height).nunique() >= 3 and all(rows[name].nunique() < 2 for name in numbers):
            figure = draw_growth(results, rows, f"{scene}, view {view}", tables)
            yield f"growth_{''.join(c if c.isalnum() else '_' for c in scene)}_{view}", figure


ALL = [law_of_steps, thickness_maps, thickness_curves, comparison, growth]

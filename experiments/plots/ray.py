"""One ray, drawn from what `ssrlab ray` wrote: from the side, and on screen."""
import json
import math

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib import colormaps
from matplotlib.patches import Rectangle

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")  # Okabe and Ito
MARKERS = "oXsDPv"
MOST_TECHNIQUES = len(COLOURS)


def length_px(ray):
    return math.hypot(*ray["delta_px_depth"][:2])


def finite(value, otherwise):
    return otherwise if value is None else value


def shown_t(ray):
    """The part of the ray that is worth a look: a little more than to the last end that anybody gives it."""
    ends = [end["t"] for end in ray["techniques"] + [ray["screen_truth"]] if "t" in end] + [scene_truth_t(ray) or 0]
    return min(1, 1.4 * max(ends) + 2 / max(length_px(ray), 2)) if max(ends) > 0 else 1


def draw_side(axes, ray):
    """Distance against the way on screen: the ray, and what each crossed pixel holds."""
    scale, until = length_px(ray), shown_t(ray)
    walk = [v for v in ray["walk"] if v["t_in"] <= until]
    fronts = [v["front_m"] for v in walk if v["front_m"]]
    rays = [v["ray_in_m"] for v in walk if v["ray_in_m"]] + [v["ray_out_m"] for v in walk if v["ray_out_m"]]
    top = max(rays + [1e-9])
    high = 1.1 * max([top] + [d for d in fronts if d < 1.3 * top])
    for v in walk:
        if v["front_m"] == 0 and v["back_m"] == 0:
            continue
        a, b = v["t_in"] * scale, v["t_out"] * scale
        front, back = finite(v["front_m"], 0), min(finite(v["back_m"], high), high)
        axes.fill_between([a, b], front, max(back, front), color="#bbbbbb", linewidth=0)
        axes.plot([a, b], [front, front], color="#444444", linewidth=1, solid_capstyle="butt")
    xs = [v["t_in"] * scale for v in walk] + [walk[-1]["t_out"] * scale] if walk else []
    ys = [finite(v["ray_in_m"], high) for v in walk] + [finite(walk[-1]["ray_out_m"], high)] if walk else []
    axes.plot(xs, ys, color="black", linewidth=1.2, label="ray")
    axes.plot([], [], color="#bbbbbb", linewidth=6, label="what the pixels hold")
    low = min([y for y in ys] + [f for f in fronts if f < high] + [high])
    axes.set_ylim(high, max(0, low - 0.1 * (high - low)))
    axes.set_xlim(-0.02 * until * scale, 1.02 * until * scale)
    axes.set_ylabel("distance from the camera, m")
    for place, technique in enumerate(ray["techniques"][:MOST_TECHNIQUES]):
        if "t" in technique:
            visit = min(walk, key=lambda v: abs(v["t_in"] - technique["t"]) if v["t_in"] <= technique["t"] <= v["t_out"] else 9)
            share = (technique["t"] - visit["t_in"]) / max(visit["t_out"] - visit["t_in"], 1e-12)
            y = finite(visit["ray_in_m"], high) * (1 - share) + finite(visit["ray_out_m"], high) * share
            axes.plot(technique["t"] * scale, y, MARKERS[place], color=COLOURS[place], markersize=9,
                      markerfacecolor="none", markeredgewidth=2, label=f"{technique['technique']}: {technique['status']}")
        else:
            axes.plot([], [], MARKERS[place], color=COLOURS[place], markerfacecolor="none",
                      label=f"{technique['technique']}: {technique['status']}")
    if "t" in ray["screen_truth"]:
        axes.axvline(ray["screen_truth"]["t"] * scale, color="#117733", linewidth=1, linestyle="--", label="screen truth")
    true_t = scene_truth_t(ray)
    if true_t is not None:
        axes.axvline(true_t * scale, color="#aa4499", linewidth=1, linestyle=":", label="scene truth")
    axes.legend(loc="best", fontsize=8, framealpha=0.8)


def scene_truth_t(ray):
    truth = ray["scene_truth"]
    if truth is None or truth["class"] in ("sky", "behind_camera", "not_traced") or None in truth["point_px"]:
        return None
    dx, dy = ray["delta_px_depth"][:2]
    along = (truth["point_px"][0] - ray["origin_px_depth"][0]) * dx + (truth["point_px"][1] - ray["origin_px_depth"][1]) * dy
    t = along / max(dx * dx + dy * dy, 1e-30)
    return t if 0 <= t <= 1.05 else None


def draw_visits(axes, ray, technique, colour):
    """Which level was asked where; from one visit to the next, downward in time."""
    scale = length_px(ray)
    visits = [v for v in technique["visits"] if v["t_in"] <= shown_t(ray)][:4000]
    for order, v in enumerate(visits):
        a, b = v["t_in"] * scale, v["t_out"] * scale
        strength = 1.0 if v["then"] in ("hit", "stopped") else 0.75 if v["then"] == "opens" else 0.4
        if a == b:
            axes.plot(a, order + 1, "D", color=colour, markersize=3)
        else:
            axes.plot([a, b], [order + 1, order + 1], color=colour, alpha=strength, linewidth=2 + v["level"],
                      solid_capstyle="butt")
    axes.set_ylim(max(len(visits), 1) + 0.8, 0.2)
    axes.set_ylabel(f"{technique['technique']}\nvisit")
    axes.yaxis.get_major_locator().set_params(integer=True, nbins=5)


def draw_screen(axes, ray):
    background = ray["background"]
    x, y = background["first"]
    rows = background["rows"]
    shown = [[[c ** (1 / 2.2) for c in pixel] for pixel in row] for row in rows]
    axes.imshow(shown, extent=(x, x + len(rows[0]), y + len(rows), y), interpolation="nearest", aspect="equal")
    levels = max([v["level"] for technique in ray["techniques"] for v in technique["visits"]] + [1])
    colours = colormaps["viridis"]
    first = ray["techniques"][0]
    for v in first["visits"][:4000]:
        side = 1 << v["level"]
        corner = [p >> v["level"] << v["level"] for p in v["pixel"]]
        axes.add_patch(Rectangle(corner, side, side, fill=False, linewidth=0.9, edgecolor=colours(v["level"] / levels)))
    ox, oy, _ = ray["origin_px_depth"]
    dx, dy, _ = ray["delta_px_depth"]
    axes.plot([ox, ox + dx], [oy, oy + dy], color="white", linewidth=2.2)
    axes.plot([ox, ox + dx], [oy, oy + dy], color="black", linewidth=1)
    axes.plot(ox, oy, "o", color="black", markersize=4)
    for place, technique in enumerate(ray["techniques"][:MOST_TECHNIQUES]):
        if "t" in technique:
            axes.plot(ox + technique["t"] * dx, oy + technique["t"] * dy, MARKERS[place], color=COLOURS[place],
                      markersize=9, markerfacecolor="none", markeredgewidth=2)
    until, margin = shown_t(ray), 4
    xs, ys = sorted((ox, ox + until * dx)), sorted((oy, oy + until * dy))
    axes.set_xlim(max(x, xs[0] - margin), min(x + len(rows[0]), xs[1] + margin))
    axes.set_ylim(min(y + len(rows), ys[1] + margin), max(y, ys[0] - margin))
    axes.set_xlabel(f"x, px; visited by {first['technique']}:\ndark is level 0, light level {levels}")
    axes.set_ylabel("y, px")


def main(found, picture):
    with open(found, encoding="utf-8") as file:
        ray = json.load(file)
    techniques = ray["techniques"][:MOST_TECHNIQUES]
    until = shown_t(ray)
    upright = abs(ray["delta_px_depth"][1]) > abs(ray["delta_px_depth"][0])
    heights = [3.4] + [1.4] * len(techniques)
    figure = plt.figure(figsize=(13 if upright else 11, sum(heights) + (1 if upright else 5)), layout="constrained")
    if upright:
        grid = figure.add_gridspec(len(heights), 2, height_ratios=heights, width_ratios=[3, 1])
        screen = figure.add_subplot(grid[:, 1])
    else:
        grid = figure.add_gridspec(len(heights) + 1, 1, height_ratios=heights + [4])
        screen = figure.add_subplot(grid[-1, 0])
    axes = [figure.add_subplot(grid[row, 0]) for row in range(len(heights))]
    draw_side(axes[0], ray)
    for place, technique in enumerate(techniques):
        draw_visits(axes[1 + place], ray, technique, COLOURS[place])
        axes[1 + place].sharex(axes[0])
    axes[-1].set_xlabel("way on screen, px" + ("" if until == 1 else f" (of {length_px(ray):.0f})"))
    draw_screen(screen, ray)
    axes[0].set_title(f"{ray['scene']}, pixel ({ray['pixel'][0]}, {ray['pixel'][1]})", loc="left")
    figure.savefig(picture, dpi=110, metadata={"Software": "ssrlab"})


"""Draws how the cost of a ray grows with the picture, from a sweep over sizes.

    build/bin/ssrlab run experiments/resolution.toml
    experiments/plot growth results/resolution -o growth.png
Left the trace's time per traced ray, right the fetches per ray, against pixels. The legend gives each fitted exponent: 0 does not
grow, 0.5 grows with the width of the picture.
"""

import argparse
import os
import sys

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.ticker import NullLocator

from .data import Results
from .figures import fit_line, log_axis


def exponent(pixels, values):
    return fit_line(np.log(pixels), np.log(values))[0]


def draw(results, rows, title, output):
    rows = rows.assign(pixels=rows.width * rows.height, ns_per_ray=rows.trace_ms_median * 1e6 / rows.rays)
    sizes = rows.drop_duplicates("pixels")
    lines = {name: line.sort_values("pixels") for name, line in rows.groupby("series")}
    figure, axes = plt.subplots(1, 2, figsize=(15, 5))
    for axis, column, label in zip(axes, ("ns_per_ray", "fetches_mean"), ("time per ray, ns", "fetches per ray")):
        for name in sorted(lines, key=lambda name: -lines[name][column].iloc[-1]):
            line = lines[name]
            slope = f"{exponent(line.pixels, line[column]) + 0:+.2f}" if len(line) > 1 else "–"
            axis.plot(line.pixels, line[column], label=f"{name}  {slope}", **results.styles[name])
        axis.set(xscale="log", xlabel="picture", ylabel=label)
        log_axis(axis.yaxis)
        axis.set_xticks(sizes.pixels, [f"{row.height}p" for _, row in sizes.iterrows()])
        axis.xaxis.set_minor_locator(NullLocator())
        axis.legend(title="technique, exponent", fontsize=8, loc="upper left", bbox_to_anchor=(1, 1))
    figure.suptitle(title)
    figure.savefig(output, dpi=120)
    print(output)


def main(words):
    parser = argparse.ArgumentParser(prog="plot growth", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", help="a results folder with several sizes")
    parser.add_argument("--scene", default="thin_yard")
    parser.add_argument("--view", default="default")
    parser.add_argument("-o", "--output", default="growth.png", metavar="FILE.png")
    options = parser.parse_args(words)
    if not os.path.exists(os.path.join(options.folder, "results.csv")):
        sys.exit(f"plot growth: {options.folder}: holds no results.csv; make one with ssrlab run")
    results = Results(options.folder)
    rows = results.rows[(results.rows.scene == options.scene) & (results.rows["view"] == options.view)]
    if rows.empty:
        sys.exit(f"plot growth: {options.folder}: no row of {options.scene}, view {options.view}")
    device = results.environment.get("identity", {}).get("device", "a device that is not known")
    draw(results, rows, f"{options.scene}, view {options.view}: growth with resolution on {device}", options.output)


#!/usr/bin/python3
"""Draws how passes grow with the picture, from JSON files of the benchmark program (or of ./experiments/bench -o FOLDER).

    build/bin/benchmarks --scene=thin_yard --benchmark_filter=trace/ --benchmark_out=growth.json
    experiments/plot_benchmarks.py growth.json -o growth.png
Left the time per traced ray, right the fetches per ray, against pixels; the legend gives each fitted exponent: 0 does not grow, 0.5
grows with the width of the picture. With --reference, prints each pass's time relative to copy_depth and to the pixel walk in both
files instead.
"""

import argparse
import json
import math
import statistics
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import LogLocator, NullLocator

PIXELS = {"360p": 640 * 360, "720p": 1280 * 720, "1080p": 1920 * 1080, "2160p": 3840 * 2160}


def read(files):
    """{(scene, pass): {size: {value: median}}}, and the device."""
    values, device = defaultdict(lambda: defaultdict(lambda: defaultdict(list))), ""
    for file in files:
        report = json.loads(Path(file).read_text())
        device = report["context"]["device"]
        time = "cpu_ms" if report["context"].get("device_type") == "Cpu" else "real_time"
        for row in report["benchmarks"]:
            if row["run_type"] != "iteration" or "error_occurred" in row or time not in row:
                continue
            scene, size, name = row["name"].split("/iterations:")[0].split("/", 2)
            place = values[scene, name][size]
            place["ms"].append(row[time])
            if row.get("rays"):
                place["ns_per_ray"].append(row[time] * 1e6 / row["rays"])
            if "fetches_per_ray" in row:
                place["fetches_per_ray"].append(row["fetches_per_ray"])
    return {key: {size: {name: statistics.median(v) for name, v in place.items()} for size, place in sizes.items()}
            for key, sizes in values.items()}, device


def exponent(points):
    """Slope of log value over log pixels, least squares."""
    x, y = [math.log(p) for p, _ in points], [math.log(v) for _, v in points]
    mean_x, mean_y = statistics.mean(x), statistics.mean(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x) ** 2 for a in x)


def curve(values, scene, name, column):
    sizes = values[scene, name]
    return sorted((PIXELS[size], sizes[size][column]) for size in sizes if sizes[size].get(column, 0) > 0)


def draw(values, device, scene, output):
    figure, axes = plt.subplots(1, 2, figsize=(15, 5), layout="constrained")
    names = [name for s, name in values if s == scene and name.startswith("trace/")]
    names.sort(key=lambda name: -curve(values, scene, name, "ns_per_ray")[-1][1])
    markers = dict(zip(sorted(names), "osD^v<>PX*hpd"))
    for axis, column, label in zip(axes, ("ns_per_ray", "fetches_per_ray"), ("time per ray, ns", "fetches per ray")):
        for colour, name in enumerate(names):
            points = curve(values, scene, name, column)
            slope = f"{round(exponent(points), 2) + 0:+.2f}" if len(points) > 1 else "–"
            axis.plot(*zip(*points), marker=markers[name], markersize=5, color=plt.get_cmap("tab20")(colour % 20),
                      label=f"{name.removeprefix('trace/')}  {slope}")
        axis.set(xscale="log", yscale="log", xlabel="picture", ylabel=label)
        measured = [size for size in PIXELS if any(size in values[scene, name] for name in names)]
        axis.set_xticks([PIXELS[size] for size in measured], measured)
        axis.xaxis.set_minor_locator(NullLocator())
        axis.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.yaxis.set_major_formatter("{x:g}")
        axis.yaxis.set_minor_locator(NullLocator())
        axis.grid(alpha=0.3)
        axis.legend(title="technique, exponent", fontsize=8, loc="upper left", bbox_to_anchor=(1, 1))
    figure.suptitle(f"{scene}: growth with resolution on {device}")
    figure.savefig(output, dpi=120)
    print(output)


def compare(values, reference):
    """Relative to the copy of the depth and to the pixel walk of the same picture and run, so that machines compare: the one says how
    fast memory is, the other how fast arithmetic."""
    yardsticks = {"copy": "copy_depth", "dda": "trace/dda"}
    print(f"{'pass':48} " + " ".join(f"{f'/ {short} now':>11} {'reference':>11} {'change':>8}" for short in yardsticks))

    def ms(run, scene, name, size):
        return run.get((scene, name), {}).get(size, {}).get("ms", 0)

    def change(scene, name, size, yardstick):
        if not ms(values, scene, yardstick, size) or not ms(reference, scene, yardstick, size):
            return f"{'–':>11} {'–':>11} {'–':>8}"
        now, then = (ms(run, scene, name, size) / ms(run, scene, yardstick, size) for run in (values, reference))
        return f"{now:11.3g} {then:11.3g} {now / then:8.2f}"

    for (scene, name), sizes in sorted(values.items()):
        for size in sizes:
            columns = [change(scene, name, size, yardstick) for yardstick in yardsticks.values()]
            if ms(reference, scene, name, size) and name not in yardsticks.values() and any("–" not in column for column in columns):
                print(f"{f'{scene}/{size}/{name}':48} " + " ".join(columns))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="+", metavar="FILE.json")
    parser.add_argument("--reference", metavar="FILE.json", help="compare with this run")
    parser.add_argument("--scene", default="thin_yard")
    parser.add_argument("-o", "--output", default="growth.png", metavar="FILE.png")
    options = parser.parse_args()
    values, device = read(options.files)
    if options.reference:
        return compare(values, read([options.reference])[0])
    if not any(scene == options.scene and name.startswith("trace/") for scene, name in values):
        sys.exit(f"plot_benchmarks: no trace of {options.scene} in {', '.join(options.files)}")
    draw(values, device, options.scene, options.output)


if __name__ == "__main__":
    main()

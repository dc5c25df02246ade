"""The look that all figures share: 85 mm wide, the message as the title, what it was measured on below, names at the ends of lines."""
import textwrap

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator  # noqa: E402
from matplotlib.transforms import blended_transform_factory  # noqa: E402

WIDTH_INCHES = 85 / 25.4
BELOW_INCHES = 0.35  # ticks of a panel and their label
COLOURS = ["#D55E00", "#E69F00", "#CC79A7", "#8A6D00", "#0072B2", "#009E73", "#56B4E9", "#1A1A1A"]

plt.rcParams.update({"font.size": 7, "axes.titlesize": 7, "axes.titlelocation": "left", "xtick.labelsize": 6.5, "ytick.labelsize": 6.5,
                     "legend.fontsize": 6.5, "legend.frameon": False, "legend.handlelength": 1.2, "legend.columnspacing": 1,
                     "lines.linewidth": 1.1, "lines.markersize": 3.5, "axes.linewidth": 0.6, "axes.grid": True, "grid.alpha": 0.3,
                     "grid.linewidth": 0.5, "axes.axisbelow": True, "figure.constrained_layout.use": True, "savefig.dpi": 300,
                     "axes.spines.top": False, "axes.spines.right": False, "svg.fonttype": "none"})


def sheet(*heights_inches, columns=1, **more):
    """(figure, axes): panels one below the other, or some in each row."""
    return plt.subplots(len(heights_inches), columns, figsize=(WIDTH_INCHES, sum(heights_inches) + 0.7),
                        height_ratios=heights_inches, squeeze=False, **more)


def titled(figure, message, measured_on=""):
    """The message becomes the alt text, too."""
    figure.suptitle("\n".join(textwrap.wrap(message, 54)), x=0.01, ha="left", fontsize=8)
    if measured_on:
        figure.supxlabel("\n".join(textwrap.wrap(measured_on, 75)), x=0.99, ha="right", fontsize=5.5, color="#666666")
    figure.finding = message + (f" ({measured_on})" if measured_on else "")


def spread(x, y, room, low, high):
    """Heights for the names of points: near theirs, at least `room` apart and within the bounds as far as they suffice. Of points that
    are about equally high the one at the right is named first, from below, so that few lines cross."""
    order = np.lexsort((-x, np.round(y / (0.25 * room))))
    room = min(room, (high - low) / max(1, len(y) - 1))
    placed = y[order]
    for i in range(1, len(placed)):
        placed[i] = max(placed[i], placed[i - 1] + room)
    placed = np.minimum(placed, high - room * np.arange(len(placed) - 1, -1, -1))
    for i in range(len(placed) - 2, -1, -1):
        placed[i] = min(placed[i], placed[i + 1] - room)
    result = np.empty(len(placed))
    result[order] = placed
    return result


def wrapped(name):
    return textwrap.fill(name, 19, break_long_words=False)


def room_of(names):
    """Inches between names that stand one below the other."""
    return 7.5 / 72 * (1.7 if any("\n" in wrapped(name) for name in names) else 1)


def height_beside(names, least):
    """Inches of a panel beside which these names have room."""
    return max(least, BELOW_INCHES + room_of(names) * len(names))


def name_lines(axis, ends):
    """Names right of the axes, each joined to its line's end. ends: [(name, x, y, colour)] in data. Limits and scales must be final."""
    ends = [(wrapped(name), x, y, colour) for name, x, y, colour in ends if np.isfinite(y)]
    if not ends:
        return
    axis.set(xlim=axis.get_xlim(), ylim=axis.get_ylim())
    at = axis.transAxes.inverted().transform(axis.transData.transform([(x, y) for _, x, y, _ in ends]))
    place = axis.get_subplotspec()
    inches = place.get_gridspec().get_height_ratios()[place.rowspan.start] - BELOW_INCHES
    room = room_of([name for name, *_ in ends]) / inches
    for (name, x, y, colour), place in zip(ends, spread(at[:, 0], at[:, 1], room, 0.02, 0.98)):
        axis.annotate(name, (x, y), xytext=(1.05, place), textcoords="axes fraction", fontsize=6, va="center", color=colour, linespacing=0.9,
                      annotation_clip=False, arrowprops=dict(arrowstyle="-", color=colour, lw=0.5, alpha=0.6, shrinkA=0, shrinkB=2, relpos=(0, 0.5)))


def short_names(names):
    """{name: its parts between commas that not all of them have}; whole names where one would be empty."""
    parts = {name: name.split(", ") for name in names}
    common = set.intersection(*map(set, parts.values())) if len(parts) > 1 else set()
    short = {name: ", ".join(part for part in own if part not in common) for name, own in parts.items()}
    return short if all(short.values()) else {name: name for name in names}


def key_below(axis, handles, labels, columns):
    """A legend that fills an empty panel below the others, as wide as the figure."""
    axis.axis("off")
    axis.legend(handles, labels, loc="upper left", bbox_to_anchor=(0.02, 1.2), ncols=columns,
                bbox_transform=blended_transform_factory(axis.get_figure().transFigure, axis.transAxes)).set_in_layout(False)


def log_axis(axis):
    """Logarithmic, labelled 1, 2, 5, 10 … in plain numbers; 1, 10, 100 where they would collide, 1, 2, 3 … within one decade."""
    axis.axes.set(**{f"{axis.axis_name}scale": "log"})
    low, high = axis.get_view_interval()
    decades = np.log10(high / low) if low > 0 else 0
    axis.set_major_locator(LogLocator(subs=(1,) if decades > 2.2 else (1, 2, 5) if decades > 0.7 else range(1, 10)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: np.format_float_positional(value, 6, trim="-", fractional=False)))
    axis.set_minor_formatter(NullFormatter())


def plain_ticks(axis, values):
    """Measured values of a logarithmic axis labelled as they are written, but for those with no room beside the one before."""
    places = sorted(value for value in values if 0 < value < np.inf)
    labelled = places[:1]
    for value in places[1:]:
        if value >= (places[-1] / places[0]) ** (1 / 6) * labelled[-1]:
            labelled.append(value)
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_ticks(labelled)
    axis.set_minor_locator(NullLocator())

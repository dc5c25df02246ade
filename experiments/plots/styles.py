"""One colour and marker for each technique, the same in every plot, report and page.

Twelve colours and ten markers give 24 pairs that all differ. Techniques that share a marker have colours that the colour-blind tell
apart (Machado, Oliveira and Fernandes 2009; a test checks it), on paper and on a dark screen.
"""
import zlib

# (on white, on dark)
COLOURS = [("#0072B2", "#4DB1F2"), ("#D55E00", "#FF8A3D"), ("#00875F", "#2FCB9A"), ("#B8548C", "#F29CC9"), ("#1A1A1A", "#F2F2F2"),
           ("#8A6D00", "#E3C23C"), ("#3A2BA8", "#9B8CFF"), ("#6B3A00", "#C98F55"), ("#00727D", "#5FD6E0"), ("#7A1340", "#E0607F"),
           ("#5C8F00", "#B9DC4A"), ("#6D7480", "#A9B1BD")]
# (matplotlib, Chart.js point style, its rotation in degrees)
MARKERS = [("o", "circle", 0), ("s", "rect", 0), ("^", "triangle", 0), ("D", "rectRot", 0), ("v", "triangle", 180), (">", "triangle", 90),
           ("<", "triangle", 270), ("P", "cross", 0), ("X", "crossRot", 0), ("*", "star", 0)]
DASHES = ["-", "--", ":", "-."]  # variants of one technique
SLOTS = 24
# Fixed places, so that a technique looks alike in every report. Others find theirs by their name.
PLACES = ["linear", "linear_binary", "dda_strided", "strided_direction", "dda", "hiz", "hiz_packets", "quadtree", "hiz_waves"]


def slots(techniques):
    """{technique: slot}. An author's technique keeps its slot from report to report, unless two names want the same one."""
    taken = {name: PLACES.index(name) for name in techniques if name in PLACES}
    for name in sorted(set(techniques) - set(PLACES)):
        free = [slot for slot in range(len(PLACES), max(SLOTS, len(techniques))) if slot not in taken.values()]
        wanted = len(PLACES) + zlib.crc32(name.encode()) % (SLOTS - len(PLACES))
        taken[name] = wanted if wanted in free else free[0]
    return taken


def look(slot):
    """(colour on white, colour on dark, matplotlib marker, Chart.js point style, rotation) of a slot."""
    dozen, place = divmod(slot, len(COLOURS))
    return COLOURS[place] + MARKERS[(place + 2 * dozen - 2 * (place // len(MARKERS))) % len(MARKERS)]


def lines_of(series):
    """(name, look, dash) of each line. Variants have their technique's colour and markers of their own; where there is one technique,
    they have colours of their own, too."""
    slot_of = slots(list(series))
    for technique, names in series.items():
        for i, name in enumerate(names):
            own = look((slot_of[technique] + i) % SLOTS)
            yield name, own if len(series) == 1 else look(slot_of[technique])[:2] + own[2:], DASHES[i % len(DASHES)] if len(series) > 1 else "-"


def styles(series):
    """{series: matplotlib style}. series: {technique: its variants, in the order of their names}."""
    return {name: dict(color=colour, marker=marker, linestyle=dash) for name, (colour, _, marker, _, _), dash in lines_of(series)}


def chart_styles(series):
    """The same for Chart.js."""
    dashes = {"-": [], "--": [6, 4], ":": [2, 3], "-.": [6, 3, 2, 3]}
    return {name: {"light": light, "dark": dark, "point": point, "rotation": rotation, "dash": dashes[dash]}
            for name, (light, dark, _, point, rotation), dash in lines_of(series)}

"""report.md and report.html: the same content, written once as a list of blocks."""
import html
import os

SHOWN = ["scene", "view", "width", "height", "series", "trace_ms_median", "trace_ms_ci_low", "trace_ms_ci_high",
         "structures_ms_median", "frame_ms_median", "fps", "fetches_mean", "recall_1px", "precision_1px", "f1_1px", "screen_recall_1px", "screen_precision_1px", "false_hits",
         "flip_visible", "repeats"]
MANY_ROWS = 60
MANY_PICTURES = 24
MANY_PAIRS = 12
NOT_REACHED = "target not reached"

STYLE = """body{font:15px/1.5 system-ui,sans-serif;max-width:76em;margin:2em auto;padding:0 1em;color:#222}
table{border-collapse:collapse;font-size:13px;margin:1em 0;display:block;overflow-x:auto}
td,th{border:1px solid #ccc;padding:.2em .6em;text-align:right;white-space:nowrap}td:first-child,th:first-child{text-align:left}
th{background:#f2f2f2}img{max-width:100%}figure{display:inline-block;width:31%;margin:.5%;vertical-align:top}
figcaption{font-size:12px;color:#555}.plot{width:100%}.half{width:49.5%;margin-right:.5%}pre{background:#f6f6f6;padding:1em;overflow-x:auto}"""


def short(value):
    if isinstance(value, float):
        return "" if value != value else f"{value:.4g}"
    return str(value)


def table(rows):
    """rows: dictionaries with the same keys."""
    return ("table", list(rows[0]), [[short(value) for value in row.values()] for row in rows])


def blocks(results, plots, tables, summary):
    """(kind, content …) from top to bottom."""
    environment = results.environment
    yield "title", environment.get("title") or os.path.basename(os.path.abspath(results.folder))
    counts = results.all_rows.outcome.value_counts()
    yield "text", f"{len(results.all_rows)} runs: " + ", ".join(f"{n} {outcome}" for outcome, n in counts.items()) + "."
    identity = environment.get("identity", {})
    device_type = environment.get("device_type", "").lower()
    if device_type == "cpu":
        yield "text", "The device is a CPU. Compare these times with each other, not with those of a GPU."
    about = {"device": identity.get("device"), "driver": identity.get("driver"),
             "processor": identity.get("processor"), "commit": environment.get("commit"),
             "command": environment.get("command_line"), "started": environment.get("started"),
             "seed": environment.get("seed"), "system": environment.get("system")}
    yield table([{"environment": name, "": value} for name, value in about.items() if value])

    failed = results.all_rows[results.all_rows.outcome.isin(["failed", "invalid"])]
    if len(failed):
        yield "heading", "Failed runs"
        yield table([{"run": row.run_id, "technique": row.technique, "scene": row.scene, "message": row.message}
                     for _, row in failed.head(MANY_ROWS).iterrows()])
    speedups = summary[summary.kind == "speedup"] if len(summary) else summary
    if len(speedups):
        yield "heading", "How many times as fast"
        yield "text", ("Cheapest settings that reach the target, and their speed-up with its 95 % interval, judged by pairs of frames of "
                       "the same round. Where the rival's setting was found by search, the interval begins at the neighbour that "
                       "misses the target. No interval: not known. Against the screen truth exact techniques find all. Against the "
                       "scene truth every tracer lacks what a single depth buffer does not hold.")
        yield table(list(headline(summary)))
    known = summary[(summary.kind == "cheapest_for_target") & summary.value.notna()] if len(summary) else summary
    if plots:
        yield "heading", "Plots"
        for name in plots:
            yield "plot", f"plots/{name}.png", name.replace("_", " ")
    for heading, rows in tables.items():
        yield "heading", heading
        yield table(rows)
    targets = known[known.run_id.notna()] if len(known) else known
    if len(targets):
        yield "heading", "Cheapest setting for a target"
        yield "text", ("Time is trace plus the structures that the technique needs. The columns recall, precision and F1 are against "
                       "the same truth as the target. All derived rows: summary.csv.")
        yield table([{"scene": row.scene, "size": f"{row.width}×{row.height}", "of": row.measure, "target": row.target,
                      "setting": row.setting, "recall": row.recall, "precision": row.precision, "F1": row.f1, "ms": row.time_ms,
                      "fetches": row.fetches_mean} for _, row in targets.iterrows()])
    if len(results.rows):
        yield "heading", "Rows"
        shown = [name for name in SHOWN if results.has(name)]
        extra = [name for name in results.swept(results.rows) if name not in shown]
        chosen = results.rows.sort_values(["scene", "width", "series"] + extra).head(MANY_ROWS)
        yield table([{name: row[name] for name in shown[:5] + extra + shown[5:]} for _, row in chosen.iterrows()])
        if len(results.rows) > MANY_ROWS:
            yield "text", f"These are the first {MANY_ROWS} of {len(results.rows)} rows. results.csv has all of them, with every measure."
    pictures = results.rows[results.rows.picture.notna()] if "picture" in results.rows else results.rows.iloc[:0]
    if len(pictures):
        if len(pictures) <= MANY_PAIRS:
            yield "heading", "Side by side"
            yield "text", "Each picture is shown beside the one with the most similar settings."
            for left, right, caption in pairs(results, pictures):
                yield "pair", left, right, caption
        yield "heading", "Pictures"
        for _, row in pictures.head(MANY_PICTURES).iterrows():
            yield "picture", row.picture, f"{row.scene}, {row.width}×{row.height}: {setting(results, row)}"
    if environment.get("specification"):
        yield "heading", "Specification"
        yield "code", environment["specification"]


def pairs(results, pictures):
    """(left, right, what differs): every picture with the closest other one of the same scene, each pair once."""
    names = ["technique"] + results.varying(pictures)
    rows = [row for _, row in pictures.sort_values(["scene"] + names).iterrows()]

    def differing(a, b):
        return [name for name in names if a[name] != b[name] and (a[name] == a[name] or b[name] == b[name])]

    seen = set()
    for row in rows:
        others = [other for other in rows if other.scene == row.scene and other.run_id != row.run_id]
        if not others:
            continue
        other = min(others, key=lambda candidate: len(differing(row, candidate)))
        if (other.run_id, row.run_id) in seen:
            continue
        seen.add((row.run_id, other.run_id))
        changes = ", ".join(f"{name} {short(row[name])} → {short(other[name])}" for name in differing(row, other))
        yield row.picture, other.picture, f"{row.scene}: {changes}"


def headline(summary):
    """One row for each scene and target: the subject's time, and its speed-up over each rival or why there is none."""
    speedups = summary[summary.kind == "speedup"]
    keys = ["scene", "view", "width", "height", "measure", "target"]
    for (scene, view, width, height, measure, target), part in speedups.groupby(keys, sort=False):
        subject = part.technique.iloc[0]
        own = summary[(summary.kind == "cheapest_for_target") & (summary.technique == subject)]
        for key, value in zip(keys, (scene, view, width, height, measure, target)):
            own = own[own[key] == value]
        row = {"scene": scene, "view": view, "size": f"{width}×{height}", "of": measure, "target": target,
               f"{subject}, ms": own.time_ms.iloc[0]}
        for over in ("dda", "best other", "linear"):
            one = part[part.over == over]
            row[f"over {over}"] = NOT_REACHED if one.empty else speedup_text(one.iloc[0])
        yield row


def speedup_text(row):
    bounds = f"[{row.speedup_ci_low:.3g}, {row.speedup_ci_high:.3g}]" if row.verdict != "not known" else "(interval not known)"
    return f"{row.speedup:.3g} {bounds}× {row.setting}" if row.over != "dda" else f"{row.speedup:.3g} {bounds}×"


def setting(results, row):
    parts = [f"{name} {row[name]:g}" if not isinstance(row[name], (str, bool)) else f"{name} {row[name]}"
             for name in results.varying(results.rows) if row[name] == row[name]]
    return ", ".join([row.technique] + parts)


def to_markdown(parts):
    lines = []
    for kind, *content in parts:
        if kind == "title":
            lines.append(f"# {content[0]}")
        elif kind == "heading":
            lines.append(f"## {content[0]}")
        elif kind == "text":
            lines.append(content[0])
        elif kind == "table":
            cells = [[cell.replace("|", "\\|").replace("\n", " ") for cell in row] for row in [content[0]] + content[1]]
            lines.append("\n".join(["| " + " | ".join(cells[0]) + " |", "|" + "---|" * len(cells[0])] +
                                   ["| " + " | ".join(row) + " |" for row in cells[1:]]))
        elif kind in ("plot", "picture"):
            lines.append(f"![{content[1]}]({content[0]})" + (f"\n*{content[1]}*" if kind == "picture" else ""))
        elif kind == "pair":
            lines.append(f"| {content[2]} | |\n|---|---|\n| ![]({content[0]}) | ![]({content[1]}) |")
        elif kind == "code":
            lines.append(f"```toml\n{content[0].rstrip()}\n```")
    return "\n\n".join(lines) + "\n"


def to_html(parts):
    body = []
    title = ""
    for kind, *content in parts:
        safe = [html.escape(part) if isinstance(part, str) else part for part in content]
        if kind == "title":
            title = safe[0]
            body.append(f"<h1>{title}</h1>")
        elif kind == "heading":
            body.append(f"<h2>{safe[0]}</h2>")
        elif kind == "text":
            body.append(f"<p>{safe[0]}</p>")
        elif kind == "table":
            head = "".join(f"<th>{html.escape(name)}</th>" for name in content[0])
            rows = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>\n" for row in content[1])
            body.append(f"<table><tr>{head}</tr>\n{rows}</table>")
        elif kind == "plot":
            vector = safe[0].replace(".png", ".svg")
            body.append(f'<p><a href="{vector}"><img class="plot" src="{safe[0]}" alt="{safe[1]}"></a></p>')
        elif kind == "picture":
            body.append(f'<figure><a href="{safe[0]}"><img src="{safe[0]}" alt=""></a><figcaption>{safe[1]}</figcaption></figure>')
        elif kind == "pair":
            images = "".join(f'<a href="{path}"><img class="half" src="{path}" alt=""></a>' for path in safe[:2])
            body.append(f"<p>{images}<br>{safe[2]}</p>")
        elif kind == "code":
            body.append(f"<pre>{safe[0]}</pre>")
    text = "\n".join(body)
    return f'<!doctype html>\n<html lang="en"><meta charset="utf-8"><title>{title}</title>\n<style>{STYLE}</style>\n{text}\n</html>\n'


def write(results, plots, tables, summary):
    parts = list(blocks(results, plots, tables, summary))
    for name, text in (("report.md", to_markdown(parts)), ("report.html", to_html(parts))):
        with open(os.path.join(results.folder, name), "w", encoding="utf-8") as file:
            file.write(text)

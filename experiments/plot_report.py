"""report.md and report.html: the same content, written once as a list of blocks."""
import html
import os

SHOWN = ["scene", "view", "width", "height", "series", "trace_ms_median", "trace_ms_ci_low", "trace_ms_ci_high",
         "structures_ms_median", "frame_ms_median", "fps", "fetches_mean", "recall_1px", "screen_recall_1px", "false_hits",
         "flip_visible", "repeats"]
MANY_ROWS = 60
MANY_PICTURES = 24
MANY_PAIRS = 12
HEADLINE_TARGET = 0.99

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
    known = summary[(summary.kind == "cheapest_for_target") & summary.recall.notna()] if len(summary) else summary
    if len(known):
        yield "heading", f"At {100 * HEADLINE_TARGET:g} % recall"
        yield "text", (f"Time of the cheapest setting that reaches {100 * HEADLINE_TARGET:g} % recall, and speed-up over linear [95 % interval]. "
                       '"no": not reached; the best recall is shown. Against the screen truth, exact techniques find every hit. '
                       "Against the scene truth, a single depth buffer lacks hidden surfaces, so no tracer reaches 100 %.")
        yield table(list(at_target(known[known.target == HEADLINE_TARGET])))
    if plots:
        yield "heading", "Plots"
        for name in plots:
            yield "plot", f"plots/{name}.png", name.replace("_", " ")
    for heading, rows in tables.items():
        yield "heading", heading
        yield table(rows)
    targets = known[known.run_id.notna()] if len(known) else known
    if len(targets):
        yield "heading", "Cheapest setting for a target recall"
        yield "text", ("Time is the trace plus the structures that the technique needs. screen_recall_1px is the share found of the "
                       "hits that the depth buffer holds. recall_1px is the share found of the true points that the frame shows; "
                       "no tracer finds all of them. All derived rows are in summary.csv.")
        yield table([{"scene": row.scene, "size": f"{row.width}×{row.height}", "of": row.recall_of,
                      "target": f"{100 * row.target:g} %", "setting": row.setting, "ms": row.time_ms,
                      "fetches": row.fetches_mean,
                      "speed-up over linear": interval(row.speedup_over_linear, row.speedup_ci_low, row.speedup_ci_high)}
                     for _, row in targets.iterrows()])
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


def at_target(rows):
    """One row for each scene and truth, one column for each technique."""
    keys = ["scene", "view", "width", "height", "recall_of"]
    for (scene, view, width, height, recall), part in rows.groupby(keys, sort=False):
        row = {"scene": scene, "view": view, "size": f"{width}×{height}",
               "truth": "screen" if recall.startswith("screen") else "scene"}
        for _, one in part.iterrows():
            reached = one.run_id == one.run_id
            row[one.technique] = f"no: {100 * one.recall:.1f} %" if not reached else f"{short(one.time_ms)} ms"
            if reached and one.technique != "linear" and one.speedup_over_linear == one.speedup_over_linear:
                row[one.technique] += f", {interval(one.speedup_over_linear, one.speedup_ci_low, one.speedup_ci_high)}×"
        yield row


def interval(value, low, high):
    return "" if value != value else f"{value:.3g} [{low:.3g}, {high:.3g}]"


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

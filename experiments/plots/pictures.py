"""Pictures of runs for the report: which ones, in which order, and small enough to be inside its file."""
import base64
import io
import os

from PIL import Image

from .data import describe
from .verdict import has_value, milliseconds, percent

WIDEST = 640
MANY = 10  # per frame
KINDS = {"picture": "", "agreement": "_agreement", "causes": "_causes", "FLIP": "_flip", "fetches": "_fetches"}


def data_uri(path, flat=False, width=WIDEST):
    """WebP inside a text. flat: few colours with sharp borders, which must stay the ones of the legend."""
    with Image.open(path) as file:
        image = file.convert("RGB")
    if image.width > width:
        size = (width, round(image.height * width / image.width))
        image = image.resize(size, Image.NEAREST if flat else Image.LANCZOS)
    data = io.BytesIO()
    if flat:
        image.save(data, "WEBP", lossless=True, method=4)
    else:
        image.save(data, "WEBP", quality=82, method=6)
    return "data:image/webp;base64," + base64.b64encode(data.getvalue()).decode()


def aspect(path):
    with Image.open(path) as image:
        return f"{image.width} / {image.height}"


def path_of(results, picture, end):
    stem, dot = os.path.splitext(picture)
    path = os.path.join(results.folder, f"{stem}{end}{dot}")
    return path if os.path.exists(path) else None


def finding(row, kind):
    """What a picture shows, in words."""
    if kind == "agreement" and has_value(row, "recall_1px"):
        return f"finds {percent(row.recall_1px)} of what the frame shows, {percent(row.false_hits)} of the rays end in a false hit"
    if kind == "agreement" and has_value(row, "screen_recall_1px"):
        return f"finds {percent(row.screen_recall_1px)} of what the depth buffer holds"
    if kind == "causes" and has_value(row, "wrong_rays"):
        return f"{percent(row.wrong_rays)} of the rays are wrong"
    if kind == "FLIP" and has_value(row, "picture_flip"):
        return f"mean FLIP against the truth {row.picture_flip:.3g}"
    if kind == "fetches":
        return f"{row.fetches_mean:.3g} fetches a ray"
    return milliseconds(row)


def shot(name, images, run="", series=""):
    return {"name": name, "run": run, "series": series, "images": images}


def image(path, kind, name, alt, caption=None):
    return {"src": data_uri(path, flat=kind in ("agreement", "causes")), "kind": kind, "name": name, "alt": alt, "caption": caption or kind}


def interesting(chosen):
    """The best run of each technique first, then the variants; each part in the order of the ranking."""
    return [row for repeated in (False, True) for _, row in chosen[chosen.technique.duplicated() == repeated].iterrows()]


def coarsest(results, rows):
    """The run with the lowest F1, beside which the best shows what accuracy buys; None without a truth."""
    measure = next((name for name in ("f1_1px", "screen_f1_1px") if name in rows and rows[name].notna().any()), None)
    if measure is None:
        return None
    row = rows.loc[rows[measure].idxmin()].copy()
    row["setting"] = describe(results, row, rows)
    return row


def shows_environment(row):
    """Whether a ray that finds nothing shows the environment, as the truth's does."""
    return str(row.get("environment_fallback", True)).lower() != "false" and row.get("pass_set", "all") != "shading"


def shots(results, chosen, all_rows):
    """([shots], how many runs have none here, aspect, pairs): without reflections and the truth, then a line a run. pairs: what the slider
    compares, as (words, name on the left, name on the right), the first one first. The truth stands beside runs with its environment only."""
    if "picture" not in chosen:
        return [], 0, "", []
    drawn = all_rows[[has_value(row, "picture") and path_of(results, row.picture, "") is not None for _, row in all_rows.iterrows()]]
    found, coarse = interesting(chosen[chosen.run_id.isin(drawn.run_id)]), coarsest(results, drawn)
    if not found:
        return [], 0, "", []
    if coarse is not None and coarse.run_id != found[0].run_id:
        found = [found[0], coarse] + [row for row in found[1:] if row.run_id != coarse.run_id]
    found = found[:MANY]
    made, pairs, best = [], [], found[0].setting
    truth = found[0].truth_picture if has_value(found[0], "truth_picture") else None
    if truth and path_of(results, truth, "") and path_of(results, truth, "_off"):
        title = found[0].frame_name
        made.append(shot("Without reflections, and the truth" + ("" if shows_environment(found[0]) else ", which shows the environment where these runs do not"),
                         [image(path_of(results, truth, "_off"), "picture", "off", f"{title} without reflections", "without reflections"),
                          image(path_of(results, truth, ""), "picture", "truth", f"{title} with the reflections of the scene's triangles", "truth")]))
        pairs = [("best and truth", best, "truth")] if shows_environment(found[0]) else [("off and best", "off", best)]
    if coarse is not None and coarse.run_id != found[0].run_id:
        pairs.insert(len(pairs) if shows_environment(found[0]) else 0, ("coarse and best", coarse.setting, best))
    for row in found:
        paths = {kind: path_of(results, row.picture, end) for kind, end in KINDS.items()}
        made.append(shot(row.setting, [image(path, kind, row.setting, f"{row.setting}, {kind}: {finding(row, kind)}")
                                       for kind, path in paths.items() if path], row.run_id, row.series))
    return made, max(0, int(all_rows.picture.notna().sum()) - len(found)), aspect(path_of(results, found[0].picture, "")), pairs

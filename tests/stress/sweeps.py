"""A small sweep, and what it wrote."""
import csv
import os
import subprocess

from plots.results import OF_TIME


def write(path, content):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(content if isinstance(content, bytes) else content.encode())
    return path


def read(*path):
    """The file's text; empty where there is none."""
    if not os.path.exists(os.path.join(*path)):
        return ""
    with open(os.path.join(*path), encoding="utf-8", newline="", errors="replace") as file:
        return file.read()


def sweep(program, spec, out, *more, **environment):
    """Runs a specification to its end."""
    subprocess.run([program, "--quiet", "run", spec, "-o", out, *more], check=True, stdout=subprocess.DEVNULL,
                   env={**os.environ, "SSRLAB_CACHE": os.path.join(os.path.dirname(out), "cache"), **environment})


def rows_of(out):
    """{run id: row}."""
    return {row["run_id"]: row for row in csv.DictReader(read(out, "results.csv").splitlines())}


def pictures_of(out):
    """{path: bytes}."""
    found = {}
    for folder, _, names in os.walk(os.path.join(out, "pictures")):
        for name in names:
            with open(os.path.join(folder, name), "rb") as file:
                found[os.path.relpath(os.path.join(folder, name), out)] = file.read()
    return found


def differences(expected, found):
    """What differs of the rows and pictures of two sweeps, but for times."""
    (rows, pictures), (other_rows, other_pictures) = expected, found
    if rows.keys() != other_rows.keys():
        return ["rows " + ", ".join(sorted(rows.keys() ^ other_rows.keys()))]
    return ([f"{run_id} {column}" for run_id, row in rows.items() for column, value in row.items()
             if not OF_TIME.search(column) and other_rows[run_id].get(column) != value] +
            sorted(name for name in pictures.keys() | other_pictures.keys() if pictures.get(name) != other_pictures.get(name)))

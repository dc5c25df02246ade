"""A file of figures that grows: the runs of one check, on whichever day each was made."""
import json
import os


def add_run(path, figures):
    """To the runs that are there; none of them is changed."""
    runs = []
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            runs = json.load(file)["runs"]
    with open(path + ".tmp", "w", encoding="utf-8") as file:
        file.write(json.dumps({"runs": runs + [figures]}, indent=2, ensure_ascii=False) + "\n")
    os.replace(path + ".tmp", path)

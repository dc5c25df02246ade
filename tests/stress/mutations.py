"""Changes one operator of a file at a time: does a test that the file concerns (tests/run --for FILE) notice?

The files must be as they are committed, and are put back; after a kill, `git checkout FILE` does that. A change that no test notices either
changes nothing, or is an assumption that nothing holds. hard_cases/mutations.cpp breaks each assumption of the exactness proof in the everyday run."""
import os
import random
import re
import subprocess

from sweeps import read, write

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
OPERATORS = ((" < ", " <= "), (" <= ", " < "), (" > ", " >= "), (" >= ", " > "), (" == ", " != "), (" + ", " - "), (" - ", " + "), (" * ", " / "),
             (" && ", " || "), (" || ", " && "), ("min(", "max("), ("max(", "min("), ("true", "false"), ("false", "true"), (".x", ".y"), ("0.5", "1.0"))
GLSL_ERROR = re.compile(r"\.(glsl|comp|frag|vert|h):\d+: '")


def places(text):
    """(offset, before, after) of each operator outside comments, preprocessor lines and texts."""
    offset = 0
    for line in text.splitlines(keepends=True):
        code = line.split("//")[0]
        if not code.lstrip().startswith(("#", "*", "/*")) and '"' not in code:
            for before, after in OPERATORS:
                yield from ((offset + found.start(), before, after) for found in re.finditer(re.escape(before), code))
        offset += len(line)


def verdict(file):
    """Of the tree as it is."""
    if file.startswith("framework/") and subprocess.run(["cmake", "--build", "build"], cwd=ROOT, capture_output=True, check=False).returncode != 0:
        return "does not compile"
    done = subprocess.run(["tests/run", "--no-install", "--for", file], cwd=ROOT, capture_output=True, text=True, check=False)
    log = read(ROOT, "build", "log", "tests.txt")
    return "does not compile" if GLSL_ERROR.search(log) else "noticed" if done.returncode != 0 else "NOT NOTICED"


def add_options(parser):
    parser.add_argument("files", nargs="+", metavar="FILE", help="below framework/, shaders/ or techniques/")
    parser.add_argument("--count", type=int, default=10, help="changes of each file (default: 10)")
    parser.add_argument("--seed", type=int, default=1)


def run(options, _):
    broken, tried = [], 0
    for file in options.files:
        if subprocess.run(["git", "diff", "--quiet", "HEAD", "--", file], cwd=ROOT, check=False).returncode != 0:
            return [f"{file} is not as it is committed"], "nothing was changed"
        if (before := verdict(file)) != "NOT NOTICED":
            return [f"the tests of {file} fail without any change: {before}"], "nothing was changed"
        text = read(ROOT, file)
        every = list(places(text))
        for at, old, new in sorted(random.Random(options.seed).sample(every, min(options.count, len(every)))):
            line, path = text.count("\n", 0, at) + 1, os.path.join(ROOT, file)
            try:
                write(path, text[:at] + new + text[at + len(old):])
                found = verdict(file)
            finally:
                write(path, text)
            print(f"{file}:{line}: '{old.strip()}' for '{new.strip()}': {found}", flush=True)
            tried += found != "does not compile"
            if found == "NOT NOTICED":
                broken.append(f"{file}:{line}: no test notices '{new.strip()}' in place of '{old.strip()}'")
    return broken, f"{tried} changes of {len(options.files)} files, {tried - len(broken)} noticed"

"""Damages sound files of every kind by rules and a seed, and gives each to the program.

The program may use a file all the same (exit code 0), or refuse it (1 or 2) in one line that names it or the file that names it. It may not
end by a signal, exceed the limits of time and memory, or print bytes that a terminal obeys."""
import concurrent.futures
import json
import os
import random
import re
import resource
import shutil
import subprocess

import seeds
from sweeps import sweep, write

LONGEST_S, MOST_BYTES = 60, 8 << 30
ROOT = seeds.ROOT
SPEC = ('scenes = ["builtin:stairs"]\nsizes = ["32x18"]\n[passes]\npass_set = "shading"\n[trace]\nsurface = "box"\nbehind = "hit"\n'
        'thickness_m = [0.1, 0.2]\n[techniques.linear]\nsteps = [4, 8]\n[measure]\nmin_repeats = 1\nmax_repeats = 1\n')
RECIPE = ('ambient = 0.1\nenvironment = "sky.exr"\n[[part]]\nfile = "model.obj"\nheight_m = 1.5\nposition = [[0, 0, -1], [0.5, 0, -2]]\n'
          'rotation_deg = [0, 30, 0]\n[[part]]\nshape = "plane"\nsize_m = [6, 0, 6]\nmaterial = { metallic = 0.9, roughness = 0.05 }\n[[light]]\n'
          'type = "spot"\nposition = [1, 3, 2]\ntarget = [0, 0, -1]\nintensity = 20\nangle_deg = 60\n[[view]]\nname = "front"\n'
          'position = [0, 1, 3]\ntarget = [0, 0.5, -1]\nfov_y_deg = 50\nnear_m = 0.1\nsize = "32x18"\n')
NUMBERS = (b"-1", b"0", b"0.5", b"1e999", b"-1e308", b"nan", b"2147483647", b"4294967296", b"18446744073709551616", b'""', b"[]", b"{}", b"true")
WORDS = (b"x", b"", b"\xff\xfe", b"\x00", b"../x", b"\x1b[2J", b"w" * 70_000)
VALUES = (None, True, -1, 0.5, 2**31, 2**64, "", "../x", "/etc/passwd", "data:,", "x" * 100_000, [], {}, [[]], [None] * 3)


# ---- Damages: the bytes of the sound file and a source of random numbers give other bytes.
def flipped(content, draw):
    damaged = bytearray(content)
    for _ in range(draw.choice((1, 2, 8, 64))):
        damaged[draw.randrange(draw.choice((64, len(damaged)))) % len(damaged)] ^= 1 << draw.randrange(8)
    return bytes(damaged)


def replaced(content, draw):
    first = draw.randrange(len(content))
    last = first + draw.randint(1, 200)
    return content[:first] + draw.choice((b"", bytes(last - first), b"\xff" * (last - first), content[first:last] * 1000)) + content[last:]


def other(pattern, values):
    def rule(content, draw):
        place = draw.choice(list(re.finditer(pattern, content)) or [re.match(b"", content)])
        return content[:place.start()] + draw.choice(values) + content[place.end():]
    return rule


def json_places(node):
    for key, value in list(node.items() if isinstance(node, dict) else enumerate(node) if isinstance(node, list) else ()):
        yield node, key
        yield from json_places(value)


def json_value(content, draw):
    root = json.loads(content)
    container, key = draw.choice(list(json_places(root)))
    container[key] = draw.choice(VALUES)
    return json.dumps(root).encode()


ANY = {"truncated": lambda content, draw: content[:draw.randrange(len(content))], "flipped": flipped, "replaced": replaced,
       "noise": lambda content, draw: draw.randbytes(len(content)), "terminal": lambda content, draw: b"\x1b]0;x\x07\x1b[2J" + content}
TEXT = {"number": other(rb"(?<![\w.])-?\d+(?:\.\d+)?", NUMBERS), "word": other(rb"[A-Za-z_]{2,}", WORDS),
        "brackets": lambda content, draw: draw.choice((b"[", b'{"a":')) * 200_000}
PLACED = {"missing": lambda path: None, "folder": os.mkdir, "pipe": os.mkfifo, "link to itself": lambda path: os.symlink(path, path),
          "link to zeros": lambda path: os.symlink("/dev/zero", path)}


def sound_files(program, folder, only):
    """{kind: (the file that is damaged, command, rules beside the common ones, files)}; each lies with what it needs in folder/KIND."""
    def drawn(scene):
        return ["gbuffer", scene, "--size", "32x18", "-o", "drawn.exr"]

    png = seeds.encoded_images()["png"][4]
    text, glb, _ = seeds.gltf_files(png)
    textured = json.loads(text)
    textured["images"] = [{"uri": "image.png"}]
    recipe = {"scene.toml": RECIPE, "model.obj": seeds.OBJ[0], "model.mtl": seeds.OBJ[0], "t.png": png,
              "sky.exr": seeds.float_images(folder, "exr", (4, 2), ["R", "G", "B"], ["zip"])[0]}
    with open(os.path.join(ROOT, "techniques/linear/technique.toml"), "rb") as manifest, open(os.path.join(ROOT, "techniques/linear/trace.glsl"), "rb") as trace:
        technique = {"mine/steps/technique.toml": manifest.read(), "mine/steps/trace.glsl": trace.read()}
    resumed = ["run", "spec.toml", "-o", "out", "--resume"]
    made = {"gltf": ("scene.gltf", drawn("scene.gltf"), {**TEXT, "value": json_value}, {"scene.gltf": text}),
            "glb": ("scene.glb", drawn("scene.glb"), {}, {"scene.glb": glb}),
            "png": ("image.png", drawn("scene.gltf"), {}, {"scene.gltf": json.dumps(textured), "image.png": png}),
            "obj": ("model.obj", drawn("scene.toml"), TEXT, recipe), "exr": ("sky.exr", drawn("scene.toml"), {}, recipe),
            "recipe": ("scene.toml", drawn("scene.toml"), TEXT, recipe),
            "views": ("scene.gltf.views.toml", drawn("scene.gltf"), TEXT, {"scene.gltf": text, "scene.gltf.views.toml": seeds.VIEWS}),
            "spec": ("spec.toml", ["run", "spec.toml", "-o", "out", "--dry-run"], TEXT, {"spec.toml": SPEC}),
            "technique": ("mine/steps/technique.toml", ["--techniques", "mine", "show", "steps"], TEXT, technique),
            "frame": ("frame.exr", ["gbuffer", "frame.exr", "-o", "drawn.exr"], {}, {"spec.toml": SPEC}),
            "rows": ("out/results.csv", resumed, TEXT, {"spec.toml": SPEC}), "samples": ("out/samples.csv", resumed, TEXT, {"spec.toml": SPEC}),
            "environment": ("out/environment.json", resumed, {**TEXT, "value": json_value}, {"spec.toml": SPEC})}
    made = {kind: entry for kind, entry in made.items() if only in ("", kind)}
    for kind, (victim, command, _, files) in made.items():
        for name, content in files.items():
            write(os.path.join(folder, kind, name), content)
        if kind == "frame":
            subprocess.run([program, "--quiet", "gbuffer", "builtin:stairs", "--size", "32x18", "-o", os.path.join(folder, kind, victim)], check=True)
        if command == resumed:
            sweep(program, os.path.join(folder, kind, "spec.toml"), os.path.join(folder, kind, "out"))
    return made


def broken_promise(code, said, names):
    """Which promise was broken, or None. code None: the time was up. names: the damaged file and those that name it."""
    if code is None or code < 0 or code > 2:
        return "time" if code is None else f"exit code {code}"
    if re.search(r"[^\n -~\u00a0-\u2027\u2030-\uffff]", said):
        return "control characters"
    errors = [line for line in said.splitlines() if line.startswith("ssrlab: ")]
    if code == 0:
        return None
    if len(errors) != 1 or not said.rstrip().endswith(errors[0]):
        return "not one line"
    return None if any(name in errors[0] for name in names) else "file not named"


def limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (MOST_BYTES, resource.getrlimit(resource.RLIMIT_AS)[1]))


def trial(options, sound, kinds, name):
    """What was broken, as text; None: nothing."""
    kind, rule, number = name
    victim, command, rules, files = kinds[kind]
    folder = os.path.join(sound, "_".join(map(str, name)).replace(" ", "_"))
    shutil.copytree(os.path.join(sound, kind), folder)
    path, draw = os.path.join(folder, victim), random.Random(f"{options.seed}/{kind}/{rule}/{number}")
    with open(path, "rb") as file:
        content = file.read()
    os.remove(path)
    if rule in PLACED:
        PLACED[rule](path)
    elif rule != "sound":
        write(path, {**ANY, **rules}[rule](content, draw))
    else:
        write(path, content)
    try:
        done = subprocess.run([options.program, *command], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, timeout=LONGEST_S,
                              env={**os.environ, "SSRLAB_CACHE": "cache"}, preexec_fn=limit_memory)
        code, said = done.returncode, done.stderr.decode(errors="replace")
    except subprocess.TimeoutExpired:
        code, said = None, ""
    shutil.rmtree(folder)
    promise = broken_promise(code, said, [os.path.basename(victim), os.path.dirname(victim) or victim, *map(os.path.basename, files)])
    if promise is None and rule == "sound" and code != 0:
        promise = f"exit code {code} before it was damaged"
    identity = "/".join(map(str, name))
    return promise and f"{promise}: {said[:1000]!r}\n  repeat: tests/stress/run hostile --seed {options.seed} --only '{identity}'"


def add_options(parser):
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--each", type=int, default=2, metavar="N", help="files of each kind and rule (default: 2)")
    parser.add_argument("--only", default="", metavar="KIND/RULE/NUMBER", help="only those that begin so")


def run(options, folder):
    kinds = sound_files(options.program, folder, options.only.split("/")[0])
    names = [(kind, rule, number) for kind, (_, _, rules, _) in kinds.items() for rule in ["sound", *PLACED, *ANY, *rules]
             for number in range(1 if rule in PLACED or rule == "sound" else options.each)]
    names = [name for name in names if "/".join(map(str, name)).startswith(options.only)]
    if not names:
        return [f"--only: nothing begins with '{options.only}'"], "0 files"
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        broken = [what for what in pool.map(lambda name: trial(options, folder, kinds, name), names) if what]
    return broken, f"{len(names)} files of {len(kinds)} kind(s): {len(broken)} promises broken"

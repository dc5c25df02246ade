"""Draws large scenes, measures one of them with all truths, and has the program refuse what is one step larger.

5 million triangles, meshes that share a list of vertices, a texture and an environment of 16k, 30 lights with shadows, 20,000 cameras. What is
refused must be so within 5 s of CPU time, with exit code 2 and a message that names file, limit and what was found. Needs 12 GiB of memory."""
import json
import os
import struct
import subprocess

from sweeps import read, rows_of, sweep, write

REFUSED_WITHIN_S = 5
SPEC = 'scenes = ["{}"]\nsizes = ["{}"]\n[trace]\nmax_distance_m = 20\n[techniques.hiz]\n[measure]\nmin_repeats = 2\nmax_repeats = 2\nbudget_s = 0\n'
RECIPE = ('environment = "sky.exr"\n[[part]]\nshape = "sphere"\nsize_m = [1, 1, 1]\nmaterial = { metallic = 1, roughness = 0.3 }\n'
          '[[view]]\nname = "front"\nposition = [0, 1, 3]\ntarget = [0, 0.5, 0]\n')
CAMERA = {"camera": 0, "translation": [0, 1.5, 6], "rotation": [-0.13, 0, 0, 0.9915]}
FLOOR = (struct.pack("<12f", -4, 0, 4, 4, 0, 4, 4, 0, -4, -4, 0, -4), struct.pack("<8f", 0, 1, 1, 1, 1, 0, 0, 0), struct.pack("<6I", 0, 1, 2, 0, 2, 3))


def gltf(folder, name, parts=FLOOR, accessors=((5126, 4, "VEC3"), (5126, 4, "VEC2"), (5125, 6, "SCALAR")), nodes=(CAMERA,), primitives=1, lights=(),
         **more):
    """A mesh of positions, perhaps more, and indices; a part that is a number is so many bytes of zeros. Returns the scene's path."""
    views, offset = [], 0
    with open(os.path.join(folder, name + ".bin"), "wb") as file:
        for part in parts:
            size = part if isinstance(part, int) else len(part)
            views.append({"buffer": 0, "byteOffset": offset, "byteLength": size})
            offset += size
            if not isinstance(part, int):
                file.write(part)
        file.truncate(offset)  # zeros that nobody wrote take no disk
    attributes = {"POSITION": 0} if len(parts) == 2 else {"POSITION": 0, ("TEXCOORD_0" if accessors[1][2] == "VEC2" else "NORMAL"): 1}
    primitive = {"attributes": attributes, "indices": len(parts) - 1, "material": 0}
    root = {"asset": {"version": "2.0"}, "scenes": [{"nodes": list(range(len(nodes) + 1))}], "nodes": [{"mesh": 0}, *nodes],
            "meshes": [{"primitives": [primitive] * primitives}],
            "materials": [{"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0.05}}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}], "bufferViews": views,
            "accessors": [{"bufferView": i, "componentType": kind, "count": count, "type": shape} for i, (kind, count, shape) in enumerate(accessors)],
            "buffers": [{"byteLength": offset, "uri": name + ".bin"}], **more}
    if lights:
        root.update(extensionsUsed=["KHR_lights_punctual"], extensions={"KHR_lights_punctual": {"lights": list(lights)}})
    return write(os.path.join(folder, name + ".gltf"), json.dumps(root))


def waves(folder, triangles):
    """A floor of waves; its file, and how many triangles it has."""
    import numpy
    side = int((triangles / 2) ** 0.5) + 1
    x, z = numpy.meshgrid(numpy.linspace(-4, 4, side + 1, dtype=numpy.float32), numpy.linspace(-4, 4, side + 1, dtype=numpy.float32))
    points = numpy.stack([x, 0.1 * numpy.sin(3 * x) * numpy.sin(2 * z), z], axis=-1)
    normals = numpy.stack([-0.3 * numpy.cos(3 * x) * numpy.sin(2 * z), numpy.ones_like(x), -0.2 * numpy.sin(3 * x) * numpy.cos(2 * z)], axis=-1)
    normals /= numpy.linalg.norm(normals, axis=-1, keepdims=True)
    first = (numpy.arange(side)[:, None] * (side + 1) + numpy.arange(side)).astype(numpy.uint32).ravel()
    corners = numpy.stack([first, first + side + 1, first + 1, first + 1, first + side + 1, first + side + 2], axis=-1)
    count = (side + 1) ** 2
    return gltf(folder, "waves", [numpy.ascontiguousarray(part, kind).tobytes() for part, kind in ((points, "f4"), (normals, "f4"), (corners, "u4"))],
                ((5126, count, "VEC3"), (5126, count, "VEC3"), (5125, corners.size, "SCALAR"))), 2 * side * side


def picture(path, width, height):
    """A chequered one."""
    import numpy
    import OpenImageIO as oiio
    kind = "half" if path.endswith("exr") else "uint8"
    output, spec = oiio.ImageOutput.create(path), oiio.ImageSpec(width, height, 3, kind)
    spec.attribute("png:compressionLevel", 1)
    output.open(path, spec)
    rows = [numpy.repeat((0.2 + 0.6 * ((numpy.arange(width) // 64 + phase) % 2))[:, None], 3, 1).astype(numpy.float32) for phase in (0, 1)]
    for y in range(height):
        output.write_scanline(y, 0, numpy.ascontiguousarray(rows[y // 64 % 2]))
    output.close()


def textured(folder, name, width_px, height_px):
    picture(os.path.join(folder, name + ".png"), width_px, height_px)
    material = {"pbrMetallicRoughness": {"metallicFactor": 1, "roughnessFactor": 0.05, "baseColorTexture": {"index": 0}}}
    return gltf(folder, name, materials=[material], textures=[{"source": 0}], images=[{"uri": name + ".png"}])


def surrounded(folder, width_px, height_px):
    picture(os.path.join(folder, "sky.exr"), width_px, height_px)
    return write(os.path.join(folder, "surrounded.toml"), RECIPE)


def lit(folder, count):
    nodes = [{"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [4 * (i % 6) / 6 - 2, 3, 4 * (i // 6) / 6 - 2],
              "rotation": [-0.7071, 0, 0, 0.7071]} for i in range(count)]
    return gltf(folder, f"lights_{count}", nodes=[CAMERA, *nodes], lights=[{"type": "spot", "intensity": 100 / count, "spot": {"outerConeAngle": 0.6}}])


def ran(options, folder, *arguments):
    """Exit code, seconds of CPU time, peak memory in MiB, and what was said."""
    with open(os.path.join(folder, "said.txt"), "wb") as said:
        process = subprocess.Popen([options.program, "--quiet", *arguments], stdout=subprocess.DEVNULL, stderr=said, cwd=folder)
        _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024, read(folder, "said.txt").strip()


def draw(options, folder, scene, what, broken):
    """CPU seconds."""
    code, worked_s, mib, said = ran(options, folder, "render", scene, "-t", "hiz", "--size", options.size, "-o", "drawn.png")
    print(f"{what}: {worked_s:.1f} CPU seconds, {mib:.0f} MiB", flush=True)
    if code != 0 or said:
        broken.append(f"{what}: exit code {code}: {said}")
    return worked_s


def refuse(options, folder, scene, broken, *says):
    code, worked_s, mib, said = ran(options, folder, "gbuffer", scene, "--size", options.size, "-o", "drawn.exr")
    print(f"refused after {worked_s:.1f} CPU seconds, {mib:.0f} MiB: {said}", flush=True)
    if code != 2 or "\n" in said or any(text not in said for text in says) or worked_s > REFUSED_WITHIN_S:
        broken.append(f"{scene}: exit code {code} after {worked_s:.1f} CPU seconds, expected 2 within {REFUSED_WITHIN_S} s and {says}: {said}")


def measure(options, folder, scene, what, broken):
    out = os.path.join(folder, "out")
    sweep(options.program, write(os.path.join(folder, "sizes.toml"), SPEC.format(scene, options.size)), out)
    row, = rows_of(out).values()
    if row["outcome"] != "ok" or int(row["rays"]) < 100 or not row["recall_1px"] or not row["picture_rmse"]:
        broken.append(f"{what}: measured {row['outcome']}, {row['rays']} rays, recall {row['recall_1px']}, error {row['picture_rmse']}")


def add_options(parser):
    parser.add_argument("--triangles", type=int, default=5_000_000)
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--small", action="store_true", help="only what is refused, and the triangles")


def refused(options, folder, broken):
    points = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    refuse(options, folder, gltf(folder, "triangles", [points, 3 * 40_000_001], ((5126, 3, "VEC3"), (5121, 3 * 40_000_001, "SCALAR"))), broken,
           "triangles.gltf", "40000001 triangles", "at most 40000000")
    refuse(options, folder, textured(folder, "wide", 16385, 64), broken, "wide.gltf", "wide.png", "16385x64", "at most 16384 a side")
    refuse(options, folder, surrounded(folder, 16386, 64), broken, "sky.exr", "at most 16384 a side", "16386x64")
    refuse(options, folder, lit(folder, 1025), broken, "lights_1025.gltf", "1025 lights", "at most 1024")
    refuse(options, folder, gltf(folder, "cameras", nodes=[CAMERA] * 100_001), broken, "cameras.gltf", "100001 cameras", "at most 100000")


def run(options, folder):
    broken = []
    refused(options, folder, broken)
    scene, count = waves(folder, options.triangles)
    what = f"{count:,} triangles"
    draw(options, folder, scene, what, broken)
    measure(options, folder, scene, what, broken)
    if options.small:
        return broken, f"5 sizes refused, {what} measured: {len(broken)} promises broken"
    points = struct.pack("<9f", -1, 0, 0, 1, 0, 0, 0, 2, 0)
    shared = gltf(folder, "shared", [points + bytes(12 * 1_999_997), struct.pack("<3I", 0, 1, 2)], ((5126, 2_000_000, "VEC3"), (5125, 3, "SCALAR")), primitives=40)
    draw(options, folder, shared, "40 meshes that share 2,000,000 vertices", broken)
    draw(options, folder, textured(folder, "texture", 16384, 16384), "texture of 16384 x 16384", broken)
    draw(options, folder, surrounded(folder, 16384, 8192), "environment of 16384 x 8192", broken)
    draw(options, folder, lit(folder, 30), "30 lights with shadows", broken)
    times = [draw(options, folder, gltf(folder, f"cameras_{number}", nodes=[CAMERA] * number), f"{number:,} cameras", broken) for number in (1, 8_000, 20_000)]
    if times[2] - times[0] > 4 * (times[1] - times[0]) + 0.5:  # linear: 2.5 times as many take 2.5 times as long
        broken.append(f"1, 8,000 and 20,000 cameras took {times} CPU seconds, which is more than linear")
    return broken, f"5 sizes refused, 8 scenes drawn, {what} measured: {len(broken)} promises broken"

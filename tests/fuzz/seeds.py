"""Where the fuzzer starts: files of the tree, and small ones of each kind that are made here."""
import base64
import glob
import io
import json
import os
import re
import struct

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
FRAME_CONVENTIONS = (
    '[camera]\nfov_y_deg = 60\nnear_m = 0.1\nfar_m = 100\nshift_x_px = 3\nright = [1, 0, 0]\nup = [0, 1, 0]\nforward = [0, 0, -1]\n'
    'position = [1, 2, 3]\n[depth]\nkind = "standard"\n[normals]\nspace = "world"\nunsigned = true\nflip = "xz"\n',
    'reference = "true.exr"\n[camera]\nprojection = "orthographic"\nheight_m = 4\nnear_m = 0.1\nfar_m = 20\n[depth]\nkind = "ray_distance"\n'
    'unit_m = 0.01\nbackground_m = 1e4\n[channels]\ndepth = "Depth.Z"\n"normal.x" = "n.exr:X"\n[values]\nroughness = 0.5\nmetallic = 1\n'
    'base_colour = [1, 0.5, 0]\n')
VIEWS = ('[[view]]\nname = "a"\nposition = [0, 1, 2]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nfov_y_deg = 40\nnear_m = 0.1\nsize = "64x36"\nhard_for = "x"\n'
         '[[view]]\nposition = [0, 1, 2]\ntarget = [0, 0, 0]\nprojection = "orthographic"\nheight_m = 3\nfar_m = 90\n')
TOML = ('a = "é"\nb = """\\\n  x"""\nc = 1979-05-27T07:32:00.5+01:00\nd = 0x1F\ne = -inf\nf."g" = \'\'\'\n\\\'\'\'\n'
        'h = [1, [2.5e3, {i = true}],]\n[[j.k]]\n[j.k.l]\n')
OBJ = ("mtllib model.mtl\nnewmtl red\nKd 1 0 0\nKs 0.5 0.5 0.5\nNs 90\nd 0.4\nillum 2\nKe 0 0 1\nmap_Kd -s 1 1 1 t.png\no box\ng a b\ns 1\nv 0 0 0\nv 1 0 0\n"
       "v 1 1 0\nv 0 1 0 1 0 0\nvt 0 0\nvt 1 1\nvn 0 0 1\nusemtl red\nf 1/1/1 2/2/1 3/1/1 4/2/1\nf 1//1 2//1 -1//1\nl 1 2\np 1\nf 1 2 3\n",
       "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")


def toml_files(*patterns):
    return [path for pattern in patterns for path in sorted(glob.glob(os.path.join(ROOT, pattern), recursive=True))]


def read(path):
    with open(path, "rb") as file:
        return file.read()


def readme_blocks(name, language):
    """Examples in the documents."""
    with open(os.path.join(ROOT, name), encoding="utf-8") as file:
        return [block.encode() for block in re.findall(rf"```{language}\n(.*?)```", file.read(), re.DOTALL)]


def encoded_images():
    """{ending: [bytes]} of small pictures."""
    from PIL import Image
    coloured, found = Image.frombytes("RGBA", (5, 3), bytes(range(60))), {}
    for ending, kind, modes, ways in (("png", "PNG", ("1", "L", "LA", "P", "RGB", "RGBA"), ({},)), ("bmp", "BMP", ("1", "L", "P", "RGB", "RGBA"), ({},)),
                                      ("jpg", "JPEG", ("L", "RGB", "CMYK"), ({}, {"progressive": True})),
                                      ("tga", "TGA", ("L", "LA", "P", "RGB", "RGBA"), ({}, {"compression": "tga_rle"}))):
        pictures = [coloured.convert(mode) for mode in modes]
        if ending == "png":
            pictures.append(Image.frombytes("I;16", (5, 3), bytes(range(30))))
        for picture in pictures:
            for way in ways:
                buffer = io.BytesIO()
                picture.save(buffer, kind, **way)
                found.setdefault(ending, []).append(buffer.getvalue())
    return found


def float_images(folder, ending, size, channels, compressions):
    """Pictures that OpenImageIO writes."""
    import OpenImageIO as oiio
    import numpy
    found = []
    for compression in compressions:
        path = os.path.join(folder, f"seed.{ending}")
        spec = oiio.ImageSpec(size[0], size[1], len(channels), "half" if compression == "piz" else "float")
        spec.channelnames = channels
        if compression:
            spec["compression"] = compression
        output = oiio.ImageOutput.create(path)
        values = numpy.linspace(1, 2, size[0] * size[1] * len(channels), dtype=numpy.float32).reshape(size[1], size[0], len(channels))
        for at, name in enumerate(channels):
            if "normal" in name:
                values[:, :, at] = 1 if name.endswith("Z") else 0
        if not (output and output.open(path, spec) and output.write_image(values) and output.close()):
            raise OSError(f"{path}: {oiio.geterror()}")
        found.append(read(path))
    return found


def gltf_json(png, uri):
    """A scene with nearly everything that the loader reads, and its binary buffer."""
    binary, views, accessors = b"", [], []

    def add(fmt, values, kind=None, component=5126, more=None):
        nonlocal binary
        data = struct.pack("<" + fmt, *values) if fmt else values
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary += data + bytes(-len(data) % 4)
        if kind:
            width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}[kind]
            accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(values) // width, "type": kind, **(more or {})})
            return len(accessors) - 1
        return len(views) - 1

    position = add("12f", (0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0), "VEC3")
    normal = add("12f", (0, 0, 1) * 4, "VEC3")
    uv = add("8H", (0, 0, 65535, 0, 65535, 65535, 0, 65535), "VEC2", 5123, {"normalized": True})
    colour = add("16B", (255, 0, 0, 255) * 4, "VEC4", 5121, {"normalized": True})
    index = add("6H", (0, 1, 2, 0, 2, 3), "SCALAR", 5123)
    times = add("3f", (0, 0.1, 0.2), "SCALAR")
    turns = add("12f", (0, 0, 0, 1, 0, 0.7, 0, 0.7, 0, 0, 0, 1), "VEC4")
    moves = add("9f", (0, 0, 0, 1, 0, 0, 2, 0, 0), "VEC3")
    rows, values = add("1H", (1,)), add("3f", (2, 0, 0))
    accessors.append({"bufferView": accessors[position]["bufferView"], "componentType": 5126, "count": 4, "type": "VEC3", "sparse": {
        "count": 1, "indices": {"bufferView": rows, "componentType": 5123}, "values": {"bufferView": values}}})
    image = add("", png)
    root = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2, 3]}], "extensionsUsed": ["KHR_lights_punctual", "KHR_texture_transform"],
            "nodes": [{"mesh": 0, "rotation": [0, 0, 0, 1], "children": [4]}, {"camera": 0, "translation": [0, 0, 3], "name": "eye"}, {"camera": 1},
                      {"extensions": {"KHR_lights_punctual": {"light": 0}}}, {"mesh": 0, "scale": [1, 2, 1]},
                      {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1, "aspectRatio": 1.5}},
                        {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 10}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": position, "NORMAL": normal, "TEXCOORD_0": uv, "COLOR_0": colour},
                                        "indices": index, "material": 0},
                                       {"attributes": {"POSITION": len(accessors) - 1}, "mode": 5}]}],
            "materials": [{"name": "m", "doubleSided": True, "alphaMode": "MASK", "alphaCutoff": 0.5, "emissiveFactor": [1, 0, 0],
                           "normalTexture": {"index": 0, "scale": 0.5}, "pbrMetallicRoughness": {
                               "baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0.5, "roughnessFactor": 0.5,
                               "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0, 0], "rotation": 1, "scale": [2, 2]}}},
                               "metallicRoughnessTexture": {"index": 0}},
                           "extensions": {"KHR_materials_ior": {"ior": 1.3}, "KHR_materials_emissive_strength": {"emissiveStrength": 2},
                                          "KHR_materials_specular": {"specularFactor": 0.5}, "KHR_materials_clearcoat": {"clearcoatFactor": 1}}}],
            "textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 33071, "wrapT": 33648}],
            "images": [{"bufferView": image, "mimeType": "image/png"}],
            "animations": [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}},
                                         {"sampler": 1, "target": {"node": 1, "path": "translation"}}],
                            "samplers": [{"input": times, "output": turns, "interpolation": "LINEAR"},
                                         {"input": times, "output": moves, "interpolation": "STEP"}]}],
            "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "color": [1, 1, 1], "intensity": 5, "range": 9,
                                                               "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.5}}]}},
            "buffers": [{"byteLength": len(binary)}], "bufferViews": views, "accessors": accessors}
    if uri:
        root["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    return root, binary


def gltf_files(png):
    text = json.dumps(gltf_json(png, True)[0], separators=(",", ":")).encode()
    root, binary = gltf_json(png, False)
    chunk = json.dumps(root, separators=(",", ":")).encode()
    chunk += b" " * (-len(chunk) % 4)
    binary += bytes(-len(binary) % 4)
    glb = struct.pack("<4sIIII", b"glTF", 2, 28 + len(chunk) + len(binary), len(chunk), 0x4E4F534A) + chunk
    glb += struct.pack("<II", len(binary), 0x004E4942) + binary
    small = b'{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}]}'
    return [text, glb, small]


MANIFESTS = {"technique_manifest": ("techniques/*/technique.toml", "techniques/rivals/*/technique.toml"),
             "structure_manifest": ("techniques/**/structure.toml",),
             "surface_manifest": ("shaders/surfaces/*/surface.toml",), "reprojection_manifest": ("techniques/**/reprojection.toml",),
             "experiment": ("experiments/*.toml",), "recipe": ("experiments/scenes/*.toml",)}


def seeds_of(target, folder):
    """The files from which the target's inputs grow, as bytes."""
    if target == "toml":
        return [read(path) for patterns in MANIFESTS.values() for path in toml_files(*patterns)] + [TOML.encode()]
    if target in MANIFESTS:
        examples = {"recipe": "experiments/scenes/README.md", "experiment": "docs/how-to/experiments.md"}
        return [read(path) for path in toml_files(*MANIFESTS[target])] + (readme_blocks(examples[target], "toml") if target in examples else [])
    if target == "views":
        return [VIEWS.encode()]
    if target == "frame_convention":
        return [text.encode() for text in FRAME_CONVENTIONS]
    if target == "obj":
        return [text.encode() for text in OBJ]
    if target == "environment_hdr":
        return float_images(folder, "hdr", (16, 8), ["R", "G", "B"], [None]) + [b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\nabcdabcd"]
    if target == "environment_exr":
        return float_images(folder, "exr", (4, 2), ["R", "G", "B"], ["none", "zip", "rle", "piz", "pxr24", "b44"])
    if target == "frame":
        return float_images(folder, "exr", (4, 3), ["depth.Z", "normal.X", "normal.Y", "normal.Z", "object_id"], ["none", "zip", "rle", "piz", "dwaa"])
    if target == "gltf":
        return gltf_files(encoded_images()["png"][4])
    if target == "image":
        return [data for kind in encoded_images().values() for data in kind]
    raise KeyError(target)


def dictionary_of(seeds):
    """The words of texts, as libFuzzer reads them."""
    words = set()
    for seed in seeds:
        words.update(re.findall(rb'[A-Za-z_][A-Za-z_0-9.]{2,30}', seed))
    return "".join(f'"{word.decode()}"\n' for word in sorted(words)[:1500])

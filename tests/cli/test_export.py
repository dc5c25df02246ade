"""ssrlab export: techniques as shaders for an engine, and the proof in their folder."""
import csv
import glob
import json
import os
import re
import shlex
import shutil
import struct
import subprocess
import sys

from support import Case, main, read

SWIFTSHADER = "/usr/lib/chromium/vk_swiftshader_icd.json"

OWN = {
    "technique.toml": 'name = "Two stops"\nsummary = "Looks at the middle and at the end."\nexact = false\n'
                      'structures = ["own_rows"]\nbounded_by = ["looks"]\nlimits = ["point_sampled"]\n'
                      "[parameters]\nlooks = { default = 12, min = 1, max = 64, doc = \"Samples.\" }\n",
    "trace.glsl": '#include "api/sampling.glsl"\n'
                  "#define STOP(i) (real(i) / real(looks))\n"
                  "TraceResult trace(Ray ray)\n{\n"
                  "    Contact contact = no_contact();\n    int taken = 0;\n"
                  "    while (!contact.found && taken < looks)\n    {\n        ++taken;\n"
                  "        ivec2 pixel = pixel_at(ray, STOP(taken));\n"
                  "        bool  empty = row_is_empty(pixel.y);\n"
                  "        if (!empty && pixel != ray.start_pixel) contact = test_sample(ray, pixel, STOP(taken));\n"
                  "    }\n    return contact.found ? hit(ray, contact, taken) : miss(ray, taken);\n}\n",
    "own_rows/structure.toml": 'name = "Rows"\nsummary = "Which tiles have a surface."\n'
                               '[buffers]\nfilled = { per = "tile", tile_px = 8, type = "uint" }\n'
                               '[[passes]]\nshader = "build.comp"\nper = "tile"\ntile_px = 8\n',
    "own_rows/build.comp": '#include "api/view.glsl"\n#include "api/slab.glsl"\n#include "structure/parameters"\n'
                           '#include "structure/buffers"\nlayout(local_size_x = 8, local_size_y = 8) in;\n'
                           "void main()\n{\n    ivec2 tile = ivec2(gl_GlobalInvocationID.xy), tiles = (size_px - 1) / 8 + 1;\n"
                           "    if (any(greaterThanEqual(tile, tiles))) return;\n"
                           "    uint filled = 0;\n"
                           "    for (int i = 0; i < 64; ++i)\n    {\n"
                           "        ivec2 pixel = min(8 * tile + ivec2(i % 8, i / 8), size_px - 1);\n"
                           "        filled |= uint(depth_in(load_cell(pixel, 0), pixel) > 0.0);\n    }\n"
                           "    store_filled(tile_index(8 * tile, 8), filled);\n}\n",
    "own_rows/read.glsl": "bool row_is_empty(int y)\n{\n    uint any_filled = 0;\n"
                          "    for (int x = 0; x < size_px.x; x += 8) any_filled |= load_filled(tile_index(ivec2(x, y), 8));\n"
                          "    count_fetch(STRUCTURE_own_rows);\n    return any_filled == 0;\n}\n",
}


class Test(Case):
    def export(self, technique, language, *more, folder=None):
        folder = folder or self.path(f"{technique}_{language}")
        self.ssrlab("--quiet", "export", technique, "--to", language, "-o", folder, "--size", "64x36", *more)
        return folder

    def test_a_frame_file_has_its_own_size(self):
        self.ssrlab("gbuffer", "builtin:stairs", "--size", "48x27", "-o", "frame.exr")
        self.ssrlab("--quiet", "export", "dda", "--to", "glsl", "--scene", "frame.exr", "-o", "out")
        with open(self.path("out/README.md"), encoding="utf-8") as file:
            said = file.read()
        self.assertIn("d == 0 ? 0 : d * (1 - n / f) + n / f", said)
        self.assertNotIn("dielectric_", said)
        self.assertRegex(self.ssrlab("export", "--verify", "out"), r"scene: 0 of [1-9]\d* rays differ")

    def verified(self, folder, code=0, **environment):
        """The rays of each frame that differ, and all that was said."""
        said = self.ssrlab("export", "--verify", folder, code=code, **environment)
        found = re.findall(r"^(\w+): (\d+) of (\d+) rays differ", said, re.M)
        self.assertEqual({name for name, _, _ in found},
                         {os.path.basename(path)[:-5] for path in glob.glob(f"{folder}/frames/*.json")}, said)
        for _, _, rays in found:
            self.assertGreater(int(rays), 0, said)
        return {name: int(differing) for name, differing, _ in found}, said

    def assert_equal_on_every_ray(self, folder, **environment):
        differing, said = self.verified(folder, **environment)
        self.assertEqual(set(differing.values()), {0}, said)
        self.assertGreaterEqual(len(differing), 4, said)
        self.assertIn("0 are set up otherwise", said)

    def check_language(self, language):
        for technique, surface in (("linear", "box"), ("dda", "plane"), ("hiz", "box"), ("hiz", "plane")):
            with self.subTest(technique=technique, surface=surface):
                folder = self.export(technique, language, "-p", f"surface={surface}",
                                     folder=self.path(f"{technique}_{surface}_{language}"))
                self.assert_equal_on_every_ray(folder)

    def test_glsl_answers_as_the_lab_does(self):
        self.check_language("glsl")

    def test_hlsl_answers_as_the_lab_does(self):
        self.check_language("hlsl")

    def test_hlsl_binds_as_d3d12_allows(self):
        for technique in ("hiz", "hiz_waves"):
            folder = self.export(technique, "hlsl")
            said = read(folder, "README.md")
            self.assertIn("Neither DXC nor D3D12", said)
            for step in json.loads(read(folder, "frames", "scene.json"))["passes"]:
                text = read(folder, step["file"])
                self.assertNotIn("RWTexture2D", text) # images are only read
                registers = {number: kind + number for kind, number in re.findall(r": register\(([tub])(\d+), space0\)", text)}
                places = {}
                for number, resource in step["bindings"].items():
                    places.setdefault(resource, []).append(registers[number])
                    self.assertIn(f"{registers[number]} `{resource.replace('made_count', 'ray_count').replace('made_rays', 'rays')}`", said)
                for resource, at in places.items():
                    self.assertTrue(len(at) == 1 or all(one[0] == "t" for one in at), f"{step['file']}: {resource} is {at}")

    def test_ray_packets_and_a_second_driver(self):
        for language in ("glsl", "hlsl"):
            folder = self.export("hiz_waves", language)
            self.assert_equal_on_every_ray(folder)
            if os.path.exists(SWIFTSHADER):
                self.assert_equal_on_every_ray(folder, VK_ICD_FILENAMES=SWIFTSHADER)

    def test_wgsl_answers_as_the_lab_does(self):
        folder = self.export("hiz", "wgsl")
        trace = read(folder, "4_trace.wgsl")
        self.assertIn("fn strip_index(", trace)
        self.assertNotRegex(trace, r"if (true|false) ")
        self.assertIn("var<storage, read> ", trace)
        self.assertLessEqual(len(read(folder, "run.js").splitlines()), 150)

        frame = json.loads(read(folder, "frames", "scene.json"))
        path = os.path.join(folder, "expected", "scene.bin")
        words = list(struct.unpack(f"<{2 * frame['rays']}I", self.bytes(path)))
        first = next(i for i in range(0, len(words), 2) if words[i] >> 28 == 1)
        words[first + 1] += 1 # the next larger t
        with open(path, "wb") as file:
            file.write(struct.pack(f"<{len(words)}I", *words))
        differing, said = self.verified(folder)
        self.assertEqual((differing["scene"], sum(differing.values())), (1, 1), said)
        self.assertGreaterEqual(len(differing), 4)
        self.assertIn("0 are set up otherwise", said)
        self.assertRegex(said, r"ray \d+ of pixel \(\d+, \d+\): .* px apart: rounding\)")

        for other in set(glob.glob(f"{folder}/frames/*.json")) - {os.path.join(folder, "frames", "scene.json")}:
            os.remove(other)
        path = os.path.join(folder, "4_trace.wgsl")
        self.write(path, re.sub(r"@workgroup_size\(64, 1, 1\)", "@workgroup_size(32, 1, 1)", trace))
        differing, said = self.verified(folder, code=1)
        self.assertGreater(differing["scene"], 100, said)
        self.write(path, trace + "no WGSL")
        self.ssrlab("export", "--verify", folder, code=1, says=["4_trace.wgsl:"])

    def test_hard_cases_in_wgsl(self):
        case = ("--quiet", "export", "hiz", "--to", "wgsl", "--hard-cases", "--case", "axis_aligned")
        said = self.ssrlab(*case)
        rays, = re.findall(r"^axis_aligned: 0 of (\d+) rays differ$", said, re.M)
        self.assertGreater(int(rays), 50, said)
        self.assertRegex(said, rf"(?m)^0 of {rays} answers differ on .+")
        # The host's answers changed: the first hit of the first setup lies two pixels beside the right one.
        node = self.write("bin/node", f"#!/bin/sh\n{shlex.quote(shutil.which('node'))} \"$@\" && {shlex.quote(sys.executable)} {self.path('falsify.py')} \"$2\"\n")
        os.chmod(node, 0o755)
        self.write("falsify.py", "import os, struct, sys\npath = sys.argv[1] + '/0.case.hits.bin'\n"
                   "if os.path.exists(path):\n    words = list(struct.unpack(f'<{os.path.getsize(path) // 4}I', open(path, 'rb').read()))\n"
                   "    words[next(i for i in range(0, len(words), 2) if words[i] >> 28 == 1)] ^= 2\n"
                   "    open(path, 'wb').write(struct.pack(f'<{len(words)}I', *words))\n")
        said = self.ssrlab(*case, code=1, PATH=self.path("bin") + ":" + os.environ["PATH"])
        self.assertIn(f"axis_aligned: 1 of {rays} rays differ", said)
        self.assertRegex(said, r"ray \d+ of pixel \(\d+, \d+\): hit .*, expected hit .* \(unexplained\)")

    def test_hard_cases_list_every_answer_that_differs(self):
        # The host's answers changed: twelve hits, by their pixel, and the depth of a ray, which moves nothing in the image.
        node = self.write("bin/node", f"#!/bin/sh\n{shlex.quote(shutil.which('node'))} \"$@\" && {shlex.quote(sys.executable)} {self.path('falsify.py')} \"$2\"\n")
        os.chmod(node, 0o755)
        self.write("falsify.py", "import os, struct, sys\n"
                   "def change(what, changed):\n    path = f'{sys.argv[1]}/0.case.{what}.bin'\n    if not os.path.exists(path): return\n"
                   "    words = list(struct.unpack(f'<{os.path.getsize(path) // 4}I', open(path, 'rb').read()))\n    changed(words)\n"
                   "    open(path, 'wb').write(struct.pack(f'<{len(words)}I', *words))\n"
                   "def hits(words):\n    for i in [i for i in range(0, len(words), 2) if words[i] >> 28 == 1][:12]: words[i] ^= 2\n"
                   "def depth(words):\n    words[2] += 1 << 20\n"
                   "change('hits', hits)\nchange('made_rays', depth)\n")
        folder = self.path("tables")
        said = self.ssrlab("--quiet", "export", "dda", "--to", "wgsl", "--hard-cases", "--case", "contact_points", "-o", folder, code=1,
                           PATH=self.path("bin") + ":" + os.environ["PATH"])
        self.assertEqual(len(re.findall(r"expected", said)), 10, said)
        with open(os.path.join(folder, "differing.csv"), encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        traced = [row for row in rows if row["ray"] != "set-up"]
        self.assertEqual([(row["values"], row["cause"]) for row in traced], [("pixel", "unexplained")] * 12)
        wrong, = (row for row in rows if row["ray"] == "set-up" and row["cause"] == "unexplained")
        self.assertEqual((wrong["values"].split()[0], float(wrong["apart_px"]) < 0.05), ("depth", True))
        with open(os.path.join(folder, "setups.csv"), encoding="utf-8", newline="") as file:
            first = next(csv.DictReader(file))
        self.assertEqual((first["case"], first["rays_differing"], first["unexplained"]), ("contact_points", "12", "13"))
        self.assertEqual(int(first["set_ups_differing"]), sum(row["ray"] == "set-up" and row["setup"] == first["setup"] for row in rows))

    def test_wgsl_without_its_translator(self):
        os.makedirs(self.path("bin"))
        for program in ("glslangValidator", "spirv-opt"):
            os.symlink(shutil.which(program), self.path(f"bin/{program}"))
        said = self.ssrlab("export", "dda", "--to", "wgsl", "-o", self.path("out"), "--size", "64x36", code=1,
                           PATH=self.path("bin"))
        self.assertIn("node is not installed: install Debian's package nodejs", said)

    def test_glsl_is_plain(self):
        folder = self.export("hiz", "glsl", "-p", "max_steps=77")
        files = sorted(glob.glob(f"{folder}/*.comp"))
        self.assertEqual([os.path.basename(path) for path in files],
                         ["1_depth.comp", "2_depth_pyramid_level.comp", "3_rays.comp", "4_trace.comp"])
        for path in files:
            text = read(path)
            for absent in ("#include", "#if", "##", "constant_id", "push_constant", "scalar"):
                self.assertNotIn(absent, text, path)
            done = subprocess.run(["glslangValidator", "-V", path, "-o", self.path("out.spv")], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, f"{path}: {done.stdout}")
        trace = read(folder, "4_trace.comp")
        self.assertIn("const int max_steps = 77;", trace)
        self.assertIn("TraceResult trace(Ray ray)", trace)
        self.assertNotIn("stride_to_t", trace) # of the API, and not used here
        readme = read(folder, "README.md")
        for told in ("max_steps = 77", "--to glsl", "host_depth", "## Licence"):
            self.assertIn(told, readme)

    def test_a_number_stays_a_constant_of_the_pipeline(self):
        folder = self.export("dda", "glsl", "--keep", "max_steps")
        self.assertRegex(read(folder, "3_trace.comp"), r"layout\(constant_id = \d+\) const int max_steps = 60000;")
        self.assert_equal_on_every_ray(folder)
        ways = {"glsl": (r"layout\(constant_id = {}\) const int steps = 40;", "`constantID = {}` of"),
                "hlsl": (r"#define SPIRV_CROSS_CONSTANT_ID_{} 40", "`-D SPIRV_CROSS_CONSTANT_ID_{}=VALUE`"),
                "msl": (r"constant int steps_tmp \[\[function_constant\({}\)\]\];", "atIndex:{}`"),
                "essl": (r"#define SPIRV_CROSS_CONSTANT_ID_{} 40", "`#define SPIRV_CROSS_CONSTANT_ID_{} VALUE`"),
                "wgsl": (r"@id\({}\) override steps\w*: i32 = 40i;", "`constants: {{ {}: VALUE }}`")}
        for language, (declared, told) in ways.items():
            folder = self.export("linear", language, "-p", "steps=40", "--keep", "steps", folder=self.path(f"kept_{language}"))
            said = read(folder, "README.md")
            constant, = re.findall(r"^\| `steps` \| (\d+) \| int \| 40 \| 1 to 60000 \| `", said, re.M)
            self.assertIn(told.format(constant), said)
            self.assertIn("constants, but for those that the host sets", said)
            self.assertIn("- steps = 40, unless the host sets it", said)
            trace, = glob.glob(f"{folder}/3_trace.*")
            self.assertRegex(read(trace), declared.format(constant))
        folder = self.export("dda", "wgsl", "--keep", "max_steps")
        self.assertRegex(read(folder, "3_trace.wgsl"), r"@id\(\d+\) override max_steps\w*: i32 = 60000i;")
        self.refused("export", "dda", "--to", "glsl", "-o", self.path("out"), "--keep", "arithmetic", code=2,
                     says=["--keep arithmetic: expected a number among the parameters of dda"])

    def test_a_wrong_shader_is_found(self):
        folder = self.export("dda", "glsl")
        path = os.path.join(folder, "3_trace.comp")
        text = read(path)
        self.assertEqual(text.count("t_border.x < t_border.y ?"), 1)
        self.write(path, text.replace("t_border.x < t_border.y ?", "t_border.x > t_border.y ?"))
        differing, said = self.verified(folder, code=1)
        self.assertGreater(sum(differing.values()), 0)
        self.assertRegex(said, r"ray \d+ of pixel \(\d+, \d+\): .*, expected ")

    def test_inputs_of_another_size_are_refused(self):
        folder = self.export("hiz", "glsl")
        path = os.path.join(folder, "frames", "scene.json")
        text = read(path)
        frame = json.loads(text)
        bytes_of = {name: resource["bytes"] for name, resource in frame["resources"].items()}
        for file, expected in ((f"{folder}/frames/scene.rays.bin", bytes_of["rays"]), (f"{folder}/frames/scene.normals.bin", bytes_of["normals"]),
                               (f"{folder}/expected/scene.bin", 8 * frame["rays"])):
            right = self.bytes(file)
            self.assertEqual(len(right), expected)
            for wrong in (right[:100], right[:-1], right + b"0000"):
                with open(file, "wb") as changed:
                    changed.write(wrong)
                self.refused("export", "--verify", folder, code=2,
                             says=[f"{os.path.relpath(file, folder)}: {len(wrong)} bytes, expected {expected}"])
            with open(file, "wb") as changed:
                changed.write(right)
        for name, expected in bytes_of.items():
            self.write(path, re.sub(rf'("{name}": {{[^}}]*"bytes": )\d+', r"\g<1>96", text))
            self.refused("export", "--verify", folder, code=2, says=[f"scene.json: 96 bytes of '{name}', expected {expected}"])
        for change in ({"rays": frame["rays"] - 1}, {"size_px": [64, 35]}, {"size_px": [64, 0]}):
            self.write(path, json.dumps(frame | change))
            self.refused("export", "--verify", folder, code=2, says=["expected"])
        self.write(path, text)
        self.verified(folder)

    def test_the_proof_holds_the_depth_of_the_host(self):
        near = (" && depth <= 1.0", ""), ("depth <= 1.0", "depth <= 0.5")
        # A traversal of the pyramid never tests cells of depth 0 or less, so these change none of its answers.
        sky = ("depth > 0.0 && ", ""), ("BACKGROUND_DEPTH -1", "BACKGROUND_DEPTH 0")
        for technique, surface, changes in (("hiz", "box", near), ("hiz", "plane_solid", near), ("linear", "box", near),
                                            ("dda", "box", near + sky), ("dda", "plane", near + sky)):
            folder = self.export(technique, "glsl", "-p", f"surface={surface}", "-p", "thickness_m=0.3", "-p", "max_distance_m=5",
                                 "--near", "0.1", folder=self.path(f"{technique}_{surface}"))
            self.assert_equal_on_every_ray(folder)
            path = os.path.join(folder, "1_depth.comp")
            text = read(path)
            for right, wrong in changes:
                with self.subTest(technique=technique, surface=surface, wrong=f"{right} -> {wrong}"):
                    self.assertEqual(text.count(right), 1)
                    self.write(path, text.replace(right, wrong))
                    differing, said = self.verified(folder, code=1)
                    self.assertGreater(differing["host_depth"], 0, said)

    def test_a_technique_of_ones_own(self):
        for name, text in OWN.items():
            self.write(f"own/{name}" if not name.startswith("own_rows") else f"own_structures/{name}", text)
        more = ("--techniques", self.path("own"), "--techniques", self.path("own_structures"))
        for language in ("glsl", "hlsl"):
            self.assert_equal_on_every_ray(self.export("own", language, *more))
        self.verified(self.export("own", "wgsl", *more)) # equal but for rounding
        self.assertNotIn("STOP(", read(self.path("own_glsl"), "4_trace.comp"))

    def test_languages_that_are_not_run(self):
        for language, ending, holds in (("msl", "metal", "kernel void main0"), ("essl", "essl", "#version 310 es")):
            folder = self.export("hiz", language)
            files = glob.glob(f"{folder}/*.{ending}")
            self.assertEqual(len(files), 4)
            for path in files:
                self.assertIn(holds, read(path))
                self.assertNotRegex(read(path), r"if \((true|false)\)")
            self.refused("export", "--verify", folder, code=2, says=["other languages are not run"])

    def test_wrong_usage(self):
        self.refused("export", code=2, says=["expected a technique"])
        self.refused("export", "dda", "-o", self.path("out"), code=2, says=["--to: expected glsl, hlsl"])
        self.refused("export", "dda", "--to", "glsl", code=2, says=["-o: expected a folder"])
        self.refused("export", "nothing", "--to", "glsl", "-o", self.path("out"), code=2, says=["nothing"])
        self.refused("export", "dda", "--to", "glsl", "-o", self.path("out"), "-p", "layers=2", code=2, says=["layers = 2"])
        self.refused("export", "--verify", self.path("none"), code=2, says=["no export"])
        self.refused("export", "dda", "--to", "msl", "--hard-cases", code=2, says=["glsl, hlsl or wgsl"])
        self.refused("export", "dda", "--to", "wgsl", "--hard-cases", "--case", "axis_alined", code=2, says=["axis_aligned"])
        self.refused("export", "dda", "--to", "wgsl", "-o", self.path("out"), "-p", "arithmetic=exact", code=2, says=["64-bit"])
        self.ssrlab("export", "dda", "--to", "spirv", "-o", self.path("out"), code=2, says=["spirv"])
        self.assertFalse(os.path.exists(self.path("out")), "what was refused")
        os.makedirs(self.path("bin"))
        os.makedirs(self.path("empty"))
        for folder in ("out", "empty"): # spirv-opt is missing: the first passes were already written
            self.refused("export", "dda", "--to", "hlsl", "-o", self.path(folder), "--size", "64x36", code=1, says=["spirv-opt"],
                         PATH=self.path("bin"))
        self.assertFalse(os.path.exists(self.path("out")))
        self.assertEqual(os.listdir(self.path("empty")), [])
        self.write("full/file", "")
        self.refused("export", "dda", "--to", "glsl", "-o", self.path("full"), code=2, says=["new or empty folder"])
        folder = self.export("dda", "glsl")
        shutil.copy(os.path.join(folder, "frames", "scene.json"), self.path("kept"))
        frame = json.loads(read(self.path("kept")))
        del frame["resources"]["rays"]
        self.write("dda_glsl/frames/scene.json", json.dumps(frame))
        self.refused("export", "--verify", folder, code=2, says=["scene.json"])


if __name__ == "__main__":
    main()

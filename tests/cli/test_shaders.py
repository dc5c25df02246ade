"""ssrlab shaders and the bytes of a plan: what Mesa's compiler for AMD GPUs makes of each pass, without a GPU, and what the compiler reads of a technique."""
import json
import os
import re

from support import SOURCE, Case, main

TECHNIQUES = ("hiz", "hiz_packets", "hiz_waves", "dda", "linear")


class Test(Case):
    def compiled(self, *arguments):
        return json.loads(self.ssrlab("--quiet", "shaders", *arguments, "--json"))["pipelines"]

    def trace_of(self, pipelines, technique):
        found = [one for one in pipelines
                 if technique in one["techniques"] and one["shader"].startswith("trace/trace")]
        self.assertEqual(len(found), 1, [one["shader"] for one in pipelines])
        return found[0]

    def assert_plausible(self, pipeline):
        said = pipeline["statistics"]
        for name in ("VGPRs", "SGPRs", "Subgroups per SIMD", "Code size", "Instructions"):
            self.assertGreater(said[name], 0, f"{name} of {pipeline}")
        for name in ("Spilled VGPRs", "Spilled SGPRs"):
            self.assertEqual(said[name], 0, f"{name} of {pipeline}")
        self.assertIn(pipeline["lanes"], (32, 64))

    def test_every_technique_on_navi21(self):
        self.need_amd()
        pipelines = self.compiled(*TECHNIQUES, "--chip", "navi21")
        for pipeline in pipelines:
            self.assert_plausible(pipeline)
        for technique in TECHNIQUES:
            loop = self.trace_of(pipelines, technique)["innermost_loop"]
            self.assertGreater(loop["loads"], 0, technique)
            self.assertLess(loop["loads"], loop["instructions"])
        self.assertEqual(self.trace_of(pipelines, "hiz_packets")["shader"], "trace/trace_pairs.comp")
        for technique in ("hiz", "hiz_packets", "hiz_waves"):
            self.assertEqual(self.trace_of(pipelines, technique)["invocations_a_group"], 64)
        shared = [one for one in pipelines if one["shader"] == "rays/rays.comp"]
        self.assertEqual([one["techniques"] for one in shared], [list(TECHNIQUES)])
        pyramid = [one for one in pipelines if one["shader"] == "depth_pyramid/levels.comp"]
        self.assertEqual([one["techniques"] for one in pyramid], [["hiz", "hiz_packets", "hiz_waves"]])

    def test_table_and_assembly(self):
        self.need_amd()
        text = self.ssrlab("shaders", "linear", "--chip", "navi21", "--assembly", "code", says=["NAVI21", "| linear |"])
        pipelines, frame = text.split("\nA pixel of a 1920x1080 frame")
        rows = [line.split("|")[1:-1] for line in pipelines.splitlines() if line.startswith("|")]
        self.assertEqual({len(row) for row in rows}, {14}, text)
        written = sorted(os.listdir(self.path("code")))
        self.assertEqual(len(written), len(rows) - 2)
        trace = [name for name in written if name.endswith("linear_trace.comp.s")]
        self.assertIn("s_endpgm", self.text(f"code/{trace[0]}"))

    def test_bytes_and_instructions_of_a_frame(self):
        self.need_amd()
        text = self.ssrlab("shaders", "linear", "--chip", "navi21", "--bandwidth-gbps", "1000", "-p", "gloss=off")
        rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in text.split("A pixel of a")[1].splitlines() if line.startswith("|")]
        self.assertEqual(rows[0], ["technique", "pass", "instructions", "bytes read", "bytes written", "least µs at 1000 GB/s"])
        passes = {name: [float(number) for number in numbers] for _, name, *numbers in rows[2:]}
        self.assertEqual(list(passes), ["classification", "rays", "trace", "hit_colour", "composite", "frame"])
        # By the formats: four images of light and the material 8, the normal 16, depth and reflectance 4.
        self.assertEqual(passes["composite"][1:], [64, 8, round(72 * 1920 * 1080 / 1e6, 1)])
        self.assertEqual(passes["trace"][2], 8)
        for column in range(4):
            self.assertAlmostEqual(passes["frame"][column], sum(numbers[column] for name, numbers in passes.items() if name != "frame"), delta=0.5)
        self.assertGreater(passes["trace"][0], 100)
        frame, = json.loads(self.ssrlab("--quiet", "shaders", "linear", "--chip", "navi21", "-p", "gloss=off", "--json"))["frames"]
        self.assertEqual(frame["passes"][-1]["bytes_read_a_pixel"], 64)

    def test_bytes_of_a_planned_frame(self):
        text = self.ssrlab("plan", "builtin:corridor", "--size", "64x36", "-t", "linear", "--repeats", "1", "-p", "pass_set=shading", "--bandwidth-gbps", "0.001")
        head = next(line for line in text.splitlines() if line.startswith("pass "))
        self.assertRegex(head, r"planned ms +unculled ms +MB read +MB written +least ms +why")
        rays = int(re.search(r"(\d+) of 2304 pixels reflect", text)[1])
        of = {line.split()[0]: line.split() for line in text.splitlines() if " run " in line}
        read, written = 24 * 2304 + 40 * rays, 8 * 2304
        self.assertEqual(of["composite"][4:7], [f"{read / 1e6:.2f}", f"{written / 1e6:.2f}", f"{(read + written) / 1e3:.4f}"])
        self.ssrlab("plan", "builtin:corridor", "--bandwidth-gbps", "0", code=2, says=["--bandwidth-gbps"])

    def test_settings_and_other_chips(self):
        self.need_amd()
        default = self.trace_of(self.compiled("hiz", "--chip", "navi10"), "hiz")
        box = self.trace_of(self.compiled("hiz", "--chip", "navi10", "-p", "surface=box", "-p", "behind=hit"), "hiz")
        self.assertLess(box["statistics"]["Code size"], default["statistics"]["Code size"])
        for chip in ("vega10", "gfx1100"):
            self.assert_plausible(self.trace_of(self.compiled("hiz", "--chip", chip), "hiz"))

    def test_the_commit_is_named(self):
        self.need_amd()
        said = json.loads(self.ssrlab("--quiet", "shaders", "linear", "--chip", "navi21", "--json"))
        self.assertRegex(said["commit"], r"^[0-9a-f]{40}( with changes)?$|^not known$")

    def test_a_technique_from_outside(self):
        self.need_amd()
        folder = os.path.join(SOURCE, "techniques", "rivals")
        pipelines = self.compiled("unity_hiz", "--techniques", folder, "--chip", "navi21")
        self.assert_plausible(self.trace_of(pipelines, "unity_hiz"))

    def test_refusals(self):
        self.need_amd()
        self.refused("shaders", "hiz", "--chip", "navi2", code=2, says=["--chip", "'navi2'", "navi21"])
        self.refused("shaders", "hizz", "--chip", "navi21", code=2, says=["hizz", "'hiz'"])
        self.refused("shaders", "hiz", "--chip", "navi21", "-p", "steps=3", code=2, says=["steps"])
        self.refused("shaders", "hiz", "--device", "llvmpipe", code=1, says=["llvmpipe", "VK_KHR_pipeline_executable"])

    # Of code, without comments and empty lines: all that has to be read to understand a technique.
    MOST_LINES = {"dda": 450, "hiz": 600}

    def files_of(self, technique, *arguments):
        """(lines in all, {file: lines}) of the technique."""
        text = self.ssrlab("--quiet", *arguments, "shaders", technique, "--files")
        head, rest = re.fullmatch(rf"{technique}: (.*?\n)(.*)", text.split("ray set-up")[0], re.S).groups()
        rows = [(name, int(lines)) for lines, name in re.findall(r"^ +(\d+)  (.+)$", rest, re.M)]
        files = dict(rows)
        self.assertEqual(len(files), len(rows), text)
        self.assertEqual(head, f"{sum(files.values())} lines of code in {len(files)} files\n")
        return sum(files.values()), files

    def test_what_an_author_has_to_read_stays_short(self):
        for technique, most in self.MOST_LINES.items():
            lines, files = self.files_of(technique)
            self.assertLessEqual(lines, most, files)
            self.assertIn(f"techniques/{technique}/trace.glsl", files)
            self.assertIn("shaders/surfaces/plane/meeting.glsl", files)
        self.assertIn("techniques/structures/depth_pyramid/make_cells.glsl", files)

    def test_lines_of_code_are_counted(self):
        self.write("mine/none/technique.toml", 'name = "None"\nsummary = "Misses."\n')
        self.write("mine/none/part.glsl", "/* not\n   this */\nconst int one = 1; // but this\n")
        self.write("mine/none/trace.glsl", '#include "part.glsl"\n\n// Nothing.\nTraceResult trace(Ray ray) { return miss(ray, one); }\n')
        lines, files = self.files_of("none", "--techniques", "mine")
        own = {os.path.basename(name): count for name, count in files.items() if "none" in name}
        self.assertEqual(own, {"trace.glsl": 2, "part.glsl": 1})
        self.assertLess(lines, self.files_of("dda")[0])


if __name__ == "__main__":
    main()

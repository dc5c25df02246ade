"""The hits of a renderer, judged: what a run measures of them, and exit codes for a CI."""
import json
import os
import re
import shlex
import shutil

from support import SOURCE, Case, main, read

PAGE = "docs/how-to/judge_a_renderer.md"

SPEC = """scenes = ["builtin:corridor"]
sizes  = ["160x90"]
[trace]
max_distance_m = 20
[techniques.hiz]
[techniques.linear]
steps = 24
[measure]
min_repeats = 1
max_repeats = 1
double_twin = false
pictures = false
image_errors = false
"""


class Test(Case):
    def setUp(self):
        super().setUp()
        self.ssrlab("gbuffer", "builtin:corridor", "--size", "160x90", "-o", "frame.exr")

    def trace(self, technique, *pairs, scene="frame.exr"):
        settings = [word for pair in ("max_distance_m=20",) + pairs for word in ("-p", pair)]
        self.ssrlab("trace", scene, "-t", technique, *settings, "-o", "hits.exr")

    def judged(self, *arguments, code=0):
        return json.loads(self.ssrlab("judge", "frame.exr", "hits.exr", "--json", *arguments, code=code))

    def test_has_the_measures_of_a_run(self):
        self.ssrlab("run", self.write("s.toml", SPEC), "-o", "out")
        rows = {row["technique"]: row for row in self.rows()}
        with open(self.path("out/environment.json"), encoding="utf-8") as file:
            settings = json.load(file)["pass_parameters"].split()
        for technique, pairs in (("hiz", ()), ("linear", ("steps=24",))):
            self.trace(technique, *pairs)
            judged = self.judged("--scene", "builtin:corridor")
            row, measures = rows[technique], judged["measures"]
            self.assertGreater(len(measures), 50)
            for name, value in measures.items():
                if "displacement" in name:  # the file rounds hit points to float
                    self.assertAlmostEqual(value, float(row[name]), delta=1e-4, msg=name)
                else:
                    self.assertEqual(f"{value:.6g}", row[name], f"{technique} {name}")
            lacking = [name for name in row if row[name] and name.startswith(("screen_", "wrong_", "recall", "missed", "false_", "truth_v", "f1_"))
                       and name not in measures and name not in settings]
            self.assertEqual(lacking, [])
            self.assertEqual(f"{judged['f1']:.6g}", row["f1_1px"])
            self.assertEqual(f"{self.judged()['f1']:.6g}", row["screen_f1_1px"])
        self.assertGreater(float(rows["linear"]["wrong_rays"]), 0)

    def test_exact_hits_are_right_and_others_are_named(self):
        self.trace("hiz")
        self.assertEqual((self.judged()["wrong"], self.judged()["settings"]), (0, ["max_distance_m=20"]))
        self.ssrlab("judge", "frame.exr", "hits.exr", "--min-f1", "1", says=["0 wrong", "F1 1 against the screen truth, at least 1: passes"])
        self.trace("linear", "steps=8")
        judged = self.judged("--min-f1", "0.95", code=1)
        self.assertFalse(judged["passed"])
        self.assertEqual(sum(judged["by_contract"].values()), judged["rays"])
        self.assertEqual(len(judged["findings"]), judged["wrong"])
        self.assertEqual({"pixel", "fault", "expected", "got", "why"}, set(judged["findings"][0]))
        self.ssrlab("judge", "frame.exr", "hits.exr", "--scene", "builtin:corridor", says=["by cause: ", "and ", " more; --json lists all"])
        # Another contract than that of the file is another question.
        self.assertEqual(self.judged("-p", "thickness_m=2", "-p", "surface=box")["settings"], ["thickness_m=2", "max_distance_m=20", "surface=box"])

    def test_pictures_are_those_of_render(self):
        self.trace("linear", "steps=8")
        for show, more in (("agreement", ()), ("causes", ("--scene", "builtin:corridor"))):
            self.ssrlab("judge", "frame.exr", "hits.exr", "-o", f"{show}.png", "--show", show, *more, says=[f"{show}.png"])
            scene, size = ("builtin:corridor", ("--size", "160x90")) if more else ("frame.exr", ())
            self.ssrlab("render", scene, *size, "-t", "linear", "-p", "steps=8", "-p", "max_distance_m=20", "--show", show, "-o", "same.png")
            for name in (f"{show}.png", "same.png"):
                self.assertGreater(os.path.getsize(self.path(name)), 100)
            self.assertEqual(self.pixels(f"{show}.png"), self.pixels("same.png"), show)

    def pixels(self, name):
        import OpenImageIO
        return OpenImageIO.ImageBuf(self.path(name)).get_pixels(OpenImageIO.UINT8).tobytes()

    def test_the_page_and_every_case(self):
        """The commands of the page: the exact walk is right in every exported case, and a rival's loop is not."""
        page = read(PAGE)
        commands = [line for block in re.findall(r"^```sh\n(.*?)^```", page, re.M | re.S) for line in block.splitlines()]
        self.assertEqual(len(commands), 10)
        said = ""
        for command in commands:
            words = shlex.split(command.replace("$SSRLAB_SOURCE", SOURCE))
            self.assertEqual(words[0], "ssrlab")
            said = self.ssrlab(*words[1:], code=1 if command == "ssrlab judge cases rival" else 0)
            if command == "ssrlab judge cases hits":
                self.assertRegex(said, r"\b(\d+) of \1 cases pass")
        self.assertIn(re.search(r"^FAIL .*", page, re.M)[0], said)
        manifest = json.loads(self.text("cases/manifest.json"))
        names = [frame["name"] for frame in manifest["frames"]]
        self.assertGreater(len(names), 100)
        self.assertGreater(len(manifest["left_out"]), 100)
        for case in re.findall(r"`(\w+)`", page.split("| a bug often reported")[1].split("##")[0].replace("`size >> level`", "")):
            self.assertTrue([name for name in names if re.fullmatch(case + r"(_\d+)?", name)], case)
        # Who shows what the frame before held is found in each frame that has one.
        stale = [(frame["name"], frame["after"]) for frame in manifest["frames"] if "after" in frame]
        self.assertEqual(len(stale), 3)
        os.mkdir(self.path("stale"))
        for name, before in stale:
            shutil.copy(self.path(f"hits/{before}.exr"), self.path(f"stale/{name}.exr"))
        self.ssrlab("judge", "cases", "stale", "--partial", code=1, says=["0 of 3 cases pass; --partial: ", "FAIL previous_frame_1: 64 rays, 64 wrong"])
        verdict = json.loads(self.ssrlab("judge", "cases", "stale", "--json", "--min-f1", "0", "--partial"))
        self.assertEqual([one["passed"] for one in verdict], [True] * 3)
        # Without hits nothing passes, and no misspelt name is passed over.
        self.ssrlab("judge", "cases", "stale", "--min-f1", "0", code=1, says=[f"3 of {len(names)} cases pass", f"FAIL {names[-1]}: no hits"])
        verdict = json.loads(self.ssrlab("judge", "cases", "stale", "--json", "--min-f1", "0", code=1))
        self.assertEqual([sum(one["passed"] for one in verdict), len(verdict)], [3, len(names)])
        self.assertTrue(all(os.path.exists(self.path(one["frame"])) for one in verdict))
        shutil.copy(self.path(f"hits/{names[0]}.exr"), self.path(f"stale/{names[0]}x.exr"))
        self.refused("judge", "cases", "stale", "--partial", code=2, says=[f"got {names[0]}x.exr", f"did you mean '{names[0]}'"])
        self.refused("export-cases", "cases", code=2, says=["cases: expected a new or empty folder"])
        self.refused("judge", "cases", "cases/frames/..", code=2, says=["no hits: expected NAME.exr"])
        self.refused("judge", "cases", "hits", "-p", "thickness_m=1", code=2, says=["the cases have their own settings"])

    def test_wrong_input_is_refused(self):
        self.trace("linear")
        for arguments, says in ((("frame.exr", "none.exr"), "none.exr: no such file"),
                                (("frame.exr", "frame.exr"), "frame.exr: nothing says which rays hit"),
                                (("hits.exr", "hits.exr"), "hits.exr: nothing says how the camera looks"),
                                (("builtin:corridor", "hits.exr"), "builtin:corridor: expected a frame file"),
                                (("frame.exr", "hits.exr", "-p", "steps=8"), "-p steps=8: unknown setting of [trace] 'steps'"),
                                (("frame.exr", "hits.exr", "-p", "layers=2"), "layers = 2"),
                                (("frame.exr", "hits.exr", "--scene", "frame.exr"), "--scene frame.exr: a frame has no triangles"),
                                (("frame.exr", "hits.exr", "--show", "causes"), "give --scene"),
                                (("frame.exr", "hits.exr", "-o", "x.exr"), "expected a file that ends in .png"),
                                ((".", "hits.exr"), "manifest.json: no such file")):
            self.refused("judge", *arguments, code=2, says=[says])
        self.refused("judge", "frame.exr", "hits.exr", "--scene", "builtin:stairs", code=1, says=["pixels this scene has no surface"])
        self.write("hits.exr", "no EXR")
        self.refused("judge", "frame.exr", "hits.exr", code=1, says=["hits.exr"])


if __name__ == "__main__":
    main()

"""Bad input: a clear line, the stated exit code, nothing written."""
import os

from support import SWEEP, Case, main

SCENE = "builtin:stairs"


class Test(Case):
    def render_refused(self, *arguments, code=2, says, scene=SCENE, technique="linear", size="32x18", **more):
        self.refused("render", scene, "-t", technique, "--size", size, "-o", self.path("a.png"), *arguments, code=code,
                     says=says, **more)
        self.assertFalse(os.path.exists(self.path("a.png")))

    def test_what_render_is_asked(self):
        broken, fake = self.write("broken.gltf", '{"asset": {"version": "2.0"}, "meshes": ['), self.write("broken.glb", "glTF but not really")
        for options, more, says in (((), {"scene": "builtin:stars"}, ["unknown scene 'builtin:stars': did you mean 'builtin:stairs'?"]), ((), {"scene": self.path("none.glb")}, ["none.glb"]),
                                    ((), {"scene": broken, "code": 1}, ["broken.gltf"]), ((), {"scene": fake, "code": 1}, ["broken.glb"]),
                                    ((), {"technique": "linaer"}, ["linaer", "linear"]), (("-p", "steps=0"), {}, ["steps", "[1, 60000]", "got 0"]),
                                    (("-p", "steps=many"), {}, ["steps", "many"]), (("-p", "steps=2.5"), {}, ["steps", "integer"]),
                                    (("-p", "stepz=2"), {}, ["stepz", "steps"]), (("-p", "surfce=box"), {}, ["did you mean 'surface'?"]),
                                    (("-p", "surface=plan"), {}, ["got 'plan': did you mean 'plane'?"]), (("-p", "steps=8", "-p", "steps=9"), {}, ["'steps' is given twice"]),
                                    (("-p", "space"), {}, ["name=value"]),
                                    (("-p", "thickness_m=nan"), {}, ["thickness_m", "nan"]),
                                    *(((), {"size": size}, ["--size", size]) for size in ("0x18", "32", "32x-1", "32x18px")),
                                    ((), {"size": "100000x100000"}, ["100000"]), ((), {"size": "17000x8"}, ["17000"]),
                                    (("--view", "moon"), {}, ["no view 'moon': its views are default"]), (("--view", "defualt"), {}, ["did you mean 'default'? its views are"]),
                                    (("--side-by-sid",), {}, ["unknown option of render '--side-by-sid': did you mean '--side-by-side'?"]), (("--device", "abacus"), {}, ["abacus"])):
            with self.subTest(options=options, **more):
                self.render_refused(*options, says=says, **more)

    def test_what_a_recipe_says(self):
        part = '[[part]]\nshape = "box"\n'
        for text, says in ((part + '[[part]]\nfile = "nosuch.obj"\n', ["recipe.toml:3: ", "nosuch.obj: no such file"]), ('[[part]]\nshape = "box"\nfile = "a.obj"\n', ["recipe.toml:1: ", "got both"]),
                           (part + "size_m = [8, 8]\n", ["recipe.toml:3: ", "three finite numbers", "got a list of 2"]),
                           (part + '[[part]]\nfile = "sweethome3d:chair"\n', ["recipe.toml:3: SSRLAB_DATA = /nonexistent: no such folder"])):
            with self.subTest(text=text):
                self.render_refused(scene=self.write("recipe.toml", text), says=says, SSRLAB_DATA="/nonexistent")
        self.render_refused(scene=self.write("box.obj", "v 0 0 0\n"), says=["expected a .glb, .gltf, recipe", 'A recipe with [[part]] and file = "'])
        self.render_refused(scene=self.write("empty.gltf", '{"asset": {"version": "2.0"}, "scenes": [{"nodes": []}], "scene": 0}'), code=1, says=["empty.gltf: no triangle that can be drawn"])

    def test_no_vulkan_driver(self):
        none = {"VK_ICD_FILENAMES": "/nonexistent", "VK_DRIVER_FILES": "/nonexistent"}
        self.render_refused(code=1, says=["Vulkan"], **none)
        self.ssrlab("list", says=["none:"], **none)

    def test_unwritable_output(self):
        for output in ("/proc/a.png", self.write("file", "") + "/a.png"):
            self.refused("render", SCENE, "-t", "linear", "--size", "32x18", "-o", output, code=1, says=["a.png"])
        none = {"VK_ICD_FILENAMES": "/nonexistent", "VK_DRIVER_FILES": "/nonexistent"}  # refused before a device is opened
        self.refused("render", SCENE, "-t", "linear", "-o", "none/a.png", code=1, says=["-o none/a.png: its folder cannot be written: No such file"], **none)
        self.refused("ray", SCENE, "-t", "linear", "--pixel", "1,1", "-o", "none/a.png", code=1, says=["its folder cannot be written"], **none)

    def test_unknown_image_format(self):
        self.refused("render", SCENE, "-t", "linear", "--size", "32x18", "-o", self.path("a.xyz"), code=2, says=["a.xyz"])

    def test_specification_missing_or_broken(self):
        self.refused("run", self.path("none.toml"), code=2, says=["none.toml"])
        self.refused("run", self.write("s.toml", "scenes = ["), "-o", "out", code=2, says=["s.toml:1"])

    def test_what_a_specification_says(self):
        for old, wrong, says in (("steps = [", "stepz = [", ["s.toml:7", "stepz"]), ("[techniques.dda]", "[techniques.ddda]", ["s.toml:8", "ddda", "dda"]),
                                 ("builtin:stairs", "builtin:stars", ["s.toml:2", "builtin:stars"]), ("budget_s", "budget_h", ["s.toml:12", "budget_h"]),
                                 ("8, 16", "8, 0", ["s.toml:7", "steps"]), ("8, 16", '8, "16"', ["s.toml:7", "steps"]),
                                 ("max_distance_m = 9", "thickness_m = nan", ["s.toml:5", "thickness_m", "must be a number, got nan, which is not a number"]), ("64x36", "0x36", ["s.toml:3", "0x36"]),
                                 ("64x36", "100000x36", ["s.toml", "100000"]), ('sizes  =', 'views = ["default", "nope"]\nsizes =', ["s.toml:3: scene 'builtin:stairs' has no view 'nope': its views are default"]), ("[8, 16, 32, 64]", "[]", ["s.toml:7", "steps"])):
            with self.subTest(wrong=wrong):
                self.assertIn(old, SWEEP)
                self.refused("run", self.write("s.toml", SWEEP.replace(old, wrong)), "-o", "out", code=2, says=says)
                self.assertFalse(os.path.exists(self.path("out")))

    def test_figures_that_the_runs_cannot_make(self):
        good = SWEEP + """pictures = true
[figures.f]
says     = "Coarse"
measures = ["recall_1px"]
crop     = [0, 0, 64, 36]
panels   = [{ scene = "builtin:stairs", steps = 8 }, { scene = "builtin:stairs", technique = "dda", max_distance_m = 9.0, show = "truth" }]
"""
        self.ssrlab("run", self.write("s.toml", good), "--dry-run")
        for old, wrong, says in (("says  ", "sais  ", ["s.toml:15: unknown key of [figures.f] 'sais': did you mean 'says'?"]), ('says     = "Coarse"', "", ["s.toml:14: [figures.f] has no 'says'"]),
                                 ("recall_1px", "recal_1px", ["s.toml:16: unknown measure 'recal_1px': did you mean 'recall_1px'?"]), ("64, 36]", "65, 36]", ["s.toml:17: crop [0, 0, 65, 36] leaves the picture of 64x36"]),
                                 ("64, 36]", '"64", 36]', ["s.toml:17: 'crop' must be an integer"]), ("steps = 8 }", "step = 8 }", ["s.toml:18: unknown column of results.csv 'step': did you mean 'steps'?"]),
                                 ("steps = 8 }", "steps = 9 }", ["s.toml:18: ", "none has 'steps' as the integer 9"]), ("steps = 8 }", 'technique = "linear" }', ["s.toml:18: ", "this names 4, which differ in steps"]),
                                 ('"truth"', '"thruth"', ["did you mean 'truth'?"]), ('"truth"', '"flip"', ["needs image_errors = true"]), ("pictures = true", "pictures = false", ["needs pictures = true"]),
                                 ("panels ", "panel ", ["did you mean 'panels'?"]), ("[figures.f]", "[figures]", ["must be a table"]),
                                 ("[figures.f]", "[targets]\nrecall_1px = 0.9\n[figures.f]", ["s.toml:16: [figures] name runs", "not with [targets]"])):
            with self.subTest(wrong=wrong):
                self.assertIn(old, good)
                spec = self.write("s.toml", good.replace(old, wrong, 1).replace("[measure]", "[measure]\nimage_errors = false" if "flip" in wrong else "[measure]"))
                for options in (["--dry-run"], ["-o", "out"]):
                    self.refused("run", spec, *options, code=2, says=says)
                self.assertFalse(os.path.exists(self.path("out")))

    def test_unwritable_results_folder(self):
        spec = self.write("s.toml", SWEEP)
        for folder in ("/proc/out", self.write("file", "") + "/out"):
            self.refused("run", spec, "-o", folder, code=1, says=["out", "cannot be created"])

    def test_plot_without_results(self):
        self.ssrlab("plot", self.path("none"), code=2, says=["none"])
        self.write("out/results.csv", "run_id,scene,view,width,height,technique,trace_ms_median,outcome\nr0,s,default,80,60,hiz,fast,ok\n")
        for given in ("out", "out/results.csv"):
            self.refused("plot", given, code=1, says=["results.csv: damaged: row 1 (run r0), column 'trace_ms_median': expected a number, got 'fast'"])


if __name__ == "__main__":
    main()

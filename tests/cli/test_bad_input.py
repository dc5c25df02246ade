"""Bad input: a clear line, the stated exit code, nothing written."""
import os

from support import SWEEP, Case, main

SCENE = "builtin:stairs"


class Test(Case):
    def render_refused(self, *arguments, code=2, says, scene=SCENE, technique="linear", size="32x18", **more):
        self.refused("render", scene, "-t", technique, "--size", size, "-o", self.path("a.png"), *arguments, code=code,
                     says=says, **more)
        self.assertFalse(os.path.exists(self.path("a.png")))

    def run_refused(self, old, new, says, code=2):
        self.assertIn(old, SWEEP)
        spec = self.write("s.toml", SWEEP.replace(old, new))
        self.refused("run", spec, "-o", "out", code=code, says=says)
        self.assertFalse(os.path.exists(self.path("out")))

    def test_missing_scene(self):
        self.render_refused(scene="builtin:stars", says=["builtin:stars", "builtin:stairs"])
        self.render_refused(scene=self.path("none.glb"), says=["none.glb"])

    def test_broken_gltf(self):
        self.render_refused(scene=self.write("broken.gltf", '{"asset": {"version": "2.0"}, "meshes": ['), code=1,
                            says=["broken.gltf"])
        self.render_refused(scene=self.write("broken.glb", "glTF but not really"), code=1, says=["broken.glb"])

    def test_unknown_technique(self):
        self.render_refused(technique="linaer", says=["linaer", "linear"])

    def test_parameter_out_of_range(self):
        self.render_refused("-p", "steps=0", says=["steps", "[1, 60000]", "got 0"])

    def test_parameter_of_wrong_type(self):
        self.render_refused("-p", "steps=many", says=["steps", "many"])
        self.render_refused("-p", "steps=2.5", says=["steps", "integer"])
        self.render_refused("-p", "stepz=2", says=["stepz", "steps"])
        self.render_refused("-p", "space", says=["name=value"])

    def test_nan_thickness(self):
        self.render_refused("-p", "thickness_m=nan", says=["thickness_m", "nan"])

    def test_zero_size(self):
        for size in ("0x18", "32", "32x-1", "32x18px"):
            self.render_refused(size=size, says=["--size", size])

    def test_size_over_the_devices_limit(self):
        self.render_refused(size="100000x100000", says=["100000"])
        self.render_refused(size="17000x8", says=["17000"])

    def test_unknown_view(self):
        self.render_refused("--view", "moon", says=["moon"])

    def test_unknown_device(self):
        self.render_refused("--device", "abacus", says=["abacus"])

    def test_no_vulkan_driver(self):
        none = {"VK_ICD_FILENAMES": "/nonexistent", "VK_DRIVER_FILES": "/nonexistent"}
        self.render_refused(code=1, says=["Vulkan"], **none)
        self.ssrlab("list", says=["none:"], **none)

    def test_unwritable_output(self):
        for output in ("/proc/a.png", self.write("file", "") + "/a.png"):
            self.refused("render", SCENE, "-t", "linear", "--size", "32x18", "-o", output, code=1, says=["a.png"])

    def test_unknown_image_format(self):
        self.refused("render", SCENE, "-t", "linear", "--size", "32x18", "-o", self.path("a.xyz"), code=2, says=["a.xyz"])

    def test_specification_missing_or_broken(self):
        self.refused("run", self.path("none.toml"), code=2, says=["none.toml"])
        self.refused("run", self.write("s.toml", "scenes = ["), "-o", "out", code=2, says=["s.toml:1"])

    def test_specification_unknown_names(self):
        self.run_refused("steps = [", "stepz = [", says=["s.toml:7", "stepz"])
        self.run_refused("[techniques.dda]", "[techniques.ddda]", says=["s.toml:8", "ddda", "dda"])
        self.run_refused("builtin:stairs", "builtin:stars", says=["s.toml:2", "builtin:stars"])
        self.run_refused("budget_s", "budget_h", says=["s.toml:12", "budget_h"])

    def test_specification_values(self):
        self.run_refused("8, 16", "8, 0", says=["s.toml:7", "steps"])
        self.run_refused("8, 16", '8, "16"', says=["s.toml:7", "steps"])
        self.run_refused("max_distance_m = 9", "thickness_m = nan", says=["s.toml:5", "thickness_m"])
        self.run_refused("64x36", "0x36", says=["s.toml:3", "0x36"])
        self.run_refused("64x36", "100000x36", says=["s.toml", "100000"])
        self.run_refused("[8, 16, 32, 64]", "[]", says=["s.toml:7", "steps"])

    def test_unwritable_results_folder(self):
        spec = self.write("s.toml", SWEEP)
        for folder in ("/proc/out", self.write("file", "") + "/out"):
            self.refused("run", spec, "-o", folder, code=1, says=["out", "cannot be created"])

    def test_plot_without_results(self):
        self.ssrlab("plot", self.path("none"), code=2, says=["none"])


if __name__ == "__main__":
    main()

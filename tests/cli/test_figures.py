"""[figures] of an experiment: pictures of its runs side by side; and pages of pictures."""
import json
import os
import subprocess
import tomllib

import OpenImageIO as oiio
from support import SOURCE, Case, main, read

SPEC = """
scenes = ["builtin:mirror_floor_wall"]
sizes  = ["64x36"]
[passes]
viewer_fade = "off"
edge_fade   = "off"
[trace]
max_distance_m = 30
[techniques.linear]
steps = [16, 64]
[measure]
min_repeats = 1
max_repeats = 1
budget_s    = 0
[figures.one]
says     = "Few steps and many, none and all"
measures = ["recall_1px"]
panels   = [
    { steps = 16 }, { steps = 64 }, { steps = 64, show = "off" }, { steps = 64, show = "truth" },
]
"""


def pixels(path):
    return oiio.ImageBuf(path).get_pixels(oiio.FLOAT)[:, :, :3]


class Test(Case):
    def test_a_figure_shows_the_runs_that_it_names(self):
        self.ssrlab("run", self.write("few.toml", SPEC), "-o", "out")
        self.ssrlab("plot", "out")
        self.assertEqual(sorted(os.listdir(self.path("out/plots"))), ["one.png", "one.svg"])
        many = next(row for row in self.rows() if row["steps"] == "64")
        figure = json.loads(self.text("out/environment.json"))["figures"]["one"]
        self.assertEqual(figure["panels"][2], {"run_id": many["run_id"], "steps": 64, "show": "off"})
        traced, truth, off = (pixels(self.path("out/" + name)) for name in (
            many["picture"], many["truth_picture"], many["truth_picture"][:-len(".png")] + "_off.png"))
        self.assertGreater(abs(traced - off).mean(), 0.02)
        self.assertLess(abs(traced - truth).mean(), abs(off - truth).mean())
        self.assertGreaterEqual(self.text("out/plots/one.svg").count("<image"), 4)

    def test_a_panel_must_name_one_run(self):
        spec = self.write("few.toml", SPEC.replace("{ steps = 16 }, ", '{ technique = "linear" }, '))
        self.refused("run", spec, "-o", "out", code=2, says=["a panel must name one run, this names 2"])

    def test_runs_of_the_documents_are_all_there(self):
        """Each panel of experiments/figures names values that its experiment sweeps; --dry-run expands it. One may have rows alone."""
        folder = os.path.join(SOURCE, "experiments", "figures")
        names = sorted(name for name in os.listdir(folder) if name.endswith(".toml"))
        self.assertGreaterEqual(len(names), 5)
        for name in names:
            figures = tomllib.loads(read(folder, name)).get("figures", {})
            self.assertTrue(all(figure.startswith(name.split("_")[0].split(".")[0] + "_") for figure in figures), name)
            self.ssrlab("run", os.path.join(folder, name), "--dry-run", says=["runs, about"])

    def test_a_page_holds_every_picture(self):
        for i, scene in enumerate(("builtin:stairs", "builtin:matte", "builtin:puddle")):
            self.ssrlab("render", scene, "-t", "dda", "--size", "64x36", "-o", self.path(f"{i}.png"))
        command = [os.path.join(SOURCE, "experiments", "contact_sheet"), "-o", self.path("page.png"), "--width", "64",
                   *(self.path(f"{i}.png") for i in range(3))]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        page = pixels(self.path("page.png"))
        self.assertEqual(page.shape[1], 128)
        for i, (x, y) in enumerate(((0, 18), (64, 18), (0, 72))):
            self.assertLess(abs(page[y:y + 36, x:x + 64] - pixels(self.path(f"{i}.png"))).mean(), 0.02, f"picture {i}")


if __name__ == "__main__":
    main()

"""README.md's technique, scene and experiment, as they stand there."""
import os
import re

import OpenImageIO as oiio

from support import SOURCE, Case, main

STATUE = "v -1 0 -1\nv 1 0 -1\nv 0 0 1\nv 0 2 0\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 3 2\n"


def imageio_read(path):
    return oiio.ImageBuf(path).get_pixels(oiio.UINT8)


class Test(Case):
    def setUp(self):
        super().setUp()
        with open(os.path.join(SOURCE, "README.md"), encoding="utf-8") as file:
            blocks = re.findall(r"```\w+\n(?:#|//) (\S+\.\w+)\n(.*?)```", file.read(), re.S)
        self.blocks = dict(blocks)
        for name, text in blocks:
            self.write(name, text)
        self.write("statue.obj", STATUE)

    def test_examples_are_found(self):
        self.assertEqual(set(self.blocks), {"mine/strides/technique.toml", "mine/strides/trace.glsl", "statue.toml", "mine.toml"})

    def test_scene_renders(self):
        self.ssrlab("render", "statue.toml", "-t", "hiz", "--size", "64x36", "-o", "a.png")

    def test_technique_passes_the_hard_cases(self):
        self.ssrlab("--techniques", "mine", "check", "strides")

    def commands(self):
        """The pictures' commands, by the file that they write."""
        with open(os.path.join(SOURCE, "README.md"), encoding="utf-8") as file:
            text = file.read()
        shown = re.findall(r"\]\(docs/images/(\S+)\)", text)
        commands = re.findall(r"^build/bin/ssrlab (render .* -o (\S+\.png))$", text.replace("\\\n", ""), re.M)
        return {output: command.split() for command, output in commands if output in shown}

    def check_picture(self, output):
        """Within what another compiler or driver may change: 99 % of the values within 2 of 255."""
        self.ssrlab(*self.commands()[output])
        made, shown = (imageio_read(path) for path in (self.path(output), os.path.join(SOURCE, "docs/images", output)))
        self.assertEqual(made.shape, shown.shape)
        near = (abs(made.astype(int) - shown.astype(int)) <= 2).mean()
        self.assertGreater(near, 0.99, "make it again with README's command")

    def test_every_picture_is_checked(self):
        self.assertEqual(set(self.commands()), {"wet_street.png", "forest_clearing.png", "thin_yard.png"})

    def test_wet_street_is_what_its_command_makes(self):
        self.check_picture("wet_street.png")

    def test_forest_clearing_is_what_its_command_makes(self):
        self.check_picture("forest_clearing.png")

    def test_thin_yard_is_what_its_command_makes(self):
        self.check_picture("thin_yard.png")

    def test_experiment_runs_with_the_technique(self):
        small = self.blocks["mine.toml"].replace("320x180", "48x27").replace("640x360", "64x36").replace("= 1\n", "= 0.1\n")
        spec = self.write("mine.toml", small)
        self.ssrlab("run", spec, "-o", "out", "--techniques", "mine")
        self.assert_complete(self.rows(), 24)
        self.assertGreater(max(float(row["screen_same_pixel"]) for row in self.rows() if row["technique"] == "strides"), 0.3)


if __name__ == "__main__":
    main()

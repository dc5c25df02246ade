"""list, show, render, trace, gbuffer, measures."""
import re

import numpy
import OpenImageIO as oiio
from support import Case, main, read

SCENE = "builtin:sphere_over_mirror"
STATUS_NAMES = "0=not_traced 1=hit 2=left_screen 3=past_max_distance 4=out_of_steps 5=facing_away 6=stopped"


class Test(Case):
    def read(self, name):
        """Channels by name, metadata."""
        image = oiio.ImageBuf(self.path(name))
        self.assertFalse(image.has_error, image.geterror())
        spec = image.spec()
        pixels = image.get_pixels(oiio.FLOAT)
        return {channel: pixels[:, :, i] for i, channel in enumerate(spec.channelnames)}, spec

    def test_list_names_techniques_scenes_devices(self):
        self.ssrlab("list", says=["linear_binary", "hiz", "builtin:stairs", "thin_yard", "Devices"])

    def test_show_gives_ranges_and_sources(self):
        self.ssrlab("show", "hiz", says=["max_steps", "60000", "occupancy | minmax | nearest", "Uludag", "exact"])

    def test_help_of_everything(self):
        self.ssrlab("--help", says=["render", "trace", "gbuffer", "run", "plot", "--device"])
        for command in ("list", "show", "render", "trace", "gbuffer", "run", "plot", "check", "measures"):
            self.ssrlab(command, "--help", says=["Usage"])

    def test_render_png_shows_something(self):
        self.ssrlab("render", SCENE, "-t", "hiz", "--size", "161x91", "-o", self.path("a.png"))
        channels, spec = self.read("a.png")
        self.assertEqual((spec.width, spec.height), (161, 91))
        self.assertGreater(channels["R"].std(), 0.02, "the picture is flat")

    def test_reflections_change_the_picture(self):
        for distance_m in ("0.001", "100"):
            self.ssrlab("render", "builtin:mirror_floor_wall", "-t", "hiz", "-p", f"max_distance_m={distance_m}",
                        "--size", "161x91", "-o", self.path(f"{distance_m}.exr"))
        without, reflected = self.read("0.001.exr")[0], self.read("100.exr")[0]
        self.assertFalse(all(numpy.array_equal(without[name], reflected[name]) for name in "RGB"))
        self.assertTrue(all(numpy.isfinite(reflected[name]).all() for name in "RGB"))

    def test_trace_has_every_channel_and_the_legend(self):
        self.ssrlab("trace", SCENE, "-t", "hiz", "-p", "max_distance_m=9", "--size", "161x91", "-o", self.path("h.exr"))
        channels, spec = self.read("h.exr")
        self.assertEqual(set(channels), {"hit.x", "hit.y", "hit.t", "hit.z", "layer", "pixel.x", "pixel.y", "status", "steps", "depth_fetches", "structure_fetches"})
        self.assertEqual(spec.getattribute("ssrlab:status_names"), STATUS_NAMES)
        hit = channels["status"] == 1
        self.assertGreater(hit.sum(), 0)
        self.assertTrue((channels["hit.t"][hit] <= 1).all() and (channels["hit.t"][hit] >= 0).all())
        self.assertTrue((channels["hit.x"][hit] <= 161).all() and (channels["hit.y"][hit] <= 91).all())
        stopped = channels["status"] == 6
        hit |= stopped  # they have a place, too
        self.assertTrue((channels["hit.x"][stopped] > 0).all() and (channels["hit.z"][stopped] > 0).all())
        self.assertGreater(stopped.sum(), 0)
        self.assertTrue((channels["hit.x"][~hit] == 0).all())
        for axis in "xy":
            pixel, place = channels[f"pixel.{axis}"][hit], channels[f"hit.{axis}"][hit]
            self.assertTrue((pixel == numpy.floor(pixel)).all() and (abs(place - pixel - 0.5) <= 0.501).all())
            self.assertTrue((channels[f"pixel.{axis}"][~hit] == 0).all())
        self.assertGreater(channels["structure_fetches"].sum(), 0)

    def test_too_few_steps_say_so(self):
        self.ssrlab("trace", SCENE, "-t", "dda", "-p", "max_steps=2", "--size", "64x36", "-o", self.path("h.exr"))
        self.assertGreater((self.read("h.exr")[0]["status"] == 4).sum(), 0)

    def test_gbuffer_has_every_channel_and_the_camera(self):
        self.ssrlab("gbuffer", SCENE, "--size", "64x36", "-o", self.path("g.exr"))
        channels, spec = self.read("g.exr")
        for name in ("depth", "normal_vs.x", "normal_vs.y", "normal_vs.z", "roughness", "metallic", "base_colour.R", "R", "object_id"):
            self.assertIn(name, channels)
        self.assertEqual(len(spec.getattribute("ssrlab:world_to_view").split()), 16)
        self.assertEqual(len(spec.getattribute("ssrlab:view_to_clip").split()), 16)
        seen = channels["depth"] > 0
        length = sum(channels[f"normal_vs.{axis}"] ** 2 for axis in "xyz")
        self.assertTrue(numpy.allclose(length[seen], 1, atol=1e-4))

    def names_every(self, page, heading, names):
        """The first cells of a page's tables name all of `names`, and nothing else. `…` and words in capitals stand for any ending or name."""
        cells = re.findall(r"^\| ([^|]*`[^|]*) \|", read("docs/reference", page).split(heading, 1)[1], re.M)
        patterns = [re.sub(r"[A-Z]{4,}", r"\\w+", re.escape(name)).replace("…", r"[\w.]+") for cell in cells for name in re.findall(r"`([^`]+)`", cell)]
        self.assertGreater(len(names), 10)
        self.assertEqual([name for name in names if not any(re.fullmatch(pattern, name) for pattern in patterns)], [], "not in the page")
        self.assertEqual([pattern for pattern in patterns if not any(re.fullmatch(pattern, name) for name in names)], [], "no such name")

    def test_the_reference_names_every_column_and_setting(self):
        name = r"^\| `([^`]+)` \|"
        self.names_every("columns.md", "## results.csv", re.findall(name, self.ssrlab("measures").split("## Summary")[0].split("## Runs")[1], re.M))
        self.names_every("settings.md", "# Settings", re.findall(name, self.ssrlab("list", "--markdown"), re.M))

    def test_the_reference_names_every_command(self):
        table = re.search(r"\| commands \|.*?\n\n", read("docs/reference/command_line.md"), re.S)[0]
        commands = re.findall(r"^  ([a-z-]+)", self.ssrlab("--help").split("Subcommands:")[1], re.M)
        self.assertGreater(len(commands), 10)
        self.assertEqual(sorted(re.findall(r"`([^`]+)`", table)), sorted(commands))


if __name__ == "__main__":
    main()

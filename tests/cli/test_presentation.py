"""render's pictures for people: samples, exposure, display transform, truth, side by side."""
import numpy
import OpenImageIO as oiio
from support import Case, main

SCENE = "builtin:sphere_over_mirror"
SIZE = (96, 54)


class Test(Case):
    def render(self, name, *options, scene=SCENE, **more):
        text = self.ssrlab("render", scene, "-t", "dda", "-p", "viewer_fade=off", "-p", "edge_fade=off", "--size",
                           "x".join(map(str, SIZE)), "-o", self.path(name), *options, **more)
        image = oiio.ImageBuf(self.path(name))
        self.assertFalse(image.has_error, text)
        self.command = image.spec().getattribute("ssrlab:command")
        return image.get_pixels(oiio.FLOAT)

    def test_what_is_not_asked_for_changes_nothing(self):
        plain = self.render("a.png")
        self.assertNotIn("--samples", self.command)
        numpy.testing.assert_array_equal(plain, self.render("b.png", "--samples", "1", "--exposure", "0", "--display", "clip"))

    def test_samples_smooth_edges_and_keep_the_picture(self):
        one, many = self.render("a.exr"), self.render("b.exr", "--samples", "16")
        self.assertIn("--samples 16", self.command)

        def roughest(image):
            """Of the sphere's outline: the largest step from one row to the next but one, over steps between."""
            return len(numpy.unique(image[:, :, 0].round(4)))
        self.assertGreater(roughest(many), roughest(one))
        # Nothing moves: the mean over blocks of 6 x 6 pixels stays.
        blocks = [image[:, :, :3].reshape(9, 6, 16, 6, 3).mean((1, 3)) for image in (one, many)]
        self.assertLess(abs(blocks[0] - blocks[1]).mean(), 0.01)
        half = one.shape[0] // 2
        self.assertLess(abs(one[:half] - many[:half]).mean(), 0.02)

    def test_samples_are_the_same_each_time(self):
        numpy.testing.assert_array_equal(self.render("a.png", "--samples", "3"), self.render("b.png", "--samples", "3"))

    def test_exposure_doubles_linear_light(self):
        def linear(image):
            return numpy.where(image <= 0.04045, image / 12.92, ((image + 0.055) / 1.055) ** 2.4)
        plain, brighter = linear(self.render("a.png")), linear(self.render("b.png", "--exposure", "1"))
        self.assertIn("--exposure 1", self.command)
        inside = (brighter < 0.98) & (plain > 0.02)
        self.assertGreater(inside.sum(), 100)
        self.assertLess(abs(brighter[inside] / plain[inside] - 2).max(), 0.1)

    def test_exposure_takes_parts_of_a_stop(self):
        half, whole = self.render("a.png", "--exposure", "0.5"), self.render("b.png", "--exposure", "1")
        self.assertIn("--exposure 1", self.command)
        self.assertLess(half.mean(), whole.mean())
        self.assertLess(self.render("c.png").mean(), half.mean())

    def test_agx_darkens_what_would_clip(self):
        clipped, agx = self.render("a.png", "--exposure", "3"), self.render("b.png", "--exposure", "3", "--display", "agx")
        self.assertIn("--display agx", self.command)
        self.assertGreater((clipped == 1).mean(), 0.3)
        self.assertLess((agx == 1).mean(), 0.01)

    def test_truth_is_what_exact_tracing_finds_on_a_plain_scene(self):
        """The floor shows the wall: all of it is on screen."""
        wall = {"scene": "builtin:mirror_floor_wall"}
        traced, truth = self.render("a.exr", **wall), self.render("b.exr", "--truth", **wall)
        self.assertIn("--truth", self.command)
        near = (abs(traced - truth).max(2) < 0.05).mean()
        self.assertGreater(near, 0.9)
        without = self.render("c.exr", "-p", "max_distance_m=0.001", **wall)
        self.assertGreater(abs(truth - without).mean(), 0.02, "the truth shows no reflection")

    def test_side_by_side_holds_the_three_pictures(self):
        traced, truth = self.render("a.png"), self.render("b.png", "--truth")
        three = self.render("c.png", "--side-by-side")
        width, height = SIZE
        self.assertEqual(three.shape[1], 3 * width)
        off, second, third = (three[-height:, k * width:(k + 1) * width] for k in range(3))
        numpy.testing.assert_array_equal(second, traced)
        numpy.testing.assert_array_equal(third, truth)
        self.assertGreater(abs(off - traced).mean(), 0.005)

    def test_bad_use(self):
        common = ("render", SCENE, "-t", "dda", "--size", "16x9", "-o")
        for options, says in ((("a.exr", "--display", "agx"), "--exposure and --display need a .png"),
                              (("a.exr", "--exposure", "1"), "--exposure and --display need a .png")):
            self.refused(*common, *options, code=2, says=[says])
        for options, says in ((("--display", "AGX"), "--display: unknown value 'AGX': did you mean 'agx'?"), (("--show", "caus"), "did you mean 'causes'?"),
                              (("--storage", "plainbuffers"), "did you mean 'plain-buffers'?"), (("--passes", "Serial"), "did you mean 'serial'?")):
            self.ssrlab(*common, "a.png", *options, code=2, says=[says])
        for options in (("a.png", "--samples", "0"), ("a.png", "--samples", "257"), ("a.png", "--display", "film"),
                        ("a.png", "--truth", "--side-by-side"), ("a.png", "--exposure", "nan")):
            self.ssrlab(*common, *options, code=2)


if __name__ == "__main__":
    main()

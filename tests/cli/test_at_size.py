"""tests/at_size: large scenes are drawn and measured, larger ones refused; what does not hold is found."""

from support import PROGRAM, Case, load_script, main


class Test(Case):
    def setUp(self):
        super().setUp()
        self.at_size = load_script("tests", "at_size")
        self.trial = self.at_size.Trial(PROGRAM, self.folder)

    def test_triangles_are_counted_and_measured(self):
        scene, count = self.at_size.waves(self.folder, 20_000)
        self.assertEqual(count, 2 * 101**2)
        self.trial.measure("waves", scene)
        self.assertGreater(self.trial.done[0]["peak_mib"], 20)

    def test_meshes_take_of_a_shared_list_what_they_use(self):
        self.trial.draw("shared", self.at_size.shared(self.folder, 40, 200_000))
        self.assertLess(self.trial.done[0]["peak_mib"], 400, "with the whole list for each, it is 1 GiB more")

    def test_too_many_triangles_are_refused_before_they_are_read(self):
        scene = self.at_size.more_triangles(self.folder, 40_000_001)
        self.trial.refuse("more", scene, ["more_triangles.gltf", "40000001 triangles", "at most 40000000"])
        self.assertLess(self.trial.refused[0]["peak_mib"], 250, "the file has 114 MiB")

    def test_too_wide_an_environment_is_refused(self):
        self.trial.refuse("wide", self.at_size.surrounded(self.folder, 16386, 64), ["sky.exr", "16386x64", "at most 16384 a side"])

    def test_too_wide_a_texture_is_refused(self):
        scene = self.at_size.textured(self.folder, "texture", 16385, 64)
        self.trial.refuse("texture", scene, ["texture.gltf", "texture.png", "16385x64", "at most 16384 a side"])

    def test_what_does_not_hold_is_found(self):
        scene, _ = self.at_size.waves(self.folder, 200)
        with self.assertRaisesRegex(self.at_size.Broken, "exit code 0 after"):
            self.trial.refuse("not refused", scene, [])
        with self.assertRaisesRegex(self.at_size.Broken, "exit code 2"):
            self.trial.draw("refused", self.at_size.lit(self.folder, 1025))


if __name__ == "__main__":
    main()

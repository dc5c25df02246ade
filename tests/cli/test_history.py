"""Frames of a sequence with their history."""
from support import Case, main

ORBIT = ["builtin:moving_boxes", "-t", "hiz", "--view", "orbit", "--size", "96x54"]


class Test(Case):
    def picture(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def test_frames_in_a_row_have_one_and_repeat_bit_by_bit(self):
        self.ssrlab("render", *ORBIT, "--frames", "4", "-o", "a.exr")
        self.ssrlab("render", *ORBIT, "--frames", "4", "-o", "b.exr")
        self.ssrlab("render", *ORBIT, "--frames", "4", "-p", "history_weight=0", "-o", "c.exr")
        self.ssrlab("render", *ORBIT, "--frame", "3", "-o", "alone.exr")
        for frame in range(4):
            self.assertEqual(self.picture(f"a_{frame:04}.exr"), self.picture(f"b_{frame:04}.exr"), frame)
        self.assertNotEqual(self.picture("a_0003.exr"), self.picture("c_0003.exr"))
        self.assertNotEqual(self.picture("a_0003.exr"), self.picture("alone.exr"))

    def test_the_plan_says_what_changed(self):
        moves = "moving camera, 2 of 4 objects move, no jitter"
        self.ssrlab("plan", *ORBIT, "--frame", "3", "--repeats", "1", says=["history              run", moves, "bit-identical"])
        still = self.ssrlab("plan", "builtin:stairs", "--frame", "3", "--repeats", "1", "--size", "96x54",
                            says=["still camera, 0 of 10 objects move, no jitter: the frame before once more", "bit-identical"])
        self.assertRegex(still, r"reprojection +skipped")
        self.ssrlab("plan", "builtin:stairs", "--repeats", "1", "--size", "96x54", says=["a single frame: no history"])


if __name__ == "__main__":
    main()

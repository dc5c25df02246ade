"""README.md's picture is what its command makes."""
import os
import re

import OpenImageIO as oiio

from support import SOURCE, Case, main, read


def pixels_of(path):
    return oiio.ImageBuf(path).get_pixels(oiio.UINT8)


class Test(Case):
    def test_the_picture_is_what_its_command_makes(self):
        """Within what another compiler or driver may change: 99 % of the values within 2 of 255."""
        text = read("README.md")
        output, = re.findall(r"\]\(docs/images/(\S+)\)", text)
        command, = re.findall(rf"^build/bin/ssrlab (render .* -o {output})$", text.replace("\\\n", ""), re.M)
        self.ssrlab(*command.split())
        made, shown = (pixels_of(path) for path in (self.path(output), os.path.join(SOURCE, "docs/images", output)))
        self.assertEqual(made.shape, shown.shape)
        near = (abs(made.astype(int) - shown.astype(int)) <= 2).mean()
        self.assertGreater(near, 0.99, "make it again with README's command")

    def test_the_f1_of_engines_is_that_of_the_table(self):
        words = " ".join(read("README.md").split())
        said = re.findall(r"an F1 of (\d+) to (\d+) % at 360p and (\d+) to (\d+) % at 1080p, where `hiz_packets` over planes reaches (\d+) and (\d+) %", words)
        of_size = [part for part in read("results/reference/engines.md").split("\n## ") if part.startswith("By default")]
        self.assertEqual([part.splitlines()[0].split()[-3:] for part in of_size], [["640", "×", "360"], ["1920", "×", "1080"]])
        f1 = [[int(cells[6].strip("% ")) for cells in (line.split("|") for line in part.splitlines()) if len(cells) > 6 and cells[2].strip() == "default"]
              for part in of_size]
        ours = [re.search(r"`hiz_packets`, `plane` \|[^|]*\|[^|]*\| (\d+)%", part)[1] for part in of_size]
        self.assertEqual(said, [(*(str(pick(one)) for one in f1 for pick in (min, max)), *ours)])

    def test_its_commands_exist(self):
        named = set(re.findall(r"^build/bin/ssrlab ([a-z-]+)", read("README.md"), re.M))
        self.assertGreater(len(named), 5)
        for name in named:
            self.ssrlab(name, "--help")


if __name__ == "__main__":
    main()

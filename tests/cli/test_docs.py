"""The docs against the tree: links, paths and names exist, pictures are shown, lines are short."""
import glob
import os
import re
import unittest

from support import SOURCE, read

FOLDERS = ("docs", "experiments", "framework", "results", "shaders", "structures", "techniques", "tests")
CODE_FOLDERS = ("experiments", "framework", "shaders", "structures", "techniques", "tests")
# What runs write is not in the tree; results/reference is.
WRITTEN_BY_RUNS = re.compile(r"results/(?!reference\b)")
MOST_COLUMNS = 100
# Shaders whose functions a tracer may use, and those of them that only the framework calls.
API = ("box", "covered_depths", "depth_interval", "directions", "grid", "grid.exact_arithmetic", "random", "sampling", "slab", "slab_front", "span",
       "test_pixel", "trace_api", "view")
FRAMEWORK_ONLY = {"ends_at", "fetch_pixel", "surface_of", "test_interval", "meets", "slab_front_of", "reaches_slab_back", "nearest_steps",
                  "scaled_depth"}


def pages():
    names = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "experiments/README.md", "experiments/scenes/README.md", "tests/README.md"]
    there = [name for name in names if os.path.exists(os.path.join(SOURCE, name))]
    return there + sorted(glob.glob("docs/**/*.md", root_dir=SOURCE, recursive=True))


def without_code(text):
    """Fenced code becomes empty lines, so that line numbers stay."""
    return re.sub(r"^```.*?^```[^\n]*", lambda block: "\n" * block[0].count("\n"), text, flags=re.S | re.M)


def spans(text):
    """What stands in backticks, also over the end of a line."""
    return [" ".join(span.split()) for span in re.findall(r"`([^`]+)`", without_code(text))]


def anchors(text):
    """As GitHub makes them from headings: lower case, without punctuation, hyphens for spaces, numbered where they repeat."""
    seen, found = {}, set()
    for heading in re.findall(r"^#+ (.+)$", without_code(text), flags=re.M):
        anchor = re.sub(r"[^\w\- ]", "", re.sub(r"\]\([^)]*\)", "", heading).lower()).strip().replace(" ", "-")
        found.add(f"{anchor}-{seen[anchor]}" if anchor in seen else anchor)
        seen[anchor] = seen.get(anchor, 0) + 1
    return found


def broken_links(page, text):
    broken = []
    for link in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", without_code(text))):
        if re.match(r"\w+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
        if not os.path.exists(os.path.join(SOURCE, target)):
            broken.append(link)
        elif anchor and anchor not in anchors(text if target == page else read(target)):
            broken.append(link)
    return broken


def missing_paths(text):
    """Paths of the tree, in backticks or not. A part in capitals stands for any name: those are skipped, as is what runs write."""
    missing = []
    for path in re.findall(rf"(?<![\w/.\-])(?:\./)?((?:{'|'.join(FOLDERS)})/[\w./*\-]*)", without_code(text)):
        path = path.rstrip(".")
        if WRITTEN_BY_RUNS.match(path) or any(re.fullmatch(r"[A-Z_]+", part) for part in path.split("/")):
            continue
        if not glob.glob(path, root_dir=SOURCE):
            missing.append(path)
    return missing


def missing_source_names(text, tree):
    """Names of source files without their folder."""
    names = [span for span in spans(text) if re.fullmatch(r"[\w\-]+\.(glsl|comp|vert|frag|cpp|h|py|sh)", span)]
    return [name for name in names if name not in tree]


def missing_functions(text, code):
    """`name()` or `name(…)`. Functions of mathematics have names of up to three characters."""
    names = [match[1] for match in (re.fullmatch(r"([A-Za-z_]\w{3,})\(.*\)", span) for span in spans(text)) if match]
    return [name for name in names if not re.search(rf"\b{name}\b", code)]


def long_lines(text):
    """A table's row and a single link cannot be broken."""
    lines = enumerate(without_code(text).splitlines(), 1)
    return [number for number, line in lines if len(line) > MOST_COLUMNS and not line.startswith("|") and not re.fullmatch(r" *\S+\]\(http\S+", line)]


def code_files():
    for folder in CODE_FOLDERS:
        for parent, folders, names in os.walk(os.path.join(SOURCE, folder)):
            folders[:] = [one for one in folders if one not in ("kept", "node_modules")]  # inputs found by fuzzing; npm's
            for name in names:
                if not name.endswith((".md", ".pyc", ".png", ".json", ".csv", ".bin")):
                    yield os.path.join(parent, name)


class Test(unittest.TestCase):
    maxDiff = None

    def each_page(self, find):
        found = {page: find(page, read(page)) for page in pages()}
        self.assertGreater(len(found), 10)
        self.assertEqual({page: problems for page, problems in found.items() if problems}, {})

    def test_links_lead_somewhere(self):
        self.each_page(broken_links)

    def test_paths_exist(self):
        self.each_page(lambda _, text: missing_paths(text))

    def test_names_exist_in_the_code(self):
        files = list(code_files())
        code = "\n".join(read(file) for file in files if os.path.basename(file) != os.path.basename(__file__))
        tree = {os.path.basename(file) for file in files}
        self.each_page(lambda _, text: missing_functions(text, code) + missing_source_names(text, tree))

    def test_the_guide_names_every_function_of_the_api(self):
        code = "\n".join(read(f"shaders/api/{name}.glsl") for name in API)
        functions = set(re.findall(r"^\w+ +(\w+)\([^;]*?\)\s*\{", code, flags=re.M))
        self.assertGreater(len(functions), 35)
        self.assertEqual(FRAMEWORK_ONLY - functions, set(), "no such function")
        guide = read("docs/reference/shader_api.md")
        missing = [name for name in sorted(functions - FRAMEWORK_ONLY) if f"{name}(" not in guide]
        self.assertEqual(missing, [])

    def test_lines_are_short(self):
        self.each_page(lambda _, text: long_lines(text))

    def test_headers_are_narrow(self):
        """120 columns, as .clang-format has it for code; what GLSL reads, too, has functions of one line."""
        headers = [file for file in code_files() if file.endswith(".h")]
        self.assertGreater(len(headers), 150)
        wide = [f"{file}:{number}" for file in headers for number, line in enumerate(read(file).splitlines(), 1)
                if len(line) > 120 and not line.startswith("SHARED_FUNCTION")]
        self.assertEqual(wide, [])

    def test_the_glossary_is_in_order(self):
        rows = re.findall(r"^\| ([^|]+) \| ([^|]+) \|$", read("docs/reference/glossary.md"), flags=re.M)[1:]
        terms = [term.lower() for term, _ in rows]
        self.assertGreater(len(terms), 40)
        self.assertEqual(terms, sorted(set(terms), key=lambda term: re.sub(r"[^a-z]", "", term)))
        for term, meaning in rows:
            self.assertRegex(meaning, r"^[A-Z].*\.$", term)

    def test_the_index_names_every_page(self):
        index = read("docs/README.md")
        missing = [page for page in pages() if page.startswith("docs/") and page != "docs/README.md" and f"]({page[5:]})" not in index]
        self.assertEqual(missing, [])

    def test_every_picture_is_shown(self):
        shown = set(re.findall(r"images/([\w.]+)\)", "".join(read(page) for page in pages())))
        self.assertEqual(set(os.listdir(os.path.join(SOURCE, "docs/images"))), shown)

    def test_readme_is_short(self):
        self.assertLessEqual(read("README.md").count("\n"), 120)

    def test_what_is_wrong_is_found(self):
        page = "docs/explanation/hard_cases.md"
        self.assertEqual(broken_links(page, "[a](nowhere.md) [b](exactness.md#nowhere) [c](exactness.md#it-ends) [d](#e)\n# E\n"),
                         ["nowhere.md", "exactness.md#nowhere"])
        self.assertEqual(missing_paths("`shaders/nowhere.glsl`, `framework/core/*.h`, `results/NAME/results.csv`, docs/nowhere.md."),
                         ["shaders/nowhere.glsl", "docs/nowhere.md"])
        self.assertEqual(missing_functions("`trace(Ray ray)`, `vanished()`, `T_x(X)`", "TraceResult trace(Ray ray)"), ["vanished"])
        self.assertEqual(missing_source_names("`trace.comp`, `vanished.glsl`", {"trace.comp"}), ["vanished.glsl"])
        self.assertEqual(long_lines("\n".join(["x" * 100, "x" * 101, "|" + "x" * 200, "```", "x" * 200, "```", "x" * 101, "x](https://" + "y" * 100 + ")."])), [2, 7])


if __name__ == "__main__":
    unittest.main()

"""The page of a design review, of real archives, as a browser gets it."""

import html
import html.parser
import json
import shutil
import subprocess

import pytest
from command import REFERENCE, sealdyn
from PIL import Image

from sealdyn.analysis.sources import sources_of_film
from sealdyn.archive import open_archive
from sealdyn.report.review import told

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
ODD = "# Does <script>alert(1)</script> & co. stay words?  More of it.\n"


class Page(html.parser.HTMLParser):
    """Addresses, headings and text of a page; all that is opened is closed."""

    def __init__(self, words):
        super().__init__()
        self.addresses, self.tags, self.open, self.text = [], [], [], ""
        self.feed(words)
        assert self.open == []

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        if tag not in ("meta", "img"):
            self.open.append(tag)
        self.addresses += [value for key, value in attrs if key in ("src", "href")]

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.text += data


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("review")
    (folder / "odd.toml").write_text(ODD + REFERENCE.read_text())
    short = ["--set", "run.turns=2", "--set", "run.samples_per_turn=16", "--no-plot"]
    sealdyn("run", "odd.toml", *short, "--out", "a.h5", cwd=folder)
    sealdyn("study", "equilibrium", REFERENCE, "--no-plot", "--out", "b.h5", cwd=folder)
    answer = sealdyn("report", "a.h5", "b.h5", "--out", "review.html", cwd=folder)
    assert answer.code == 0 and answer.out.strip() == "review.html"
    return folder


@pytest.mark.core
def test_it_stands_by_itself(folder):
    page = Page((folder / "review.html").read_text())
    assert all(address.startswith("#part") for address in page.addresses)
    assert page.tags.count("svg") == 5 and page.tags.count("script") == 1
    assert "Does <script>alert(1)</script> & co. stay words?" in page.text


def test_it_says_what_the_program_says(folder):
    text = " ".join(Page((folder / "review.html").read_text()).text.split())
    for words in (
        "energy audit",
        "asked 1e-06, estimated",
        "critical speed",
        "film.clearance",
        "made",
        "balance ratio",
    ):
        assert words in text, words
    rules = sealdyn("check", REFERENCE, "--json", cwd=folder).found["design_rules"]
    assert all(" ".join(told(rule["said"]).split()) in text for rule in rules) and text.count("not applicable") >= 5
    study = sealdyn("show", "b.h5", cwd=folder).out.splitlines()
    # The last line is for those who want a table.
    cells = [cell.strip() for line in study[1:-1] for cell in line.strip().split("  ") if cell]
    assert len(cells) > 10 and all(cell in text or told(cell) in text for cell in cells)


def test_it_shows_what_the_film_was_held_against(folder):
    """The reference run has the radial film: Ludwig and Allen, number by number."""
    text = " ".join(Page((folder / "review.html").read_text()).text.split())
    (source,) = sources_of_film("radial")
    assert "Validation of the film radial" in text and source["command"] in text
    assert f"{len(source['rows'])} numbers" in text and text.count("Validation of the film") == 1
    assert all(" ".join(row["where"].split()) in text for row in source["rows"])


def test_runs_of_different_scenes_are_told_apart(folder):
    """a and b are one scene, asked differently; c has another clearance."""
    assert "different scenes" not in (folder / "review.html").read_text()
    changed = ["--set", "run.turns=1", "--set", "film.clearance=9 um", "--no-plot"]
    sealdyn("run", "odd.toml", *changed, "--out", "c.h5", cwd=folder)
    assert sealdyn("report", "a.h5", "c.h5", "b.h5", "--out", "two.html", cwd=folder).code == 0
    text = " ".join(Page((folder / "two.html").read_text()).text.split())
    assert text.count("(2 different scenes)") == 2
    first, second = text.index("Scene 1:"), text.index("Scene 2:")
    assert first < text.index("(a.h5)") < text.index("(b.h5)") < second < text.index("(c.h5)")


def test_a_seal_whose_support_has_no_radius(folder):
    """Its sketch; and a rule that is broken on purpose, whose reason is a sentence of its own."""
    support = "rotor.support={axial_stiffness=5e5, axial_damping=300, tilt_stiffness=400, tilt_damping=0.24}"
    broken = 'application.acknowledge={leakage="drained"}'
    words = ["--set", support, "--set", broken, "--set", "run.turns=1", "--no-plot", "--out", "d.h5"]
    assert sealdyn("run", REFERENCE, *words, cwd=folder).code == 0
    assert sealdyn("report", "d.h5", "--out", "d.html", cwd=folder).code == 0
    page = (folder / "d.html").read_text()
    assert '<figure class="sketch"' in page and ". Acknowledged: drained" in page


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["nothing.h5"], "nothing.h5"),
        (["odd.toml"], "odd.toml"),
        (["a.h5", "--out", "a.pdf"], ".html"),
        (["a.h5", "--out", "odd.toml/a.html"], "cannot be written"),
    ],
)
def test_bad_input_is_one_line(words, said, folder):
    before = sorted(folder.iterdir())
    answer = sealdyn("report", *words, cwd=folder)
    assert answer.code == 2 and said in answer.err and len(answer.err.strip().splitlines()) == 1
    assert sorted(folder.iterdir()) == before


def browsed(folder, page, *words):
    """What the browser says of a page, without a network."""
    quiet = ["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking"]
    more = ["--disable-component-update", "--disable-sync", "--disable-quic", f"--user-data-dir={folder / 'browser'}"]
    command = [BROWSER, *quiet, *more, *words, (folder / page).as_uri()]
    return subprocess.run(command, check=True, timeout=120, capture_output=True, text=True).stdout


@pytest.mark.slow
@pytest.mark.skipif(BROWSER is None, reason="no Chromium or Chrome is installed")
def test_a_browser_shows_it(folder):
    """Not as an empty page."""
    browsed(folder, "review.html", "--window-size=1200,3000", f"--screenshot={folder / 'page.png'}")
    with Image.open(folder / "page.png") as shown:
        assert shown.size == (1200, 3000)
        assert len(shown.convert("RGB").getcolors(1 << 24)) > 500


# What a hand does: point at the last point of a curve of the overview, pull a frame around it, double click; click the
# head of the first column of a table, twice.
HAND = """<script>
const figure = document.querySelector("figure.overview"), svg = figure.querySelector("svg"), told = [];
svg.setPointerCapture = () => {};
const curves = JSON.parse(figure.dataset.axes).map(({ id }) => svg.querySelector(`#${id} > g[id^="line2d"] > path`));
const numbers = (path) => path.getAttribute("d").match(/[-\\d.]+/g).map(Number);
const curve = curves.find((path) => path && numbers(path).length > 40), [x, y] = numbers(curve).slice(-2);
const act = (name, dx, dy) => {
  const p = new DOMPoint(x + dx, y + dy).matrixTransform(svg.getScreenCTM());
  svg.dispatchEvent(new PointerEvent(name, { clientX: p.x, clientY: p.y }));
};
act("pointermove", -1, 1);
told.push(curve.parentNode.parentNode.id, figure.querySelector("output").textContent);
act("pointerdown", -20, -10); act("pointermove", 10, 10); act("pointerup", 20, 10);
told.push(svg.getAttribute("viewBox"), x, y);
svg.dispatchEvent(new MouseEvent("dblclick"));
told.push(svg.getAttribute("viewBox"));
const head = document.querySelector("th"), table = head.closest("table");
const column = () => [...table.rows].slice(1).map((row) => row.cells[0].textContent);
head.click(); told.push(column()); head.click(); told.push(column());
document.body.innerHTML = ""; document.body.textContent = JSON.stringify(told);
</script>"""


@pytest.mark.slow
@pytest.mark.skipif(BROWSER is None, reason="no Chromium or Chrome is installed")
def test_its_figures_are_read_off_and_enlarged_and_its_tables_sorted(folder):
    page = (folder / "review.html").read_text()
    (folder / "driven.html").write_text(page.replace("</body>", f"{HAND}</body>"))
    shown = browsed(folder, "driven.html", "--dump-dom")
    told = json.loads(html.unescape(shown[shown.index("<body>") + 6 : shown.index("</body>")]).strip())
    _, read, near, x, y, whole, up, down = told
    turns, thinnest = (float(words.split("=")[1]) for words in read.rsplit(",", 2)[::2])
    last = open_archive(folder / "a.h5")["h_min"].values[-1]
    assert (turns, thinnest) == (pytest.approx(2.0, rel=1e-4), pytest.approx(1e6 * last, rel=1e-4))
    left, top, width, height = map(float, near.split())
    assert left < x < left + width < left + 60 and top < y < top + height and whole.startswith("0 0 ")
    assert up == sorted(up, key=str.lower) != down == up[::-1] and len(up) > 10

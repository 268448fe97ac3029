"""The page of a design review, of real archives, as a browser gets it."""

import html.parser
import shutil
import subprocess

import pytest
from command import REFERENCE, sealdyn
from PIL import Image

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


def test_it_stands_by_itself(folder):
    page = Page((folder / "review.html").read_text())
    assert all(address.startswith(("data:image/png;base64,", "#part")) for address in page.addresses)
    assert page.tags.count("img") == 5 and "script" not in page.tags
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
    assert all(" ".join(rule["said"].split()) in text for rule in rules) and text.count("not applicable") >= 5
    study = sealdyn("show", "b.h5", cwd=folder).out.splitlines()
    # The last line is for those who want a table.
    assert all(" ".join(line.split()) in text for line in study[1:-1])


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


@pytest.mark.slow
@pytest.mark.skipif(BROWSER is None, reason="no Chromium or Chrome is installed")
def test_a_browser_shows_it(folder):
    """Without a network, and not as an empty page."""
    quiet = ["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking"]
    more = ["--disable-component-update", "--disable-sync", "--disable-quic", f"--user-data-dir={folder / 'browser'}"]
    words = [BROWSER, *quiet, *more, "--window-size=1200,3000", f"--screenshot={folder / 'page.png'}"]
    subprocess.run([*words, (folder / "review.html").as_uri()], check=True, timeout=120, capture_output=True)
    with Image.open(folder / "page.png") as shown:
        assert shown.size == (1200, 3000)
        assert len(shown.convert("RGB").getcolors(1 << 24)) > 500

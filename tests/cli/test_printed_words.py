"""Words of files on a terminal and in a spreadsheet: nothing that either would obey."""

import csv
import io

import numpy as np
import pytest
from command import sealdyn

from sealdyn.report.text import csv_lines
from sealdyn.studies._runner import StudyContext
from sealdyn.terminal import Progress, say
from sealdyn.units import printable

HOSTILE = ("\x1b[2J", "\x1b]0;title\x07", "\x9b31m", "a\rb", "a\nb", "\u202egnp", "\udc80", "\x00", "\u2028")


@pytest.mark.parametrize("words", HOSTILE)
def test_nothing_that_a_terminal_obeys_is_printed(words, capsys):
    told = printable(f"<{words}>")
    assert told.isprintable() and told.encode() and told.startswith("<") and told.endswith(">")
    say(words, words)
    say(words, error=True)
    out, error = capsys.readouterr()
    assert out.count("\n") == 2 and error.count("\n") == 1 and "\x1b" not in out + error


@pytest.mark.parametrize("words", HOSTILE)
def test_a_study_and_its_progress_print_no_other(words, capsys):
    """Keys and settings are words of a file, too; nor are brackets colours."""
    StudyContext(None, None, progress=print).tell(f"<{words}>")
    (line,) = capsys.readouterr().err.splitlines()
    bar = Progress()
    bar(1.0, 2.0, f"[red]{words}")
    assert line.isprintable() and bar.now["words"].isprintable() and bar.now["words"].startswith("[red]")


def test_plain_words_are_as_they_are():
    assert printable("5 µm, 3·10⁻⁶ — “Dichtung”, 密封") == "5 µm, 3·10⁻⁶ — “Dichtung”, 密封"


@pytest.mark.parametrize("name", ["\x1b[31mred.toml", "a\nb.toml", "\udcff.toml"])
def test_names_of_files_are_words_too(tmp_path, name):
    done = sealdyn("check", name, cwd=tmp_path)
    assert done.code == 2 and done.err.count("\n") == 1 and done.err.strip().isprintable()


CELLS = ["=1+1", "+1 um", "-cmd|' /C calc'!A0", "@SUM(A1)", "\tx", "a=b", "-3.5", "+2e-3", "plain", 'say "x", y']


def test_words_that_a_spreadsheet_would_compute_are_text():
    columns = {"=heading": np.array(CELLS, dtype=object), "number": np.linspace(-1.0, 1.0, len(CELLS))}
    heading, *rows = csv.reader(io.StringIO("\n".join(csv_lines(columns))))
    assert heading == ["'=heading", "number"] and [float(row[1]) for row in rows] == list(columns["number"])
    for cell, (words, _) in zip(CELLS, rows, strict=True):
        assert words in (cell, f"'{cell}")
        assert (words == cell) == (cell in ("a=b", "-3.5", "+2e-3", "plain", 'say "x", y'))

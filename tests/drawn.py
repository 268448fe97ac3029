"""Charts as the tests read them: the figure a chart saves, its lines as data, and whether its words can be read."""

import warnings
from importlib import import_module
from unittest import mock

import numpy as np
from PIL import Image

from sealdyn.archive import write_study


def drawn(chart, archive, out, written=True):
    """The figure that `chart.draw` hands to be saved; `written`: saved too, as a PNG with nothing left beside it."""
    seen, save = [], chart.save

    def keep(figure, path):
        seen.append(figure)
        return save(figure, path) if written else path

    with mock.patch.object(chart, "save", keep):
        assert chart.draw(archive, out) == out
    if written:
        with Image.open(out) as picture:
            assert picture.format == "PNG" and round(picture.info["dpi"][0]) == 150
        assert list(out.parent.glob("*.new")) == []
    (figure,) = seen
    return figure


def study(tmp_path, name, answer, scenario="", **meta):
    """The figure of a study's answer, as it is saved."""
    meta = {"study": name, "name": "seal", "question": "Does it ride?", "overrides": [], "version": "1", **meta}
    path = write_study(tmp_path / "s.h5", scenario, {}, meta, {"verdict": ["It rides."], **answer}, {})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return drawn(import_module(f"sealdyn.report.charts.study_{name}"), path, tmp_path / "s.png")


def panel(figure, title):
    """The axes of this title, or the one whose title begins so."""
    titled = [(ax.get_title("left") or ax.get_title("center"), ax) for ax in figure.axes]
    exact = [ax for words, ax in titled if words == title]
    (found,) = exact or [ax for words, ax in titled if words.startswith(title)]
    return found


def curve(ax, label):
    """x and y of the one line with this label, (2, n)."""
    (line,) = [line for line in ax.lines if line.get_label() == label]
    return np.array(line.get_data(), dtype=float)


def points(ax):
    """x and y of everything drawn as lines or marks in data coordinates, (2, n)."""
    return np.hstack([np.array(line.get_data(), dtype=float) for line in ax.lines if len(line.get_xdata())])


def has_points(ax, x, y, rel=1e-9):
    """Whether each (x, y) is drawn somewhere in the panel."""
    found = points(ax)
    wanted = np.array([np.atleast_1d(x), np.atleast_1d(y)], dtype=float)
    return all(np.isclose(found, pair[:, None], rtol=rel, atol=0.0).all(axis=0).any() for pair in wanted.T)


def text_trouble(figure):
    """Pairs of texts that lie on one another, and texts that leave the page."""
    figure.draw_without_rendering()
    page, hidden = figure.bbox, _hidden(figure)
    texts = [
        text
        for text in figure.findobj(lambda artist: hasattr(artist, "get_text") and hasattr(artist, "get_fontsize"))
        if text.get_visible() and text.get_text().strip() and text not in hidden
    ]
    words = [text.get_text() for text in texts]
    boxes = np.array([text.get_window_extent().extents for text in texts]).reshape(-1, 4)
    low, high = boxes[:, :2], boxes[:, 2:]
    # Letters fill nine tenths of their box's width and eight of its height.
    room = (high - low) * [0.05, 0.1]
    low, high, empty = low + room, high - room, high[:, 0] - low[:, 0] < 1
    meet = np.all((low[:, None] < high) & (low < high[:, None]), axis=-1) & ~empty & ~empty[:, None]
    outside = (boxes[:, :2] < 0).any(axis=1) | (boxes[:, 2:] > [page.x1, page.y1]).any(axis=1)
    return [(words[i], words[j]) for i, j in np.argwhere(np.triu(meet, 1))], [words[i] for i in np.flatnonzero(outside)]


def _hidden(figure):
    """Texts that are there and not drawn: labels of ticks out of view, of hidden axes, unused titles."""
    found = set()
    for ax in [*figure.axes, *(inner for outer in figure.axes for inner in outer.child_axes)]:
        for axis in (ax.xaxis, ax.yaxis):
            visible = axis.get_visible() and ax.axison
            seen = {tick.label1 for tick in axis._update_ticks()} if visible else set()
            for tick in [*axis.get_major_ticks(), *axis.get_minor_ticks()]:
                found |= {tick.label1, tick.label2} - seen
            if not visible:
                found |= {axis.label, axis.offsetText}
    return found


def crossed(ax):
    """Names in a panel that a line not their own, or a mark, runs through."""
    ax.figure.draw_without_rendering()
    found = []
    for text in ax.texts:
        box = text.get_window_extent()
        for line in (line for line in ax.lines if len(line.get_xdata())):
            points = line.get_transform().transform(np.column_stack(line.get_data()).astype(float))
            along = np.linspace(0, 1, 4000)
            at = np.linspace(0, 1, len(points))
            dense = np.column_stack([np.interp(along, at, points[:, k]) for k in (0, 1)])
            inside = (box.x0 < dense[:, 0]) & (dense[:, 0] < box.x1) & (box.y0 < dense[:, 1]) & (dense[:, 1] < box.y1)
            # Its own line runs through the middle of the name.
            middle = np.hypot(dense[:, 0] - (box.x0 + box.x1) / 2, dense[:, 1] - (box.y0 + box.y1) / 2).min()
            if inside.any() and middle > 2:
                found.append(text.get_text())
    return found


def frames(path) -> tuple[list[np.ndarray], int]:
    """Every picture of a GIF, and how often it is shown (0: for ever)."""
    with Image.open(path) as film:
        return [np.asarray(film.convert("RGB")) for k in range(film.n_frames) if not film.seek(k)], film.info["loop"]

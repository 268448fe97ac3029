"""A figure as a page has it: lines that stay sharp as they are enlarged, and the scales by which they are read off."""

import io
import json
import re
from itertools import chain

import numpy as np
from matplotlib import rc_context
from matplotlib.axis import Axis
from matplotlib.figure import Figure

# What has no place in a page, and what says nothing there.
ASIDE = re.compile(r"^.*?(?=<svg)|<!--.*?-->|<metadata>.*?</metadata>", re.DOTALL)
# Share of a pixel by which a curve of many points is simplified: enlarged twenty times nothing is to be seen of it.
SIMPLER = 0.02


def svg_of(figure: Figure) -> tuple[str, str]:
    """The <svg> of a figure, and JSON of its axes: `id` of their group, `box` (left, top, right, bottom) as drawn, and
    of x and y the `name`, the `kind` of scale ("linear", "log", "asinh"), its `width`, and the ends on that scale."""
    held = io.StringIO()
    with rc_context({"svg.hashsalt": "sealdyn", "path.simplify_threshold": SIMPLER}):
        figure.savefig(held, format="svg", metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    # Known only once it is laid out; a point is 1/72 inch.
    height, points = 72.0 * figure.get_figheight(), 72.0 / figure.dpi
    axes = []
    for number, ax in enumerate(figure.axes, 1):
        if not ax.axison or ax.name != "rectilinear":
            continue
        x, y = _scale(ax, ax.xaxis), _scale(ax, ax.yaxis)
        if x and y:
            extent = ax.get_window_extent()
            box = [extent.x0 * points, height - extent.y1 * points, extent.x1 * points, height - extent.y0 * points]
            axes.append({"id": f"axes_{number}", "box": [round(end, 2) for end in box], "x": x, "y": y})
    return ASIDE.sub("", held.getvalue()), json.dumps(axes)


def _scale(ax, axis: Axis) -> dict | None:
    """Of an axis of numbers; None of one of words, of another scale, and without a name."""
    which, kind = axis.axis_name, axis.get_scale()
    alike = getattr(ax, f"get_shared_{which}_axes")().get_siblings(ax)
    names = [getattr(one, f"get_{which}label")() for one in chain([ax], alike)]
    words = [label.get_text() for label in axis.get_ticklabels()]
    name = next(filter(None, names), "")
    if kind not in ("linear", "log", "asinh") or not name or any(word[:1].isalpha() for word in words):
        return None
    width = float(axis.get_transform().linear_width) if kind == "asinh" else 1.0
    ends = np.array(axis.get_view_interval(), float)
    ends = np.log10(ends) if kind == "log" else np.arcsinh(ends / width) if kind == "asinh" else ends
    return {"name": name, "kind": kind, "width": width, "ends": ends.tolist()}

"""Film pressure over the face, over the radius and around the circle, at one gap state."""

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Normalize

from ...archive import read_study
from .face import annulus, in_the_middle
from .page import absent, legend, look, save, study_page
from .palette import BLACK, CONTACT, FILM, GREEN, GREY, PRESSURE

BAR, STEPS = 1e-5, 20
# Of the largest pressure: a field that differs by less around the circle is that of aligned faces.
EVEN = 1e-9
# A legend that lines may run below.
PAPERED = {"frameon": True, "facecolor": "white", "edgecolor": "none", "framealpha": 0.85}


@look()
def draw(archive_path, out_path):
    """The face on the left, profiles over radius and angle on the right, from a study's archive."""
    study = read_study(archive_path)
    answer = study["answer"]
    title, below = "How is the film pressure spread over the face?", " ".join(answer["verdict"])
    field = BAR * np.array([[0.0]] if answer["pressure"] is None else answer["pressure"]["p"])
    # Aligned faces have neither a thinnest nor a thickest place, and the same pressure all around.
    uneven = bool(np.ptp(field, axis=1).max() > EVEN * np.abs(field).max())
    mosaic = [["face", "radius"], ["face", "circle"]] if uneven else [["face", "radius"]]
    figure, ax = study_page(study, 11.5, 7.0, mosaic, title, below, width_ratios=(5, 6),
                            per_subplot_kw={"face": {"projection": "polar"}})  # fmt: skip
    if answer["pressure"] is None:
        for name, words in (("face", "Over the face"), ("radius", "Over the radius")):
            absent(ax[name], words, f"The {answer.get('film', '')} film shows no pressure over the face.")
        return save(figure, out_path)
    r, theta = 1e3 * np.array(answer["pressure"]["r"]), np.array(answer["pressure"]["theta"])
    # Pads in a face that is otherwise even leave it no one thinnest place.
    placed = uneven and len({answer["profiles"]["at"][name] for name in ("thinnest", "thickest")}) > 1
    image = _face(ax["face"], answer, r, theta, field, placed)
    figure.colorbar(image, ax=ax["face"], location="bottom", shrink=0.8, pad=0.04, label="film pressure, bar absolute")
    _over_radius(ax["radius"], answer, r, placed)
    if uneven:
        _around(ax["circle"], answer, theta, placed)
    return save(figure, out_path)


def _face(ax, answer, r, theta, p, placed):
    # The circle closes.
    theta, p = np.append(theta, theta[0] + 2 * np.pi), np.hstack([p, p[:, :1]])
    scale = Normalize(p.min(), max(p.max(), p.min() + 1e-3 * abs(p).max(), p.min() + 1e-9))
    image = ax.pcolormesh(theta, r, p, shading="gouraud", cmap=colormaps[PRESSURE].resampled(STEPS), norm=scale)
    edges = [1e3 * answer["edges"][side][0] for side in ("inner", "outer")]
    words = ["Film pressure", annulus(ax, *edges), *(["circle: thinnest film"] if placed else [])]
    # A title above would lie on the page's heading.
    in_the_middle(ax, "\n".join(words))
    if placed:
        low = answer["h_min"]
        ax.plot(low["theta"], 1e3 * low["radius"], "o", ms=7, mfc="none", mec=CONTACT, mew=1.8, clip_on=False)
    return image


def _over_radius(ax, answer, r, placed):
    profiles, beside = answer["profiles"], answer.get("beside") or []
    if placed and not beside:
        for name, colour, dashes in (("thinnest", CONTACT, "-"), ("thickest", GREEN, "--")):
            label = f"where the film is {name}, {np.degrees(profiles['at'][name]):.4g}°"
            ax.plot(r, BAR * np.array(profiles[name]), color=colour, ls=dashes, lw=1.6, label=label)
    label = f"at {1e6 * answer['clearance']:.4g} µm, mean of the circle" if beside else "mean of the circle"
    ax.plot(r, BAR * np.array(profiles["circle_mean"]), color=FILM, lw=2.0, label=label)
    for k, other in enumerate(beside):
        # From the film's own colour on, lighter as the clearance grows.
        colour, label = colormaps[PRESSURE]((k + 1) / (len(beside) + 1)), f"at {1e6 * other['clearance']:.4g} µm"
        ax.plot(r, BAR * np.array(other["circle_mean"]), color=colour, lw=1.6, label=label)
    ax.set(xlabel="radius, mm", ylabel="film pressure, bar", title="Over the radius")
    centre, edges = answer["centre_of_pressure"], [1e3 * answer["edges"][side][0] for side in ("inner", "outer")]
    ax.set_xlim(*edges)
    if centre is not None and 0 <= centre <= 1:
        high, low = edges[::-1] if answer["high_pressure"] == "outer" else edges
        ax.axvline(high + centre * (low - high), color=GREY, ls=":", lw=1.2, label="centre of the gauge pressure")
    _legend(ax, 0.42, 2)


def _around(ax, answer, theta, placed):
    profiles = answer["profiles"]
    degrees = np.append(np.degrees(theta), np.degrees(theta[0]) + 360)

    def closed(name):
        return BAR * np.append(profiles[name], profiles[name][0])

    ax.plot(degrees, closed("width_mean"), color=FILM, lw=2.0, label="mean of the face's width")
    label = f"at r = {1e3 * profiles['at']['mid_radius']:.4g} mm"
    ax.plot(degrees, closed("mid_radius"), color=BLACK, lw=1.4, ls="--", label=label)
    if placed:
        ax.axvline(np.degrees(answer["h_min"]["theta"]), color=CONTACT, ls=":", lw=1.2, label="thinnest film")
    ax.set(xlim=(degrees[0], degrees[-1]), xticks=range(0, 361, 60), xlabel="angle from the x axis, degrees",
           ylabel="film pressure, bar", title="Around the circle")  # fmt: skip
    _legend(ax, 0.2, 3)


def _legend(ax, room: float, columns: int) -> None:
    """The legend above all curves, on `room` (of their height)."""
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + room * (high - low))
    legend(ax, "upper right", ncols=columns, columnspacing=1.0, **PAPERED)

"""Film thickness around the circle: as it changes over the last turns, and at its thinnest moment; film pressure."""

import numpy as np
from matplotlib import colormaps
from matplotlib.colors import Normalize
from matplotlib.ticker import MaxNLocator

from ...archive import FIELD_TIME, field
from .page import CONTACT, EVEN, FILM, PRESSURE, SKY, THICKNESS, absent, annulus, header, look, save, sheet
from .record import DEG, MM, Run

MOST_COLUMNS, STEPS = 1500, 20
# Inches: the sheet, and what the pressure adds to it.
WIDTH, HEIGHT, FOR_PRESSURE = 12.0, 5.8, 4.7
# Angles around the circle, at least, and per wave of the highest order.
ANGLES, PER_WAVE = 180, 16
NOTHING = 1e-12  # m: a film this even shows no thinnest place


def draw(archive_path, out_path, turns: float = 6.0):
    """Map of film thickness over angle and turns, at the radius of its minimum, and over the face at the
    thinnest sample of the whole run; where the archive keeps it, film pressure over the face."""
    run = Run(archive_path)
    drawable = run.clearance is not None and run.has("h_min", "axial_gap_change")
    pressed = drawable and run.info["grid"].get(FIELD_TIME, 0) > 0 and "pressure" in run.info["fields"]
    with look():
        figure = sheet(WIDTH + pressed * FOR_PRESSURE, HEIGHT)
        header(figure, run)
        over_turns = _axes(figure, 0.72, 5.64, 0.64)
        face = _axes(figure, 8.1, 2.76, 0.58, "polar")
        if not drawable:
            absent(over_turns, "Film thickness around the circle")
            absent(face, "Thinnest moment")
            return save(figure, out_path)
        label = f"film thickness, {run.shown('h_min')[0]}"
        if _uneven(run, turns):
            _bar(figure, map_over_turns(over_turns, run, turns), 6.48, label)
        else:
            lines_over_turns(over_turns, run)
        image = face_at_minimum(face, run)
        if image is not None:
            _bar(figure, image, 11.34, label)
        if pressed:
            image = pressure(_axes(figure, 12.5, 2.76, 0.58, "polar"), run)
            _bar(figure, image, 15.74, f"film pressure, {run.info['fields']['pressure'].display_unit}")
        return save(figure, out_path)


def _axes(figure, left: float, width: float, height: float, projection=None):
    """Axes from `left` (inches), `width` wide (inches) and `height` high (share of a sheet with a short heading)."""
    whole, share = figure.get_figwidth(), HEIGHT / figure.get_figheight()
    low = 0.1 if projection else 0.11
    return figure.add_axes((left / whole, low * share, width / whole, height * share), projection=projection)


def _bar(figure, image, left: float, label: str) -> None:
    """The colours of an image; of one that is even a single number."""
    low, high = image.get_array().min(), image.get_array().max()
    even = high - low <= EVEN * abs(high)
    ticks = [low] if even else MaxNLocator(6, steps=[1, 2, 2.5, 5, 10])
    figure.colorbar(image, cax=_axes(figure, left, 0.13, 0.64), label=label, ticks=ticks, format="{x:.5g}")


def thickness(run: Run, radius, angle, first: int, stop: int):
    """Film thickness (m): rows first to stop along axis 0, then broadcast over `radius` and `angle`.

    h = C + dz + r (g_x sin - g_y cos) + shape(r) + waves; no tilt in the archive: aligned faces.
    """

    def rows(name):
        values = run.values(name, first, stop) if run.has(name) else np.zeros(min(stop, run.rows) - first)
        return values.reshape(-1, *([1] * np.broadcast(radius, angle).ndim))

    wedge = rows("relative_tilt_x") * np.sin(angle) - rows("relative_tilt_y") * np.cos(angle)
    coning = rows("coning") if run.has("coning") else None
    waves = sum(
        rows(f"gap_cos_{n}") * np.cos(n * angle) + rows(f"gap_sin_{n}") * np.sin(n * angle) for n in run.wave_orders
    )
    return run.clearance + rows("axial_gap_change") + radius * wedge + run.shape(radius, coning) + waves


def around(run: Run) -> np.ndarray:
    """Angles (rad) of a full circle, fine enough for the waves."""
    return np.linspace(0, 2 * np.pi, max(ANGLES, PER_WAVE * max(run.wave_orders, default=0)) + 1)


def _uneven(run: Run, turns: float) -> bool:
    """Whether the film differs around the circle, by tilt or waves, in the last `turns`."""
    first = run.last(turns, run.rows)
    tilts = max((np.abs(run.values(f"relative_tilt_{axis}", first)).max() for axis in "xy"
                 if run.has(f"relative_tilt_{axis}")), default=0.0)  # fmt: skip
    rise = 2 * tilts * _edge(run, first)
    return bool(run.wave_orders) or rise > max(NOTHING, EVEN * np.abs(run.values("h_min", first)).max())


def lines_over_turns(ax, run: Run) -> None:
    """Of faces that stay square with each other the film over the whole run, at either edge."""
    unit, per = run.shown("h_min")
    radii = (run.film("inner_radius"), run.film("outer_radius"))
    rows = _columns(run, 0)
    for radius, colour, width, edge in zip(radii, (FILM, SKY), (2.6, 1.0), ("inner", "outer"), strict=True):
        if radius:
            values = _thickness_of(run, rows, radius, np.zeros(1))[:, 0]
            ax.plot(run.progress[rows], per * values, color=colour, lw=width, label=f"at the {edge} radius")
    ax.set(title="Film thickness, even around the circle", xlabel=run.progress_label, ylabel=f"film thickness, {unit}")
    ax.set_xlim(run.progress[0], run.progress[-1])
    ax.set_ylim(min(0.0, 1.1 * ax.dataLim.y0), 1.25 * ax.dataLim.y1)
    ax.legend(loc="upper right", ncols=2)


def _columns(run: Run, first: int) -> np.ndarray:
    """Rows from `first` on, evenly thinned to the columns of a map."""
    return np.unique(np.linspace(first, run.rows - 1, min(MOST_COLUMNS, run.rows - first)).round().astype(int))


def _thickness_of(run: Run, rows, radius: float, angles) -> np.ndarray:
    """Film thickness (m) of rising rows over angles; read in blocks, of which the rows are kept."""
    kept = []
    for start in range(rows[0], rows[-1] + 1, MOST_COLUMNS):
        inside = rows[(rows >= start) & (rows < start + MOST_COLUMNS)]
        if len(inside):
            kept.append(thickness(run, radius, angles, start, inside[-1] + 1)[inside - start])
    return np.concatenate(kept)


def map_over_turns(ax, run: Run, turns: float):
    """Angle against turns; the line follows the smallest film thickness."""
    first = run.last(turns, run.rows)
    radius, rows, angles = _edge(run, first), _columns(run, first), around(run)
    over = run.shown("h_min")[1] * _thickness_of(run, rows, radius, angles)
    progress = run.progress[rows]
    even = np.linspace(progress[0], progress[-1], len(progress))
    over = over[np.clip(np.searchsorted(progress, even), 0, len(progress) - 1)]
    image = ax.imshow(
        over.T,
        origin="lower",
        aspect="auto",
        extent=(progress[0], progress[-1], 0, 360),
        cmap=colormaps[THICKNESS].resampled(STEPS),
        norm=scale(over),
        interpolation="bilinear",
        interpolation_stage="data",
    )
    title = "Film thickness around the circle"
    if run.has("h_min_angle"):
        angle = DEG * run.values("h_min_angle", first)[rows - first] % 360
        ax.plot(progress, angle, ".", ms=1.6, color="white")
        title += "  (white: where it is thinnest)"
    ax.set_title(title)
    ax.grid(False)
    ax.set(xlabel=run.progress_label, yticks=range(0, 361, 60))
    ax.set_ylabel(f"angle from the x axis, degrees, at r = {MM * radius:.4g} mm")
    return image


def face_at_minimum(ax, run: Run):
    """The face at the sample with the smallest h_min of the whole run."""
    at = int(np.nanargmin(run.values("h_min")))
    inner, outer = run.film("inner_radius"), run.film("outer_radius")
    if not (inner and outer):
        absent(ax, "Thinnest moment")
        return None
    radius, angle = np.linspace(inner, outer, 12), around(run)
    unit, per = run.shown("h_min")
    over = np.broadcast_to(thickness(run, radius[:, None], angle, at, at + 1)[0], (len(radius), len(angle)))
    low = np.unravel_index(over.argmin(), over.shape)
    image = _over_face(ax, radius, angle, per * over, THICKNESS)
    if np.ptp(over[low[0]]) > NOTHING:
        _thinnest_place(ax, angle[low[1]], radius[low[0]])
    ax.set_title(f"Thinnest sample: {run.values('h_min', at, at + 1)[0] * per:.4g} {unit} at {_when(run, at)}",
                 pad=16, loc="center")  # fmt: skip
    return image


def pressure(ax, run: Run):
    """The film pressure over the face at the instant with the smallest h_min among those whose fields are kept; the
    mark: where the film is thinnest."""
    rows = np.searchsorted(run.values("time"), field(run.path, FIELD_TIME))
    # A run that goes on may have kept more since this figure was begun.
    rows = rows[rows < run.rows]
    h_min = [run.values("h_min", row, row + 1)[0] for row in rows]
    kept, at = int(np.argmin(h_min)), int(rows[np.argmin(h_min)])
    radius, angle = field(run.path, "r"), field(run.path, "theta")
    over = run.info["fields"]["pressure"].display_factor * field(run.path, "pressure")[kept]
    # The circle closes.
    angle, over = np.append(angle, angle[0] + 2 * np.pi), np.hstack([over, over[:, :1]])
    image = _over_face(ax, radius, angle, over, PRESSURE)
    if run.has("h_min_angle", "h_min_radius", "relative_misalignment"):
        tilt, place, there = (
            run.values(name, at, at + 1)[0] for name in ("relative_misalignment", "h_min_angle", "h_min_radius")
        )
        if tilt * there > NOTHING:
            _thinnest_place(ax, place, there)
    ax.set_title(f"Film pressure at {_when(run, at)}", pad=16, loc="center")
    return image


def _over_face(ax, radius, angle, over, colours: str):
    """Values (radii, angles) over the face."""
    image = ax.pcolormesh(
        angle, MM * radius, over, shading="gouraud", cmap=colormaps[colours].resampled(STEPS), norm=scale(over),
        rasterized=True,
    )  # fmt: skip
    annulus(ax, MM * radius[0], MM * radius[-1])
    return image


def _thinnest_place(ax, angle, radius) -> None:
    ax.plot(angle, MM * radius, "o", ms=7, mfc="none", mec=CONTACT, mew=1.8, clip_on=False)


def _when(run: Run, row: int) -> str:
    return f"turn {run.progress[row]:.4g}" if run.turning else f"{run.progress[row]:.4g} {run.progress_unit}"


def scale(over) -> Normalize:
    """From the thinnest to the thickest, but never a scale so fine that nothing happens all over it."""
    return Normalize(over.min(), max(over.max(), over.min() + 2e-3 * abs(over).max()))


def _edge(run: Run, first: int) -> float:
    """Radius (m) where the film is thinnest most of the time."""
    if run.has("h_min_radius"):
        return float(np.median(run.values("h_min_radius", first)))
    return run.film("inner_radius") or 0.0

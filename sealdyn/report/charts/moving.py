"""Pictures of a run one after the other: drawn, and written as a GIF, an MP4 or a PNG."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from PIL import Image

from .page import MARK, header, look, replacing, sheet
from .record import MILLISECONDS, Run

# Pictures of a turn by default, and of a second; pictures at most; inches of a picture and dots of an inch.
PER_TURN, PER_SECOND, MOST, SIZE, DPI = 36, 15, 2000, (11.0, 6.2), 80
# Colours of a whole picture.
COLOURS = 255
SUFFIXES = (".gif", ".mp4", ".png")


def moments(run: Run, turns: float, per_turn: int, out_path: Path) -> np.ndarray:
    """Progress (m,) at which a picture of the last `turns` turns is asked for.

    **Raises** ValueError for more than MOST in a file of several."""
    end = run.progress[-1]
    begin = max(run.progress[0], end - turns)
    count = max(2, 1 + round((end - begin) * per_turn))
    if not is_still(out_path) and count > MOST:
        raise ValueError(f"{count} pictures; expected at most {MOST}: fewer --turns or --per-turn")
    return np.linspace(begin, end, count)


def is_still(path: Path) -> bool:
    """Whether a file of this name holds one picture."""
    return path.suffix == ".png"


def check_name(path: Path) -> None:
    """Raises ValueError for a kind of file that cannot be written."""
    if path.suffix not in SUFFIXES:
        raise ValueError(f'"{path.name}"; expected a file name ending in {", ".join(SUFFIXES)}')


def write(run: Run, panels, at: np.ndarray, path: Path, progress=None) -> Path:
    """Write the pictures at the progress `at` (m,), of a still the last; `panels` as of `stage`, `progress(done, end,
    words)`.  Returns the path."""
    pictures = _pictures(run, panels, at, is_still(path), progress)
    with replacing(path) as fresh:
        (_write_mp4 if path.suffix == ".mp4" else _write)(pictures, fresh)
    return path


def stage(run: Run, panels, at: np.ndarray):
    """The figure of all pictures and functions of the progress that move what moves in it: those that `panels(figure,
    run, at, top)` returns, which draws what stands still below `top` (share of the height)."""
    with look():
        figure = sheet(*SIZE)
        figure.set_dpi(DPI)
        return figure, panels(figure, run, at, header(figure, run))


def _pictures(run: Run, panels, at: np.ndarray, still: bool, progress) -> Iterator[Image.Image]:
    """One after the other, or the last one; nothing but what moves is drawn anew."""
    figure, movers = stage(run, panels, at)
    at = at[-1:] if still else at
    for k, moment in enumerate(at):
        for move in movers:
            move(moment)
        figure.canvas.draw()
        if progress:
            progress(k + 1, len(at), f"picture {k + 1} of {len(at)}")
        yield Image.fromarray(np.asarray(figure.canvas.buffer_rgba())).convert("RGB")


def _write(pictures: Iterator[Image.Image], path: Path) -> None:
    """One palette for all, so that only what moves is stored."""
    few, palette = [], None
    for picture in pictures:
        # Not the commonest colours: a mark of a few dots keeps its own.
        palette = palette or picture.quantize(COLOURS, method=Image.Quantize.MAXCOVERAGE)
        few.append(picture.quantize(palette=palette, dither=Image.Dither.NONE))
    more = {"save_all": True, "append_images": few[1:], "duration": round(MILLISECONDS / PER_SECOND), "loop": 0}
    few[0].save(path, **(more if path.suffix == ".gif" else {}))


def _write_mp4(pictures: Iterator[Image.Image], path: Path) -> None:
    from imageio_ffmpeg import write_frames

    writer = None
    for picture in pictures:
        if writer is None:
            # The codec wants even numbers.
            width, height = (length - length % 2 for length in picture.size)
            writer = write_frames(str(path), (width, height), fps=PER_SECOND, macro_block_size=2)
            writer.send(None)
        writer.send(np.ascontiguousarray(np.asarray(picture)[:height, :width]))
    writer.close()


# --- what pictures of both kinds of seal have in common ----------------------------------------------------


def now(ax, run: Run, at) -> Callable[[float], None]:
    """Makes a panel of the stretch `at` (progress) a time line: a mark that moves; returns what moves it."""
    mark = ax.axvline(at[0], color=MARK, lw=1.2, clip_on=False)
    ax.set(xlabel=run.progress_label, xlim=(at[0], at[-1]))
    return lambda moment: mark.set_xdata([moment, moment])


def round_times(most: float) -> float:
    """How many times something is enlarged, at most `most`: a 1, 2 or 5 of a decade, or 1."""
    if not most >= 2.0:
        return 1.0
    decade = 10.0 ** np.floor(np.log10(most))
    return float(decade * max(step for step in (1, 2, 5) if step * decade <= most * (1 + 1e-9)))

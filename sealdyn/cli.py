"""The verbs of the command line.  Everything heavy is imported by the verb that needs it."""

import contextlib
import json
import os
import shlex
import sys
from importlib import import_module
from pathlib import Path
from typing import Annotated, Literal

import typer
from typer.core import TyperCommand

from .numerics.interruption import VARIABLES
from .status import Status
from .terminal import (
    CHECK_FAILED,
    DONE,
    EXIT,
    Progress,
    Stop,
    carried_out,
    drawn,
    interruption,
    kept_of_run,
    kept_of_study,
    leaves,
    left,
    libraries_on_stderr,
    not_written,
    reads,
    say,
)  # fmt: skip

# Before anything loads a BLAS.
for _threads in VARIABLES:
    os.environ.setdefault(_threads, "1")
# Whatever is set: figures are files, and ask for no screen; kernels are compiled, and take one thread.
os.environ |= {"MPLBACKEND": "agg", "NUMBA_DISABLE_JIT": "0", "NUMBA_NUM_THREADS": "1"}
# It would look for plugins in everything that is installed.
os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")

# Bytes of an archive whose size is worth a line.
WORTH_SAYING = 1e9
# Figures of a run, and what they are written as.
CHARTS = ("overview", "orbit", "film", "spectrum", "poincare")
FIGURES = (".png", ".svg", ".pdf")
# What `sealdyn` alone prints.
FIRST_STEPS = (
    ("sealdyn new fms", "writes a commented seal to change: fms.toml"),
    ("sealdyn check fms.toml", "says what is wrong with it, and what design rules say"),
    ("sealdyn run fms.toml", "computes its motion: outputs/fms.h5 and a figure"),
    ("sealdyn plot outputs/fms.h5", "draws it again; with --kind orbit otherwise"),
    ("sealdyn study stability fms.toml", "answers a question; sealdyn study --help names them"),
    ("sealdyn list", "names the scenarios that come with the program"),
    ("sealdyn --help", "lists all commands"),
)

app = typer.Typer(
    add_completion=True,
    epilog=f"First steps: {', '.join(line for line, _ in FIRST_STEPS[:-2])}.  sealdyn alone says what each does.",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    help=(
        "Time-domain rotor dynamics of flexibly mounted mechanical face seals.  "
        "Exit codes: 0 done, 2 bad input, 3 film collapsed, 4 solver failed, 5 a check failed, 130 interrupted."
    ),
)


def _say_version(asked: bool):
    if asked:
        from . import __version__

        print(f"sealdyn {__version__}")
        raise typer.Exit


@app.callback(invoke_without_command=True)
def _options(
    context: typer.Context,
    version: Annotated[
        bool, typer.Option("--version", callback=_say_version, is_eager=True, help="print the version and end")
    ] = False,
):
    if context.invoked_subcommand is None:
        width = max(len(line) for line, _ in FIRST_STEPS)
        print("sealdyn: how the rings of a mechanical face seal move.  First steps:\n")
        for line, what in FIRST_STEPS:
            print(f"  {line:{width}}  {what}")


def _completes(room: str, names: str):
    """What the shell offers for a word of which `names()` of a room are the choices: loaded when it is asked for."""
    return lambda incomplete: [
        name for name in vars(import_module(f"sealdyn.{room}"))[names]() if name.startswith(incomplete)
    ]


ScenarioFile = Annotated[Path, typer.Argument(help="scenario (TOML), or an archive (HDF5) whose scenario is run again")]
Overrides = Annotated[list[str] | None, typer.Option("--set", help='override, e.g. rotor.runout="0.2 mrad"')]
AsJson = Annotated[bool, typer.Option("--json", help="one JSON object on standard output, progress on standard error")]


def _read(path: Path, overrides):
    """Scenario of a TOML file or of an archive; input errors end here."""
    from .scenario.reader import ScenarioError, read_scenario

    try:
        with reads(path) if path.suffix == ".h5" else contextlib.nullcontext():
            scenario = read_scenario(path, overrides or ())
        if scenario.study:
            from .studies._declared import refuse_unknown_studies

            refuse_unknown_studies(scenario)
        return scenario
    except ScenarioError as error:
        raise Stop(Status.INVALID, str(error), errors=(error, *error.others)) from None


@app.command()
def run(
    file: ScenarioFile,
    set: Overrides = None,
    out: Annotated[Path | None, typer.Option(help="archive to write (default outputs/<scenario>.h5)")] = None,
    plot: Annotated[bool, typer.Option("--plot/--no-plot", help="draw the overview figure beside the archive")] = True,
    as_json: AsJson = False,
    resume: Annotated[bool, typer.Option("--continue", help="go on with an interrupted or killed run")] = False,
    verbose: Annotated[bool, typer.Option("--verbose", help="print all of the summary")] = False,
    yes: Annotated[bool, typer.Option("--yes", help="also a run of days, or of an archive of many gigabytes")] = False,
):
    """Run a scenario: archive, figure, and what a seal engineer reads first."""
    from .archive import ArchiveError, file_stem, partial_path
    from .quantities import reading_in
    from .report.summary import run_answer
    from .report.text import lines, written_units
    from .scene.scene import SceneError
    from .simulation.simulate import simulate

    scenario = _read(file, set)
    if out is None:
        stem = f"{file.stem}-rerun" if file.suffix == ".h5" else file_stem(scenario.name)
        out = (file.parent if file.suffix == ".h5" else Path("outputs")) / f"{stem}.h5"
    if out.is_dir() or out.suffix != ".h5":
        raise Stop(Status.INVALID, f'--out: found "{out}"; expected a file name ending in .h5')
    if resume:
        _check_resumable(out, scenario)
    yes = _large(file, scenario, yes)
    words = [str(file), *(f"--set {shlex.quote(word)}" for word in set or ()), "--out", str(out), "--continue"]
    leaves(lambda: kept_of_run(partial_path(out), words))
    with Progress() as bar, libraries_on_stderr(), interruption.looks():
        try:
            result = simulate(
                scenario, out, progress=bar, stop=lambda: bool(interruption.asked), resume=resume, allow_large=yes
            )
        except (SceneError, ArchiveError) as error:
            raise Stop(error.status, f"{file}: {error}") from None
        except OSError as error:
            raise not_written(error, out, left["words"]()) from None
    summary = {**result.summary, "figure": None}
    interrupted = result.status == Status.INTERRUPTED
    leaves(lambda: kept_of_run(result.archive, words) if interrupted else f"the run is complete: {result.archive}")
    if plot and not interrupted and not interruption.asked:
        summary["figure"] = drawn("charts.overview", result.archive)
    if as_json:
        print(json.dumps(summary))
    else:
        with reading_in(written_units({"scenario": scenario.text, "overrides": scenario.overrides})):
            say(*lines(scenario.name, run_answer(summary), verbose))
    left["answered"] = True
    raise typer.Exit(EXIT[result.status])


def _large(file, scenario, yes: bool) -> bool:
    """Whether a large run is wanted: said, or asked on a terminal; what is worth saying of its size is said."""
    from .scene.scene import SceneError
    from .simulation.plausibility import refuse_large, size_of

    size = size_of(scenario)
    try:
        refuse_large(scenario, yes)
    except SceneError as error:
        asked = size.possible and sys.stdin.isatty()
        if not (asked and typer.confirm(f"{size}.  Run it?", err=True)):
            raise Stop(Status.INVALID, f"{file}: {error}") from None
        return True
    if size.bytes > WORTH_SAYING:
        say(size, error=True)
    return yes


def _check_resumable(out, scenario):
    from .archive import partial_path, read_info
    from .simulation.simulate import going_on

    source = partial_path(out) if partial_path(out).exists() else out
    if not source.exists():
        raise Stop(Status.INVALID, f"{source}: nothing to continue; run without --continue first")
    with reads(source):
        info = read_info(source)
    if info["status"] not in (Status.RUNNING, Status.INTERRUPTED):
        raise Stop(Status.OK, f"{source}: nothing to continue, the run is complete ({info['status']})")
    held, now = (
        [(tables.get(name) or {}).get("motion") for name in ("shaft", "housing")]
        for tables in (info["resolved"], scenario.resolved())
    )
    asked = list(going_on(scenario, out).overrides)
    if info["scenario"] != scenario.text or list(info.get("overrides", [])) != asked or held != now:
        line = f"{source}: was made from another scenario text or other --set; run without --continue"
        raise Stop(Status.INVALID, line)


@app.command()
def check(file: ScenarioFile, set: Overrides = None, as_json: AsJson = False):
    """Read a scenario, say what is wrong with it or print it resolved to SI."""
    from .analysis.desk import checked
    from .archive import ArchiveError
    from .quantities import reading_in
    from .report.text import resolved_lines, written_units
    from .scene.scene import SceneError
    from .simulation.plausibility import size_of

    scenario = _read(file, set)
    odd = _refuse_settings(scenario) if scenario.study else []
    # The sentences of its rules and warnings have numbers, too.
    with reading_in(written_units({"scenario": scenario.text, "overrides": scenario.overrides})):
        with Progress() as bar:
            try:
                found = checked(scenario)
            except (SceneError, ArchiveError) as error:
                raise Stop(error.status, f"{file}: {error}") from None
            bar(1.0, 1.0, "ready")
        found["warnings"] += odd
        if as_json:
            print(json.dumps(found))
        else:
            say(*resolved_lines(found))
            if (size := size_of(scenario)).bytes > WORTH_SAYING:
                say(f"  size          {size}")


def _refuse_settings(scenario) -> list[str]:
    """Ends the verb for settings of a study that it does not take; else what is odd in them."""
    from .scenario.errors import ScenarioError
    from .studies._declared import refuse_settings

    try:
        return refuse_settings(scenario)
    except ScenarioError as error:
        raise Stop(Status.INVALID, str(error), errors=(error,)) from None


def _of_a_face_seal(file):
    """Ends the verb for an archive of a radial seal."""
    from .archive import is_study, read_info
    from .report.summary import is_radial

    if not is_study(file) and is_radial(read_info(file)):
        raise Stop(Status.INVALID, f"{file}: the archive of a radial seal; expected that of a face seal: its figure "
                                   "is the overview, its motion in animate")  # fmt: skip


@app.command("compile")
def compile_kernels():
    """Compile all that runs need beforehand, in an image for instance: every film and method, some minutes."""
    from .analysis.desk import compile_all

    leaves(lambda: "what has been compiled is kept")
    with Progress() as bar, libraries_on_stderr():
        found = compile_all(bar)
    say(found)


@app.command()
def new(
    kind: Annotated[
        str,
        typer.Argument(
            help="fms (the stator floats), fmr (the rotor), fmsr (both), gas (a sealing dam), pump (rough faces that "
            "touch) or wavy (wavy and rough ones)",
            autocompletion=_completes("scenario.templates", "kinds"),
        ),
    ],
    out: Annotated[Path | None, typer.Option(help="scenario to write (default KIND.toml here)")] = None,
):
    """Write a commented scenario to begin with."""
    from .scenario.templates import kinds, template

    if kind not in kinds():
        line = f'new: found "{kind}"; expected one of {", ".join(kinds())}{_nearest(kind, kinds())}'
        raise Stop(Status.INVALID, line)
    out = out or Path(f"{kind}.toml")
    try:
        with open(out, "x", encoding="utf-8") as file:
            file.write(template(kind))
    except FileExistsError:
        raise Stop(Status.INVALID, f"{out}: is there already; expected --out with another name") from None
    except OSError as error:
        raise not_written(error, out, "nothing is kept") from None
    say(f"{out}: try  sealdyn check {out}  and  sealdyn run {out}")


@app.command()
def schema(radial: Annotated[bool, typer.Option("--radial", help="of lip and circumferential seals")] = False):
    """Print the JSON schema of scenario files, for editors."""
    from .studies._declared import schema as schema_of

    print(json.dumps(schema_of(radial), indent=2))


@app.command("list")
def list_scenarios(as_json: AsJson = False):
    """Name the scenarios that come with the program, and what each asks."""
    from .scenario.templates import examples, shipped_folder, shipped_paths

    folder, found, paths = shipped_folder(), examples(), shipped_paths()
    if as_json:
        rows = [{"name": n, "question": q, "file": str(paths[n])} for n, q in found.items()]
        print(json.dumps({"status": Status.OK, "message": f"{len(rows)} scenarios", "scenarios": rows}))
        return
    say(f"scenarios in {folder}:")
    for name, question in found.items():
        say(f"  {name:{max(map(len, found))}}  {question}")


@app.command()
def show(
    file: Annotated[Path, typer.Argument(help="archive (HDF5), complete or still being written")],
    csv: Annotated[bool, typer.Option("--csv", help="all series, or a table of a study, to standard output")] = False,
    mat: Annotated[Path | None, typer.Option("--mat", help="MATLAB file to write them to")] = None,
    table: Annotated[str | None, typer.Option(help="which table of a study, as --csv has it or for --mat")] = None,
    units: Annotated[Literal["si", "read"], typer.Option(help="of --csv: SI, or as people read them, um, ml/h")] = "si",
    as_json: AsJson = False,
):
    """Say what an archive holds; works while a run writes it."""
    from .archive import column, is_study, read_info
    from .report.text import archive_lines, csv_rows

    if mat is not None and mat.suffix != ".mat":
        raise Stop(Status.INVALID, f'--mat: found "{mat}"; expected a file name ending in .mat')
    with reads(file):
        if is_study(file):
            return _show_study(file, csv, mat, as_json, table, units)
        if table is not None:
            raise Stop(Status.INVALID, f"--table: found {table!r}; expected nothing, {file} is the archive of a run")
        info = read_info(file)
        if mat is not None:
            _write_mat(mat, {name: column(file, name) for name in ("time", *info["series"])}, "series of the run")
        elif csv:
            for row in csv_rows(info, lambda name, rows: column(file, name, rows), units == "read"):
                say(row, cells=True)
        elif as_json:
            names = ("status", "message", "rows", "summary", "scenario", "version", "libraries", "events")
            print(json.dumps({name: info.get(name) for name in names}))
        else:
            say(*archive_lines(file, info))


def _show_study(file, csv, mat, as_json, table, units):
    """The answer of a study; a table of it for other programs."""
    from .archive import answer_tables, read_study
    from .report.text import as_read, csv_lines, study_lines, tables_line

    study = read_study(file)
    answer = study["answer"]
    if mat is not None:
        name, columns = _table_of(file, study, table)
        # MATLAB has no points in names, and no units.
        plain = {key.split(" [")[0].replace(".", "_"): values for key, values in columns.items()}
        _write_mat(mat, plain, f"columns of the table {name}, units as --csv has them")
    elif csv or table is not None:
        columns = _table_of(file, study, table)[1]
        for line in csv_lines(as_read(columns) if units == "read" else columns):
            say(line, cells=True)
    elif as_json:
        print(json.dumps(answer))
    else:
        say(f"{study['name']}, study {study['study']}:", *study_lines(answer), *tables_line(answer_tables(study)))


def _table_of(file, study, name) -> tuple[str, dict]:
    """Name and columns of a table of a study: the one asked for, or that there is, or that is meant for others."""
    from .archive import answer_tables

    tables = answer_tables(study)
    if name is None and isinstance(study["answer"].get("table"), dict):
        name = "table"
    if name is None and len(tables) == 1:
        return next(iter(tables.items()))
    if name in tables:
        return name, tables[name]
    found = "nothing" if name is None else f'"{name}"'
    expected = f"one of {', '.join(tables)}{_nearest(name or '', tables)}" if tables else "nothing, it has no table"
    raise Stop(Status.INVALID, f"{file}: --table: found {found}; expected {expected}")


def _write_mat(path, columns, words):
    """Columns of numbers into a MATLAB file; `words` say what they are."""
    from scipy.io import savemat

    try:
        savemat(path, columns, oned_as="column")
    except OSError as error:
        raise Stop(Status.INVALID, f"{path}: cannot be written ({error.strerror})") from None
    say(f"{path}: {len(columns)} {words}, {len(next(iter(columns.values())))} rows")


@app.command()
def plot(
    file: Annotated[Path, typer.Argument(help="archive (HDF5)")],
    kind: Annotated[
        str | None,
        typer.Option(
            help="of a run: overview (default), orbit, film, spectrum or poincare",
            autocompletion=lambda incomplete: [name for name in CHARTS if name.startswith(incomplete)],
        ),
    ] = None,
    out: Annotated[Path | None, typer.Option(help="figure to write: png, svg, pdf (default png, beside it)")] = None,
):
    """Draw a figure from an archive, of a study its own."""
    from .archive import is_study, read_study
    from .studies import study_names

    if kind is not None and kind not in CHARTS:
        line = f'--kind: found "{kind}"; expected one of {", ".join(CHARTS)}{_nearest(kind, CHARTS)}'
        raise Stop(Status.INVALID, line)
    if out is not None and out.suffix not in FIGURES:
        raise Stop(Status.INVALID, f'--out: found "{out}"; expected a file name ending in {", ".join(FIGURES)}')
    if out is None:
        out = file.with_name(file.stem + ("" if kind in (None, "overview") else f"-{kind}") + ".png")
    with reads(file):
        name = kind or "overview"
        if is_study(file):
            if kind is not None:
                raise Stop(Status.INVALID, f'--kind: found "{kind}" of a study\'s archive; expected none, it has one')
            asked = read_study(file)["study"]
            if asked.replace("_", "-") not in study_names():
                raise Stop(Status.INVALID, f'{file}: study "{asked}"; expected one of {", ".join(study_names())}')
            name = None
        elif kind not in (None, "overview"):
            _of_a_face_seal(file)
        try:
            import_module("sealdyn.report." + (f"charts.{name}" if name else "panels")).draw(file, out)
        except OSError as error:
            raise not_written(error, out, "the archive is whole") from None
    say(out)


@app.command()
def animate(
    file: Annotated[Path, typer.Argument(help="archive (HDF5) of a run")],
    out: Annotated[Path | None, typer.Option(help="GIF, MP4 or a still PNG (default GIF beside the archive)")] = None,
    turns: Annotated[float, typer.Option(help="last turns of the shaft (at rest: ms)", min=1e-6)] = 4.0,
    per_turn: Annotated[int, typer.Option(help="pictures of a turn (at rest: of a ms)", min=1)] = 36,
):
    """Show the motion: both rings with enlarged tilts, the film over the face, the orbit, and the time line; of a
    radial seal the shaft with enlarged runout, its followers, and gap and load around it."""
    from .archive import is_study
    from .report.charts.animation import animate

    out = out or file.with_suffix(".gif")
    with Progress() as bar, reads(file):
        if is_study(file):
            raise Stop(Status.INVALID, f"{file}: the archive of a study; expected that of a run")
        try:
            animate(file, out, turns, per_turn, progress=bar)
        except ImportError:
            line = f'--out: found "{out}"; expected .gif, or the package imageio-ffmpeg: pip install "sealdyn[video]"'
            raise Stop(Status.INVALID, line) from None
        except ValueError as error:
            raise Stop(Status.INVALID, f"animate: found {error}") from None
        except OSError as error:
            raise not_written(error, out, "the archive is whole") from None
    say(out)


@app.command()
def report(
    files: Annotated[list[Path], typer.Argument(help="archives (HDF5) of runs and studies")],
    out: Annotated[Path, typer.Option(help="page to write")] = Path("report.html"),
    title: Annotated[str, typer.Option(help="its heading")] = "",
):
    """Write one page for a design review: it opens anywhere, without a network."""
    from .analysis.sources import sources_of_film
    from .report.review import review

    if out.suffix not in (".html", ".htm"):
        raise Stop(Status.INVALID, f'--out: found "{out}"; expected a file name ending in .html')
    for file in files:
        _must_be_archive(file)
    with Progress() as bar, reads(files[0]):
        try:
            review(files, out, title, _rules_of, sources_of_film, progress=bar)
        except OSError as error:
            raise not_written(error, out, "the archives are whole") from None
    say(out)


@app.command()
def compare(
    one: Annotated[Path, typer.Argument(help="archive (HDF5) of a run")],
    other: Annotated[Path, typer.Argument(help="archive of another run")],
    as_json: AsJson = False,
):
    """Say what two runs have different: of their scenes, and of their results."""
    from .report.comparison import comparison, comparison_lines

    for file in (one, other):
        _must_be_archive(file)
    with reads(other):
        found = comparison(one, other)
    if as_json:
        print(json.dumps(found))
    else:
        say(*comparison_lines(found, _in_words(one)))


def _in_words(file):
    """What tells a number at a key of the scene of a run, as `comparison_lines` wants it."""
    from .quantities import in_words
    from .scenario.settings import with_own_unit

    scene = _read(file, None).scene
    return lambda key, value: in_words(with_own_unit(scene, {"key": key})["si"].replace("SI", "1"), value, digits=6)


def _rules_of(file, info) -> list[dict]:
    """What the design rules say of the scene of a run."""
    from .analysis.desk import rules_of
    from .archive import ArchiveError
    from .scene.scene import SceneError

    try:
        return rules_of(_read(file, None))
    except (SceneError, ArchiveError) as error:
        # It began from an archive, say, that is gone.
        say(f"warning: {file}: the page has no design rules ({error})", error=True)
        return []


def _must_be_archive(file):
    from .archive import is_study, read_info, read_study

    with reads(file):
        (read_study if is_study(file) else read_info)(file)


@app.command()
def validate(
    source: Annotated[
        str | None,
        typer.Argument(
            help="one source, e.g. zuk-1972 (default all)",
            autocompletion=_completes("analysis.sources", "source_names"),
        ),
    ] = None,
    as_json: AsJson = False,
):
    """Compare published numbers with what the program computes: all sources, or one."""
    from .analysis.sources import checks, report, source_names, wanted_sources

    try:
        wanted = wanted_sources(source)
    except ValueError as error:
        near = _nearest(source.replace("_", "-"), source_names())
        raise Stop(Status.INVALID, f"{error}{near}") from None
    with Progress(), libraries_on_stderr():
        found = checks(wanted)
    rows = [row for part in found.values() for row in part]
    good = all(row["verdict"] != "FAILED" for row in rows)
    if as_json:
        print(json.dumps({"status": Status.OK if good else Status.FAILED, "checks": rows}))
    else:
        report(found)
    raise typer.Exit(DONE if good else CHECK_FAILED)


class _StudyCommand(TyperCommand):
    """`sealdyn study NAME --help` ends with the settings of that study, `sealdyn study --help` with their names."""

    def parse_args(self, context, args):
        if {"-h", "--help"} & set(args):
            from rich.markup import escape

            from .studies._declared import help_text

            self.epilog = escape(help_text(next((word for word in args if word[0] != "-"), "")))
        return super().parse_args(context, args)


@app.command(cls=_StudyCommand, context_settings={"allow_extra_args": True, "ignore_unknown_options": True})
def study(
    context: typer.Context,
    name: Annotated[
        str,
        typer.Argument(
            help="the study, e.g. critical-speed; --help lists them",
            autocompletion=_completes("studies", "study_names"),
        ),
    ],
    file: ScenarioFile,
    set: Overrides = None,
    out: Annotated[Path | None, typer.Option(help="archive to write (default outputs/<scenario>-<study>.h5)")] = None,
    plot: Annotated[bool, typer.Option("--plot/--no-plot", help="draw the study's figure beside the archive")] = True,
    workers: Annotated[int | None, typer.Option(help="processes (default: all cores)", min=1, max=1024)] = None,
    scheduler: Annotated[str | None, typer.Option(help="Dask scheduler in their place, tcp://host:port")] = None,
    results: Annotated[Path | None, typer.Option(help="folder that keeps finished points for other studies")] = None,
    without: Annotated[
        list[str] | None, typer.Option(help="contact (the film alone, no secondary seals either) or secondary-seal")
    ] = None,
    as_json: AsJson = False,
):
    """Answer a question about a scenario; any setting of its table study.NAME may be given as --key value."""
    from .archive import ArchiveError
    from .numerics.cluster import ClusterError
    from .report.text import study_lines
    from .scenario.reader import ScenarioError
    from .scene.scene import SceneError
    from .studies import study_names
    from .studies._runner import archive_of, journal_of, run_study

    names = study_names()
    if name.replace("_", "-") not in names:
        raise Stop(Status.INVALID, f'study: found "{name}"; expected one of {", ".join(names)}{_nearest(name, names)}')
    if scheduler is not None and workers is not None:
        raise Stop(Status.INVALID, f"--workers: found {workers}; expected nothing, the scheduler has its own")
    scenario = _read(file, set)
    out = archive_of(name, scenario, out)
    leaves(lambda: kept_of_study(journal_of(out), results))
    with Progress() as bar, libraries_on_stderr():
        try:
            answer = run_study(
                name, scenario, out, flags=_flags(context.args), workers=workers, scheduler=scheduler, results=results,
                progress=bar, leave_out=without or (),
            )  # fmt: skip
        except (ScenarioError, SceneError) as error:
            where = "" if isinstance(error, ScenarioError) else f"{file}: "
            raise Stop(Status.INVALID, f"{where}{error}") from None
        except (ClusterError, ArchiveError) as error:
            raise Stop(Status.INVALID, str(error)) from None
        except OSError as error:
            raise not_written(error, error.filename or out, left["words"]()) from None
    leaves(lambda: f"the study is complete: {answer['archive']}")
    if plot and (figure := drawn("panels", Path(answer["archive"]))):
        answer["figure"] = figure
    if as_json:
        print(json.dumps(answer))
    else:
        files = "  files: " + ", ".join(answer[k] for k in ("archive", "figure") if answer.get(k))
        say(f"{scenario.name}, study {name}:", *study_lines(answer), files)
    raise typer.Exit(EXIT[answer["status"]])


def _nearest(name: str, names) -> str:
    from .scenario.errors import nearest_of

    return nearest_of(name, names)


def _flags(words: list[str]) -> dict:
    """`--key value` and `--key=value` of a study's settings; a key given several times becomes a list."""
    flags, words = {}, list(words)
    while words:
        word = words.pop(0)
        if not word.startswith("--"):
            raise Stop(Status.INVALID, f'study: found "{word}"; expected settings as --key value')
        key, equals, value = word[2:].partition("=")
        if not equals:
            if not words:
                raise Stop(Status.INVALID, f"study: --{key} has no value")
            value = words.pop(0)
        with contextlib.suppress(ValueError, RecursionError):
            value = json.loads(value)
        key = key.replace("-", "_")
        before = flags.get(key, [])
        flags[key] = [*(before if isinstance(before, list) else [before]), value] if key in flags else value
    return flags


def main():
    """Entry point."""
    carried_out(app)


if __name__ == "__main__":
    main()

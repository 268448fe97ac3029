"""The world around a run: streams that are closed or full, names, folders, limits and settings that nobody foresaw."""

import ctypes
import os
import random
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from threading import Timer

from sealdyn.archive import ArchiveError, read_info

from .outcome import SLOW, judged, shared

SEAL = Path(__file__).parents[3] / "scenarios" / "fms_reference.toml"
COMMAND = [sys.executable, "-m", "sealdyn.cli"]
LIBC = ctypes.CDLL(None)
# Longest time (s); where kernels are compiled anew; where there is an end to be waited for.
PATIENCE, COMPILING = 60, 400
SHORT = ("--set", "run.turns=4", "--set", "run.samples_per_turn=16")


def worlds(ledger, seed, numbers, folder: Path) -> None:
    """A run in each of them: done, or refused in one line; of what is done the archive is whole."""
    every = sorted(WORLDS.items())
    random.Random(seed).shuffle(every)
    for number in numbers:
        name, place = every[number]
        here = folder / f"world-{number}"
        here.mkdir()
        outcome, how, error = world(place, here, (0, 130) if name in ENDED else (0, 2, 3, 4, 5))
        ledger.note("hostile world", outcome, how and f"{name}: {how}", error)
        shutil.rmtree(here, ignore_errors=True)


def world(place, here, allowed=(0, 2, 3, 4, 5)) -> tuple[str, str, str]:
    """Outcome of one of them in the empty folder `here`, how it came through, and what was said; `allowed` exit
    codes."""
    code, error, out = place(here)
    outcome, how = judged(code, error, allowed)
    if not how and code == 0 and out is not None:
        outcome, how = _whole(out, here, outcome)
    return outcome, how, error


def _whole(out, here, outcome):
    try:
        rows = read_info(out)["rows"]
    except ArchiveError as error:
        return "escaped", f"no whole archive: {error}"
    left = [path.name for path in here.iterdir() if path.suffix in (".new", ".lock") or ".partial" in path.name]
    return ("escaped", f"left behind: {left}") if rows != 65 or left else (outcome, "")


def ran(
    here, *words, env=None, patience=PATIENCE, out="a.h5", scenario=SEAL, verb="run", command=tuple(COMMAND), **how
):
    """Exit code, standard error, and the archive of a run."""
    # A whole path stays one.
    out = here / out
    given = [verb, scenario, *SHORT, *words] + (["--out", out] if verb == "run" else [])
    how = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, **how}
    among = {**os.environ, **(env or {})}
    among = {name: value for name, value in among.items() if value is not None}
    try:
        done = subprocess.run([*command, *given], env=among, timeout=shared(patience), **how)
    except subprocess.TimeoutExpired:
        return SLOW, "", None
    return done.returncode, (done.stderr or b"").decode(errors="replace"), out if verb == "run" else None


def _with(patience=PATIENCE, **env):
    return lambda here: ran(here, env=env, patience=patience)


def _limited(what, most):
    return lambda here: ran(here, preexec_fn=lambda: resource.setrlimit(what, (most, most)))


def _shell(words):
    """The command within a line of a shell, in place of %s."""

    def place(here):
        command = " ".join([sys.executable, "-m", "sealdyn.cli", "run", str(SEAL), *SHORT, "--out", str(here / "a.h5")])
        try:
            nothing = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
            line = ["sh", "-c", words.replace("%s", command)]
            done = subprocess.run(line, timeout=shared(PATIENCE), cwd=here, **nothing)
        except subprocess.TimeoutExpired:
            return SLOW, "", None
        return done.returncode, done.stderr.decode(errors="replace"), here / "a.h5" if done.returncode == 0 else None

    return place


def symlink(here):
    """Its target is written."""
    (here / "there").mkdir()
    (here / "there" / "b.h5").write_bytes(b"")
    (here / "a.h5").symlink_to(here / "there" / "b.h5")
    code, error, _ = ran(here)
    whole = (here / "a.h5").is_symlink() and (here / "there" / "b.h5").stat().st_size > 1000
    return code if whole else 70, error + ("" if whole else "the symlink was replaced"), here / "there" / "b.h5"


def fifo(here):
    os.mkfifo(here / "a.h5")
    code, error, _ = ran(here)
    return code if code != 0 else 70, error, None


def endless(here):
    os.mkfifo(here / "a.toml")
    return ran(here, scenario=here / "a.toml")


def huge(here):
    with open(here / "a.toml", "wb") as file:
        file.truncate(3 << 30)
    return ran(here, scenario=here / "a.toml")


def unicode_name(env):
    return lambda here: ran(here, scenario=shutil.copyfile(SEAL, here / "Gleitring ±µ 密封 😀.toml"), env=env,
                            out="Läufer ± 密封 😀.h5")  # fmt: skip


def no_utf8(here):
    name = os.path.join(os.fsencode(here), b"a\xff\xfe.toml")
    shutil.copyfile(SEAL, name)
    return ran(here, scenario=name, out=Path(os.fsdecode(os.path.join(os.fsencode(here), b"b\xff.h5"))))


def lost_folder(here):
    gone = here / "gone"
    gone.mkdir()
    return ran(here, cwd=gone, preexec_fn=lambda: os.rmdir(gone))


def damaged_kernels(here):
    """Kept kernels, half of them cut, half of them nonsense."""
    kept = here / "kernels"
    code, error, _ = ran(here, env={"NUMBA_CACHE_DIR": str(kept)}, patience=COMPILING)
    files = [path for path in kept.rglob("*") if path.is_file() and path.suffix in (".nbi", ".nbc")]
    if code or not files:
        return 70, f"{error}no kernels in {kept}", None
    for number, path in enumerate(sorted(files)):
        data = path.read_bytes()
        path.write_bytes(data[: len(data) // 2] if number % 2 else bytes(255 - byte for byte in data))
    return ran(here, env={"NUMBA_CACHE_DIR": str(kept)}, patience=COMPILING)


def immutable(here):
    """Where the system knows such files and we may make them."""
    (here / "a.h5").write_bytes(b"mine")
    made = (
        subprocess.run(["chattr", "+i", here / "a.h5"], capture_output=True).returncode == 0
        if shutil.which("chattr")
        else False
    )
    try:
        code, error, out = ran(here)
        left = [path.name for path in here.iterdir() if path.name != "a.h5"]
        return (70, f"left: {left}", None) if made and [n for n in left if "partial" not in n] else (code, error, out)
    finally:
        if made:
            subprocess.run(["chattr", "-i", here / "a.h5"])


def _no_rights():
    """Be bound by the permissions of files, as who is not root is: from the command on."""
    if os.geteuid() == 0:
        for right in (1, 2, 3):  # CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH, CAP_FOWNER
            LIBC.prctl(24, right, 0, 0, 0)  # PR_CAPBSET_DROP


def read_only(here, kept=None, out=False):
    """Home, folder and temporary folder can be read, and nothing more; kernels are those `kept`; `out`: one folder for
    what is asked for can be written."""
    for name in ("home", "out"):
        (here / name).mkdir()
    os.chmod(here / "home", 0o555)
    env = {"HOME": str(here / "home"), "XDG_CACHE_HOME": None, "MPLCONFIGDIR": None, "TMPDIR": str(here / "home")}
    env |= {"NUMBA_CACHE_DIR": str(kept)} if kept else {}
    os.chmod(here, 0o555)
    try:
        where = "out/a.h5" if out else "a.h5"
        return ran(here, env=env, out=where, cwd=here, patience=COMPILING, preexec_fn=_no_rights)
    finally:
        os.chmod(here, 0o755)


def read_only_kernels(here):
    """Kept kernels of another, in a folder where nothing can be written, with the marks of a clock of tomorrow."""
    kept, late = here / "kernels", time.time() + 1e8
    code, error, _ = ran(here, env={"NUMBA_CACHE_DIR": str(kept)}, patience=COMPILING)
    if code:
        return code, error, None
    for path in (*kept.rglob("*"), kept):
        os.utime(path, (late, late))
        os.chmod(path, 0o555 if path.is_dir() else 0o444)
    return read_only(here, kept, out=True)


def no_processor(here):
    """Kernels for it are kept apart."""
    env = {"NUMBA_CPU_NAME": "nonsense", "NUMBA_CACHE_DIR": str(here / "kernels")}
    return ran(here, env=env, patience=COMPILING)


def rc_file(here):
    """Settings of matplotlib that are none, where it looks for them first."""
    (here / "matplotlibrc").write_text("backend: nonsense\nfont.size: -3\n\x00\xff: : :\n")
    return ran(here, cwd=here)


def other_letters(here):
    """Of the folder one stands in, a line break among them."""
    at = here / "Läufer 密封 \n ±"
    at.mkdir()
    return ran(here, cwd=at, out=at / "a.h5")


def shadows(here):
    """Files in the folder that are named as what is imported."""
    for name in ("numpy", "json", "h5py", "signal", "sealdyn"):
        (here / f"{name}.py").write_text("raise SystemExit(70)\n")
    program = Path(sys.executable).with_name("sealdyn")
    return ran(here, cwd=here, command=[str(program)]) if program.exists() else (2, "", None)


def terminal(here):
    """One of no size, whose type nobody knows."""
    import pty

    ours, theirs = pty.openpty()
    try:
        env = {"TERM": "nobody-knows", "COLUMNS": "0", "LINES": "-1"}
        return ran(here, env=env, stdin=theirs, stdout=theirs)
    finally:
        os.close(ours)
        os.close(theirs)


def full_pipe(here):
    """Standard output is a pipe with room for nothing, and its reader goes."""
    ours, theirs = os.pipe()
    os.set_blocking(theirs, False)
    try:
        while True:
            os.write(theirs, bytes(65536))
    except BlockingIOError:
        pass
    os.set_blocking(theirs, True)
    Timer(5.0, os.close, (ours,)).start()
    try:
        return ran(here, stdout=theirs)
    finally:
        os.close(theirs)


def _before(*steps):
    """Steps that the process does before it becomes the command."""
    return lambda here: ran(here, preexec_fn=lambda: [step() for step in steps])


def _ignored(*signals):
    return lambda here: ran(
        here, restore_signals=False, preexec_fn=lambda: [signal.signal(n, signal.SIG_IGN) for n in signals]
    )


def _blocked():
    signal.pthread_sigmask(signal.SIG_BLOCK, signal.valid_signals())


WORLDS = {
    "C locale": _with(LC_ALL="C", PYTHONUTF8="0", PYTHONCOERCECLOCALE="0"),
    "ascii streams": _with(PYTHONIOENCODING="ascii"),
    "nonsense locale": _with(LC_ALL="xx_YY.nonsense"),
    "unicode names": unicode_name({}),
    "unicode names, C locale": unicode_name({"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}),
    "names without UTF-8": no_utf8,
    "a name of 240 characters": lambda here: ran(here, out="a" * 237 + ".h5"),
    "a name of 400 characters": lambda here: ran(here, out="a" * 400 + ".h5"),
    "a name of two lines": lambda here: ran(here, out="a\nb.h5"),
    "figures for a screen that is none": _with(MPLBACKEND="nonsense"),
    "no folder for matplotlib": _with(MPLCONFIGDIR="/proc/nothing"),
    "no home": _with(HOME=None),
    "a home that is not there": _with(HOME="/nothing", XDG_CACHE_HOME="/proc/nothing"),
    "no temporary folder": _with(TMPDIR="/nothing"),
    "a terminal of one column": _with(COLUMNS="1", LINES="1", TERM="dumb"),
    "no terminal at all": _with(TERM=None, COLUMNS="nonsense"),
    "warnings are errors": _with(PYTHONWARNINGS="error"),
    "no docstrings": _with(COMPILING, PYTHONOPTIMIZE="2"),
    "threads that are no number": _with(OMP_NUM_THREADS="nonsense", NUMBA_NUM_THREADS="1"),
    "a time zone that is none": _with(TZ="nonsense"),
    "output closed": _shell("%s >&-"),
    "errors closed": _shell("%s 2>&-"),
    "all closed": _shell("%s <&- >&- 2>&-"),
    "output full": _shell("%s >/dev/full"),
    "errors full": _shell("%s 2>/dev/full"),
    "output read by nobody": _shell("%s | true"),
    "a umask that forbids all": _shell("umask 777; %s"),
    "16 open files": _limited(resource.RLIMIT_NOFILE, 16),
    "files of 64 kB at most": _limited(resource.RLIMIT_FSIZE, 1 << 16),
    "files of nothing": _limited(resource.RLIMIT_FSIZE, 0),
    "3 GB of memory": _limited(resource.RLIMIT_AS, 3 << 30),
    "a symlink": symlink,
    "a symlink to nothing": lambda here: ((here / "a.h5").symlink_to(here / "b.h5"), ran(here))[1],
    "a symlink to itself": lambda here: ((here / "a.h5").symlink_to(here / "a.h5"), ran(here))[1],
    "a FIFO as output": fifo,
    "a folder as output": lambda here: ((here / "a.h5").mkdir(), ran(here))[1],
    "a folder that is a file": lambda here: ((here / "b").write_text(""), ran(here, out="b/a.h5"))[1],
    "a folder in /proc": lambda here: ran(here, out=Path("/proc/nothing/a.h5")),
    "a device as output": lambda here: ran(here, out=Path("/dev/null/a.h5")),
    "immutable output": immutable,
    "endless scenario": lambda here: ran(here, scenario="/dev/zero"),
    "a FIFO as scenario": endless,
    "a scenario of 3 GB": huge,
    "a folder as scenario": lambda here: ran(here, scenario=here),
    "a folder that is gone": lost_folder,
    "a folder of other letters": other_letters,
    "files of the names of modules": shadows,
    "nothing can be written": read_only,
    "nothing but the answer can be written": lambda here: read_only(here, out=True),
    "kernels that are another's, of tomorrow": read_only_kernels,
    "kernels nowhere": _with(COMPILING, NUMBA_CACHE_DIR="/proc/nothing", PYTHONPYCACHEPREFIX="/proc/nothing"),
    "no compiler": _with(NUMBA_DISABLE_JIT="1"),
    "a processor of no name": no_processor,
    "threads without number": _with(NUMBA_NUM_THREADS="0", OPENBLAS_NUM_THREADS="-1", OMP_NUM_THREADS="100000"),
    "one core": _before(lambda: os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})),
    "no locks": _with(HDF5_USE_FILE_LOCKING="FALSE"),
    "locks of no kind": _with(HDF5_USE_FILE_LOCKING="nonsense", HDF5_PLUGIN_PATH="/dev/null"),
    "SUNDIALS by Python": _with(SEALDYN_SUNDIALS="python"),
    "SUNDIALS by nobody": _with(SEALDYN_SUNDIALS="nonsense"),
    "hashes of chance": _with(PYTHONHASHSEED="4294967295"),
    "developer mode": _with(PYTHONDEVMODE="1", PYTHONMALLOC="debug", PYTHONWARNINGS="error"),
    "no bytecode, no site": _with(PYTHONDONTWRITEBYTECODE="1", PYTHONNOUSERSITE="1", PYTHONSAFEPATH="1"),
    "settings of matplotlib": rc_file,
    "a terminal of no size": terminal,
    "a pipe that is full": full_pipe,
    "no way to programs": _with(PATH="", SHELL=None, USER=None, LOGNAME=None),
    "700 MB of memory": _limited(resource.RLIMIT_AS, 700 << 20),
    "a stack of 128 kB": _limited(resource.RLIMIT_STACK, 1 << 17),
    "a process alone": _limited(resource.RLIMIT_NPROC, 1),
    "no core files, no locked memory": _before(
        lambda: resource.setrlimit(resource.RLIMIT_CORE, (0, 0)),
        lambda: resource.setrlimit(resource.RLIMIT_MEMLOCK, (0, 0)),
    ),
    "one second of processor": _before(lambda: resource.setrlimit(resource.RLIMIT_CPU, (1, resource.RLIM_INFINITY))),
    "signals that are ignored": _ignored(signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGPIPE, signal.SIGCHLD),
    "signals that are blocked": _before(_blocked),
    "damaged kernels": damaged_kernels,
}  # fmt: skip
# Of those a machine ends a run that takes long, which then goes on.
ENDED = {"one second of processor"}

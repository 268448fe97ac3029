"""How a run, or a study, ended."""

from enum import StrEnum


class Status(StrEnum):
    """How a run ended; RUNNING is what an archive says while it is written, or when its run was killed."""

    OK = "ok"
    INACCURATE = "inaccurate"
    COLLAPSED = "collapsed"
    FAILED = "failed"
    INTERRUPTED = "interrupted"
    INVALID = "invalid"
    RUNNING = "running"

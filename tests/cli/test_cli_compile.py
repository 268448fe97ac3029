"""Verbs say that they compile; kernels made beforehand are those of `python tests/benchmark/compiled_ahead.py`."""

import time

from sealdyn import kernel_cache, terminal


def test_any_verb_says_once_that_it_compiles(monkeypatch, capsys):
    """Compiling that lasts is told when the next kernel begins, on a terminal or not; what is done at once is not."""
    monkeypatch.setattr(terminal, "PATIENCE", 0.05)
    with terminal.Progress() as bar:
        bar.timer.cancel()
        (tell,) = kernel_cache.compiling
        tell(1), tell(-1)
        assert capsys.readouterr().err == ""
        time.sleep(0.06)
        tell(1), tell(1), tell(-1), tell(-1)
        assert capsys.readouterr().err.count("\n") == 1
    assert kernel_cache.compiling == []

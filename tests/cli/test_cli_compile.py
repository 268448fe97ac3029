"""Verbs say that they compile; kernels made beforehand are those of `python tests/benchmark/compiled_ahead.py`."""

from sealdyn import kernel_cache, terminal


def test_any_verb_says_once_that_it_compiles(monkeypatch, capsys):
    """Compiling that lasts is told when the next kernel begins, on a terminal or not; what is done at once is not."""
    now = [1.0]
    monkeypatch.setattr(terminal, "monotonic", lambda: now[0])
    with terminal.Progress() as bar:
        bar.timer.cancel()
        (tell,) = kernel_cache.compiling
        tell(1), tell(-1)
        now[0] += 0.9 * terminal.PATIENCE
        tell(1), tell(-1)
        assert capsys.readouterr().err == ""
        now[0] += 0.2 * terminal.PATIENCE
        tell(1), tell(1), tell(-1), tell(-1)
        assert capsys.readouterr().err.count("\n") == 1
    assert kernel_cache.compiling == []

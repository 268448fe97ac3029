"""Exhibits: files by subject, of places where a method fails, shown in the order of their items.

What every file offers (the contract): `EXHIBITS` {name: (item, show, meets)}:

`item`       int; exhibits of one number belong to one place where methods fail.
`show()`     list of rows, made by running the failing method and the survivor on a small scene of the reference seal
             (Green, 1989); at most some seconds.  A row is a dict: `item`, `title`, `failing` and `survivor` (what each
             is), `failing_error` and `survivor_error` (numbers in `unit`; None: no answer at all), `unit`, and
             `default`, a sentence on what the program does by itself.
`meets(scene, run)`  what of a scene and its run (RunState, made ready) leads to this place, in words, or empty.

An exhibit may use a bare library method: the naive use of it is what fails.
"""

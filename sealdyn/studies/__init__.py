"""Studies: one file per question, found by file name (hyphens on the command line, underscores in files).

What every study module offers (the contract):

`Settings`  frozen dataclass: the keys of `[study.NAME]` with their defaults and units (types of units.py);
            flags `--key value` on the command line override.
`run(scenario, settings, tools) -> dict`
            the answer, JSON-ready, with the keys of `study --json` and `verdict`, a list of at most three sentences,
            the answer to the question first.
            `tools.map(function, points, what)` evaluates a module-level function of one JSON-able point on all
            cores or on other machines, remembers finished points across interruptions, and returns a list of rows: the
            function's dict, or `{"failed": reason}`: the verdict then also says how many failed and why the first did.
            A row hangs on nothing but the function, what it is bound to (a scenario, a scene), and the point: whoever
            asks the same again may get it from a folder of results.
            `tools.alone()` does so one point after the other, here, for rows that measure time.
            `tools.say(fraction)` reports progress of anything else, `tools.tell(words)` says a line before a long wait.
`tables(answer)`  pairs of rows and columns printed below the verdict (report.text.study_lines), if there are any.
`REFUSES`   of "contact" and "secondary-seal" what the study cannot reckon with: a scenario that has it is refused, and
            --without leaves it out.  A study of small motion refuses secondary seals: their rings stick in it.
`WITH_WAVES`    True if the study reckons with wavy faces, or does not ask how thin the film is; else it refuses them.
`units`     dict: result key (joined by "/"), or its end, or "*" for all others -> units, for the archive; of elements
            with units of their own a list.  What hangs on the scenario is in a table `units` of the answer.
`ALONG`     (if any) dict: table of the answer, or path of a column -> names of what it lies along, in the order of its
            axes: the dimensions of its numbers for those who open the archive (archive/tables.py).

The chart of a study has the same name in `charts` with the prefix `study_`, and draws from the study's archive only.
A study knows scenarios, models and solvers; it never opens a file or draws.
"""

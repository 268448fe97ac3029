"""Sources: published numbers beside what the program computes, one file per source, found by file name.

What every source offers:

`TITLE`     a line: the source, what is held against it, the units of its table.
`FILM`      the film that it is held against, by the name of its file.
`COVERS`    what of a seal it stands for, in a few words.
`checks()`  a list of rows (dicts), one per printed number, SI units:
              source        str, publication and place in it
              quantity      str
              published     the printed number; None: none printed, or the source says that there is none
              deviation     what is computed over `published`, less 1; None without one
              roads_apart   largest difference of the methods, relative; None with one method only
              verdict       "agrees" | "rounding" (follows from the digits printed) | "print differs" (the error of the
                            source itself, explained in `remark`) | "unexplained" (not the printed number, though two
                            independent computations agree) | "FAILED"
              remark        str, "" if there is nothing to say
            and what else tells the rows of this source apart.
`HEAD`      headings of its table.
`cells(row)`  a line of it, a str per heading.
`place(row)`  which line a remark speaks of, a few words.

results.json keeps the rows for pages that must be quick: tests/benchmark/validation_results.py writes it.
"""

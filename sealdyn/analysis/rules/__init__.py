"""Design rules that a seal can be held against before it runs, one file per rule, found by file name.

**Source** Hayden & Keller, Design Guide for Helicopter Transmission Seals, NASA CR-120997 (1974): experience with oil
in gearboxes, good for a first judgement of other seals.  Limits are as printed, in SI.

What every rule offers:

`SOURCE`         what of the guide its numbers are, with the table or section where that is known
`COMMAND`        what tests the rule in the time domain or on the film, "" if nothing does
`finding(seal)`  what comes of it (`Finding`, _finding.py) for a `Seal` (_seal.py)

Its file name is the rule's name, under which [application.acknowledge] gives the reason for breaking it.
"""

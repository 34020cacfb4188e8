"""Two copies of a season that went apart become one: all that is in either, once each.

`merge` has the recipe; each other module has one kind of row. A row is known again by what it says
and by the batch it came with, never by its number. What was taken back in one copy is taken back.
What both recorded for themselves counts once; the later one stands back for the first until that
one is taken back. A treatment is known again whatever labels added to it (`treatments.known_by`).
Everything is put in the order in which it was recorded, so that it does not matter which copy takes
in the other; what a copy recorded later stays so, whatever its clock said. Inspections that both
copies begin with, and that come out where they are, are left there: of a long season these are
nearly all.

What is refused here pages may show, so that it is `worded`; what came of merging only commands and
programs say.
"""

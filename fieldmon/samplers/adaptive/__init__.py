"""Adaptive: the drive that is expected to find most in the hours left, planned anew after a find.

The hours have a price: a plant is worth its stop, and a row its drive, only if what is expected
there is worth more than the seconds cost; and of several inspection times it gets the one that is
worth most more than it costs. The price is set so that the day is just filled. At a given price
the best tour of the rows, one after the other up or down the plot, is found by dynamic programming
(a profitable tour problem: Feillet, Dejax & Gendreau 2005; here rows are passed by, driven
through, or entered and left by the same end).

`sampler` holds its settings, `day` the day as it goes, `replan` the price and the plan at it,
`tours` the best tours over the rows, `rows` what each way of driving a row comes to, and `arrays`
what all of them work in.
"""

from fieldmon.samplers.adaptive.sampler import Adaptive

__all__ = ["Adaptive"]

"""Many days: seasons, and experiments of many seasons.

`season` walks through the days from a `start`, and `metrics` says what they come to. `experiment`
cuts settings and seeds into chunks and has an `executor` run them on threads, processes or many
machines. A study of one's own plots is such an experiment: `design` says what is compared,
`worker` simulates a chunk of it, and `results` keeps what comes back.
"""

"""Studies of one's own: samplers x settings x seeds on any plots, on as many machines as there are.

`design` says what is compared, `chunks` simulates a few seconds of it, `engine` has Dask do so on
one machine or many, and `store` keeps what comes back.
"""
